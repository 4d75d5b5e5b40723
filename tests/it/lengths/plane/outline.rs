//! Polygons joined in the plane, and their lengths by closed forms: every edge and every corner is
//! looked at, for every point.

use glam::DVec2;

/// Lengths that are less are rounding.
const ROUNDING: f64 = 1e-9;

/// What is inside of some polygons, joined, and the pieces of their edges that are its border.
pub struct Outline {
    pieces: Vec<[DVec2; 2]>,
    polygons: Vec<Vec<DVec2>>,
    holds: fn(&[bool]) -> bool,
}

/// Whether a point is inside of a polygon.
fn contains(polygon: &[DVec2], p: DVec2) -> bool {
    let ends = polygon.iter().zip(polygon.iter().cycle().skip(1));
    let crossed =
        ends.filter(|(a, b)| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x));
    crossed.count() % 2 == 1
}

/// How far along a line from `a` to `b` another one crosses it, and how far along that one.
fn crossing([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> Option<[f64; 2]> {
    let (along, other) = (b - a, d - c);
    let sine = along.perp_dot(other);
    (sine.abs() > 1e-12 * along.length() * other.length())
        .then(|| [(c - a).perp_dot(other) / sine, (c - a).perp_dot(along) / sine])
}

impl Outline {
    /// Of polygons; what is inside is told by which of them a point is in.
    pub fn new(polygons: Vec<Vec<DVec2>>, holds: fn(&[bool]) -> bool) -> Outline {
        let edges = polygons.iter().flat_map(|polygon| polygon.iter().zip(polygon.iter().cycle().skip(1)));
        let edges: Vec<[DVec2; 2]> = edges.map(|(a, b)| [*a, *b]).collect();
        let mut outline = Outline { pieces: Vec::new(), polygons, holds };
        for edge in &edges {
            let mut cuts = vec![0.0, 1.0];
            let crossings = edges.iter().filter_map(|other| crossing(*edge, *other));
            cuts.extend(crossings.filter(|[s, t]| (0.0..=1.0).contains(s) && (0.0..=1.0).contains(t)).map(|[s, _]| s));
            cuts.sort_by(f64::total_cmp);
            cuts.dedup_by(|a, b| (*a - *b).abs() < 1e-12);
            let [a, b] = *edge;
            let across = 1e-7 * (b - a).normalize().perp();
            for ends in cuts.windows(2) {
                let middle = a.lerp(b, 0.5 * (ends[0] + ends[1]));
                if outline.contains(middle + across) != outline.contains(middle - across) {
                    outline.pieces.push([a.lerp(b, ends[0]), a.lerp(b, ends[1])]);
                }
            }
        }
        outline
    }

    pub fn contains(&self, p: DVec2) -> bool {
        let inside: Vec<bool> = self.polygons.iter().map(|polygon| contains(polygon, p)).collect();
        (self.holds)(&inside)
    }

    /// The signed distance, positive inside.
    pub fn distance(&self, p: DVec2) -> f64 {
        let way = |[a, b]: &[DVec2; 2]| p.distance(foot(p, *a, *b));
        let way = self.pieces.iter().map(way).fold(f64::INFINITY, f64::min);
        if self.contains(p) { way } else { -way }
    }

    /// A point of the border.
    pub fn point(&self, number: usize, along: f64) -> DVec2 {
        let [a, b] = self.pieces[number % self.pieces.len()];
        a.lerp(b, along)
    }

    pub fn len(&self) -> usize {
        self.pieces.len()
    }

    /// Where the distance is `level`.
    pub fn level(&self, level: f64) -> Level<'_> {
        let r = level.abs();
        let sides = self.pieces.iter().flat_map(|[a, b]| {
            let across = r * (b - a).normalize().perp();
            [[*a + across, *b + across], [*a - across, *b - across]]
        });
        let sides: Vec<[DVec2; 2]> = sides.collect();
        let mut centres: Vec<DVec2> = Vec::new();
        for p in self.pieces.iter().flatten() {
            if centres.iter().all(|q| q.distance(*p) > 1e-9) {
                centres.push(*p);
            }
        }
        let mut corners: Vec<DVec2> = sides.iter().flatten().copied().collect();
        for (number, side) in sides.iter().enumerate() {
            let crossings = sides[number + 1..].iter().filter_map(|other| crossing(*side, *other));
            corners.extend(crossings.map(|[s, _]| side[0].lerp(side[1], s)));
            corners.extend(centres.iter().flat_map(|c| on_circle(*c, r, side[0], side[1])));
        }
        for (number, c) in centres.iter().enumerate() {
            corners.extend(centres[number + 1..].iter().flat_map(|d| {
                let (middle, apart) = (0.5 * (c + d), d - c);
                let across = r * r - 0.25 * apart.length_squared();
                let by = across.max(0.0).sqrt() * apart.normalize().perp();
                if across < 0.0 { [DVec2::NAN; 2] } else { [middle + by, middle - by] }
            }));
        }
        let mut found = Level { outline: self, level, sides, centres, corners: Vec::new() };
        corners.retain(|p| found.has(*p));
        found.corners = corners;
        found
    }
}

/// The points of a line that are at a distance from a point.
fn on_circle(c: DVec2, r: f64, a: DVec2, b: DVec2) -> [DVec2; 2] {
    let along = (b - a).normalize();
    let foot = a + (c - a).dot(along) * along;
    let rest = r * r - foot.distance_squared(c);
    // Lines that only touch the circle do so at the ends of sides.
    if rest < 0.0 { [DVec2::NAN; 2] } else { [foot + rest.sqrt() * along, foot - rest.sqrt() * along] }
}

fn foot(p: DVec2, a: DVec2, b: DVec2) -> DVec2 {
    let along = b - a;
    a + ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0) * along
}

