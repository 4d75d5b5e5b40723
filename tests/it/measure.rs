//! Volume, centroid, inertia and area of solids: against closed forms, meshes and inclusion and
//! exclusion, within the bounds that are told.

use glam::{DMat3, DVec3};
use rvachev::catalogue::{Group, Part};
use rvachev::{
    Blend, CancelToken, CellSize, GeneralisedSuperquadric, MeasureReport, Mesh, MeshSettings, MeshSolid, Profile,
    Progress, RFunction, Run, Solid, catalogue, deg, rad,
};

use crate::support::Random;

fn most(matrix: DMat3) -> f64 {
    matrix.to_cols_array().into_iter().fold(0.0, |most: f64, x| most.max(x.abs()))
}

/// The solid cut so that it has no closed form, but nothing is taken off.
fn without_form(solid: &Solid) -> Solid {
    let bounds = solid.bounds().unwrap();
    let hull = Solid::cuboid(2.0 * bounds.size()).translate(bounds.center());
    solid.intersection(hull, RFunction::MIN_MAX)
}

/// Whether two reports agree within their errors.
fn assert_agree(name: &str, one: &MeasureReport, other: &MeasureReport) {
    let off = (one.volume - other.volume).abs();
    assert!(off <= one.volume_error + other.volume_error, "{name}: volume {off}\n{one:?}\n{other:?}");
    let off = (one.centroid.unwrap() - other.centroid.unwrap()).abs().max_element();
    assert!(off <= one.centroid_error + other.centroid_error, "{name}: centroid {off}\n{one:?}\n{other:?}");
    let off = most(one.inertia.unwrap() - other.inertia.unwrap());
    assert!(off <= one.inertia_error + other.inertia_error, "{name}: inertia {off}\n{one:?}\n{other:?}");
    let off = (one.area - other.area).abs();
    assert!(off <= one.area_error + other.area_error, "{name}: area {off}\n{one:?}\n{other:?}");
}

#[test]
fn leaves_of_the_catalogue_agree_with_quadrature_and_meshes() {
    let mut closed = 0;
    for entry in catalogue().iter().filter(|entry| entry.group() == Group::Leaf) {
        let name = entry.name();
        let Part::Solid(leaf) = entry.example() else { continue };
        if leaf.finite_bounds().is_err() {
            assert!(leaf.measure(1e-2).unwrap_err().to_string().contains("unbounded"), "{name}");
            continue;
        }
        let moved = leaf.rotate_z(deg(40.0)).rotate_x(deg(-25.0)).translate([3.0, -1.0, 2.0]);
        // Ranges of a supershape's slopes are wide.
        let tolerance = match name {
            "supershape" => 0.3,
            "torus" | "supertoroid" => 0.02,
            _ => 1e-3,
        };
        let report = moved.measure(tolerance).unwrap();
        if report.volume_error < 1e-11 * report.volume {
            closed += 1;
            let by_field = without_form(&moved).measure(tolerance).unwrap();
            assert!(by_field.volume_error <= tolerance * by_field.volume, "{name}: {by_field}");
            assert!(by_field.area_error <= tolerance * by_field.area, "{name}: {by_field}");
            assert_agree(name, &report, &by_field);
        }
        let mesh = moved.mesh(&MeshSettings { cell: CellSize::LongestSide(64), ..MeshSettings::default() }).unwrap();
        let off = (mesh.volume() - report.volume).abs() / report.volume;
        assert!(off < 5e-3 + report.volume_error / report.volume, "{name}: {off}");
        assert!(
            (mesh.area() - report.area).abs() < 5e-3 * report.area + report.area_error,
            "{name}: {} {}",
            mesh.area(),
            report.area
        );
    }
    assert!(closed >= 13, "{closed}");
}

