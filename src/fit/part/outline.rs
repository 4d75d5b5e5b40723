//! The outline of an extruded profile: few corners, with straight sides or arcs between them.
//!
//! ```text
//!      .---------.
//!      |          \        sides are straight, or arcs of at most half a turn: to the right of the
//!      |           )       way from corner to corner where the radius is positive, to the left
//!      |          /        where it is negative
//!      '---------'
//! ```

use glam::DVec2;

use crate::{Profile, RFunction};

/// How far other sides may reach into a disc that is added or cut as a whole, in radii.
const OFF: f64 = 2e-3;

/// A closed outline without holes, counter-clockwise or not.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::fit) struct Outline {
    pub(in crate::fit) corners: Vec<DVec2>,
    /// Of the side from each corner to the next: the radius of an arc, or 0.
    pub(in crate::fit) radii: Vec<f64>,
}

/// An arc from corner to corner.
#[derive(Clone, Copy, Debug)]
struct Arc {
    ends: [DVec2; 2],
    centre: DVec2,
    radius: f64,
    /// From the centre to the middle of the arc, of length 1.
    middle: DVec2,
    /// How far the chord is from the centre.
    chord: f64,
    is_outward: bool,
}

impl Arc {
    /// From one point to another; of a radius below 0 to the left.
    fn of([a, b]: [DVec2; 2], radius: f64) -> Arc {
        let half = 0.5 * a.distance(b);
        let size = radius.abs().max(half);
        let chord = (size * size - half * half).max(0.0).sqrt();
        let right = -(b - a).perp().normalize_or(DVec2::X);
        let middle = if radius > 0.0 { right } else { -right };
        Arc {
            ends: [a, b],
            centre: 0.5 * (a + b) - chord * middle,
            radius: size,
            middle,
            chord,
            is_outward: radius > 0.0,
        }
    }

    /// Whether a point is between the arc and its chord.
    fn holds(&self, p: DVec2) -> bool {
        let from = p - self.centre;
        from.dot(self.middle) > self.chord && from.length_squared() < self.radius * self.radius
    }

    fn distance(&self, p: DVec2) -> f64 {
        let from = p - self.centre;
        let away = from.length();
        if from.dot(self.middle) * self.radius >= self.chord * away {
            (away - self.radius).abs()
        } else {
            self.ends.map(|end| end.distance(p)).into_iter().fold(f64::INFINITY, f64::min)
        }
    }

    /// What is between the arc and its chord, or the whole disc.
    fn profile(&self, whole: bool) -> Profile {
        let disc = Profile::circle(self.radius).translate(self.centre);
        if whole {
            return disc;
        }
        let [a, b] = self.ends;
        let out = (self.radius - self.chord) * self.middle;
        disc.intersection(Profile::polygon([a, b, b + out, a + out]), RFunction::MIN_MAX)
    }
}

impl Outline {
    /// Without arcs.
    pub(in crate::fit) fn polygon(corners: Vec<DVec2>) -> Outline {
        Outline { radii: vec![0.0; corners.len()], corners }
    }

    /// The sides, each from a corner to the next, with their radii.
    fn sides(&self) -> impl Iterator<Item = ([DVec2; 2], f64)> + '_ {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().copied().zip(next.copied()).map(|(a, b)| [a, b]).zip(self.radii.iter().copied())
    }

    fn arcs(&self) -> impl Iterator<Item = Arc> + '_ {
        self.sides().filter(|(_, radius)| *radius != 0.0).map(|(ends, radius)| Arc::of(ends, radius))
    }

    /// How many of the sides are arcs.
    pub(in crate::fit) fn arc_count(&self) -> usize {
        self.radii.iter().filter(|radius| **radius != 0.0).count()
    }

    /// By how much more than its middle the radius of each arc between the same ends may be off:
    /// more of flat arcs, less of those that go around for long.
    pub(super) fn leverages(&self) -> impl Iterator<Item = f64> + '_ {
        self.arcs().map(|arc| (arc.chord / (arc.radius - arc.chord)).clamp(0.1, 200.0))
    }

    pub(in crate::fit) fn contains(&self, p: DVec2) -> bool {
        let mut inside = false;
        for ([a, b], _) in self.sides() {
            if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y) {
                inside = !inside;
            }
        }
        self.arcs().fold(inside, |inside, arc| inside != arc.holds(p))
    }

    /// The signed distance, negative inside.
    pub(in crate::fit) fn distance(&self, p: DVec2) -> f64 {
        let distance = self.sides().map(|side| from_side(side, p)).fold(f64::INFINITY, f64::min);
        if self.contains(p) { -distance } else { distance }
    }

    /// How far it reaches from the origin along the axes.
    pub(in crate::fit) fn reach(&self) -> DVec2 {
        let corners = self.corners.iter().fold(DVec2::ZERO, |reach, corner| reach.max(corner.abs()));
        let ends = |arc: Arc| {
            [DVec2::X, DVec2::Y, -DVec2::X, -DVec2::Y].map(|axis| {
                let end = arc.centre + arc.radius * axis;
                if axis.dot(arc.middle) * arc.radius > arc.chord { end } else { DVec2::ZERO }
            })
        };
        self.arcs().flat_map(ends).fold(corners, |reach, end| reach.max(end.abs()))
    }

    pub(in crate::fit) fn scaled(&self, factor: f64) -> Outline {
        Outline {
            corners: self.corners.iter().map(|corner| factor * *corner).collect(),
            radii: self.radii.iter().map(|radius| factor * radius).collect(),
        }
    }

    /// The polygon of the corners, with discs added and cut where sides are arcs.
    pub(in crate::fit) fn profile(&self) -> Profile {
        let polygon = Profile::polygon(self.corners.iter().copied());
        let is_clockwise = super::sections::area(&self.corners) < 0.0;
        let mut discs = [Vec::new(), Vec::new()];
        for (n, (ends, radius)) in self.sides().enumerate().filter(|(_, (_, radius))| *radius != 0.0) {
            let arc = Arc::of(ends, radius);
            let adds = arc.is_outward != is_clockwise;
            // A disc that no other side reaches into is beyond the chord what the outline is there.
            let mut others = self.sides().enumerate().filter(|(other, _)| *other != n);
            let is_alone = others.all(|(_, side)| from_side(side, arc.centre) > (1.0 - OFF) * arc.radius);
            discs[usize::from(!adds)].push(arc.profile(is_alone));
        }
        let [added, cut] = discs;
        let whole = match added.is_empty() {
            true => polygon,
            false => Profile::union_all([polygon].into_iter().chain(added), RFunction::MIN_MAX),
        };
        if cut.is_empty() { whole } else { whole.difference_all(cut, RFunction::MIN_MAX) }
    }
}

