//! Every number that a constructor or verb takes, given what it ought not to be: an error names
//! the node and the parameter, and nothing panics or is NaN.

use std::panic::catch_unwind;

use glam::{DAffine2, DAffine3, DMat2, DQuat, DVec3};
use rvachev::{
    Blend, Bounds, Caps, Extrusion, GeneralisedSuperquadric, Gielis, Helix, MinimalSurface, NetworkLattice, Polygon,
    Prism, Profile, RFunction, RegularPolygon, SheetLattice, Solid, Superhyperboloid, Supershape, Supertoroid, deg,
    law::{LawTable, LinearLaw, SineWave, SmoothStep},
    rad,
};

/// A solid by one of its numbers.
type Make = fn(f64) -> Solid;

fn ball() -> Solid {
    Solid::sphere(1.0)
}

fn block() -> Solid {
    Solid::cuboid(DVec3::new(1.0, 2.0, 0.5))
}

fn disc() -> Profile {
    Profile::circle(0.5)
}

/// What is made, what the error's path must hold, what its parameter must hold.
fn table() -> Vec<(&'static str, &'static str, Make)> {
    let mut all: Vec<(&'static str, &'static str, Make)> = Vec::new();
    all.extend(leaves());
    all.extend(profiles());
    all.extend(verbs());
    all
}

