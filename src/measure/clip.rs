//! The part of a box on one side of a plane: its volume and moments.
//!
//! A box is six tetrahedra along its diagonal. Of each the part where a linear function is positive
//! is cut off by its values at the corners; all terms are positive, so that nothing cancels.
//!
//! ```text
//!          a            One corner inside: a tip.   Two inside, a and b: three tetrahedra,
//!         /|\                                       a p q b,  b p q s  and  b p s r,
//!        p | q          with p on a–c, q on a–d, r on b–c, s on b–d.   Three: all but a tip.
//!       /  b  \
//!      c---+---d
//! ```

use glam::DVec3;

use super::moments::Moments;
use crate::Bounds;

/// A linear function: its value at a point, and its slope.
#[derive(Clone, Copy, Debug)]
pub(super) struct Linear {
    pub(super) at: DVec3,
    pub(super) value: f64,
    pub(super) slope: DVec3,
}

/// The axes in all orders: the ways from the low corner of a box to the high one.
const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

/// The moments of the part of a box where a function is positive that is linear in each of its
/// tetrahedra, given its values at the corners, which follow their bits.
pub(super) fn between(part: &Bounds, values: [f64; 8]) -> Moments {
    let inside = values.iter().filter(|value| **value > 0.0).count();
    if inside == 0 {
        return Moments::default();
    }
    if inside == 8 {
        return Moments::cuboid(part.center(), part.size());
    }
    let volume = part.size().element_product() / 6.0;
    let corners = part.corners();
    let mut all = Moments::default();
    for [first, second, _] in ORDERS {
        let way = [0, 1 << first, 1 << first | 1 << second, 7];
        all.add(&moments(volume, way.map(|at: usize| corners[at]), way.map(|at: usize| values[at])));
    }
    all
}

impl Linear {
    pub(super) fn of(&self, p: DVec3) -> f64 {
        self.value + self.slope.dot(p - self.at)
    }

    /// Whether it is positive all over a box, or nowhere.
    fn side(&self, part: &Bounds) -> Option<bool> {
        let (middle, reach) = (self.of(part.center()), self.slope.abs().dot(part.half_extents()));
        if middle - reach >= 0.0 {
            Some(true)
        } else if middle + reach <= 0.0 {
            Some(false)
        } else {
            None
        }
    }

    /// The volume of the part of a box where it is positive.
    pub(super) fn volume_in(&self, part: &Bounds) -> f64 {
        let whole = part.size().element_product();
        match self.side(part) {
            Some(true) => whole,
            Some(false) => 0.0,
            None => whole / 6.0 * self.tetrahedra(part).map(|(_, values)| share(values)).iter().sum::<f64>(),
        }
    }

    /// The moments of that part.
    pub(super) fn moments_in(&self, part: &Bounds) -> Moments {
        match self.side(part) {
            Some(true) => Moments::cuboid(part.center(), part.size()),
            Some(false) => Moments::default(),
            None => {
                let volume = part.size().element_product() / 6.0;
                let mut all = Moments::default();
                for (corners, values) in self.tetrahedra(part) {
                    all.add(&moments(volume, corners, values));
                }
                all
            }
        }
    }

    /// The tetrahedra of a box, and the values at their corners.
    fn tetrahedra(&self, part: &Bounds) -> [([DVec3; 4], [f64; 4]); 6] {
        ORDERS.map(|[first, second, _]| {
            let mut corners = [part.min, part.min, part.min, part.max];
            corners[1][first] = part.max[first];
            corners[2] = corners[1];
            corners[2][second] = part.max[second];
            (corners, corners.map(|p| self.of(p)))
        })
    }
}

/// Corners with positive values first; how many these are.
fn sorted<T: Copy>(corners: [T; 4], values: [f64; 4]) -> ([T; 4], [f64; 4], usize) {
    let mut order = [0, 1, 2, 3];
    order.sort_by_key(|at| values[*at] <= 0.0);
    let inside = values.iter().filter(|value| **value > 0.0).count();
    (order.map(|at| corners[at]), order.map(|at| values[at]), inside)
}

/// How far from a corner inside to one that is not the value is 0, as a part of the way.
fn crossing(inside: f64, outside: f64) -> f64 {
    inside / (inside - outside)
}