/// How far a point is from a side: straight, or an arc.
fn from_side(([a, b], radius): ([DVec2; 2], f64), p: DVec2) -> f64 {
    if radius != 0.0 {
        return Arc::of([a, b], radius).distance(p);
    }
    let (along, from) = (b - a, p - a);
    let t = (from.dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (from - t * along).length()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A slit, however narrow, is not filled by the disc of an arc.
    #[test]
    fn slits_of_discs_stay() {
        let at = |degrees: f64, radius: f64| radius * DVec2::from_angle(degrees.to_radians());
        // Round in two arcs, each of half a turn at most.
        let corners = vec![at(18.5, 0.3), at(21.5, 0.3), at(21.5, 1.0), at(200.0, 1.0), at(18.5, 1.0)];
        let outline = Outline { corners, radii: vec![0.0, 0.0, 1.0, 1.0, 0.0] };
        let profile = outline.profile();
        for (p, inside) in
            [(at(20.0, 0.9), false), (at(20.0, 0.2), true), (at(26.0, 0.9), true), (at(100.0, 0.99), true)]
        {
            assert_eq!(outline.contains(p), inside, "{p}");
            assert_eq!(profile.contains(p).unwrap(), inside, "{p}");
        }
    }

    /// The middle of an arc is off by so much less, or more, than its radius.
    #[test]
    fn flat_arcs_leave_their_radii_open() {
        for radius in [0.6, 1.0, 4.0] {
            let of = |radius: f64| {
                let corners = [[0.0, 0.0], [1.0, 0.0], [0.5, 2.0]].map(DVec2::from_array).to_vec();
                Outline { corners, radii: vec![radius, 0.0, 0.0] }
            };
            let middle = |outline: &Outline| -outline.distance(DVec2::new(0.5, 0.0));
            let by = of(radius).leverages().next().unwrap();
            let moved = (middle(&of(radius + 1e-6)) - middle(&of(radius))).abs();
            assert!((1e-6 / moved / by - 1.0).abs() < 1e-2, "{radius}: {by}, {moved}");
        }
    }

    #[test]
    fn an_l_tells_its_sides() {
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        let outline = Outline::polygon(corners.map(DVec2::from_array).to_vec());
        assert_eq!(outline.distance(DVec2::new(0.25, 2.0)), -0.25);
        assert_eq!(outline.distance(DVec2::new(1.5, 1.5)), 0.5);
        assert!(!outline.contains(DVec2::new(1.5, 2.0)) && outline.contains(DVec2::new(1.5, 0.5)));
        assert_eq!(outline.scaled(2.0).distance(DVec2::new(0.5, 4.0)), -0.5);
    }

    /// A round end, a bite, a rounded corner and a flat arc: the profile is what the outline holds.
    #[test]
    fn arcs_are_added_and_cut() {
        let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [3.0, 2.0], [2.0, 2.0], [0.5, 2.0], [0.0, 1.5]];
        let corners = corners.map(DVec2::from_array).to_vec();
        let outline = Outline { corners, radii: vec![0.0, 1.0, 0.0, -0.5, 0.0, 0.5, 3.0] };
        let turned = Outline {
            corners: outline.corners.iter().rev().copied().collect(),
            radii: [0.5, 0.0, -0.5, 0.0, 1.0, 0.0, 3.0].map(|r: f64| -r).to_vec(),
        };
        assert!((outline.distance(DVec2::new(5.5, 1.0)) - 0.5).abs() < 1e-12);
        assert!((outline.distance(DVec2::new(2.5, 2.0)) - 0.5).abs() < 1e-12);
        assert!((outline.reach() - DVec2::new(5.0, 2.0)).length() < 1e-12);
        let profiles = [outline.profile(), turned.profile()];
        for i in 0..60 {
            for j in 0..40 {
                let p = DVec2::new(-0.41 + 0.0931 * f64::from(i), -0.307 + 0.0677 * f64::from(j));
                let inside = outline.contains(p);
                assert_eq!(turned.contains(p), inside, "{p}");
                if outline.distance(p).abs() > 2e-3 {
                    for profile in &profiles {
                        assert_eq!(profile.contains(p).unwrap(), inside, "{p}");
                    }
                }
            }
        }
    }
}
