//! How tight boxes are, for every map over leaves of every kind: no box may become loose again.

use glam::{DQuat, DVec3};
use rvachev::{
    Caps, CellSize, Extrusion, Gielis, Helix, MeshSettings, Profile, Run, Solid, SolidError, Supershape,
    law::{LinearLaw, SineWave},
    rad,
};

/// The width of the solid's box over that of its mesh, along the axis where it is largest.
fn looseness(solid: &Solid, cells: u32) -> f64 {
    let settings = MeshSettings { cell: CellSize::LongestSide(cells), ..MeshSettings::default() };
    let mesh = solid.mesh_with(&settings, &Run::default()).expect("the solid has a mesh");
    let (told, found) = (solid.bounds().expect("the solid is valid"), mesh.bounds());
    // Vertices may be off by a thousandth of a cell.
    let slack = 1e-4 * told.longest_side();
    assert!((found.min + slack).cmpge(told.min).all() && (found.max - slack).cmple(told.max).all());
    (told.size() / found.size()).max_element()
}

fn leaves() -> Vec<(&'static str, Solid)> {
    let supershape = Supershape::new(Gielis::new(7.0, 9.0, 8.0, 8.0), Gielis::new(4.0, 30.0, 30.0, 30.0));
    let section = Profile::polygon([[-0.5, -0.3], [0.6, -0.4], [0.3, 0.5], [-0.4, 0.4]]);
    let with = |caps| Extrusion { caps, ..Extrusion::new(1.2) };
    vec![
        ("sphere", Solid::sphere(0.8)),
        ("cuboid", Solid::cuboid([0.9, 0.6, 1.6])),
        ("rounded_cuboid", Solid::rounded_cuboid([0.9, 0.6, 1.6], 0.2)),
        ("cylinder", Solid::cylinder(0.5, 1.6)),
        ("cone", Solid::cone(0.6, 0.2, 1.4)),
        ("capsule", Solid::capsule(0.4, 1.8)),
        ("torus", Solid::torus(0.6, 0.2)),
        ("ellipsoid", Solid::ellipsoid([0.8, 0.5, 0.7])),
        ("prism", Solid::prism(5, 0.5, 1.4)),
        ("pyramid", Solid::pyramid(4, 0.6, 1.4)),
        ("wedge", Solid::wedge([0.8, 0.6, 1.2])),
        ("superellipsoid", Solid::superellipsoid([0.7, 0.5, 0.8], 0.4, 0.6)),
        ("supertoroid", Solid::supertoroid([0.3, 0.3, 0.3], 2.0, 0.5, 0.7)),
        ("supershape", supershape.scaled([0.6, 0.6, 0.9]).into()),
        ("extrusion", section.extrude(1.2)),
        ("rounded extrusion", section.extrude_with(&with(Caps::Rounded(0.1)))),
        ("chamfered extrusion", section.extrude_with(&with(Caps::Chamfered(0.1)))),
        ("revolution", section.translate([0.7, 0.0]).revolve()),
        ("helix", section.scale(0.3).sweep_helix(&Helix::new(0.6, 0.5, 2.0))),
    ]
}

