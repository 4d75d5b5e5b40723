//! Conics and quadrics by subdivision: control polygons and cages, and what they become.
//!
//! ```text
//!     left    the control polygon or cage           polygon . . . . curve
//!     middle  after one level                       octahedron  →  ellipsoid
//!     right   the limit, its points exact           16 points   →  torus
//! ```
//!
//! Every picture shows the same figure three times. What is printed is how far the points of
//! the limit are from the equation of the figure.

mod painter;

use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

use glam::{DVec2, DVec3};
use painter::{Canvas, View};
use rvachev::{
    deg,
    subdivision::{
        ControlGrid, ControlPolygon, ProfileEnd, SubdivisionError, SubdivisionRevolution, Tension, hyperbola_of_ellipse,
    },
    surface::QuadMesh,
};

const WIDTH: u32 = 1080;
const HEIGHT: u32 = 380;

const CAGE: [f64; 3] = [0.75, 0.20, 0.12];
const CURVE: [f64; 3] = [0.10, 0.32, 0.55];
const SURFACE: [f64; 3] = [0.55, 0.68, 0.80];

/// A figure of the plane: polygon, points after a level, points of the limit.
struct Curve {
    name: &'static str,
    polygon: ControlPolygon<DVec2>,
    /// Moves points of an ellipse to a hyperbola.
    by_map: Option<f64>,
    /// 0 on the figure, if it has an equation.
    equation: Option<fn(DVec2) -> f64>,
}

fn curves() -> Result<Vec<Curve>, Box<dyn Error>> {
    let free = [(0.0, 0.0), (1.6, -0.5), (2.6, 0.7), (1.3, 1.1), (0.9, 2.1), (-0.4, 1.3)];
    let free = free.map(|(x, y)| DVec2::new(x, y));
    Ok(vec![
        Curve {
            name: "ellipse",
            polygon: ControlPolygon::ellipse([1.6, 1.0])?,
            by_map: None,
            equation: Some(|p| (p.x / 1.6).powi(2) + p.y.powi(2) - 1.0),
        },
        Curve {
            name: "triangle_to_circle",
            polygon: ControlPolygon::ellipse_of(3, [1.0, 1.0])?,
            by_map: None,
            equation: Some(|p| p.length_squared() - 1.0),
        },
        Curve {
            name: "hyperbola",
            polygon: ControlPolygon::hyperbola([1.0, 1.0], 2.0, 2)?,
            by_map: None,
            equation: Some(|p| (p.x * p.x - p.y * p.y - 1.0) / (p.x * p.x)),
        },
        Curve {
            name: "hyperbola_of_ellipse",
            polygon: ControlPolygon::ellipse_of(12, [1.0, 1.0])?,
            by_map: Some(1.0),
            equation: Some(|p| (p.x * p.x - p.y * p.y - 1.0) / (p.x * p.x)),
        },
        Curve {
            name: "parabola",
            polygon: ControlPolygon::parabola(0.5, 2.0, 2)?,
            by_map: None,
            equation: Some(|p| p.y - 0.5 * p.x * p.x),
        },
        Curve {
            name: "cosine",
            polygon: ControlPolygon::cosine_graph(5)?,
            by_map: None,
            equation: Some(|p| p.y - p.x.cos()),
        },
        Curve {
            name: "sine",
            polygon: ControlPolygon::sine_graph(5)?,
            by_map: None,
            equation: Some(|p| p.y - p.x.sin()),
        },
        Curve {
            name: "free_polygon",
            polygon: ControlPolygon::closed(&free, Tension::trigonometric(deg(60.0))?)?,
            by_map: None,
            equation: None,
        },
    ])
}

impl Curve {
    fn moved(&self, points: Vec<DVec2>) -> Result<Vec<DVec2>, SubdivisionError> {
        let Some(a) = self.by_map else { return Ok(points) };
        // What runs off to infinity is cut off.
        Ok(hyperbola_of_ellipse(&points, a)?.into_iter().filter(|p| p.y.abs() < 4.0).collect())
    }