/// Areas of curved solids are within bounds that are certain, and these are as narrow as is asked.
#[test]
fn areas_of_curved_solids_have_bounds_that_hold() {
    use std::f64::consts::PI;
    let turned = |solid: &Solid| solid.rotate_x(deg(20.0)).rotate_z(deg(35.0)).translate([0.3, -0.1, 0.2]);
    let ball = Solid::sphere(1.0);
    let beside = Solid::sphere(1.0).translate([1.0, 0.0, 0.0]);
    let rod = Solid::cylinder(0.5, 3.0);
    let plate = Solid::cuboid([6.0, 6.0, 1.0]);
    let post = Solid::cylinder(1.0, 3.0);
    let of_post = 2.0 * 36.0 + 24.0 + 4.0 * PI;
    // A quarter of a circle about the post's axis: Pappus.
    let fillet = Blend::Fillet { radius: 0.5 };
    let of_fillet = 0.5 * PI * 0.5 * 2.0 * PI * (1.5 - 2.0 * 0.5 / PI);
    let of_filleted = of_post + 2.0 * (of_fillet - PI * (1.5f64.powi(2) - 1.0) - 2.0 * PI * 0.5);
    let height = (1.0f64 - 0.25).sqrt();
    let bodies = [
        ("ball", without_form(&ball), 4.0 * PI),
        ("torus", without_form(&Solid::torus(1.0, 0.4)), 4.0 * PI * PI * 0.4),
        ("rod", without_form(&rod), 2.0 * PI * 0.5 * 3.0 + 0.5 * PI),
        ("two balls", &ball | &beside, 2.0 * 2.0 * PI * 1.5),
        ("lens", &ball & &beside, 2.0 * 2.0 * PI * 0.5),
        ("drilled ball", &ball - &rod, 4.0 * PI * height + 2.0 * PI * 0.5 * 2.0 * height),
        ("post", &plate | &post, of_post),
        ("filleted post", plate.union_with(&post, fillet), of_filleted),
        ("offset", turned(&(&ball | &beside)).offset(0.3), 2.0 * 2.0 * PI * 1.3 * (1.3 + 0.5)),
        ("rounded", Solid::cuboid([2.0, 2.0, 1.0]).rounded(0.25), {
            let flat = 2.0 * (1.5 * 1.5 + 2.0 * 1.5 * 0.5);
            flat + 0.5 * PI * 0.25 * 4.0 * (1.5 + 1.5 + 0.5) + 4.0 * PI * 0.0625
        }),
    ];
    for (name, body, area) in &bodies {
        let tolerance = 2e-2;
        let told = turned(body).measure(tolerance).unwrap();
        // Where a fillet ends nothing is known of its normals.
        let is_known = told.is_area_certain || *name == "filleted post";
        assert!(is_known && told.area_error <= tolerance * told.area, "{name}: {told:?}");
        // What is measured is off by what is measured.
        let off = 1e-3 * area * f64::from(u8::from(["filleted post", "offset", "rounded"].contains(name)));
        assert!((told.area - area).abs() <= told.area_error + off, "{name}: {told:?} {area}");
    }
}

#[test]
fn closed_forms_are_those_of_the_papers_under_maps() {
    let egg = Solid::superellipsoid([1.0, 2.0, 3.0], 0.3, 0.8);
    let report = egg.measure(0.1).unwrap();
    assert!((report.volume - 38.359362386288).abs() < 1e-11 && report.volume_error < 1e-10, "{report:?}");
    let squares = DVec3::new(9.92458049, 39.69832197, 105.26458786);
    let inertia = report.inertia.unwrap();
    assert!((inertia.x_axis.x - squares.y - squares.z).abs() < 2e-8, "{inertia}");
    assert!((inertia.z_axis.z - squares.x - squares.y).abs() < 2e-8, "{inertia}");
    let ring = Solid::supertoroid([1.2, 0.8, 0.6], 1.5, 0.3, 0.7).measure(0.1).unwrap();
    assert!((ring.volume - 23.439946622042).abs() < 1e-11, "{ring:?}");
    assert!((ring.inertia.unwrap().x_axis.x - 26.88101108 - 2.68177993).abs() < 2e-8, "{ring:?}");
    let generalised = Solid::from(GeneralisedSuperquadric::new([1.0; 3], [5.0, 3.0, 1.5])).measure(0.1).unwrap();
    assert!((generalised.volume - 5.374220338472).abs() < 1e-11, "{generalised:?}");
    // Sheared, stretched and moved.
    let map = glam::DAffine3 {
        matrix3: DMat3::from_cols(DVec3::new(1.0, 0.3, 0.0), DVec3::new(-0.2, 2.0, 0.1), DVec3::new(0.0, 0.5, 0.7)),
        translation: DVec3::new(4.0, 5.0, -6.0),
    };
    let sheared = egg.affine(map);
    let report = sheared.measure(2e-3).unwrap();
    assert!((report.volume - map.matrix3.determinant().abs() * 38.359362386288).abs() < 1e-10);
    assert!((report.centroid.unwrap() - map.translation).length() < 1e-10);
    assert_agree("sheared", &report, &without_form(&sheared).measure(2e-3).unwrap());
}

