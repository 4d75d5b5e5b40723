//! Moved and deformed meshes: affine maps, and Barr's taper, twist and bend, vertex by vertex.
//!
//! ```text
//! affine X = A x + b
//! taper  t = clamp(2z/h, −1, 1), s = 1 + K t         X = s_x x,  Y = s_y y,  Z = z
//! twist  φ = ω z                                     (X, Y) = (x, y) turned by φ,  Z = z
//! bend   r = along u = (cos α, sin α), γ = κ z       R = r + (1 − κr) z sin(γ/2) sinc(γ/2)
//!                                                    Z = (1 − κr) z sinc γ
//! normal J⁻ᵀ n at length 1
//! ```
//!
//! The same maps, parameters and ranges as those of solids ([`Solid::taper`](crate::Solid::taper),
//! [`twist`](crate::Solid::twist), [`bend`](crate::Solid::bend)), run forwards. A triangle stays
//! flat, so a mesh wants to be as fine as the deformed surface asks for. Closed meshes stay
//! closed; convex ones mostly do not stay convex.
//!
//! Sources: A. H. Barr, *Global and local deformations of solid primitives* (1984); F. Solina
//! and R. Bajcsy (1990) for the bend.

use glam::{DAffine3, DVec3, Vec3};

use super::error::RasterError;
use crate::geom::each;
use crate::{Angle, Mesh, ParamError, Run};
use rvachev_field::{AnyWarp, Bend, Erase, Taper, Twist};

/// Vertices and triangles that a thread takes at once.
const CHUNK: usize = 4096;

impl Mesh {
    /// The mesh moved by an affine map, with all that it carries. A map that mirrors turns the
    /// triangles round, so that they face outward again.
    ///
    /// ```
    /// use glam::{DAffine3, DVec3};
    /// use rvachev::surface::{ParametricSurface, PatchSettings};
    /// use rvachev::Superellipsoid;
    ///
    /// let mesh = ParametricSurface::of(&Superellipsoid::new([1.0, 1.0, 1.0], 1.0, 1.0))?.mesh(&PatchSettings::default())?;
    /// let flipped = mesh.affine(DAffine3::from_scale(DVec3::new(-2.0, 1.0, 1.0)))?;
    /// assert!((flipped.volume() / mesh.volume() - 2.0).abs() < 1e-6);
    /// assert!(flipped.corner_texture().is_some());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`RasterError::Parameter`] for a map that flattens or is not finite;
    /// [`RasterError::Mesh`] if a vertex is moved out of single precision.
    pub fn affine(&self, map: DAffine3) -> Result<Mesh, RasterError> {
        self.affine_with(map, &Run::default())
    }

    /// [`affine`](Mesh::affine) with a choice of threads, a cancel token and a progress sink.
    ///
    /// ```
    /// use glam::{DAffine3, DVec3};
    /// use rvachev::{MeshSettings, Run, Solid};
    ///
    /// let mesh = Solid::sphere(1.0).mesh(&MeshSettings::default())?;
    /// let moved = mesh.affine_with(DAffine3::from_translation(DVec3::X), &Run { threads: 2, ..Run::default() })?;
    /// assert!((moved.bounds().min.x - mesh.bounds().min.x - 1.0).abs() < 1e-5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`affine`](Mesh::affine), and [`RasterError::Cancelled`].
    pub fn affine_with(&self, map: DAffine3, run: &Run) -> Result<Mesh, RasterError> {
        let determinant = map.matrix3.determinant();
        if !map.is_finite() || determinant == 0.0 {
            return Err(ParamError::new("determinant of the map", determinant, "finite, and not 0").into());
        }
        let turned = map.matrix3.inverse().transpose();
        moved(self, determinant < 0.0, run, |p, n| (map.transform_point3(p), turned * n))
    }