type Map = (&'static str, [f64; 2], fn(&Solid) -> Solid);

/// Each with the most that a box may be wider than the solid: of leaves, and of those that are hard
/// to bound, supershapes, whose own box is turned, and helices, which are bounded as if they went
/// all round.
fn maps() -> Vec<Map> {
    vec![
        ("translate", [1.005, 1.01], |s| s.translate([0.3, -0.2, 0.7])),
        ("rotate", [1.01, 1.4], |s| s.rotate(DQuat::from_axis_angle(DVec3::new(0.36, 0.48, 0.8), 0.9))),
        ("scale_axes", [1.005, 1.01], |s| s.scale_axes([1.3, 0.8, 0.6])),
        ("mirrored", [1.01, 1.06], |s| s.translate([1.5, 0.1, 0.0]).mirrored([0.8, 0.6, 0.0], 0.1)),
        ("twist", [1.008, 1.08], |s| s.twist(rad(0.7))),
        ("twist aside", [1.01, 1.2], |s| s.translate([0.8, 0.1, 0.2]).twist(rad(-0.9))),
        ("twist_by", [1.015, 1.2], |s| {
            s.twist_by(rad(1.0), SineWave { mean: 0.2, amplitude: 0.5, wavelength: 2.0, phase: rad(0.3) })
        }),
        ("taper", [1.06, 1.2], |s| s.taper(0.4, -0.3, 2.0)),
        ("taper_by", [1.05, 1.1], |s| {
            s.taper_by(
                LinearLaw { at_zero: 1.0, slope: 0.2 },
                SineWave { mean: 1.0, amplitude: 0.3, wavelength: 1.5, phase: rad(0.3) },
            )
        }),
        ("bend", [1.01, 1.8], |s| s.bend(0.5, rad(0.6))),
        ("bend aside", [1.015, 1.35], |s| s.rotate_y(rad(0.5)).bend(-0.4, rad(0.2))),
        ("elongate", [1.005, 1.01], |s| s.elongate([0.5, 0.0, 0.8])),
        ("elongate, rotated", [1.02, 1.4], |s| s.elongate([0.5, 0.0, 0.8]).rotate_x(rad(0.6)).rotate_z(rad(0.4))),
        ("repeat", [1.01, 1.01], |s| s.repeat([3, 2, 1], [2.5, 2.2, 1.0])),
        ("repeat, rotated", [1.035, 1.2], |s| {
            s.repeat([2, 2, 2], [2.5, 2.2, 2.4]).rotate_x(rad(0.6)).rotate_z(rad(0.4))
        }),
        ("repeat_polar", [1.01, 1.08], |s| s.rotate_z(rad(0.4)).translate([2.0, 0.3, 0.0]).repeat_polar(7)),
        ("twist, rotated", [1.015, 1.65], |s| s.twist(rad(0.7)).rotate_x(rad(0.6)).rotate_z(rad(0.4))),
        ("twist, bend", [1.04, 1.7], |s| s.twist(rad(0.7)).rotate_y(rad(0.3)).bend(0.3, rad(0.4))),
        ("taper, twist, difference", [1.25, 1.55], |s| s.taper(0.3, 0.3, 2.0).twist(rad(0.5)) - s.scale(0.5)),
    ]
}

#[test]
fn boxes_behind_maps_are_tight() {
    let mut loose = Vec::new();
    for (map, most, make) in maps() {
        for (leaf, solid) in leaves() {
            let most = most[usize::from(["supershape", "helix"].contains(&leaf))];
            let found = looseness(&make(&solid), 40);
            if found > most {
                loose.push(format!("{map} of {leaf}: {found:.4}, allowed {most}"));
            }
        }
    }
    assert!(loose.is_empty(), "{}", loose.join("\n"));
}

#[test]
fn boxes_of_parts_that_were_loose() -> Result<(), SolidError> {
    let near = |solid: &Solid, size: [f64; 3]| {
        let found = solid.bounds().expect("the solid is valid").size();
        let by = (found / DVec3::from_array(size) - 1.0).to_array();
        assert!(by.iter().all(|by| (-1e-9..0.01).contains(by)), "{found}, right {size:?}");
    };
    near(&Solid::cylinder(36.0, 180.0).twist(rad(0.0067)), [72.0, 72.0, 180.0]);
    // The radius about the axis is that of the cuboid's corners.
    let reach = 5f64.sqrt() * 2.0;
    near(&Solid::cuboid([4.0, 2.0, 40.0]).twist(rad(0.5)), [reach, reach, 40.0]);
    let shape = Supershape::new(Gielis::new(7.0, 9.0, 8.0, 8.0), Gielis::new(4.0, 30.0, 30.0, 30.0));
    let vase = Solid::from(shape.scaled([34.0, 34.0, 60.0])).twist(rad(0.0087));
    let plain = vase.bounds()?;
    assert!(plain.max.x < 53.0, "{plain:?}");
    Ok(())
}

#[test]
fn nothing_is_outside_of_boxes_that_were_moved_in() {
    let mut random = crate::support::Random::new(31);
    for (map, _, make) in maps() {
        for (leaf, solid) in leaves() {
            let solid = make(&solid);
            let bounds = solid.bounds().expect("the solid is valid");
            let program = solid.field_program().expect("the solid is valid");
            for _ in 0..2000 {
                let by = random.log_range(1e-4, 0.3) * bounds.longest_side();
                let p = random.point_in(&bounds.inflate(by));
                assert!(bounds.contains(p) || program.value(p) <= 0.0, "{map} of {leaf}: {p} is outside of {bounds:?}");
            }
        }
    }
}

#[test]
fn boxes_far_from_the_origin_are_not_lost() {
    let twisted = Solid::cuboid([1.0; 3]).twist(rvachev::rad(0.1));
    let far = twisted.translate([9e8, 0.0, 0.0]).translate([9e8, 0.0, 0.0]);
    let bounds = far.bounds().unwrap();
    assert!(!bounds.is_empty() && bounds.contains(glam::DVec3::new(1.8e9, 0.0, 0.0)), "{bounds:?}");
    let across = Solid::cuboid([1e9, 1e3, 1e3]).twist(rvachev::rad(1e-9)).translate([7e8, 0.0, 0.0]);
    assert!(across.bounds().unwrap().max.x > 1.19e9, "{:?}", across.bounds());
}