/// The curve on which an outline's distance is a number: parts of straight lines beside its pieces,
/// of circles about its corners, and the corners of those.
pub struct Level<'a> {
    outline: &'a Outline,
    level: f64,
    sides: Vec<[DVec2; 2]>,
    centres: Vec<DVec2>,
    corners: Vec<DVec2>,
}

impl Level<'_> {
    fn has(&self, p: DVec2) -> bool {
        !p.is_nan() && (self.outline.distance(p) - self.level).abs() < ROUNDING
    }

    /// How far a point is from the curve, which is infinitely far if there is none.
    pub fn way(&self, p: DVec2) -> f64 {
        let r = self.level.abs();
        let beside = self.sides.iter().map(|[a, b]| foot(p, *a, *b));
        let about = self.centres.iter().map(|c| c + r * (p - c).normalize_or(DVec2::X));
        let mut least = self.corners.iter().map(|q| p.distance(*q)).fold(f64::INFINITY, f64::min);
        for q in beside.chain(about) {
            let way = p.distance(q);
            if way < least && self.has(q) {
                least = way;
            }
        }
        least
    }

    /// The signed distance to what is deeper than the level, positive inside.
    pub fn distance(&self, p: DVec2) -> f64 {
        let way = self.way(p);
        if self.outline.distance(p) > self.level { way } else { -way }
    }
}

#[test]
fn the_reference_is_right_about_a_square() {
    let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]].map(DVec2::from).to_vec();
    let outline = Outline::new(vec![square], |inside| inside[0]);
    assert_eq!(outline.len(), 4);
    let eroded = outline.level(1.0);
    assert!((eroded.distance(DVec2::ZERO) + 2f64.sqrt()).abs() < 1e-12);
    assert!((eroded.distance(DVec2::new(2.0, 1.5)) - 0.5).abs() < 1e-12);
    let grown = outline.level(-1.0);
    assert!((grown.distance(DVec2::new(-1.0, -1.0)) - (1.0 - 2f64.sqrt())).abs() < 1e-12);
    assert!((grown.distance(DVec2::new(1.0, 1.0)) - 2.0).abs() < 1e-12);
}