    fn draw(&self, canvas: &mut Canvas) -> Result<Option<f64>, Box<dyn Error>> {
        let closed = self.polygon.is_closed();
        let once = self.polygon.subdivided(1)?.points();
        let limit = self.moved(self.polygon.limit(6)?)?;
        let residual = self.equation.map(|equation| limit.iter().map(|&p| equation(p).abs()).fold(0.0, f64::max));
        let cage = self.polygon.points();
        // Of what is moved, the ellipse that it comes from.
        let source = if self.by_map.is_some() { self.polygon.limit(6)? } else { vec![] };
        let view = View::of_plane(cage.iter().chain(&limit).copied());
        let line = |points: &[DVec2]| points.iter().map(|p| p.extend(0.0)).collect::<Vec<DVec3>>();
        for panel in 0..3 {
            let place = canvas.panel(panel, 3, &view);
            canvas.polyline(&place, &line(&cage), closed, CAGE, 1.5);
            match panel {
                0 => canvas.dots(&place, &line(&cage), CAGE),
                1 => {
                    canvas.polyline(&place, &line(&once), closed, CURVE, 2.0);
                    canvas.dots(&place, &line(&once), CURVE);
                }
                _ => {
                    canvas.polyline(&place, &line(&source), closed, CURVE, 1.0);
                    canvas.polyline(&place, &line(&limit), closed && self.by_map.is_none(), CURVE, 3.0);
                }
            }
        }
        Ok(residual)
    }
}

/// A figure of space: cage, mesh after a level, mesh of the limit.
struct Surface {
    name: &'static str,
    cage: QuadMesh,
    once: QuadMesh,
    limit: QuadMesh,
    equation: Option<fn(DVec3) -> f64>,
}

fn revolution(
    name: &'static str,
    figure: &SubdivisionRevolution,
    equation: Option<fn(DVec3) -> f64>,
) -> Result<Surface, Box<dyn Error>> {
    Ok(Surface {
        name,
        cage: figure.control_cage(),
        once: figure.subdivided_mesh([1, 1])?,
        limit: figure.limit_mesh([5, 5])?,
        equation,
    })
}

fn surfaces() -> Result<Vec<Surface>, Box<dyn Error>> {
    let star: Vec<DVec2> = (0..10)
        .map(|k| DVec2::from_angle(f64::from(k) * 0.2 * std::f64::consts::PI) * [1.25, 0.8][k as usize % 2])
        .collect();
    let star = ControlPolygon::closed(&star, Tension::trigonometric(deg(36.0))?)?;
    let vase = [(0.0, -1.2), (0.8, -1.2), (1.1, -0.5), (0.5, 0.5), (0.45, 1.0), (0.75, 1.4)];
    let vase = ControlPolygon::clamped(&vase.map(|(x, y)| DVec2::new(x, y)), Tension::CUBIC)?;
    let vase = SubdivisionRevolution::new(vase, star)?.with_ends(ProfileEnd::Pole, ProfileEnd::Open);
    let profile = [(1.6, -0.5), (2.6, -0.5), (2.2, 0.6), (1.4, 0.3)].map(|(x, y)| DVec2::new(x, y));
    let right_angle = Tension::trigonometric(deg(90.0))?;
    let path = [(1.0, 0.0), (0.3, 1.2), (-1.0, 0.4), (-0.6, -0.9)].map(|(x, y)| DVec2::new(x, y) * 1.4);
    let ring = SubdivisionRevolution::new(
        ControlPolygon::closed(&profile, right_angle)?,
        ControlPolygon::closed(&path, right_angle)?,
    )?;
    // A sheet of 6 × 7 points, raised here and there.
    let heights = [[0, 0, 0, 0, 0, 0, 0], [0, 0, 1, 0, 0, 0, 0], [0, 1, 3, 1, 0, -1, 0], [0, 0, 1, 0, -1, -2, 0]];
    let height = |i: usize, j: usize| heights.get(i).map_or(0, |row| row[j]);
    let at = |k: usize| {
        let (i, j) = (k / 7, k % 7);
        0.5 * DVec3::new(j as f64 - 3.0, i as f64 - 2.5, f64::from(height(i, j)))
    };
    let points: Vec<DVec3> = (0..42).map(at).collect();
    let sheet = ControlGrid::new(&points, [6, 7], [false, false], [Tension::CUBIC; 2])?;
    let sheet = Surface {
        name: "grid",
        cage: sheet.control_cage(),
        once: sheet.subdivided(1)?.control_cage(),
        limit: sheet.limit_mesh(4)?,
        equation: None,
    };
    // Without their flat ends one sees into them.
    let one_sheet = SubdivisionRevolution::one_sheet([0.8, 0.6, 0.8], 2.4)?;
    let one_sheet = one_sheet.with_ends(ProfileEnd::Open, ProfileEnd::Open);
    let two_sheets = SubdivisionRevolution::two_sheets([0.6, 0.5, 0.5], 2.0)?;
    let two_sheets = two_sheets.with_ends(ProfileEnd::Pole, ProfileEnd::Open);
    Ok(vec![
        revolution(
            "ellipsoid",
            &SubdivisionRevolution::ellipsoid([1.5, 1.0, 0.8])?,
            Some(|p| (p.x / 1.5).powi(2) + p.y.powi(2) + (p.z / 0.8).powi(2) - 1.0),
        )?,
        revolution(
            "one_sheet",
            &one_sheet,
            Some(|p| {
                let (a, z) = ((p.x / 0.8).powi(2) + (p.y / 0.6).powi(2), (p.z / 0.8).powi(2));
                (a - z - 1.0) / a
            }),
        )?,
        revolution(
            "two_sheets",
            &two_sheets,
            Some(|p| {
                let (a, z) = ((p.x / 0.6).powi(2) + (p.y / 0.5).powi(2), (p.z / 0.5).powi(2));
                (z - a - 1.0) / z
            }),
        )?,
        revolution(
            "elliptic_torus",
            &SubdivisionRevolution::elliptic_torus([0.4, 0.5], 1.3, 0.7)?,
            Some(|p| {
                let across = (p.x.hypot(p.y / 0.7) - 1.3) / 0.4;
                across.powi(2) + (p.z / 0.5).powi(2) - 1.0
            }),
        )?,
        revolution(
            "elliptic_cylinder",
            &SubdivisionRevolution::elliptic_cylinder([1.2, 0.8], 1.8)?,
            Some(|p| {
                let a = (p.x / 1.2).powi(2) + (p.y / 0.8).powi(2);
                if a < 1e-20 { 0.0 } else { a - 1.0 }
            }),
        )?,
        revolution("vase", &vase, None)?,
        revolution("free_ring", &ring, None)?,
        sheet,
    ])
}