fn leaves() -> Vec<(&'static str, &'static str, Make)> {
    vec![
        ("sphere", "radius", |v| Solid::sphere(v)),
        ("box", "size.x", |v| Solid::cuboid([v, 1.0, 1.0])),
        ("box", "size.y", |v| Solid::cuboid([1.0, v, 1.0])),
        ("box", "size.z", |v| Solid::cuboid([1.0, 1.0, v])),
        ("cylinder", "radius", |v| Solid::cylinder(v, 1.0)),
        ("cylinder", "height", |v| Solid::cylinder(1.0, v)),
        ("half-space", "normal", |v| Solid::half_space([v, 0.0, 0.0], 1.0)),
        ("half-space", "offset", |v| Solid::half_space(DVec3::X, v)),
        ("rounded box", "size.y", |v| Solid::rounded_cuboid([1.0, v, 1.0], 0.1)),
        ("rounded box", "radius", |v| Solid::rounded_cuboid(DVec3::ONE, v)),
        ("cone", "bottom_radius", |v| Solid::cone(v, 1.0, 1.0)),
        ("cone", "top_radius", |v| Solid::cone(1.0, v, 1.0)),
        ("cone", "height", |v| Solid::cone(1.0, 0.5, v)),
        ("capsule", "radius", |v| Solid::capsule(v, 3.0)),
        ("capsule", "height", |v| Solid::capsule(1.0, v)),
        ("torus", "radius", |v| Solid::torus(v, 0.2)),
        ("torus", "tube", |v| Solid::torus(1.0, v)),
        ("ellipsoid", "semi_axes.z", |v| Solid::ellipsoid([1.0, 1.0, v])),
        ("prism", "radius", |v| Solid::prism(5, v, 1.0)),
        ("prism", "height", |v| Solid::prism(5, 1.0, v)),
        ("prism", "sides", |v| Solid::prism(if v > 0.0 && v < 1e9 { 5 } else { 2 }, 1.0, 1.0)),
        ("prism", "radius", |v| Prism::across_flats(6, v, 1.0).into()),
        ("pyramid", "radius", |v| Solid::pyramid(5, v, 1.0)),
        ("pyramid", "height", |v| Solid::pyramid(5, 1.0, v)),
        ("pyramid", "sides", |v| Solid::pyramid(if v > 0.0 && v < 1e9 { 5 } else { u32::MAX }, 1.0, 1.0)),
        ("wedge", "size.x", |v| Solid::wedge([v, 1.0, 1.0])),
        ("slab", "normal", |v| Solid::slab([0.0, v, 0.0], 1.0)),
        ("slab", "thickness", |v| Solid::slab(DVec3::X, v)),
        ("superellipsoid", "semi_axes.x", |v| Solid::superellipsoid([v, 1.0, 1.0], 1.0, 1.0)),
        ("superellipsoid", "e1", |v| Solid::superellipsoid(DVec3::ONE, v, 1.0)),
        ("superellipsoid", "e2", |v| Solid::superellipsoid(DVec3::ONE, 1.0, v)),
        ("supertoroid", "semi_axes.y", |v| Solid::supertoroid([1.0, v, 1.0], 2.0, 1.0, 1.0)),
        ("supertoroid", "ring", |v| Solid::supertoroid(DVec3::ONE, v, 1.0, 1.0)),
        ("supertoroid", "e1", |v| Supertoroid::new(DVec3::ONE, 2.0, v, 1.0).into()),
        ("supertoroid", "e2", |v| Supertoroid::new(DVec3::ONE, 2.0, 1.0, v).into()),
        ("superhyperboloid", "semi_axes.x", |v| Superhyperboloid::one_sheet([v, 1.0, 1.0], 1.0, 1.0, 2.0).into()),
        ("superhyperboloid", "e1", |v| Superhyperboloid::one_sheet(DVec3::ONE, v, 1.0, 2.0).into()),
        ("superhyperboloid", "e2", |v| Superhyperboloid::one_sheet_x(DVec3::ONE, 1.0, v, 2.0).into()),
        ("superhyperboloid", "length", |v| Superhyperboloid::one_sheet(DVec3::ONE, 1.0, 1.0, v).into()),
        ("superhyperboloid", "length", |v| Superhyperboloid::two_sheets(DVec3::ONE, 1.0, 1.0, v).into()),
        ("superhyperboloid", "length", |v| Superhyperboloid::two_sheets_x(DVec3::ONE, 1.0, 1.0, v).into()),
        ("generalised superquadric", "semi_axes.x", |v| GeneralisedSuperquadric::new([v, 1.0, 1.0], [2.0; 3]).into()),
        ("generalised superquadric", "exponents", |v| GeneralisedSuperquadric::new(DVec3::ONE, [2.0, v, 2.0]).into()),
        ("supershape", "equator.m", |v| Supershape::new(Gielis::new(v, 3.0, 3.0, 3.0), Gielis::circle()).into()),
        ("supershape", "equator.n1", |v| Supershape::new(Gielis::new(5.0, v, 3.0, 3.0), Gielis::circle()).into()),
        ("supershape", "meridian.n2", |v| Supershape::new(Gielis::circle(), Gielis::new(5.0, 3.0, v, 3.0)).into()),
        ("supershape", "scale.x", |v| Supershape::new(Gielis::circle(), Gielis::circle()).scaled([v, 1.0, 1.0]).into()),
        ("sheet lattice", "cell", |v| SheetLattice { surface: MinimalSurface::Gyroid, cell: v, thickness: 0.1 }.into()),
        ("sheet lattice", "thickness", |v| {
            SheetLattice { surface: MinimalSurface::Gyroid, cell: 1.0, thickness: v }.into()
        }),
        ("network lattice", "cell", |v| {
            NetworkLattice { surface: MinimalSurface::Gyroid, cell: v, fraction: 0.4 }.into()
        }),
        ("network lattice", "fraction", |v| {
            NetworkLattice { surface: MinimalSurface::Gyroid, cell: 1.0, fraction: v }.into()
        }),
        #[cfg(feature = "formula")]
        ("formula", "bounds.min.y", |v| {
            Solid::formula(
                &fidget::context::Tree::x(),
                Bounds { min: DVec3::new(-1.0, v, -1.0), max: DVec3::splat(9e8) },
            )
        }),
        #[cfg(feature = "formula")]
        ("formula", "bounds.max.z", |v| {
            Solid::formula(
                &fidget::context::Tree::x(),
                Bounds { min: DVec3::splat(-9e8), max: DVec3::new(1.0, 1.0, v) },
            )
        }),
        ("supershape", "equator.a", |v| {
            Supershape::new(Gielis { a: v, ..Gielis::new(5.0, 3.0, 3.0, 3.0) }, Gielis::circle()).into()
        }),
        ("supershape", "equator.n3", |v| Supershape::new(Gielis::new(5.0, 3.0, 3.0, v), Gielis::circle()).into()),
        ("supershape", "meridian.n1", |v| Supershape::new(Gielis::circle(), Gielis::new(5.0, v, 3.0, 3.0)).into()),
        ("generalised superquadric", "semi_axes.z", |v| GeneralisedSuperquadric::new([1.0, 1.0, v], [3.0; 3]).into()),
        ("supertoroid", "semi_axes.z", |v| Supertoroid::new([1.0, 1.0, v], 2.0, 0.5, 1.0).into()),
    ]
}