    /// The mesh tapered along z, with the parameters of [`Solid::taper`](crate::Solid::taper).
    ///
    /// ```
    /// use rvachev::raster::ClosedMesh;
    /// use rvachev::surface::{ParametricSurface, PatchSettings};
    /// use rvachev::{Superellipsoid, deg, rad};
    ///
    /// let bar = ParametricSurface::of(&Superellipsoid::new([0.5, 0.5, 2.0], 0.3, 0.3))?.mesh(&PatchSettings::default())?;
    /// let bent = bar.taper(0.4, 0.4, 4.0)?.twist(rad(0.6))?.bend(0.3, deg(0.0))?;
    /// ClosedMesh::new(&bent)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`RasterError::Parameter`] for a parameter that a solid of this size would not take.
    pub fn taper(&self, kx: f64, ky: f64, height: f64) -> Result<Mesh, RasterError> {
        self.taper_with(kx, ky, height, &Run::default())
    }

    /// [`taper`](Mesh::taper) with a choice of threads, a cancel token and a progress sink.
    ///
    /// # Errors
    ///
    /// Those of [`taper`](Mesh::taper), and [`RasterError::Cancelled`].
    pub fn taper_with(&self, kx: f64, ky: f64, height: f64, run: &Run) -> Result<Mesh, RasterError> {
        let half_height = 0.5 * height;
        deformed(self, &*Taper { kx, ky, height }.erase(), run, |p, n| {
            let t = (p.z / half_height).clamp(-1.0, 1.0);
            let (sx, sy) = (1.0 + kx * t, 1.0 + ky * t);
            let across = DVec3::new(n.x / sx, n.y / sy, 0.0);
            // Beyond the ends the section does not change.
            let rate = if p.z.abs() < half_height { 1.0 / half_height } else { 0.0 };
            let along = n.z - rate * (kx * p.x * across.x + ky * p.y * across.y);
            (DVec3::new(sx * p.x, sy * p.y, p.z), across + along * DVec3::Z)
        })
    }

    /// The mesh twisted about the z axis, with the parameter of
    /// [`Solid::twist`](crate::Solid::twist).
    ///
    /// # Errors
    ///
    /// [`RasterError::Parameter`].
    pub fn twist(&self, rate: impl Into<Angle>) -> Result<Mesh, RasterError> {
        self.twist_with(rate, &Run::default())
    }

    /// [`twist`](Mesh::twist) with a choice of threads, a cancel token and a progress sink.
    ///
    /// # Errors
    ///
    /// Those of [`twist`](Mesh::twist), and [`RasterError::Cancelled`].
    pub fn twist_with(&self, rate: impl Into<Angle>, run: &Run) -> Result<Mesh, RasterError> {
        let rate = rate.into();
        deformed(self, &*Twist { rate }.erase(), run, |p, n| {
            let rate = rate.radians();
            let (sin, cos) = (rate * p.z).sin_cos();
            let turned = |v: DVec3| DVec3::new(v.x * cos - v.y * sin, v.x * sin + v.y * cos, v.z);
            (turned(p), turned(n) - DVec3::Z * (rate * (p.x * n.y - p.y * n.x)))
        })
    }

    /// The mesh bent, with the parameters of [`Solid::bend`](crate::Solid::bend).
    ///
    /// # Errors
    ///
    /// [`RasterError::Parameter`].
    pub fn bend(&self, curvature: f64, angle: impl Into<Angle>) -> Result<Mesh, RasterError> {
        self.bend_with(curvature, angle, &Run::default())
    }

    /// [`bend`](Mesh::bend) with a choice of threads, a cancel token and a progress sink.
    ///
    /// # Errors
    ///
    /// Those of [`bend`](Mesh::bend), and [`RasterError::Cancelled`].
    pub fn bend_with(&self, curvature: f64, angle: impl Into<Angle>, run: &Run) -> Result<Mesh, RasterError> {
        let angle = angle.into();
        let k = curvature;
        let (sin_angle, cos_angle) = angle.sin_cos();
        let along = DVec3::new(cos_angle, sin_angle, 0.0);
        deformed(self, &*Bend { curvature, angle }.erase(), run, |p, n| {
            let r = p.dot(along);
            let left = 1.0 - k * r;
            let (sin, cos) = (k * p.z).sin_cos();
            let half = 0.5 * k * p.z;
            let shift = left * p.z * half.sin() * sinc(half);
            let point = DVec3::new(p.x, p.y, 0.0) + along * shift + DVec3::Z * (left * p.z * sinc(k * p.z));
            // The map turns by γ about the axis of the bend and stretches by `left` along the arc.
            let (nr, nz) = (n.dot(along), n.z / left);
            let side = n - along * nr - DVec3::Z * n.z;
            (point, side + along * (cos * nr + sin * nz) + DVec3::Z * (cos * nz - sin * nr))
        })
    }
}