#[test]
fn unions_are_what_inclusion_and_exclusion_say() {
    let box_ = Solid::cuboid([4.0, 3.0, 2.0]).rotate_z(deg(20.0));
    let egg = Solid::superellipsoid([1.5, 1.2, 2.0], 0.6, 1.3).translate([1.2, 0.4, 0.5]);
    let [both, common, rest] = [&box_ | &egg, &box_ & &egg, &box_ - &egg].map(|solid| solid.measure(1e-3).unwrap());
    let [own, other] = [&box_, &egg].map(|solid| solid.measure(1e-3).unwrap());
    let off = (both.volume + common.volume - own.volume - other.volume).abs();
    assert!(off <= both.volume_error + common.volume_error + 1e-10, "{off} {both} {common}");
    let off = (rest.volume + common.volume - own.volume).abs();
    assert!(off <= rest.volume_error + common.volume_error + 1e-10, "{off} {rest} {common}");
    let first = |report: &MeasureReport| report.volume * report.centroid.unwrap();
    let off = (first(&both) + first(&common) - first(&own) - first(&other)).length();
    let allowed = [both, common].map(|r| 2.0 * (r.volume * r.centroid_error + 3.0 * r.volume_error)).iter().sum();
    assert!(off <= allowed, "{off} {allowed}");
}

#[test]
fn what_is_deformed_folded_blended_measured_or_read_has_bounds_that_hold() {
    let bar = Solid::cuboid([2.0, 1.5, 6.0]);
    // A twist keeps volumes, and so do copies.
    let twisted = bar.twist(rad(0.25)).measure(3e-2).unwrap();
    assert!((twisted.volume - 18.0).abs() <= twisted.volume_error && twisted.volume_error <= 0.54, "{twisted:?}");
    let ring = bar.translate([4.0, 0.0, 0.0]).repeat_polar(3).measure(5e-2).unwrap();
    assert!((ring.volume - 3.0 * 18.0).abs() <= ring.volume_error && ring.volume_error <= 2.7, "{ring:?}");
    assert!(ring.centroid.unwrap().abs().max_element() <= ring.centroid_error, "{ring:?}");
    // The offset inwards of a box that is in two halves is measured.
    let half = Solid::cuboid([2.0, 2.0, 2.0]);
    let halves = half.translate([-1.0, 0.0, 0.0]) | half.translate([1.0, 0.0, 0.0]);
    let inner = halves.offset(-0.25).measure(3e-2).unwrap();
    assert!((inner.volume - 3.5 * 1.5 * 1.5).abs() <= inner.volume_error + 1e-3 * inner.area, "{inner:?}");
    assert!(inner.volume_error <= 3e-2 * inner.volume, "{inner:?}");
}

/// A mesh with the triangles of another after them.
fn with(one: &Mesh, other: &Mesh) -> Mesh {
    let count = one.positions().len() as u32;
    let positions = [one.positions(), other.positions()].concat();
    let moved: Vec<[u32; 3]> = other.triangles().iter().map(|t| t.map(|v| v + count)).collect();
    Mesh::new(positions, [one.triangles(), &moved].concat()).unwrap()
}