/// The part of a tetrahedron where a linear function is positive, given its values at the corners.
fn share(values: [f64; 4]) -> f64 {
    let ([..], [a, b, c, d], inside) = sorted([(); 4], values);
    match inside {
        0 => 0.0,
        1 => crossing(a, b) * crossing(a, c) * crossing(a, d),
        2 => {
            let [ac, ad, bc, bd] = [crossing(a, c), crossing(a, d), crossing(b, c), crossing(b, d)];
            ac * ad + bd * ac * (1.0 - ad) + (1.0 - ac) * bd * bc
        }
        3 => 1.0 - crossing(-d, -a) * crossing(-d, -b) * crossing(-d, -c),
        _ => 1.0,
    }
}

/// The moments of that part, of a tetrahedron with a volume.
fn moments(volume: f64, corners: [DVec3; 4], values: [f64; 4]) -> Moments {
    let ([p, q, r, s], [a, b, c, d], inside) = sorted(corners, values);
    let tip = |from: DVec3, to: [(DVec3, f64); 3]| {
        let [(u, k), (v, l), (w, m)] = to;
        Moments::tetrahedron(volume * k * l * m, &[from, from.lerp(u, k), from.lerp(v, l), from.lerp(w, m)])
    };
    match inside {
        0 => Moments::default(),
        1 => tip(p, [(q, crossing(a, b)), (r, crossing(a, c)), (s, crossing(a, d))]),
        2 => {
            let [ac, ad, bc, bd] = [crossing(a, c), crossing(a, d), crossing(b, c), crossing(b, d)];
            let (pr, ps, qr, qs) = (p.lerp(r, ac), p.lerp(s, ad), q.lerp(r, bc), q.lerp(s, bd));
            let mut all = Moments::tetrahedron(volume * ac * ad, &[p, pr, ps, q]);
            all.add(&Moments::tetrahedron(volume * bd * ac * (1.0 - ad), &[q, pr, ps, qs]));
            all.add(&Moments::tetrahedron(volume * (1.0 - ac) * bd * bc, &[q, pr, qs, qr]));
            all
        }
        3 => {
            let rest = tip(s, [(p, crossing(-d, -a)), (q, crossing(-d, -b)), (r, crossing(-d, -c))]);
            Moments::tetrahedron(volume, &corners).less(&rest)
        }
        _ => Moments::tetrahedron(volume, &corners),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Planes cut boxes into two parts that make up the whole, and by as much as points say.
    #[test]
    fn both_sides_of_a_plane_are_the_box() {
        let part = Bounds::new(DVec3::new(-1.0, 0.5, 2.0), DVec3::new(1.0, 1.5, 5.0));
        let whole = Moments::cuboid(part.center(), part.size());
        for n in 0..200 {
            let random = |k: u32| f64::from((8 * n + k).wrapping_mul(2_654_435_769).rotate_left(11)) / 2f64.powi(32);
            let at = part.min + part.size() * DVec3::new(random(0), random(1), random(2));
            let slope = DVec3::new(random(3) - 0.5, random(4) - 0.5, if n % 3 == 0 { 0.0 } else { random(5) - 0.5 });
            let plane = Linear { at, value: 0.0, slope };
            let other = Linear { at, value: 0.0, slope: -slope };
            let mut both = plane.moments_in(&part);
            assert!((both.volume - plane.volume_in(&part)).abs() < 1e-13 * whole.volume, "{n}");
            let points = 30_u32;
            let step = part.size() / f64::from(points);
            let mut counted = 0.0;
            for i in 0..points.pow(3) {
                let cell = DVec3::new(f64::from(i % points), f64::from(i / points % points), f64::from(i / 900));
                counted += if plane.of(part.min + (cell + 0.5) * step) > 0.0 { 1.0 } else { 0.0 };
            }
            let counted = counted / f64::from(points.pow(3)) * whole.volume;
            assert!((counted - both.volume).abs() < 0.03 * whole.volume, "{n}: {counted} {}", both.volume);
            both.add(&other.moments_in(&part));
            let left = whole.less(&both);
            let most = |m: glam::DMat3| m.to_cols_array().into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            assert!(left.volume.abs() < 1e-13 * whole.volume && left.first.length() < 1e-12, "{n}: {left:?}");
            assert!(most(left.second) < 1e-12 * most(whole.second), "{n}: {left:?}");
        }
    }
}
