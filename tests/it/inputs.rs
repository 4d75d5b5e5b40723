//! Whatever numbers are given to what stands around solids (cameras, planes, settings, plain data):
//! an error that tells which and what is allowed, or a result without NaN; never a panic.

use std::panic::{AssertUnwindSafe, catch_unwind};

use glam::{DAffine3, DMat3, DVec2, DVec3, Vec3};
use rvachev::{
    AtBounds, Bounds, Camera, CellSize, Features, Image, Lights, Mesh, MeshSettings, Plane, PlaneBounds, PointCloud,
    Polyline, RenderSettings, SaveSettings, SliceSettings, Solid, Style, ThinFeatures,
    camera::Intrinsics,
    io::{write_dxf, write_obj, write_ply, write_ply_points, write_stl_ascii, write_svg},
    layers::Isolines,
    rad,
    range_image::{Coordinates, Noise, RangeImage},
    raster::{Buffers, Facing, RasterView},
    volume::{Lattice, Volume, VolumeSettings},
};

use super::explicit_inputs::Chance;

impl Chance {
    fn point(&mut self) -> DVec3 {
        self.numbers::<3>().into()
    }

    fn box_(&mut self) -> Bounds {
        let [a, b] = [self.point(), self.point()];
        if self.below(4) == 0 { Bounds::new(a, b) } else { Bounds::new(a.min(b), a.max(b)) }
    }

    fn single(&mut self) -> f32 {
        self.number() as f32
    }

    fn camera(&mut self) -> Camera {
        let (eye, target, size) = (self.point(), self.point(), self.number());
        let up = if self.below(3) > 0 { DVec3::Z } else { self.point() };
        let camera = match self.below(3) {
            0 => Camera::orthographic(eye, target, up, size),
            1 => Camera::look_at(eye, target),
            _ => Camera::perspective(eye, target, up, rad(size)),
        };
        match self.below(6) {
            0 => camera.parallel(),
            1 => camera.orbit(rad(self.number()), rad(self.number())),
            2 => camera.fitted(&self.box_(), self.number()),
            3 => camera.fitted_to(&[self.point(), self.point()], self.number()),
            _ => camera,
        }
    }
}

/// What an error says.
trait Said {
    fn said(self) -> String;
}

impl<E: std::fmt::Display> Said for E {
    fn said(self) -> String {
        let text = self.to_string();
        let tells = ["allowed", "must", "finite", "lie", "needed", "unbounded", "at most", "outside", "exceed", "too"];
        assert!(!text.contains("internal error"), "{text}");
        assert!(tells.iter().any(|word| text.contains(word)), "an error that tells nothing: {text}");
        text
    }
}

/// Calls `job` with many seeds; all that panic are told.
fn all(seeds: u64, job: impl Fn(&mut Chance)) {
    let mut wrong = Vec::new();
    for seed in 0..seeds {
        let mut chance = Chance(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) + 1);
        if let Err(panic) = catch_unwind(AssertUnwindSafe(|| job(&mut chance))) {
            let text = panic.downcast_ref::<String>().cloned();
            let text = text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()));
            wrong.push(format!("{seed}: {}", text.unwrap_or_default()));
        }
    }
    assert!(wrong.is_empty(), "{} of {seeds}:\n{}", wrong.len(), wrong[..wrong.len().min(12)].join("\n"));
}

fn part() -> Solid {
    (Solid::cuboid([2.0, 1.0, 1.0]) - Solid::cylinder(0.3, 3.0)) | Solid::sphere(0.4).translate([1.0, 0.0, 0.5])
}

#[test]
fn cameras_and_pictures_take_anything() {
    let solid = part();
    all(600, |chance| {
        let camera = chance.camera();
        match solid.layers(&camera, 8, 8) {
            Ok(layers) => {
                assert!(layers.depth().pixels().iter().all(|depth| !depth.is_nan()), "{camera:?}");
                assert!(layers.normal().pixels().iter().all(|n| !n.is_nan()), "{camera:?}");
                let range = layers.range_image();
                if let Ok(cloud) = range.points(Coordinates::World) {
                    assert!(cloud.positions().iter().all(|p| p.is_finite()));
                }
            }
            Err(error) => drop(error.said()),
        }
        let light = |chance: &mut Chance| if chance.below(2) > 0 { 1.0 } else { chance.number() };
        let settings = RenderSettings {
            width: [8, 8, 8, 0, u32::MAX][chance.below(5)],
            height: [8, 8, 8, 0, u32::MAX][chance.below(5)],
            samples: [1, 2, 0, 9][chance.below(4)],
            style: Style::ALL[chance.below(4)],
            lights: Lights { key: light(chance), fill: light(chance), rim: 1.0, sky: light(chance) },
            softness: rad(light(chance)),
            ..RenderSettings::default()
        };
        if let Err(error) = solid.render(&camera, &settings) {
            error.said();
        }
        match RasterView::new(&camera, 8, 8).and_then(|view| view.with_near(chance.number())) {
            Ok(view) => {
                let mesh = Solid::cuboid(DVec3::ONE).mesh(&cells(4)).unwrap();
                let mut buffers = Buffers::new(&view);
                buffers.draw(&view.surface(&mesh), 0, Facing::Front).unwrap();
                assert!(buffers.depths().iter().all(|depth| !depth.is_nan()), "{camera:?}");
                if let Err(error) = buffers.range_image() {
                    error.said();
                }
            }
            Err(error) => drop(error.said()),
        }
    });
}

