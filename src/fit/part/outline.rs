//! The outline of an extruded profile: a polygon of few corners, as candidates are tested by.

use glam::DVec2;

/// A closed polygon without holes, counter-clockwise or not.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::fit) struct Outline {
    pub(in crate::fit) corners: Vec<DVec2>,
}

impl Outline {
    /// The sides, each from a corner to the next.
    fn sides(&self) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().copied().zip(next.copied())
    }

    pub(in crate::fit) fn contains(&self, p: DVec2) -> bool {
        let mut inside = false;
        for (a, b) in self.sides() {
            if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y) {
                inside = !inside;
            }
        }
        inside
    }

    /// The signed distance, negative inside.
    pub(in crate::fit) fn distance(&self, p: DVec2) -> f64 {
        let square = |(a, b): (DVec2, DVec2)| {
            let (along, from) = (b - a, p - a);
            let t = (from.dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            (from - t * along).length_squared()
        };
        let distance = self.sides().map(square).fold(f64::INFINITY, f64::min).sqrt();
        if self.contains(p) { -distance } else { distance }
    }

    pub(in crate::fit) fn scaled(&self, factor: f64) -> Outline {
        Outline { corners: self.corners.iter().map(|corner| factor * *corner).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_l_tells_its_sides() {
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        let outline = Outline { corners: corners.map(DVec2::from_array).to_vec() };
        assert_eq!(outline.distance(DVec2::new(0.25, 2.0)), -0.25);
        assert_eq!(outline.distance(DVec2::new(1.5, 1.5)), 0.5);
        assert!(!outline.contains(DVec2::new(1.5, 2.0)) && outline.contains(DVec2::new(1.5, 0.5)));
        assert_eq!(outline.scaled(2.0).distance(DVec2::new(0.5, 4.0)), -0.5);
    }
}