fn profiles() -> Vec<(&'static str, &'static str, Make)> {
    vec![
        ("circle", "radius", |v| Profile::circle(v).extrude(1.0)),
        ("superellipse", "semi_axes.x", |v| Profile::superellipse([v, 1.0], 1.0).extrude(1.0)),
        ("superellipse", "exponent", |v| Profile::superellipse([1.0, 1.0], v).extrude(1.0)),
        ("superpolygon", "radius", |v| Profile::superpolygon(Gielis::polygon(5, 10.0), v).extrude(1.0)),
        ("superpolygon", "curve.n1", |v| Profile::superpolygon(Gielis::new(5.0, v, 3.0, 3.0), 1.0).extrude(1.0)),
        ("superpolygon", "curve.m", |v| Profile::superpolygon(Gielis::new(v, 3.0, 3.0, 3.0), 1.0).extrude(1.0)),
        ("rectangle", "size.y", |v| Profile::rectangle([1.0, v]).extrude(1.0)),
        ("rectangle", "radius", |v| Profile::rounded_rectangle([1.0, 1.0], v).extrude(1.0)),
        ("polygon", "radius", |v| Profile::regular_polygon(5, v).extrude(1.0)),
        ("polygon", "radius", |v| Profile::from(RegularPolygon::across_flats(6, v)).extrude(1.0)),
        ("polygon", "1", |v| Profile::polygon([[0.0, 0.0], [v, 0.0], [0.0, 1.0]]).extrude(1.0)),
        ("polygon", "2", |v| Polygon::new([[[0.0, 0.0], [1.0, 0.0], [0.3, v]]]).extrude_(1.0)),
        ("extrude", "height", |v| disc().extrude(v)),
        ("extrude", "twist", |v| disc().extrude_with(&Extrusion { twist: rad(v), ..Extrusion::new(1.0) })),
        ("extrude", "scale", |v| disc().extrude_with(&Extrusion { scale: v, ..Extrusion::new(1.0) })),
        ("extrude", "caps", |v| disc().extrude_with(&Extrusion { caps: Caps::Rounded(v), ..Extrusion::new(1.0) })),
        ("extrude", "caps", |v| disc().extrude_with(&Extrusion { caps: Caps::Chamfered(v), ..Extrusion::new(1.0) })),
        ("revolve_by", "angle", |v| disc().revolve_by(rad(v))),
        ("sweep_helix", "radius", |v| disc().sweep_helix(&Helix::new(v, 1.5, 2.0))),
        ("sweep_helix", "pitch", |v| disc().sweep_helix(&Helix::new(2.0, v, 2.0))),
        ("sweep_helix", "turns", |v| disc().sweep_helix(&Helix::new(2.0, 1.5, v))),
        ("sweep_helix", "ends", |v| disc().sweep_helix(&Helix { ends: Caps::Rounded(v), ..Helix::new(2.0, 1.5, 2.0) })),
        ("offset", "distance", |v| disc().offset(v).extrude(1.0)),
        ("translate", "translation.x", |v| disc().translate([v, 0.0]).extrude(1.0)),
        ("rotate", "", |v| disc().rotate(rad(v)).extrude(1.0)),
        ("scale", "", |v| disc().scale(v).extrude(1.0)),
        ("scale_axes", "", |v| disc().scale_axes([1.0, v]).extrude(1.0)),
        ("reflect", "", |v| disc().reflect([v, 0.0], 0.0).extrude(1.0)),
        ("affine", "", |v| disc().affine(DAffine2::from_mat2(DMat2::from_diagonal([v, 1.0].into()))).extrude(1.0)),
        ("union", "alpha", |v| disc().union(disc(), RFunction::Alpha(v)).extrude(1.0)),
        ("difference", "p", |v| disc().difference(disc(), RFunction::P(v)).extrude(1.0)),
        #[cfg(feature = "formula")]
        ("formula", "bounds.min.x", |v| {
            let bounds = rvachev::PlaneBounds { min: [v, -1.0].into(), max: [9e8; 2].into() };
            Profile::formula(&fidget::context::Tree::x(), bounds).extrude(1.0)
        }),
        ("circle", "radius", |v| Profile::circle(v).revolve()),
        ("circle", "radius", |v| Profile::circle(v).column()),
        ("circle", "radius", |v| Profile::circle(v).sweep_helix(&Helix::new(2.0, 1.5, 2.0))),
        ("superellipse", "semi_axes.y", |v| Profile::superellipse([1.0, v], 1.0).revolve_by(rad(1.0))),
        ("superpolygon", "curve.n2", |v| Profile::superpolygon(Gielis::new(5.0, 3.0, v, 3.0), 1.0).column()),
        ("sweep_helix", "ends", |v| {
            disc().sweep_helix(&Helix { ends: Caps::Chamfered(v), ..Helix::new(2.0, 1.5, 2.0) })
        }),
    ]
}