fn cells(count: u32) -> MeshSettings {
    MeshSettings { cell: CellSize::LongestSide(count), ..MeshSettings::default() }
}

#[test]
fn planes_and_slices_take_anything() {
    let solid = part();
    all(400, |chance| {
        let plane = match chance.below(3) {
            0 => Plane::xy(chance.number()),
            1 => Plane::new(chance.point(), chance.point()),
            _ => Plane::new([0.0, 0.1, 0.0], chance.point()),
        };
        let [a, b] = [chance.numbers::<2>(), chance.numbers::<2>()].map(DVec2::from);
        let slice = match chance.below(2) {
            0 => solid.slice(&plane),
            _ => solid.slice_within(&plane, PlaneBounds { min: a.min(b), max: a.max(b) }),
        };
        let slice = match slice {
            Ok(slice) => slice,
            Err(error) => return drop(error.said()),
        };
        match slice.values(8) {
            Ok(values) => assert!(values.pixels().iter().all(|v| v.is_finite()), "{plane:?}"),
            Err(error) => drop(error.said()),
        }
        let isolines = [Isolines::Auto, Isolines::None, Isolines::Every(chance.number())][chance.below(3)];
        if let Err(error) = slice.picture(&SliceSettings { width: 8, isolines, ..SliceSettings::default() }) {
            error.said();
        }
        let tolerance = if chance.below(2) > 0 { 0.05 } else { chance.number() };
        match slice.contours(tolerance) {
            Ok(lines) => assert!(lines.iter().all(|line| line.area().is_finite() && line.length().is_finite())),
            Err(error) => drop(error.said()),
        }
    });
}

#[test]
fn meshing_takes_any_cells_and_bounds() {
    let solid = part();
    all(300, |chance| {
        let cell = match chance.below(3) {
            0 => CellSize::LongestSide([0, 1, 2, 9, u32::MAX][chance.below(5)]),
            1 => CellSize::Tolerance([0.0, -1.0, f64::NAN, 1e-300, 0.1, 1e300][chance.below(6)]),
            _ => CellSize::Length(chance.number()),
        };
        let bounds = (chance.below(3) > 0).then(|| chance.box_());
        // A lattice of a billion cells is no error, and not for a test.
        let cell = match (cell, bounds) {
            (CellSize::Length(length), None) if length < 0.05 => CellSize::LongestSide(8),
            (CellSize::Length(_), Some(_)) => CellSize::LongestSide(8),
            (cell, _) => cell,
        };
        let settings = MeshSettings {
            cell,
            bounds,
            at_bounds: [AtBounds::Cap, AtBounds::Refuse][chance.below(2)],
            features: [Features::Smooth, Features::Sharp][chance.below(2)],
            thin: [ThinFeatures::Ignore, ThinFeatures::Count][chance.below(2)],
            owners: chance.below(2) > 0,
        };
        match solid.mesh(&settings) {
            Ok(mesh) => sound(&mesh),
            Err(error) => drop(error.said()),
        }
        match Lattice::new(&chance.box_(), CellSize::Length(chance.number())) {
            Ok(lattice) => assert!(lattice.origin().is_finite() && lattice.step() > 0.0, "{lattice:?}"),
            Err(error) => drop(error.said()),
        }
    });
}