#[test]
fn imported_meshes_are_summed_up() {
    let settings = MeshSettings { cell: CellSize::LongestSide(24), ..MeshSettings::default() };
    let mesh =
        (Solid::torus(2.0, 0.7) - Solid::cuboid([1.0, 1.0, 3.0]).translate([2.0, 0.3, 0.0])).mesh(&settings).unwrap();
    let read = Solid::from_mesh(&mesh, MeshSolid::default());
    let report = read.measure(1e-3).unwrap();
    assert!(report.is_closed_form && report.volume_error < 2e-5 * report.volume, "{report:?}");
    assert!((report.volume - mesh.volume()).abs() <= report.volume_error, "{report:?} {}", mesh.volume());
    assert!((report.area - mesh.area()).abs() <= report.area_error, "{report:?} {}", mesh.area());
    let off = (report.centroid.unwrap() - mesh.centroid().unwrap()).abs().max_element();
    assert!(off <= report.centroid_error, "{report:?} {off}");
    let off = most(report.inertia.unwrap() - mesh.inertia().unwrap());
    assert!(off <= report.inertia_error, "{report:?} {off}");
    // Mirrored, stretched and turned, by itself and in the blocks of a join.
    let placed = read.reflect_x().scale_axes([1.0, 2.0, 0.5]).rotate_x(deg(35.0)).translate([3.0, 1.0, -2.0]);
    let report = placed.measure(1e-3).unwrap();
    assert!((report.volume - mesh.volume()).abs() <= report.volume_error, "{report:?}");
    let by_field = without_form(&placed).measure(5e-2).unwrap();
    assert!(by_field.volume_error < 2e-5 * report.volume, "{by_field:?}");
    assert_agree("placed", &report, &by_field);
    let ball = Solid::sphere(0.9).translate([-2.1, 0.2, 0.1]);
    let [both, common, rest] = [&read | &ball, &read & &ball, &ball - &read].map(|solid| solid.measure(5e-2).unwrap());
    let ball = 4.0 / 3.0 * std::f64::consts::PI * 0.729;
    let off = (both.volume + common.volume - mesh.volume() - ball).abs();
    assert!(off <= both.volume_error + common.volume_error, "{off} {both} {common}");
    let off = (rest.volume + common.volume - ball).abs();
    assert!(off <= rest.volume_error + common.volume_error, "{off} {rest} {common}");
}

/// What winding numbers above 1 enclose counts once: the sum of the triangles is no measure then.
#[test]
fn meshes_that_overlap_are_not_summed_up() {
    let settings = MeshSettings { cell: CellSize::LongestSide(3), ..MeshSettings::default() };
    let block = Solid::cuboid([2.0; 3]).mesh(&settings).unwrap();
    let within = Solid::cuboid([1.0; 3]).mesh(&settings).unwrap();
    let beside = Solid::cuboid([2.0; 3]).translate([1.1, 0.2, 0.1]).mesh(&settings).unwrap();
    let nested = Solid::from_mesh(&with(&block, &within), MeshSolid::default()).measure(0.2).unwrap();
    assert!(!nested.is_closed_form && (nested.volume - 8.0).abs() <= nested.volume_error, "{nested:?}");
    // However near one is to the other.
    let close = Solid::cuboid([1.9995; 3]).mesh(&settings).unwrap();
    let nested = Solid::from_mesh(&with(&block, &close), MeshSolid::default()).measure(0.2).unwrap();
    assert!(!nested.is_closed_form && (nested.volume - 8.0).abs() <= nested.volume_error, "{nested:?}");
    let across = Solid::from_mesh(&with(&block, &beside), MeshSolid::default()).measure(0.2).unwrap();
    let volume = 16.0 - 0.9 * 1.8 * 1.9;
    assert!(!across.is_closed_form && (across.volume - volume).abs() <= across.volume_error + 1e-5, "{across:?}");
    // A cavity is inside out, and nothing but a hole.
    let hollow = Solid::from_mesh(&with(&block, &within.flipped()), MeshSolid::default()).measure(1e-2).unwrap();
    assert!(hollow.is_closed_form && (hollow.volume - 7.0).abs() <= 1e-4, "{hollow:?}");
}

