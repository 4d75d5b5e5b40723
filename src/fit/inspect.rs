//! A scan compared with its model: how far each point is off, and which part is wrong.
//!
//! A part that has moved is as much too far out on one side as it is too far in on the other, and
//! its median deviation is 0. So a shift τ and a growth o of every leaf are fitted to the
//! deviations d of its points, n being the normals there:
//!
//! ```text
//!     minimise  Σ wᵢ (dᵢ − nᵢ·τ − o)²
//! ```

use std::collections::BTreeMap;

use glam::DVec3;

use super::check::check_extent;
use super::deviations::Deviation;
use super::error::FitError;
use super::feet::{Foot, feet};
use super::linear::{median, quantile, solved};
use super::solve::NORMAL;
use crate::distance::compiled_with;
use crate::eval::Owner;
use crate::geom::PointCloud;
use crate::{Run, Solid};

/// Fewer points of a leaf do not tell how it has moved.
const FEWEST: usize = 12;

/// Where weights of a leaf's fit fall off, in spreads.
const WIDTH: f64 = 3.0;

/// What a fit of a leaf must exceed to be told from noise, in standard deviations.
const SIGNIFICANT: f64 = 10.0;

/// How far a scan is from its model.
#[derive(Clone, Debug)]
pub struct Deviations {
    signed: Vec<f64>,
    leaves: Vec<LeafDeviation>,
}

/// How far the points of one leaf are off.
#[derive(Clone, Debug)]
pub struct LeafDeviation {
    /// The leaf, with its path and the names on it.
    pub owner: Owner,
    /// The distances of its points.
    pub sizes: Deviation,
    /// The median of the signed deviations.
    pub median: f64,
    /// Their spread about it: 1.4826 times the median absolute deviation.
    pub spread: f64,
    /// The least deviation and its place.
    pub least: (f64, DVec3),
    /// The greatest deviation and its place.
    pub greatest: (f64, DVec3),
    /// By how much the leaf has moved, in length units. 0 along directions that its points do not
    /// tell.
    pub shift: DVec3,
    /// By how much it is too large all around (a hole: too small).
    pub growth: f64,
    /// The larger of shift and growth over its standard deviation. Noise and unevenness make it 4
    /// or so.
    pub significance: f64,
}

impl LeafDeviation {
    /// Whether the leaf is off by more than noise explains:
    /// [`significance`](LeafDeviation::significance) above 10.
    #[must_use]
    pub fn is_off(&self) -> bool {
        self.significance > SIGNIFICANT
    }
}

/// Compares a scan with a solid that is where it should be.
///
/// A deviation is positive where the point is outside of the solid. It is the distance to where
/// Newton steps along the gradient lead, four of them: exact for what is near the surface
/// compared with its curvature. The point belongs to the leaf that makes the surface there.
///
/// # Errors
///
/// [`FitError::Solid`] if the solid is not valid, [`FitError::TooFew`] of no points,
/// [`FitError::Extent`] of points further than 10⁹ from the origin.
///
/// ```
/// use rvachev::fit::inspect;
/// use rvachev::surface::ParametricSurface;
/// use rvachev::{PointCloud, Solid, Superellipsoid};
///
/// let made = Superellipsoid::new([1.0, 1.0, 1.0], 1.0, 1.0);
/// let scan = ParametricSurface::of(&made)?.sample(500, 1)?;
/// let scan = PointCloud::new(scan.iter().map(|s| s.point + glam::DVec3::X * 0.02).collect())?;
/// let report = inspect(&Solid::sphere(1.0), &scan)?;
/// let ball = &report.leaves()[0];
/// assert!((ball.shift.x - 0.02).abs() < 1e-3 && ball.growth.abs() < 1e-3 && ball.is_off());
/// assert!(report.share_within(0.021)? == 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn inspect(solid: &Solid, cloud: &PointCloud) -> Result<Deviations, FitError> {
    inspect_with(solid, cloud, &Run::default())
}

