//! What triangles enclose within boxes: see [`Facets`].

use glam::DVec3;

use super::facets::Facets;
use super::moments::Moments;
use crate::Bounds;

/// Columns have as many triangles each, if these are even.
const EACH: f64 = 16.0;

/// There are not more columns along an axis.
const MOST: f64 = 256.0;

/// Triangles by columns along z, each listed in all that it is in.
pub(super) struct Columns {
    facets: Facets,
    low: [f64; 2],
    /// Of a column.
    size: [f64; 2],
    /// Along x, and along y.
    count: usize,
    starts: Vec<u32>,
    items: Vec<u32>,
}

impl Columns {
    pub(super) fn new(facets: Facets) -> Columns {
        let bounds = Bounds::from_points(facets.triangles.iter().flatten().copied());
        let count = (facets.triangles.len() as f64 / EACH).sqrt().ceil().clamp(1.0, MOST) as usize;
        let size = [0, 1].map(|axis| (bounds.size()[axis] / count as f64).max(f64::MIN_POSITIVE));
        let low = [bounds.min.x, bounds.min.y];
        let mut columns = Columns { facets, low, size, count, starts: Vec::new(), items: Vec::new() };
        let mut places: Vec<[u32; 2]> = Vec::new();
        for (n, triangle) in (0..).zip(&columns.facets.triangles) {
            let whole = Polygon::of(triangle);
            for row in columns.range(1, whole.span(1)) {
                let [from, to] = columns.side(1, row);
                let part = whole.cut(1, from, true).cut(1, to, false);
                places.extend(columns.range(0, part.span(0)).map(|at| [(row * count + at) as u32, n]));
            }
        }
        places.sort_unstable();
        columns.starts = vec![0; count * count + 1];
        places.iter().for_each(|[place, _]| columns.starts[*place as usize + 1] += 1);
        for place in 0..count * count {
            columns.starts[place + 1] += columns.starts[place];
        }
        columns.items = places.into_iter().map(|[_, n]| n).collect();
        columns
    }

    /// The columns along an axis that a range of coordinates is in.
    fn range(&self, axis: usize, [low, high]: [f64; 2]) -> std::ops::Range<usize> {
        if low > high {
            return 0..0;
        }
        let place = |x: f64| (((x - self.low[axis]) / self.size[axis]).max(0.0) as usize).min(self.count - 1);
        place(low)..place(high) + 1
    }

    /// Where a column begins and ends along an axis; those at the ends go on.
    fn side(&self, axis: usize, at: usize) -> [f64; 2] {
        let place = |at: usize| self.low[axis] + at as f64 * self.size[axis];
        let from = if at == 0 { f64::NEG_INFINITY } else { place(at) };
        [from, if at + 1 == self.count { f64::INFINITY } else { place(at + 1) }]
    }

    /// What is enclosed of a box.
    pub(super) fn moments_in(&self, part: &Bounds) -> Moments {
        let (middle, half) = (part.center(), part.half_extents());
        let mut all = Moments::default();
        for row in self.range(1, [part.min.y, part.max.y]) {
            for at in self.range(0, [part.min.x, part.max.x]) {
                let mut base = [[-half.x, half.x], [-half.y, half.y]];
                for (axis, place) in [(0, at), (1, row)] {
                    let [from, to] = self.side(axis, place);
                    base[axis][0] = base[axis][0].max(from - middle[axis]);
                    base[axis][1] = base[axis][1].min(to - middle[axis]);
                }
                let place = row * self.count + at;
                for n in &self.items[self.starts[place] as usize..self.starts[place + 1] as usize] {
                    let triangle = self.facets.triangles[*n as usize].map(|p| p - middle);
                    above(&triangle, base, half.z, &mut all);
                }
            }
        }
        all.moved(middle)
    }

    /// How far volumes may be off, as the triangles are rounded.
    pub(super) fn volume_error(&self) -> f64 {
        self.facets.volume_error()
    }
}

/// Adds what is between a triangle and the lower face of a box about the origin, within the box.
fn above(triangle: &[DVec3; 3], [x, y]: [[f64; 2]; 2], height: f64, all: &mut Moments) {
    let whole = Polygon::of(triangle);
    let misses = |axis: usize, [from, to]: [f64; 2]| {
        let [low, high] = whole.span(axis);
        high <= from || low >= to
    };
    if misses(0, x) || misses(1, y) || whole.span(2)[1] <= -height {
        return;
    }
    let within = whole.cut(0, x[0], true).cut(0, x[1], false).cut(1, y[0], true).cut(1, y[1], false);
    let within = within.cut(2, -height, true);
    within.cut(2, height, false).prisms(-height, all);
    let mut over = within.cut(2, height, true);
    over.points[..over.len].iter_mut().for_each(|p| p.z = height);
    over.prisms(-height, all);
}

/// A convex polygon: a triangle that was cut.
#[derive(Clone, Copy)]
struct Polygon {
    points: [DVec3; Polygon::MOST],
    len: usize,
}

impl Polygon {
    /// Each of six planes adds a corner.
    const MOST: usize = 10;

    fn of(triangle: &[DVec3; 3]) -> Polygon {
        let mut points = [DVec3::ZERO; Polygon::MOST];
        points[..3].copy_from_slice(triangle);
        Polygon { points, len: 3 }
    }

    /// The least and the largest of the coordinates along an axis.
    fn span(&self, axis: usize) -> [f64; 2] {
        let all = self.points[..self.len].iter().map(|p| p[axis]);
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    }

    /// The part where a coordinate is above a number, or below.
    fn cut(&self, axis: usize, at: f64, is_above: bool) -> Polygon {
        let mut part = Polygon { points: [DVec3::ZERO; Polygon::MOST], len: 0 };
        let height = |p: DVec3| if is_above { p[axis] - at } else { at - p[axis] };
        for n in 0..self.len {
            let (from, to) = (self.points[n], self.points[(n + 1) % self.len]);
            let (here, there) = (height(from), height(to));
            if here >= 0.0 {
                part.push(from);
            }
            if (here >= 0.0) != (there >= 0.0) {
                let mut between = from.lerp(to, here / (here - there));
                between[axis] = at;
                part.push(between);
            }
        }
        part
    }

    fn push(&mut self, p: DVec3) {
        if self.len < Polygon::MOST {
            self.points[self.len] = p;
            self.len += 1;
        }
    }

    /// Adds what is between it and a plane across z below: three tetrahedra a triangle.
    fn prisms(&self, below: f64, all: &mut Moments) {
        for n in 2..self.len.max(2) {
            let [p, q, r] = [self.points[0], self.points[n - 1], self.points[n]];
            let area = 0.5 * (q - p).truncate().perp_dot((r - p).truncate());
            let [p0, q0, r0] = [p, q, r].map(|p| p.truncate().extend(below));
            let share = area / 3.0;
            all.add(&Moments::tetrahedron(share * (p.z - below), &[p0, q0, r0, p]));
            all.add(&Moments::tetrahedron(share * (q.z - below), &[q0, r0, p, q]));
            all.add(&Moments::tetrahedron(share * (r.z - below), &[r0, p, q, r]));
        }
    }
}