impl Surface {
    fn draw(&self, canvas: &mut Canvas) -> Option<f64> {
        let view = View::of_space(self.cage.positions().iter().chain(self.limit.positions()).copied());
        let place = canvas.panel(0, 3, &view);
        canvas.faces(&place, &self.cage, SURFACE);
        canvas.edges(&place, &self.cage, CAGE, false);
        let place = canvas.panel(1, 3, &view);
        canvas.faces(&place, &self.once, SURFACE);
        canvas.edges(&place, &self.once, CURVE, false);
        let place = canvas.panel(2, 3, &view);
        canvas.faces(&place, &self.limit, SURFACE);
        canvas.edges(&place, &self.cage, CAGE, true);
        let positions = self.limit.positions();
        self.equation.map(|equation| positions.iter().map(|&p| equation(p).abs()).fold(0.0, f64::max))
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "target/examples".into()));
    std::fs::create_dir_all(&folder)?;
    println!("Control polygon or cage, one level, limit; how far points of the limit are from the equation:");
    let start = Instant::now();
    let save = |name: &str, residual: Option<f64>, canvas: Canvas| -> Result<(), Box<dyn Error>> {
        let path = folder.join(format!("subdivision_{name}.png"));
        canvas.image()?.save(&path)?;
        let residual = residual.map_or("no equation".into(), |residual| format!("{residual:.0e}"));
        println!("  {:54} {residual}", path.display());
        Ok(())
    };
    for curve in curves()? {
        let mut canvas = Canvas::new(WIDTH, HEIGHT);
        let residual = curve.draw(&mut canvas)?;
        save(curve.name, residual, canvas)?;
    }
    for surface in surfaces()? {
        let mut canvas = Canvas::new(WIDTH, HEIGHT);
        let residual = surface.draw(&mut canvas);
        save(surface.name, residual, canvas)?;
    }
    println!("{:.1} s", start.elapsed().as_secs_f64());
    Ok(())
}