/// A leaf that is swept at once.
trait Swept {
    fn extrude_(self, height: f64) -> Solid;
}

impl Swept for Polygon {
    fn extrude_(self, height: f64) -> Solid {
        Profile::from(self).extrude(height)
    }
}

fn verbs() -> [(&'static str, &'static str, Make); 62] {
    [
        ("union", "alpha", |v| ball().union(block(), RFunction::Alpha(v))),
        ("union", "p", |v| ball().union(block(), RFunction::P(v))),
        ("intersection", "p", |v| ball().intersection(block(), RFunction::Associative(v))),
        ("symmetric difference", "alpha", |v| ball().symmetric_difference(block(), RFunction::Alpha(v))),
        ("smooth union", "radius", |v| ball().smooth_union(block(), v)),
        ("smooth intersection", "radius", |v| ball().smooth_intersection(block(), v)),
        ("smooth difference", "radius", |v| ball().smooth_difference(block(), v)),
        ("with_tolerance", "tolerance", |v| block().offset(0.1).with_tolerance(v)),
        ("with_tolerance", "tolerance", |v| {
            disc()
                .union_with(Profile::rectangle([2.0, 0.2]), Blend::Fillet { radius: 0.1 })
                .with_tolerance(v)
                .extrude(1.0)
        }),
        ("filleted union", "radius", |v| ball().union_with(block(), Blend::Fillet { radius: v })),
        ("chamfered difference", "leg", |v| ball().difference_with(block(), Blend::Chamfer { leg: v })),
        ("displaced union", "height", |v| {
            ball().union_with(block(), Blend::Displacement { height: v, falloff: [1.0, 1.0] })
        }),
        ("displaced union", "falloff[0]", |v| {
            ball().union_with(block(), Blend::Displacement { height: 0.1, falloff: [v, 1.0] })
        }),
        ("displaced union", "falloff[1]", |v| {
            ball().union_with(block(), Blend::Displacement { height: 0.1, falloff: [1.0, v] })
        }),
        ("Ricci union", "p", |v| ball().union_with(ball().translate(DVec3::X), Blend::Ricci { p: v })),
        ("level", "value", |v| ball().level(v)),
        ("offset", "distance", |v| block().offset(v)),
        ("offset", "distance", |v| Solid::superellipsoid(DVec3::ONE, 0.3, 0.5).offset(v)),
        ("shell", "thickness", |v| block().shell(v)),
        ("rounded", "radius", |v| block().rounded(v)),
        ("filleted", "radius", |v| block().filleted(v)),
        ("offset", "distance", |v| disc().offset(v).extrude(1.0)),
        ("shell", "thickness", |v| disc().shell(v).extrude(1.0)),
        ("rounded", "radius", |v| disc().rounded(v).extrude(1.0)),
        ("filleted", "radius", |v| disc().filleted(v).extrude(1.0)),
        ("translate", "translation.y", |v| ball().translate([0.0, v, 0.0])),
        ("rotate", "", |v| ball().rotate(DQuat::from_xyzw(v, 0.0, 0.0, 1.0))),
        ("rotate_x", "angle", |v| ball().rotate_x(rad(v))),
        ("rotate_y", "angle", |v| ball().rotate_y(rad(v))),
        ("rotate_z", "angle", |v| ball().rotate_z(rad(v))),
        ("rotate_x", "angle", |v| ball().rotate_x(deg(v))),
        ("rotate_y", "angle", |v| ball().rotate_y(deg(v))),
        ("rotate_z", "angle", |v| ball().rotate_z(deg(v))),
        ("rotate_about", "axis or angle", |v| ball().rotate_about(DVec3::X, rad(v))),
        ("rotate_about", "axis or angle", |v| ball().rotate_about([v, 0.0, 0.0], rad(1.0))),
        ("rotate_about", "axis or angle", |v| ball().rotate_about(DVec3::X, deg(v))),
        ("scale", "factor", |v| ball().scale(v)),
        ("scale_axes", "factors", |v| ball().scale_axes([1.0, v, 1.0])),
        ("affine", "matrix", |v| ball().affine(DAffine3::from_scale([1.0, 1.0, v].into()))),
        ("affine", "translation.z", |v| ball().affine(DAffine3::from_translation([1.0, 1.0, v].into()))),
        ("reflect", "", |v| ball().reflect([v, 0.0, 0.0], 0.0)),
        ("reflect", "", |v| ball().reflect(DVec3::X, v)),
        ("reflect", "", |v| ball().mirrored([0.0, v, 0.0], 0.0)),
        ("reflect", "", |v| ball().mirrored(DVec3::X, v)),
        ("taper", "kx", |v| ball().taper(v, 0.0, 2.0)),
        ("taper", "ky", |v| ball().taper(0.0, v, 2.0)),
        ("taper", "height", |v| ball().taper(0.1, 0.1, v)),
        ("twist", "rate", |v| ball().twist(rad(v))),
        ("bend", "curvature", |v| ball().bend(v, deg(0.0))),
        ("bend", "angle", |v| ball().bend(0.1, rad(v))),
        ("taper_by", "", |v| ball().taper_by(v, 1.0)),
        ("taper_by", "", |v| ball().taper_by(LinearLaw { at_zero: 1.0, slope: v }, 1.0)),
        ("taper_by", "", |v| {
            ball().taper_by(SineWave { mean: 1.0, amplitude: 0.1, wavelength: v, phase: deg(0.0) }, 1.0)
        }),
        ("twist_by", "", |v| ball().twist_by(rad(1.0), SmoothStep { from: (-1.0, 0.0), to: (v, 1.0) })),
        ("twist_by", "", |v| ball().twist_by(rad(1.0), LawTable::new([(0.0, 0.0), (1.0, v)]))),
        ("twist_by", "angle", |v| ball().twist_by(rad(v), LinearLaw { at_zero: 0.0, slope: 1.0 })),
        ("elongate", "lengths.y", |v| ball().elongate([0.0, v, 0.0])),
        ("repeat", "spacing", |v| ball().repeat([3, 1, 1], [v, 1.0, 1.0])),
        // A step back starts with the last copy, where it is.
        ("repeat", "", |v| ball().repeat_linear(3, [0.0, v, 0.0])),
        ("repeat", "", |v| ball().repeat_linear(3, [v, v, 0.0])),
        ("repeat_polar", "count", |v| ball().repeat_polar(if v > 0.0 && v < 1e9 { 3 } else { 0 })),
        ("taper_by", "", |v| ball().taper_by(LawTable::new([(v, 1.0), (2.0, 1.0)]), 1.0)),
    ]
}