/// Nothing of a mesh, nor of what it is written as, is without a number.
fn sound(mesh: &Mesh) {
    assert!(mesh.positions().iter().all(|p| p.is_finite()));
    let report = mesh.check();
    assert!(!report.volume.is_nan() && !mesh.volume().is_nan() && !mesh.area().is_nan(), "{report}");
    assert!(mesh.centroid().is_none_or(|p| p.is_finite()), "{:?}", mesh.centroid());
    assert!(mesh.inertia().is_none_or(|m| m.is_finite()), "{:?}", mesh.inertia());
    let mut files = vec![Vec::new(); 3];
    let results = [
        write_stl_ascii(mesh, &mut files[0]),
        write_obj(mesh, &SaveSettings::default(), &mut files[1]),
        write_ply(mesh, &mut files[2]),
    ];
    for (file, result) in files[..2].iter().zip(results) {
        if result.is_ok() {
            no_nan(file);
        }
    }
}

fn no_nan(file: &[u8]) {
    let text = String::from_utf8_lossy(file).to_lowercase();
    let words = text.split(|c: char| !c.is_ascii_alphabetic());
    let bad = words.into_iter().find(|word| ["nan", "inf"].contains(word));
    assert!(bad.is_none(), "{bad:?} in {}", &text[..text.len().min(300)]);
}

#[test]
fn volumes_take_anything() {
    all(3000, |chance| {
        let size = [chance.below(4), 1 + chance.below(4), 1 + chance.below(4)];
        let samples: Vec<f32> = (0..size.iter().product::<usize>()).map(|_| chance.single()).collect();
        let settings =
            VolumeSettings { level: chance.single(), normals: chance.below(2) > 0, closed: chance.below(2) > 0 };
        match Volume::new(&samples, size, chance.point(), chance.point()).and_then(|volume| volume.mesh(&settings)) {
            Ok(mesh) => {
                assert!(mesh.normals().is_none_or(|normals| normals.iter().all(|n| n.is_finite())));
                sound(&mesh);
            }
            Err(error) => drop(error.said()),
        }
    });
}

