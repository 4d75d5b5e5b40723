//! The thickness of solids, against closed forms.

use glam::{DVec3, Vec3};
use rvachev::{Bounds, CellSize, Mesh, MeshSettings, MeshSolid, Run, Solid, ThicknessReport, deg};

fn thickness(solid: &Solid, cells: u32) -> ThicknessReport {
    let settings = MeshSettings { cell: CellSize::LongestSide(cells), ..MeshSettings::default() };
    solid.thickness(&settings, &Run::default()).unwrap()
}

/// Of the surface's area this much is within a hundredth of a thickness.
fn share_near(report: &ThicknessReport, thickness: f64) -> f64 {
    report.share_below(1.01 * thickness).unwrap() - report.share_below(0.99 * thickness).unwrap()
}

#[test]
fn tubes_and_shells_are_as_thick_as_their_walls() {
    let tube = thickness(&(Solid::cylinder(5.0, 12.0) - Solid::cylinder(4.0, 13.0)), 32);
    assert!((tube.least - 1.0).abs() < 0.01, "{tube}");
    let walls = 2.0 * 9.0 * 12.0;
    let ends = 2.0 * 9.0;
    assert!((share_near(&tube, 1.0) - walls / (walls + ends)).abs() < 0.03, "{}", share_near(&tube, 1.0));
    let shell = thickness(&(Solid::sphere(5.0) - Solid::sphere(4.5)), 40);
    assert!((shell.least - 0.5).abs() < 0.005 && share_near(&shell, 0.5) > 0.99, "{shell}");
    let ball = thickness(&Solid::sphere(2.0), 24);
    assert!((ball.least - 4.0).abs() < 0.04 && share_near(&ball, 4.0) > 0.99, "{ball}");
}

#[test]
fn a_drafted_rib_is_thinnest_at_its_top() {
    // 1.2 wide at the foot and 0.6 at the top.
    let side = |sign: f64| {
        let normal = DVec3::new(sign, 0.0, 0.075);
        Solid::half_space(normal.normalize(), 0.675 / normal.length())
    };
    let rib = Solid::cuboid([1.2, 10.0, 4.0]).translate([0.0, 0.0, 3.0]) & side(1.0) & side(-1.0);
    let part = Solid::cuboid([20.0, 12.0, 2.0]) | rib;
    let report = thickness(&part, 64);
    assert!((report.least - 0.6).abs() < 0.06, "{report}");
    assert!(report.at.z > 4.0 && report.at.x.abs() < 0.4, "{report}");
    assert!((share_near(&report, 2.0) - 0.8).abs() < 0.15, "{}", share_near(&report, 2.0));
}

#[test]
fn facets_that_cut_corners_off_are_no_walls() {
    let plate = Solid::cuboid([60.0, 40.0, 3.0]);
    let bracket = &plate | Solid::cuboid([3.0, 40.0, 30.0]).translate([-28.5, 0.0, 15.0]);
    for solid in
        [bracket.rotate_z(deg(33.0)).rotate_x(deg(21.0)), bracket.rotate_z(deg(30.0)), plate.rotate_x(deg(21.0))]
    {
        for cells in [32, 48, 64] {
            let report = thickness(&solid, cells);
            assert!((report.least - 3.0).abs() < 0.03, "{cells}: {report}");
        }
    }
}

#[test]
fn joints_are_no_walls() {
    let half = Solid::cuboid([2.0, 3.0, 4.0]);
    let pair = thickness(&(&half | half.translate([2.0, 0.0, 0.0])), 32);
    assert!((pair.least - 3.0).abs() < 0.01, "{pair}");
    let sum: f64 = 2.0 * (12.0 + 16.0 + 12.0);
    let bins = pair.histogram(4);
    assert_eq!(bins.len(), 4);
    assert!(bins[..2].iter().all(|bin| bin.area == 0.0) && (bins[3].to - 4.0).abs() < 0.02, "{bins:?}");
    assert!((bins.iter().map(|bin| bin.area).sum::<f64>() - sum).abs() < 0.02 * sum, "{bins:?}");
}