/// [`inspect`] with a [`Run`].
///
/// # Errors
///
/// Those of [`inspect`], and [`FitError::Cancelled`].
pub fn inspect_with(solid: &Solid, cloud: &PointCloud, run: &Run) -> Result<Deviations, FitError> {
    let run = run.stage(0.0, 1.0);
    run.report(0.0);
    if cloud.is_empty() {
        return Err(FitError::TooFew { kind: "comparison", points: 0, parameters: 0, needed: 1 });
    }
    check_extent(cloud)?;
    let programs = compiled_with(solid, &Run { progress: None, ..run.clone() })?;
    let program = &programs.surface;
    let feet = run.install(|| feet(program, cloud.positions(), &run))?;
    let mut by_leaf: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (i, foot) in feet.iter().enumerate() {
        if i.is_multiple_of(4096) {
            run.check()?;
        }
        by_leaf.entry(program.owner(foot.point).index).or_default().push(i);
    }
    let leaf = |(_, points): (&u32, &Vec<usize>)| {
        let owner = program.owner(feet[points[0]].point);
        of_leaf(owner, points, &feet, cloud.positions())
    };
    let leaves = by_leaf.iter().map(leaf).collect();
    run.report(1.0);
    Ok(Deviations { signed: feet.iter().map(|foot| foot.off).collect(), leaves })
}

impl Deviations {
    /// The signed deviation of each point of the cloud, in length units: positive outside of the
    /// solid.
    #[must_use]
    pub fn signed(&self) -> &[f64] {
        &self.signed
    }

    /// The distances of all points.
    #[must_use]
    pub fn sizes(&self) -> Deviation {
        Deviation::of(self.signed.iter().copied())
    }

    /// The leaves that have points, by their numbers.
    #[must_use]
    pub fn leaves(&self) -> &[LeafDeviation] {
        &self.leaves
    }

    /// The share of the points, 0 to 1, that are no further from the surface than a length.
    ///
    /// # Errors
    ///
    /// If the length is NaN.
    pub fn share_within(&self, tolerance: f64) -> Result<f64, FitError> {
        if tolerance.is_nan() {
            return Err(setting("tolerance", tolerance, "any number"));
        }
        let within = self.signed.iter().filter(|d| d.abs() <= tolerance).count();
        Ok(within as f64 / self.signed.len() as f64)
    }

    /// How many deviations are in each of `bins` parts of the range from −`reach` to `reach`; those
    /// beyond are counted at the ends. Nothing for no bins; at most a million.
    ///
    /// # Errors
    ///
    /// If the reach is not finite and above 0.
    pub fn histogram(&self, reach: f64, bins: usize) -> Result<Vec<usize>, FitError> {
        check_reach(reach)?;
        let bins = bins.min(1_000_000);
        let mut counts = vec![0; bins];
        if bins > 0 {
            for d in &self.signed {
                let at = ((d / reach + 1.0) * 0.5 * bins as f64).floor().max(0.0);
                counts[(at as usize).min(bins - 1)] += 1;
            }
        }
        Ok(counts)
    }

    /// The cloud, coloured by its deviations: blue at −`reach`, white at 0, red at `reach`.
    ///
    /// # Errors
    ///
    /// If the cloud has another number of points, or the reach is not finite and above 0.
    pub fn colored(&self, cloud: &PointCloud, reach: f64) -> Result<PointCloud, FitError> {
        check_reach(reach)?;
        Ok(cloud.clone().with_colors(self.signed.iter().map(|d| color(*d, reach)).collect())?)
    }
}

fn check_reach(reach: f64) -> Result<(), FitError> {
    if reach > 0.0 && reach.is_finite() { Ok(()) } else { Err(setting("reach", reach, "finite and above 0")) }
}

fn setting(setting: &'static str, value: f64, allowed: &'static str) -> FitError {
    FitError::Setting { setting, value: value.to_string(), allowed }
}