#[test]
fn meshes_and_their_deformations_take_anything() {
    all(3000, |chance| {
        let mut vector = || Vec3::new(chance.single(), chance.single(), chance.single());
        let (positions, normals) = ((0..4).map(|_| vector()).collect(), (0..4).map(|_| vector()).collect());
        let mesh = match Mesh::new(positions, vec![[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]) {
            Ok(mesh) => mesh,
            Err(error) => return drop(error.said()),
        };
        sound(&mesh);
        match mesh.clone().with_normals(normals) {
            Ok(mesh) => sound(&mesh),
            Err(error) => drop(error.said()),
        }
        let [a, b, c] = chance.numbers();
        let map = DAffine3::from_mat3_translation(DMat3::from_diagonal(chance.point()), chance.point());
        for moved in [mesh.affine(map), mesh.taper(a, b, c), mesh.twist(rad(a)), mesh.bend(a, rad(b))] {
            match moved {
                Ok(mesh) => sound(&mesh),
                Err(error) => drop(error.said()),
            }
        }
    });
}

#[test]
fn points_and_range_images_take_anything() {
    all(3000, |chance| {
        let positions = (0..3).map(|_| chance.point()).collect();
        let normals: Vec<Vec3> = (0..3).map(|_| chance.point().as_vec3()).collect();
        match PointCloud::new(positions).and_then(|cloud| cloud.with_normals(normals)) {
            Ok(cloud) => {
                let mut file = Vec::new();
                write_ply_points(&cloud, &mut file).unwrap();
                assert!(cloud.normals().unwrap().iter().all(|n| n.is_finite()));
            }
            Err(error) => drop(error.said()),
        }
        let depth = Image::new(3, 2, (0..6).map(|_| chance.number()).collect()).unwrap();
        let [fx, fy, cx, cy] = chance.numbers();
        let intrinsics = Intrinsics { width: 3, height: 2, fx, fy, cx, cy, parallel: chance.below(2) > 0 };
        let pose = DAffine3::from_mat3_translation(DMat3::from_diagonal(chance.point()), chance.point());
        let noise = Noise { deviation: chance.number(), missing: chance.number(), seed: 7 };
        match RangeImage::new(depth, intrinsics, pose) {
            Ok(range) => {
                if let Err(error) = range.with_noise(&noise) {
                    error.said();
                }
                for coordinates in [Coordinates::World, Coordinates::Camera] {
                    if let Err(error) = range.points(coordinates) {
                        error.said();
                    }
                }
            }
            Err(error) => drop(error.said()),
        }
    });
}

#[test]
fn drawings_take_anything() {
    all(3000, |chance| {
        let points = (0..chance.below(4)).map(|_| chance.numbers::<2>().into()).collect();
        let line = [Polyline::open, Polyline::closed][chance.below(2)](points);
        let (mut svg, mut dxf) = (Vec::new(), Vec::new());
        let lines = [line];
        for result in [write_svg(&lines, &mut svg), write_dxf(&lines, &mut dxf)] {
            if let Err(error) = result {
                error.said();
            }
        }
        no_nan(&svg);
        no_nan(&dxf);
    });
}

#[test]
fn questions_take_any_points_rays_and_boxes() {
    let solids = [part(), part().twist(rad(0.3)), part().offset(0.1), Solid::half_space([0.0, 1.0, 2.0], 0.3)];
    all(1500, |chance| {
        let solid = &solids[chance.below(4)];
        let (p, q, region) = (chance.point(), chance.point(), chance.box_());
        let value = solid.value(p).unwrap();
        assert!(!value.is_nan(), "{value} at {p}");
        assert!(solid.values(&[p, q]).unwrap().iter().all(|v| !v.is_nan()), "{p} {q}");
        assert!(!solid.gradient(p).unwrap().is_nan(), "{p}");
        let range = solid.range(&region).unwrap();
        assert!(!range.lo().is_nan() && !range.hi().is_nan());
        let _ = (solid.region(&region).unwrap(), solid.owner(p).unwrap(), solid.contains(p).unwrap());
        let is_ray = p.is_finite() && q.is_finite() && q != DVec3::ZERO;
        match solid.raycast(p, q) {
            Ok(hit) => {
                let is_whole = hit.is_none_or(|hit| hit.distance.is_finite() && hit.normal.is_finite());
                assert!(is_ray && is_whole, "{hit:?} from {p} along {q}");
            }
            Err(error) => assert!(!is_ray, "{} from {p} along {q}", error.said()),
        }
        match solid.closest_surface_point(p) {
            Ok(found) => assert!(found.is_none_or(|found| found.is_finite()), "{found:?} from {p}"),
            Err(error) => drop(error.said()),
        }
    });
}

#[test]
fn questions_with_numbers_that_are_not_finite_are_errors() {
    let ball = Solid::sphere(1.0);
    let text = |error: rvachev::SolidError| error.to_string();
    let (nan, far) = (DVec3::new(0.0, f64::NAN, 0.0), DVec3::new(0.0, 0.0, f64::INFINITY));
    assert_eq!(text(ball.raycast(nan, DVec3::X).unwrap_err()), "origin.y is NaN, allowed: finite");
    assert_eq!(
        text(ball.raycast(DVec3::ZERO, far).unwrap_err()),
        "direction is inf, allowed: a finite vector other than zero"
    );
    let none = text(ball.raycast(DVec3::ZERO, DVec3::ZERO).unwrap_err());
    assert_eq!(none, "direction is 0, allowed: a finite vector other than zero");
    let rays = [(DVec3::ZERO, DVec3::X), (DVec3::ZERO, nan)];
    assert_eq!(
        text(ball.raycast_all(&rays).unwrap_err()),
        "ray 1: direction is NaN, allowed: a finite vector other than zero"
    );
    assert_eq!(text(ball.closest_surface_point(far).unwrap_err()), "p.z is inf, allowed: finite");
    let points = text(ball.closest_surface_points(&[DVec3::X, nan]).unwrap_err());
    assert_eq!(points, "point 1: p.y is NaN, allowed: finite");
    assert!(ball.raycast(DVec3::ZERO, DVec3::splat(1e-310)).unwrap().is_some());
}

/// Normals of any length but 0.
#[test]
fn normals_are_directions_whatever_their_length() {
    let way = DVec3::new(1.0, -2.0, 2.0);
    for length in [1e-320, 1e-200, 1e-30, 1.0, 1e30, 1e200, 5e307] {
        let half = Solid::half_space(way * length, 3.0);
        let slab = Solid::slab(way * length, 2.0);
        // Numbers that are so small have few digits.
        let precise = if length < 1e-300 { 1e-2 } else { 1e-12 };
        for p in [DVec3::ZERO, way, 2.0 * way] {
            let along = way.dot(p) / 3.0;
            assert!((half.value(p).unwrap() - (3.0 - along)).abs() < precise, "{length}");
            assert!((slab.value(p).unwrap() - (1.0 - along.abs())).abs() < precise, "{length}");
        }
    }
    let text = |solid: Solid| solid.bounds().unwrap_err().to_string();
    let none = text(Solid::half_space(DVec3::ZERO, 1.0));
    assert_eq!(none, "half-space: normal is 0, allowed: a finite vector other than zero");
    assert_eq!(
        text(Solid::slab([0.0, f64::INFINITY, 0.0], 1.0)),
        "slab: normal is inf, allowed: a finite vector other than zero"
    );
}