/// The mesh moved by `map` if `warp` takes what it holds.
fn deformed(
    mesh: &Mesh,
    warp: &dyn AnyWarp,
    run: &Run,
    map: impl Fn(DVec3, DVec3) -> (DVec3, DVec3) + Sync,
) -> Result<Mesh, RasterError> {
    if !mesh.positions().is_empty() {
        warp.check(&mesh.bounds())?;
    }
    moved(mesh, false, run, map)
}

/// The mesh with its vertices and normals, of any length, moved by `map`; its triangles the other
/// way round if that mirrors. All else that it carries stays with its corners and triangles.
fn moved(
    mesh: &Mesh,
    mirrors: bool,
    run: &Run,
    map: impl Fn(DVec3, DVec3) -> (DVec3, DVec3) + Sync,
) -> Result<Mesh, RasterError> {
    let run = run.stage(0.0, 1.0);
    run.check()?;
    let moved = run.install(|| moved_on(mesh, mirrors, &run, &map))?;
    run.report(1.0);
    Ok(moved)
}

fn moved_on(
    mesh: &Mesh,
    mirrors: bool,
    run: &Run,
    map: &(impl Fn(DVec3, DVec3) -> (DVec3, DVec3) + Sync),
) -> Result<Mesh, RasterError> {
    let (positions, triangles) = (mesh.positions(), mesh.triangles());
    let normal = |vertex: u32, n: Vec3| {
        // Of length 1 first: one that is next to nothing would be rounded away.
        let n = map(positions[vertex as usize].as_dvec3(), n.as_dvec3()).1;
        (n / n.abs().max_element().max(f64::MIN_POSITIVE)).normalize_or_zero().as_vec3()
    };
    // As many as there are numbers to find.
    let has = |numbers: usize, is_there: bool| if is_there { numbers as f64 } else { 0.0 };
    let counts = [
        positions.len() as f64,
        has(positions.len(), mesh.normals().is_some()),
        has(3 * triangles.len(), mesh.corner_normals().is_some()),
        // What is copied only.
        0.5 * triangles.len() as f64 + 1.0,
    ];
    let [moving, turning, bending, _] = run.stages(counts);
    let vertices = each(positions.len(), CHUNK, &moving, |v| map(positions[v].as_dvec3(), DVec3::ZERO).0.as_vec3())?;
    let mut moved = Mesh::new(vertices, turned_round(triangles, mirrors))?;
    if let Some(normals) = mesh.normals() {
        moved = moved.with_normals(each(normals.len(), CHUNK, &turning, |v| normal(v as u32, normals[v]))?)?;
    }
    if let Some(normals) = mesh.corner_normals() {
        let turned = |t: usize| std::array::from_fn(|k| normal(triangles[t][k], normals[t][k]));
        let turned: Vec<[Vec3; 3]> = each(normals.len(), CHUNK, &bending, turned)?;
        moved = moved.with_corner_normals(turned_round(&turned, mirrors))?;
    }
    run.check()?;
    if let Some(colors) = mesh.corner_colors() {
        moved = moved.with_corner_colors(turned_round(colors, mirrors))?;
    }
    if let Some(texture) = mesh.corner_texture() {
        moved = moved.with_corner_texture(turned_round(texture, mirrors))?;
    }
    if let Some(owners) = mesh.owners() {
        moved = moved.with_owners(owners.to_vec())?;
    }
    Ok(moved.with_counts_of(mesh))
}

/// What triangles have at their corners, the last two exchanged if they are to be turned round.
fn turned_round<T: Copy>(corners: &[[T; 3]], turn: bool) -> Vec<[T; 3]> {
    corners.iter().map(|&[a, b, c]| if turn { [a, c, b] } else { [a, b, c] }).collect()
}

/// `sin(x)/x`.
fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-8 { 1.0 } else { x.sin() / x }
}
