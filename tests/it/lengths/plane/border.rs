//! Distances to the border of any profile by brute force: squares that it passes through, halved.

use std::collections::{HashMap, HashSet};

use glam::{DVec2, IVec2};
use rvachev::{Profile, SolidError};

/// Squares along each side of the frame to begin with.
const SQUARES: i32 = 160;

/// So often they are halved.
const HALVINGS: i32 = 12;

/// The squares that a profile's border passes through.
pub struct Border<'a> {
    profile: &'a Profile,
    corner: DVec2,
    side: f64,
    first: Vec<Square>,
}

/// A square by its place in the grid, and whether the border is known to pass through it: else it
/// is beside one of those.
#[derive(Clone, Copy)]
struct Square {
    at: IVec2,
    is_crossed: bool,
}

impl Border<'_> {
    /// Of a profile within a frame.
    pub fn new(profile: &Profile, [low, high]: [DVec2; 2]) -> Result<Border<'_>, SolidError> {
        // Nodes are not where profiles have their edges.
        let size = (high - low).max_element();
        let mut border =
            Border { profile, corner: low - 0.0137 * size, side: 1.03 * size / f64::from(SQUARES), first: Vec::new() };
        let all = (0..SQUARES * SQUARES).map(|n| IVec2::new(n % SQUARES, n / SQUARES)).collect();
        border.first = border.passed(all, 0)?;
        Ok(border)
    }

    pub fn is_empty(&self) -> bool {
        self.first.is_empty()
    }

    fn node(&self, at: IVec2, halvings: i32) -> DVec2 {
        self.corner + at.as_dvec2() * (self.side / f64::from(1 << halvings))
    }

    /// Of squares, those that the border passes through, and those beside them.
    fn passed(&self, squares: Vec<IVec2>, halvings: i32) -> Result<Vec<Square>, SolidError> {
        let corners = [IVec2::ZERO, IVec2::X, IVec2::Y, IVec2::ONE];
        let nodes: HashSet<IVec2> = squares.iter().flat_map(|at| corners.map(|corner| *at + corner)).collect();
        let nodes: Vec<IVec2> = nodes.into_iter().collect();
        let points: Vec<DVec2> = nodes.iter().map(|at| self.node(*at, halvings)).collect();
        let inside: HashMap<IVec2, bool> = nodes.into_iter().zip(self.profile.contains_all(&points)?).collect();
        let is_crossed = |at: &&IVec2| corners.iter().any(|corner| inside[&(**at + *corner)] != inside[*at]);
        let known: HashSet<IVec2> = squares.iter().filter(is_crossed).copied().collect();
        let is_beside = |at: IVec2| (-1..=1).any(|x| (-1..=1).any(|y| known.contains(&(at + IVec2::new(x, y)))));
        let square = |at: IVec2| Square { at, is_crossed: known.contains(&at) };
        Ok(squares.into_iter().filter(|at| is_beside(*at)).map(square).collect())
    }

    /// How far a point is from the border, to within 2·10⁻⁶ of the frame.
    pub fn way(&self, p: DVec2) -> Result<f64, SolidError> {
        let mut squares = self.first.clone();
        for halvings in 0.. {
            let side = self.side / f64::from(1 << halvings);
            let middle = |square: &Square| self.node(square.at, halvings) + 0.5 * side;
            let half = side * 0.5f64.sqrt();
            let crossed = squares.iter().filter(|square| square.is_crossed);
            let most = crossed.map(|square| p.distance(middle(square)) + half).fold(f64::INFINITY, f64::min);
            if halvings == HALVINGS {
                return Ok(most - half);
            }
            squares.retain(|square| p.distance(middle(square)) - half <= most);
            let parts =
                |square: &Square| [IVec2::ZERO, IVec2::X, IVec2::Y, IVec2::ONE].map(|part| 2 * square.at + part);
            squares = self.passed(squares.iter().flat_map(parts).collect(), halvings + 1)?;
        }
        Ok(f64::INFINITY)
    }

    /// The signed distance, positive inside.
    pub fn distance(&self, p: DVec2) -> Result<f64, SolidError> {
        let way = self.way(p)?;
        Ok(if self.profile.contains(p)? { way } else { -way })
    }

    /// A point near the border.
    pub fn point(&self, number: usize, [x, y]: [f64; 2]) -> DVec2 {
        self.node(self.first[number % self.first.len()].at, 0) + self.side * DVec2::new(x, y)
    }
}

#[test]
fn brute_force_finds_the_distance_to_a_ring() -> Result<(), SolidError> {
    let ring = Profile::circle(3.0) - Profile::circle(1.0);
    let border = Border::new(&ring, [DVec2::splat(-3.0), DVec2::splat(3.0)])?;
    for (p, want) in [([0.3, 0.2], 0.13f64.sqrt() - 1.0), ([1.5, 0.0], 0.5), ([0.0, 2.7], 0.3), ([4.0, 3.0], -2.0)] {
        assert!((border.distance(DVec2::from(p))? - want).abs() < 2e-5, "{p:?}");
    }
    Ok(())
}