#[test]
fn reports_are_shown_as_text_and_as_colours() {
    let report = thickness(&Solid::cuboid([4.0, 4.0, 1.0]), 24);
    assert!((report.least - 1.0).abs() < 5e-3, "{report}");
    assert!(report.to_string().starts_with("least thickness "), "{report}");
    let mesh = report.colored(0.5, 2.0).unwrap();
    let colors = mesh.corner_colors().unwrap();
    assert_eq!(colors.len(), report.thicknesses().len());
    let flat = (0..colors.len()).filter(|t| (report.thicknesses()[*t] - 1.0).abs() < 0.01);
    assert!(flat.clone().count() > 100 && flat.into_iter().all(|t| colors[t][0][0] > 100 && colors[t][0][2] == 0));
    // Whatever is asked for.
    assert_eq!(report.share_below(f64::NAN).unwrap_err().to_string(), "limit is NaN, allowed: any number");
    assert_eq!((report.share_below(f64::INFINITY), report.share_below(-1.0)), (Ok(1.0), Ok(0.0)));
    let wrong = |thin: f64, thick: f64| report.colored(thin, thick).unwrap_err().to_string();
    assert_eq!(wrong(f64::NAN, 1.0), "thin is NaN, allowed: finite");
    assert_eq!(wrong(1.0, f64::INFINITY), "thick is inf, allowed: finite");
    assert_eq!(wrong(1.0, 1.0), "thick is 1, allowed: above 1, which is thin");
    assert_eq!(report.histogram(usize::MAX).len(), 1_000_000);
    let mut other = report.clone();
    other.mesh = Mesh::default();
    assert!(other.colored(0.5, 2.0).unwrap().triangles().is_empty());
    let nothing = thickness(&(Solid::sphere(1.0) & Solid::sphere(1.0).translate([5.0, 0.0, 0.0])), 8);
    assert_eq!((nothing.least, nothing.share_below(1.0).unwrap()), (f64::INFINITY, 0.0));
    assert_eq!(nothing.to_string(), "no part of the surface faces another");
}

#[test]
fn walls_of_meshes_are_seen_however_thin_they_are() {
    let read = |solid: &Solid, cell: f64| {
        let mesh = solid.mesh(&MeshSettings { cell: CellSize::Length(cell), ..MeshSettings::default() }).unwrap();
        (Solid::from_mesh(&mesh, MeshSolid::default()), mesh.area())
    };
    // A fin that passes between the nodes of 32 cells, and a foil.
    let fin = Solid::cuboid([2.0, 2.0, 2.0]) | Solid::cuboid([0.03, 0.8, 0.8]).translate([0.0, 0.0, 1.3]);
    let foil = Solid::cuboid([2.0, 2.0, 0.02]);
    for (solid, cell, least) in [(fin, 0.02, 0.03), (foil, 0.016, 0.02)] {
        let (read, area) = read(&solid, cell);
        for part in [read.clone(), read.rotate_x(deg(30.0)).reflect_y().translate([50.0, 0.0, 0.0])] {
            let report = thickness(&part, 32);
            assert!((report.least - least).abs() < 0.01 * least, "{report}");
            assert!(part.value(report.at).unwrap().abs() < 1e-5, "{report}");
            let mesh = &report.mesh;
            assert!(mesh.check().is_closed() && mesh.volume() > 0.0);
            assert!((mesh.area() / area - 1.0).abs() < 1e-3);
            assert_eq!(mesh.triangles().len(), report.thicknesses().len());
            let longest = part.bounds().unwrap().longest_side();
            let side = |t: &[u32; 3]| {
                let [a, b] = [0, 1].map(|k| mesh.positions()[t[k] as usize]);
                f64::from(a.distance(b))
            };
            assert!(mesh.triangles().iter().all(|t| side(t) < 1.01 * longest / 32.0));
        }
        // In a box it is the mesh of what is in the box.
        let half = Bounds::new(DVec3::splat(-3.0), DVec3::new(0.5, 3.0, 3.0));
        let settings = MeshSettings { cell: CellSize::Length(0.05), bounds: Some(half), ..MeshSettings::default() };
        let report = read.thickness(&settings, &Run::default()).unwrap();
        assert!(report.mesh.bounds().is_empty() || report.mesh.bounds().max.x < 0.51);
    }
}

#[test]
fn slivers_of_a_mesh_are_no_walls() {
    // A box with a vertex all but on an edge, so that a triangle of its top has no width to speak
    // of, and looks anywhere.
    let corner = |k: u32| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { 1.0 } else { -1.0 });
    let corners: Vec<Vec3> = (0..8).map(|k| Vec3::from_array(corner(k))).collect();
    let quads = [[0, 2, 3, 1], [0, 1, 5, 4], [1, 3, 7, 5], [2, 6, 7, 3], [0, 4, 6, 2]];
    let mut triangles: Vec<[u32; 3]> = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    triangles.extend([[4, 5, 8], [5, 7, 8], [7, 6, 8], [6, 4, 8]]);
    let one = 1.0f32;
    for [y, z] in [[one.next_down(), one], [one.next_up(), one], [one.next_down(), one.next_down()], [one, one + 3e-7]]
    {
        let positions = [&corners[..], &[Vec3::new(0.1, y, z)]].concat();
        let mesh = Mesh::new(positions, triangles.clone()).unwrap();
        assert!(mesh.check().is_closed());
        let report = thickness(&Solid::from_mesh(&mesh, MeshSolid::default()), 16);
        assert!((report.least - 2.0).abs() < 0.01, "{y} {z}: {report}");
    }
}