const POINTS: [DVec3; 6] = [
    DVec3::ZERO,
    DVec3::new(0.1, 0.2, 0.3),
    DVec3::new(-1.0, 1.0, -1.0),
    DVec3::new(1e12, -1e12, 1e12),
    DVec3::new(0.0, 0.0, 1e12),
    DVec3::new(1e-30, 0.0, -1e-30),
];

#[test]
fn what_is_not_finite_is_named() {
    let mut wrong = Vec::new();
    for (row, (node, parameter, make)) in table().into_iter().enumerate() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            // A formula may go on for ever.
            if node == "formula" && !bad.is_nan() {
                continue;
            }
            let said = catch_unwind(|| make(bad).value(DVec3::ZERO).map_err(|error| error.to_string()));
            match said {
                Ok(Err(text)) if text.contains(node) && text.contains(parameter) && text.contains("allowed") => {}
                Ok(said) => wrong.push(format!("{row} {node} {parameter} {bad}: {said:?}")),
                Err(_) => wrong.push(format!("{row} {node} {parameter} {bad}: panic")),
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_number_makes_a_panic_or_nan() {
    let extremes = [0.0, -0.0, -1.0, 1e-310, 1e-9, 2e-9, 1e-3, 0.1, 0.999, 2.0, 60.0, 1e3];
    let extremes = extremes.into_iter().chain([9.9e8, 1e9, 1e30, f64::MAX, -1e9, -0.1]);
    let extremes: Vec<f64> = extremes.collect();
    let mut wrong = Vec::new();
    for (row, (node, parameter, make)) in table().into_iter().enumerate() {
        // What is measured takes a while.
        let is_measured =
            ["with_tolerance", "filleted union", "chamfered difference", "rounded", "filleted", "shell", "offset"];
        let step = if is_measured.contains(&node) { 4 } else { 1 };
        for &v in extremes.iter().step_by(step) {
            let tried = catch_unwind(|| -> Result<(), String> {
                let solid = make(v);
                let _ = format!("{solid} {solid:?} {:?}", solid.simplified() == solid);
                let error = match solid.value(DVec3::ZERO) {
                    Ok(_) => None,
                    Err(error) => Some(error.to_string()),
                };
                if let Some(text) = error {
                    // Where limits depend on one another, the other parameter may be named.
                    let named = text.contains("allowed");
                    return if named { Ok(()) } else { Err(format!("says {text}")) };
                }
                let bounds = solid.bounds().map_err(|e| e.to_string())?;
                if bounds.min.is_nan() || bounds.max.is_nan() {
                    return Err(format!("bounds {bounds:?}"));
                }
                let program = solid.surface_program().map_err(|e| e.to_string())?;
                for p in POINTS {
                    let (value, gradient) = (solid.value(p), solid.gradient(p));
                    if !value.as_ref().is_ok_and(|value| value.is_finite()) {
                        return Err(format!("value {value:?} at {p}"));
                    }
                    if !gradient.as_ref().is_ok_and(|gradient| !gradient.is_nan()) {
                        return Err(format!("gradient {gradient:?} at {p}"));
                    }
                    // Beyond the coordinate limit points are held back, ranges are not.
                    for half in [1e-3, 1e9].into_iter().filter(|_| p.length() < 1e10) {
                        let region = Bounds::from_center(p, DVec3::splat(half));
                        let range = program.range(&region);
                        let value = program.value(p);
                        if !(range.lo() <= value && value <= range.hi()) {
                            return Err(format!("{value:e} at {p} is not in {range:?} of ±{half}"));
                        }
                        let _ = program.narrow(&region);
                    }
                }
                Ok(())
            });
            match tried {
                Ok(Ok(())) => {}
                Ok(Err(text)) => wrong.push(format!("{row} {node} {parameter} {v:e}: {text}")),
                Err(_) => wrong.push(format!("{row} {node} {parameter} {v:e}: panic")),
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
