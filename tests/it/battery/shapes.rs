//! Meshes, slices, rays and closest points of one solid, against its values at many points.

use glam::{DVec2, DVec3};
use rvachev::{
    CellSize, ContourSettings, MeshSettings, Plane, PlaneBounds, Polyline, Run, Solid,
    error::{MeshingError, PrepareError, RenderError},
    program::Program,
};

use super::make::bounded;
use super::{Fault, fault, is_late, short};
use crate::support::{Random, frame_of};

/// What is asked, and how large it is.
struct Subject<'a> {
    solid: &'a Solid,
    program: Program,
    frame: rvachev::Bounds,
    size: f64,
    random: Random,
    /// What is not answered when it is over is not asked.
    run: Run,
}

pub fn check(solid: &Solid) -> Result<(), Fault> {
    let Some(solid) = &bounded(solid) else { return Ok(()) };
    let program = solid.surface_program().unwrap();
    let frame = frame_of(solid);
    let run = Run { threads: 1, ..short() };
    let mut subject = Subject { solid, program, frame, size: frame.longest_side(), random: Random::new(23), run };
    let questions = [Subject::mesh, Subject::slice, Subject::rays, Subject::closest];
    questions.into_iter().try_for_each(|ask| if is_late() { Ok(()) } else { ask(&mut subject) })
}

/// The mesh of a solid in cells of so many to the longest side; `None` if the run is over before.
pub fn meshed(solid: &Solid, cells: u32, run: &Run) -> Result<Option<rvachev::Mesh>, Fault> {
    let settings = MeshSettings { cell: CellSize::LongestSide(cells), ..MeshSettings::default() };
    match solid.mesh_with(&settings, run) {
        Ok(mesh) => Ok(Some(mesh)),
        Err(MeshingError::Cancelled(_)) => Ok(None),
        Err(error) => Err(Fault { check: "mesh", text: error.to_string() }),
    }
}