#[test]
fn empty_solids_solids_without_end_and_wrong_tolerances_are_told() {
    let nothing = Solid::sphere(1.0) & Solid::sphere(1.0).translate([3.0, 0.0, 0.0]);
    let report = nothing.measure(1e-3).unwrap();
    assert_eq!((report.volume, report.area, report.centroid, report.inertia), (0.0, 0.0, None, None));
    let error = Solid::half_space([0.0, 0.0, 1.0], 0.0).measure(1e-3).unwrap_err().to_string();
    assert!(error.contains("unbounded"), "{error}");
    for wrong in [0.0, -1.0, 2.0, f64::NAN] {
        let error = Solid::sphere(1.0).measure(wrong).unwrap_err().to_string();
        assert!(error.contains("tolerance") && error.contains("1e-9 to 1"), "{error}");
    }
    assert!(Solid::sphere(-1.0).measure(1e-3).unwrap_err().to_string().contains("radius"));
    // Bodies far from the origin, and tiny ones.
    let far = without_form(&Solid::cuboid([1.0, 2.0, 3.0]).translate([1e5, -2e5, 0.0])).measure(1e-3).unwrap();
    assert!((far.volume - 6.0).abs() <= far.volume_error && far.volume_error < 6.1e-3, "{far:?}");
    let tiny = without_form(&Solid::sphere(1e-5)).measure(1e-2).unwrap();
    assert!((tiny.volume / (4.0 / 3.0 * std::f64::consts::PI * 1e-15) - 1.0).abs() < 1e-2, "{tiny:?}");
}

#[test]
fn measuring_is_the_same_on_any_threads_and_can_be_cancelled() {
    let part = Solid::cuboid([4.0, 3.0, 2.0]) - Solid::sphere(1.2).translate([0.5, 0.3, 0.8]);
    let [one, two] = [1, 2].map(|threads| part.measure_with(3e-3, &Run { threads, ..Run::default() }).unwrap());
    assert_eq!(one, two);
    let cancel = CancelToken::new();
    let token = cancel.clone();
    let progress = Progress::new(move |fraction| {
        if fraction > 0.15 {
            token.cancel();
        }
    });
    let run = Run { cancel, progress: Some(progress), ..Run::default() };
    assert!(part.measure_with(1e-7, &run).unwrap_err().to_string().contains("cancelled"));
}

/// A sheet that no mesh shows has an area that nobody knows.
#[test]
fn areas_of_what_meshes_do_not_show_are_not_told() {
    let sheet = Solid::cuboid([1.0, 1.0, 0.0005]) - Solid::cylinder(0.2, 1.0);
    let report = sheet.measure(1e-2).unwrap();
    assert!(report.volume > 0.0, "{report:?}");
    let area = 2.0 * (1.0 - std::f64::consts::PI * 0.04);
    assert!((report.area - area).abs() <= report.area_error, "{report:?}");
    // Boxes that touch have nothing in common.
    let none = Solid::cuboid([1.0; 3]) & Solid::cuboid([1.0; 3]).translate([1.0, 0.0, 0.0]);
    assert_eq!(none.measure(1e-3).unwrap().volume, 0.0);
}