/// Blue at −`reach` and beyond, white at 0, red at `reach` and beyond.
pub(super) fn color(d: f64, reach: f64) -> [u8; 3] {
    let t = if d == 0.0 { 0.0 } else { (d / reach).clamp(-1.0, 1.0) };
    let fade = (255.0 * (1.0 - t.abs())).round() as u8;
    if t > 0.0 { [255, fade, fade] } else { [fade, fade, 255] }
}

fn of_leaf(owner: Owner, numbers: &[usize], feet: &[Foot], points: &[DVec3]) -> LeafDeviation {
    let signed: Vec<f64> = numbers.iter().map(|i| feet[*i].off).collect();
    let middle = median(&mut signed.clone());
    let spread = NORMAL * quantile(&mut signed.iter().map(|d| (d - middle).abs()).collect::<Vec<_>>(), 0.5);
    let at = |k: Option<usize>| k.map_or((0.0, DVec3::ZERO), |k| (signed[k], points[numbers[k]]));
    let by = |a: &usize, b: &usize| signed[*a].total_cmp(&signed[*b]);
    let (shift, growth, significance) = moved(numbers, feet).unwrap_or_default();
    LeafDeviation {
        owner,
        sizes: Deviation::of(signed.iter().copied()),
        median: middle,
        spread,
        least: at((0..signed.len()).min_by(by)),
        greatest: at((0..signed.len()).max_by(by)),
        shift,
        growth,
        significance,
    }
}

/// What coordinates and distances are rounded by, in proportion.
const ROUNDING: f64 = 1e-12;

/// The shift and the growth that explain the deviations, and how sure they are.
fn moved(numbers: &[usize], feet: &[Foot]) -> Option<(DVec3, f64, f64)> {
    if numbers.len() < FEWEST {
        return None;
    }
    let farthest = numbers.iter().map(|i| feet[*i].point.abs().max_element()).fold(0.0, f64::max);
    let row = |i: usize| [feet[i].normal.x, feet[i].normal.y, feet[i].normal.z, 1.0];
    let mut found = [0.0; 4];
    let mut noise = 0.0;
    let mut matrix = [[0.0; 4]; 4];
    for round in 0..4 {
        let rest = |i: usize| feet[i].off - row(i).iter().zip(found).map(|(a, b)| a * b).sum::<f64>();
        noise = NORMAL * quantile(&mut numbers.iter().map(|i| rest(*i).abs()).collect::<Vec<_>>(), 0.5);
        // Rounding of coordinates is no deviation.
        noise = noise.max(ROUNDING * farthest);
        let mut right = [0.0; 4];
        matrix = [[0.0; 4]; 4];
        for &i in numbers {
            let weight = match round {
                0 => 1.0,
                _ => (1.0 + (rest(i) / (WIDTH * noise).max(f64::MIN_POSITIVE)).powi(2)).powi(-2),
            };
            let row = row(i);
            for a in 0..4 {
                right[a] += weight * row[a] * feet[i].off;
                for b in 0..=a {
                    matrix[a][b] += weight * row[a] * row[b];
                }
            }
        }
        // What the normals do not tell stays 0: of a plane, all but half of the sum of both.
        for (a, line) in matrix.iter_mut().enumerate() {
            line[a] += 1e-3 * numbers.len() as f64;
        }
        found = solved(&matrix, &right, &[true; 4])?;
    }
    let mut significance: f64 = 0.0;
    for a in 0..4 {
        let unit = std::array::from_fn(|b| if a == b { 1.0 } else { 0.0 });
        let variance = solved(&matrix, &unit, &[true; 4])?[a] * noise * noise;
        significance = significance.max(found[a].abs() / variance.sqrt().max(1e-12 * found[a].abs() + 1e-300));
    }
    Some((DVec3::new(found[0], found[1], found[2]), found[3], significance))
}