impl Subject<'_> {
    fn inside(&self, p: DVec3) -> bool {
        self.program.value(p) > 0.0
    }

    fn mesh(&mut self) -> Result<(), Fault> {
        let Some(mesh) = meshed(self.solid, 24, &self.run)? else { return Ok(()) };
        let report = mesh.check();
        fault("soundness", report.is_sound() || report.triangles == 0, || report.to_string())?;
        let bounds = self.solid.bounds().unwrap();
        fault(
            "mesh bounds",
            report.triangles == 0 || bounds.inflate(0.2 * self.size / 24.0).contains_bounds(&report.bounds),
            || format!("{:?} beyond {bounds:?}", report.bounds),
        )?;
        if mesh.possibly_lost() > 0 || mesh.clamped_vertices() != Some(0) {
            return Ok(());
        }
        // A point in each of 16³ cells.
        let (cell, mut count) = (bounds.size() / 16.0, 0);
        for n in 0..4096u32 {
            let at = DVec3::new(f64::from(n % 16), f64::from(n / 16 % 16), f64::from(n / 256));
            let p = bounds.min + (at + self.random.vector(0.0, 1.0)) * cell;
            count += u32::from(self.inside(p));
        }
        let sampled = f64::from(count) * cell.element_product();
        let side = cell.max_element();
        // So many cells have surface in them, each of which is off by chance.
        let cut = 6.0 + 3.0 * report.area / (cell.element_product() / side);
        let may = 2.5 * cut.sqrt() * cell.element_product() + 0.1 * report.area * self.size / 24.0;
        let off = (report.volume - sampled).abs();
        fault("volume", off <= may, || format!("{} by the mesh, {sampled} by points, allowed ±{may}", report.volume))
    }

    fn slice(&mut self) -> Result<(), Fault> {
        let through = self.random.point_in(&self.frame);
        let tilted = Plane::new(through, self.random.direction());
        // In a face, where what a ray from above hits is flat.
        let above = through.with_z(self.frame.max.z + self.size);
        let hit = match self.solid.raycast_all_with(&[(above, DVec3::NEG_Z)], &self.run) {
            Err(PrepareError::Cancelled(_)) => return Ok(()),
            hits => hits.unwrap()[0],
        };
        let in_face = hit.map(|hit| Plane::xy(hit.point.z));
        for plane in [Plane::xy(through.z), tilted].into_iter().chain(in_face) {
            let corners = self.frame.corners().map(|corner| plane.coordinates(corner));
            let fold = |of: fn(DVec2, DVec2) -> DVec2| corners.into_iter().reduce(of).unwrap();
            let margin = DVec2::splat(0.05 * self.size);
            let region = PlaneBounds { min: fold(DVec2::min) - margin, max: fold(DVec2::max) + margin };
            let tolerance = 2e-3 * self.size;
            let settings = ContourSettings { tolerance, ..ContourSettings::default() };
            let slice = self.solid.slice_with(&plane, Some(region), &self.run);
            let contours = match slice.and_then(|slice| slice.contours_with(&settings, &self.run)) {
                Ok(contours) => contours,
                Err(RenderError::Cancelled(_)) => return Ok(()),
                Err(error) => return Err(Fault { check: "slice", text: error.to_string() }),
            };
            // What is not resolved is narrower than the tolerance: hardly a point is in it.
            let mut spare = if contours.unresolved() > 0 { 4 } else { 0 };
            for _ in 0..150 {
                let p = region.min + self.random.vector(0.0, 1.0).truncate() * (region.max - region.min);
                let away = contours.lines().iter().map(|line| distance(line, p)).fold(f64::INFINITY, f64::min);
                // A little above: what is flush with the plane counts as it is there.
                let above = |part: f64| self.inside(plane.point(p) + part * self.size * plane.normal());
                let expected = above(1e-5);
                if above(0.0) != expected || above(1e-4) != expected {
                    continue;
                }
                let enclosed = contours.lines().iter().filter(|line| winds(line, p)).count() % 2 == 1;
                let is_right = away < 3.0 * tolerance || enclosed == expected;
                if !is_right && spare > 0 {
                    spare -= 1;
                    continue;
                }
                fault("slice", is_right, || {
                    let at = plane.point(p);
                    format!(
                        "{at} is inside: {enclosed} by contours {away:e} away, {expected} by the value {:e}; {plane:?}",
                        self.program.value(at)
                    )
                })?;
            }
        }
        Ok(())
    }

    fn rays(&mut self) -> Result<(), Fault> {
        let around = self.frame.inflate(0.5 * self.size);
        for _ in 0..6 {
            let (origin, target) = (self.random.point_in(&around), self.random.point_in(&self.frame));
            let direction = (target - origin).normalize_or(DVec3::X);
            let hit = match self.solid.raycast_all_with(&[(origin, direction)], &self.run) {
                Err(PrepareError::Cancelled(_)) => return Ok(()),
                hits => hits.unwrap()[0],
            };
            let far = around.size().length();
            let end = hit.map_or(far, |hit| hit.distance);
            let inside = self.inside(origin);
            for i in 1..200 {
                let t = 0.999_999 * end * f64::from(i) / 200.0;
                let value = self.program.value(origin + t * direction);
                // What only touches the surface is allowed for.
                fault("ray", (value > 0.0) == inside || value.abs() < 1e-9 * self.size, || {
                    format!("{value:e} at {t} from {origin} along {direction}, hit {hit:?}")
                })?;
            }
            let Some(hit) = hit else { continue };
            let [before, after] = [-1e-7, 1e-7].map(|d| self.inside(hit.point + d * self.size * direction));
            fault("hit", before == inside || after != inside, || {
                format!("no crossing from {origin} along {direction}: {hit:?}")
            })?;
        }
        Ok(())
    }

    /// Points between one inside and one outside.
    fn on_surface(&mut self, count: usize) -> Vec<DVec3> {
        let around = self.frame.inflate(0.1 * self.size);
        let points: Vec<DVec3> = (0..count).map(|_| self.random.point_in(&around)).collect();
        let (inside, outside): (Vec<DVec3>, Vec<DVec3>) = points.into_iter().partition(|p| self.inside(*p));
        let pairs = inside.iter().cycle().zip(&outside).take(if inside.is_empty() { 0 } else { count });
        let halved = pairs.map(|(&inside, &outside)| {
            let (mut a, mut b) = (inside, outside);
            for _ in 0..50 {
                let middle = a.midpoint(b);
                *if self.inside(middle) { &mut a } else { &mut b } = middle;
            }
            a
        });
        halved.collect()
    }

    fn closest(&mut self) -> Result<(), Fault> {
        let surface = self.on_surface(400);
        let around = self.frame.inflate(0.5 * self.size);
        for _ in 0..4 {
            let p = self.random.point_in(&around);
            let nearest = surface.iter().map(|s| s.distance(p)).fold(f64::INFINITY, f64::min);
            let found = match self.solid.closest_surface_points_with(&[p], &self.run) {
                Err(PrepareError::Cancelled(_)) => return Ok(()),
                found => found.unwrap()[0],
            };
            let Some(found) = found else {
                return fault("closest point", surface.is_empty(), || format!("none from {p}, one is {nearest} away"));
            };
            let away = found.distance(p);
            fault("closest point", away <= nearest + 1e-6 * self.size, || {
                format!("{found} is {away} from {p}, another point {nearest}")
            })?;
            let inside = self.inside(p);
            let crossing = (0..300).map(|_| p + 0.999 * away * self.random.unit().cbrt() * self.random.direction());
            let crossing: Vec<DVec3> = crossing.collect();
            let before = crossing.into_iter().find(|q| self.inside(*q) != inside);
            fault("closest point", before.is_none(), || format!("{found} is {away} from {p}, past {before:?}"))?;
            let near: Vec<DVec3> = (0..200).map(|_| found + 1e-5 * self.size * self.random.direction()).collect();
            let count = near.iter().filter(|q| self.inside(**q)).count();
            let value = self.program.value(found);
            fault("closest point", count % 200 != 0 || value.abs() < 1e-9 * self.size, || {
                format!("{found} of {p} is not on the surface, but {value:e}")
            })?;
        }
        Ok(())
    }
}

fn distance(line: &Polyline, p: DVec2) -> f64 {
    let away = line.edges().map(|[a, b]| {
        let along = b - a;
        let t = ((p - a).dot(along) / along.length_squared().max(1e-300)).clamp(0.0, 1.0);
        (a + t * along).distance(p)
    });
    away.fold(f64::INFINITY, f64::min)
}

fn winds(line: &Polyline, p: DVec2) -> bool {
    let crosses =
        |[a, b]: [DVec2; 2]| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
    line.edges().filter(|edge| crosses(*edge)).count() % 2 == 1
}