/// Flat faces are summed up to rounding, whatever tolerance is asked for: of joins with flush
/// faces, of copies, of polygons, turned and stretched.
#[test]
fn flat_faces_are_right_to_rounding() {
    let turned = |solid: &Solid| solid.rotate_x(deg(20.0)).rotate_z(deg(35.0)).translate([3.0, -1.0, 2.0]);
    let tooth = Solid::cuboid([1.7, 24.0, 1.5]);
    let teeth = (0..20).map(|n| tooth.translate([2.0 * f64::from(n), 0.0, 0.0]));
    let of_tooth = [1.7 * 24.0 * 1.5, 2.0 * (1.7 * 24.0 + 24.0 * 1.5 + 1.5 * 1.7)];
    let block = Solid::cuboid([4.0, 3.0, 2.0]);
    let beside = block.translate([4.0, 0.0, 0.0]);
    let u = [[-8.0, -6.0], [8.0, -6.0], [8.0, 6.0], [1.0, 6.0], [1.0, -2.0], [-1.0, -2.0], [-1.0, 6.0], [-8.0, 6.0]];
    let slots = Solid::cuboid([0.3, 20.0, 3.0]).repeat_centered([11, 1, 1], [2.0, 1.0, 1.0]);
    let plate = Solid::cuboid([24.0, 24.0, 1.5]);
    let bodies = [
        ("comb", Solid::union_all(teeth, RFunction::MIN_MAX), of_tooth.map(|x| 20.0 * x)),
        ("copies", tooth.repeat([12, 1, 1], [2.0, 1.0, 1.0]), of_tooth.map(|x| 12.0 * x)),
        ("side by side", &block | &beside, [48.0, 2.0 * (24.0 + 6.0 + 16.0)]),
        ("flush cut", (&block | &beside) - &beside, [24.0, 52.0]),
        ("slots", &plate - &slots, [864.0 - 99.0, 1152.0 + 144.0 - 2.0 * 66.0 + 11.0 * 1.5 * 40.6]),
        ("notch", Profile::polygon(u).extrude(1.5), [264.0, 352.0 + 1.5 * (32.0 + 24.0 + 16.0)]),
    ];
    for (name, body, [volume, area]) in &bodies {
        for body in [body.clone(), turned(body)] {
            let report = body.measure(0.5).unwrap();
            assert!((report.volume - volume).abs() <= report.volume_error, "{name}: {report:?} {volume}");
            assert!((report.area - area).abs() <= report.area_error + 1e-9, "{name}: {report:?} {area}");
            assert!(report.volume_error < 1e-8 * volume && report.area_error < 1e-8 * area, "{name}: {report:?}");
        }
        let stretched = turned(body).scale_axes([1.0, 2.0, 0.5]).measure(0.5).unwrap();
        assert!((stretched.volume - volume).abs() < 1e-8 * volume, "{name}: {stretched:?}");
    }
    // Boxes that touch have nothing in common, and no skin.
    let none = turned(&(&block & &beside)).measure(1e-3).unwrap();
    assert!(none.volume < 1e-9 && none.area < 1e-6, "{none:?}");
}

/// Bodies with flat faces that lie across each other anyhow, flush ones among them: their measures
/// are those of sharp meshes.
#[test]
fn random_joins_of_flat_faces_agree_with_meshes() {
    let mut random = Random::new(371);
    for n in 0..24 {
        let mut part = || {
            let size = DVec3::new(random.range(0.3, 2.0), random.range(0.3, 2.0), random.range(0.3, 2.0));
            let leaf = match random.below(4) {
                0 => Solid::prism(5, 0.6 * size.x, size.z),
                1 => Solid::wedge(size),
                2 => Solid::pyramid(3, 0.8 * size.x, size.y),
                _ => Solid::cuboid(size),
            };
            // Steps of a half leave many faces flush.
            let at = (2.0 * random.vector(-1.0, 1.0)).round() / 2.0;
            let turned = leaf.rotate_z(deg(random.range(0.0, 90.0)));
            if random.below(2) == 0 { leaf.translate(at) } else { turned.rotate_x(deg(30.0)).translate(at) }
        };
        let mut body = part();
        for k in 0..2 + n % 4 {
            let other = part();
            body = match (n + k) % 3 {
                0 => body - other,
                1 => body | other,
                _ => body.union(&other, RFunction::P(2.0)),
            };
        }
        let mesh = body.mesh(&MeshSettings { cell: CellSize::LongestSide(96), ..MeshSettings::default() }).unwrap();
        let (told, checked) = (body.measure(0.2).unwrap(), mesh.check());
        println!(
            "{n}: {} by {:e}, {}; {}, {}",
            told.volume, told.volume_error, checked.volume, told.area, checked.area
        );
        let near = |a: f64, b: f64, part: f64| (a - b).abs() <= part * b;
        assert!(told.volume_error < 1e-6 * told.volume, "{n}: {body:?} {told:?}");
        assert!(near(told.volume, checked.volume, 1e-3), "{n}: {body:?} {told:?}");
        assert!(near(told.area, checked.area, 5e-3), "{n}: {body:?} {told:?}");
    }
}
