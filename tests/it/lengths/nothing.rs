//! Solids that hold nothing: eroded away, rounded away, taken away. Every verb takes them, and says
//! so.

use glam::{DVec2, DVec3};
use rvachev::{
    Blend, Bounds, Camera, CellSize, ContourSettings, Extrusion, Face, Features, Helix, Mesh, MeshSettings, MeshSolid,
    Plane, PlaneBounds, Profile, Quality, RFunction, RenderSettings, Run, Solid, Style, ThinFeatures,
    law::{SineWave, SmoothStep},
    program::Region,
    rad,
    range_image::Coordinates,
};

use super::{Outcome, at, fillet, l_profile, two_cubes};
use crate::support::value;

fn settings() -> MeshSettings {
    MeshSettings { cell: CellSize::LongestSide(16), ..MeshSettings::default() }
}

/// Boxes of levels and of what all is taken from are those of what they are made of.
const TOLD_BY_MESHES: [&str; 3] = ["a level", "taken away", "from itself"];

/// Solids of which nothing is left, in one way each.
fn nothings() -> Vec<(&'static str, Solid)> {
    let cube = Solid::cuboid([10.0; 3]);
    let ball = Solid::sphere(1.0);
    let (round, l) = (Profile::circle(1.0).offset(-1.5), l_profile().offset(-2.6));
    let bent = Extrusion { twist: rad(1.0), scale: 0.5, ..Extrusion::new(3.0) };
    vec![
        ("by a closed form", cube.offset(-6.0)),
        ("measured", two_cubes().offset(-5.5)),
        ("there and back", two_cubes().offset(-5.5).offset(5.5)),
        ("rounded", cube.rounded(5.5)),
        ("rounded and measured", two_cubes().rounded(5.5)),
        ("deformed", Solid::superellipsoid([3.0, 2.0, 1.0], 0.3, 0.7).twist(rad(0.2)).offset(-1.5)),
        ("a level", ball.level(-2.0)),
        ("apart", &cube & at(cube.clone(), [20.0, 0.0, 0.0])),
        ("taken away", &ball - &cube),
        ("from itself", cube.difference(&cube, RFunction::MIN_MAX)),
        ("extruded", l.extrude(2.0)),
        ("extruded and twisted", round.extrude_with(&bent)),
        ("revolved", round.translate([3.0, 0.0]).revolve()),
        ("revolved in part", l.revolve_by(rad(2.0))),
        ("swept", round.sweep_helix(&Helix::new(5.0, 4.0, 2.0))),
        ("a column", l.column()),
        ("a profile beyond its axis", Profile::circle(1.0).translate([-5.0, 0.0]).revolve()),
    ]
}

/// What is made of nothing, and is nothing.
fn made_of(nothing: &Solid) -> Vec<(&'static str, Solid)> {
    let ball = Solid::sphere(1.0);
    let wave = SineWave { mean: 1.0, amplitude: 0.3, wavelength: 2.0, phase: rad(0.4) };
    let step = SmoothStep { from: (-0.5, 0.0), to: (0.5, 1.2) };
    vec![
        ("offset", nothing.offset(1.0)),
        ("inset", nothing.offset(-1.0)),
        ("to a tolerance", nothing.offset(1.0).with_tolerance(0.1)),
        ("shell", nothing.shell(1.0)),
        ("rounded", nothing.rounded(1.0)),
        ("filleted", nothing.filleted(1.0)),
        ("level", nothing.level(-0.5)),
        ("translate", at(nothing.clone(), [1.0, 2.0, 3.0])),
        ("rotate", nothing.rotate_around([1.0, 0.0, 0.0], [0.0, 0.0, 1.0], rad(1.0))),
        ("scale", nothing.scale_axes([1.0, 2.0, 0.5])),
        ("bend", nothing.bend(0.05, rad(0.3))),
        ("bend between", nothing.bend_between(-1.0, 1.0, rad(0.3), rad(0.1))),
        ("twist", nothing.twist(rad(0.1))),
        ("twist by", nothing.twist_by(rad(1.0), step)),
        ("taper", nothing.taper(0.1, 0.1, 1.0)),
        ("taper by", nothing.taper_by(wave, 0.8)),
        ("elongate", nothing.elongate([1.0; 3])),
        ("mirrored", nothing.mirrored_x()),
        ("repeat", nothing.repeat([3, 1, 1], [4.0; 3])),
        ("repeat in a ring", nothing.repeat_polar(5)),
        ("repeat in a row", nothing.repeat_linear(3, [1.0, 0.0, 0.0])),
        ("centred", nothing.centered()),
        ("on the ground", nothing.on_ground()),
        ("aligned", nothing.aligned(Face::Left, &ball, Face::Right)),
        ("painted and named", nothing.paint([1, 2, 3]).named("nothing")),
        ("simplified", nothing.simplified()),
        ("intersection", nothing & &ball),
        ("difference", nothing - &ball),
        ("union", nothing.union(nothing, RFunction::MIN_MAX)),
        ("fillet", nothing.intersection_with(&ball, fillet(1.0))),
        ("fillet of nothing", nothing.union_with(nothing, fillet(1.0))),
        ("fillets", Solid::union_all_with([nothing, nothing], fillet(1.0))),
        ("chamfer", nothing.difference_with(&ball, Blend::Chamfer { leg: 1.0 })),
        ("smooth", nothing.smooth_intersection(&ball, 0.5)),
    ]
}

/// Fails unless a solid has no points by any question about points, rays and boxes.
fn has_no_points(nothing: &Solid) -> Outcome {
    for p in [DVec3::ZERO, DVec3::splat(4.9), DVec3::new(100.0, 0.0, -3.0), DVec3::splat(1e7)] {
        assert!(!nothing.contains(p)? && value(nothing, p) <= 0.0, "at {p}");
        assert!(nothing.gradient(p)?.is_finite(), "at {p}");
        assert!(value(nothing, p).is_finite() && !nothing.owner(p)?.path.is_empty(), "at {p}");
        assert_eq!(nothing.closest_surface_point(p)?, None);
        assert_eq!(nothing.raycast(p, DVec3::X)?, None);
    }
    assert_eq!(nothing.closest_surface_points(&[DVec3::ZERO; 3])?, [None; 3]);
    assert!(nothing.paint_at(DVec3::ZERO).is_ok());
    let unit = Bounds::from_center(DVec3::ZERO, DVec3::ONE);
    assert!(nothing.range(&unit)?.lo() <= 0.0);
    Ok(())
}

/// Fails unless a mesh holds nothing, and can be written, read, painted and moved.
fn is_no_mesh(name: &str, mesh: &Mesh, nothing: &Solid) -> Outcome {
    assert!(mesh.triangles().is_empty() && mesh.bounds().is_empty() && mesh.components().is_empty());
    assert!(!mesh.warnings().is_empty() && mesh.warnings()[0].contains("empty"), "{:?}", mesh.warnings());
    assert_eq!((mesh.volume(), mesh.area(), mesh.centroid(), mesh.inertia()), (0.0, 0.0, None, None));
    let report = mesh.check();
    assert!(report.shells == 0 && report.volume == 0.0 && !report.to_string().contains("NaN"));
    assert!(mesh.open_edges().edges == 0);
    assert!(mesh.twist(rad(1.0))?.triangles().is_empty() && mesh.keep_components(|_| true).triangles().is_empty());
    assert!(mesh.clone().painted(nothing, [1, 2, 3].into())?.triangles().is_empty());
    let formats = [
        "stl",
        "obj",
        "ply",
        "glb",
        #[cfg(feature = "threemf")]
        "3mf",
    ];
    for format in formats {
        let path = std::env::temp_dir().join(format!("rvachev_nothing_{}.{format}", name.replace(' ', "_")));
        mesh.save(&path)?;
        #[cfg(feature = "import")]
        assert!(Mesh::load(&path)?.triangles().is_empty(), "{format}");
        std::fs::remove_file(path)?;
    }
    // There is nothing that triangles enclose, which is told.
    let error = Solid::from_mesh(mesh, MeshSolid::default()).bounds().unwrap_err();
    assert_eq!(error.to_string(), "mesh: triangles is 0, allowed: 1 or more");
    Ok(())
}

/// Fails unless nothing is seen of a solid, in pictures and in slices.
fn is_not_seen(nothing: &Solid) -> Outcome {
    let camera = Camera::framing(&nothing.bounds()?);
    let plain = RenderSettings { width: 20, height: 16, samples: 1, ..RenderSettings::default() };
    for settings in [
        plain.clone(),
        RenderSettings { style: Style::Technical, ..plain.clone() },
        RenderSettings { quality: Quality::Draft, ..plain.clone() },
        RenderSettings { cut: Some(Plane::xy(0.0)), ..plain.clone() },
    ] {
        assert_eq!(nothing.render(&camera, &settings)?.width(), 20);
    }
    let layers = nothing.layers(&camera, 20, 16)?;
    assert!(layers.depth().pixels().iter().all(|depth| *depth == f64::INFINITY || depth.is_nan()));
    assert_eq!(layers.range_image().points(Coordinates::World)?.len(), 0);
    let slice = nothing.slice(&Plane::xy(0.1))?;
    assert!(slice.contours(1e-2)?.is_empty());
    assert!(slice.values(8)?.pixels().iter().all(|value| *value <= 0.0));
    for contours in nothing.slices(&[0.0, 1.0], &ContourSettings::default(), &Run::default())? {
        assert!(contours.area() == 0.0 && contours.area().is_sign_positive() && contours.lines().is_empty());
    }
    Ok(())
}

/// Fails unless a solid has no measures.
fn has_no_measures(nothing: &Solid) -> Outcome {
    let (run, ball) = (Run::default(), Solid::sphere(3.0));
    assert_eq!(nothing.prepare(&run)?, nothing.accuracy()?);
    let measures = nothing.measure(1e-2)?;
    assert_eq!((measures.volume, measures.area, measures.centroid), (0.0, 0.0, None));
    let thickness = nothing.thickness(&settings(), &run)?;
    assert_eq!((thickness.least, thickness.share_below(1.0)), (f64::INFINITY, Ok(0.0)));
    assert!(!format!("{thickness} {:?}", thickness.histogram(3)).contains("NaN"));
    assert_eq!(nothing.clearance(&ball, &run)?, None);
    assert_eq!(ball.clearance(nothing, &run)?, None);
    assert_eq!(nothing.clearance(nothing, &run)?, None);
    Ok(())
}

/// Fails unless a solid has an empty box and an empty mesh.
fn is_empty(nothing: &Solid) -> Outcome {
    assert_eq!(nothing.bounds()?, Bounds::EMPTY);
    let region = nothing.region(&Bounds::from_center(DVec3::ZERO, DVec3::ONE))?;
    assert!(matches!(region, Region::Outside), "{region:?}");
    let mesh = nothing.mesh(&MeshSettings { cell: CellSize::LongestSide(8), ..MeshSettings::default() })?;
    assert!(mesh.triangles().is_empty() && !mesh.warnings().is_empty());
    Ok(())
}

/// With the name of the solid and of what it was asked.
fn told(name: &str, what: &str, outcome: Outcome) -> Outcome {
    outcome.map_err(|error| format!("{name}, {what}: {error}").into())
}

#[test]
fn every_verb_takes_nothing() -> Outcome {
    for (name, nothing) in nothings() {
        println!("{name}");
        told(name, "points", has_no_points(&nothing))?;
        assert!(TOLD_BY_MESHES.contains(&name) || nothing.bounds()?.is_empty(), "{name}");
        for (cell, features, thin) in [
            (CellSize::Length(0.5), Features::Sharp, ThinFeatures::Ignore),
            (CellSize::LongestSide(16), Features::Smooth, ThinFeatures::Count),
            (CellSize::LongestSide(16), Features::Sharp, ThinFeatures::Refine { halvings: 1 }),
            (CellSize::Tolerance(0.05), Features::Sharp, ThinFeatures::Ignore),
        ] {
            let mesh = nothing.mesh(&MeshSettings { cell, features, thin, owners: true, ..settings() })?;
            told(name, "mesh", is_no_mesh(name, &mesh, &nothing))?;
        }
        assert_eq!(nothing.thin_features(&settings(), &Run::default())?.count, 0, "{name}");
        told(name, "pictures", is_not_seen(&nothing))?;
        told(name, "measures", has_no_measures(&nothing))?;
        #[cfg(feature = "formula")]
        assert!(!nothing.to_rust("nothing").is_empty() && nothing.to_fidget().is_ok(), "{name}");
    }
    Ok(())
}

#[test]
fn what_is_made_of_nothing_is_nothing() -> Outcome {
    for (name, nothing) in nothings().into_iter().filter(|(name, _)| !TOLD_BY_MESHES.contains(name)) {
        for (verb, made) in made_of(&nothing) {
            println!("{name}, {verb}");
            told(name, verb, is_empty(&made))?;
            told(name, verb, has_no_points(&made))?;
        }
        let ball = Solid::sphere(3.0);
        for whole in [&nothing | &ball, &ball - &nothing, &ball ^ &nothing] {
            assert_eq!(whole.bounds()?, ball.bounds()?, "{name}");
        }
        // There is no box to be aligned with, which is told.
        let error = ball.aligned(Face::Left, &nothing, Face::Right).bounds().unwrap_err();
        assert!(error.to_string().contains("finite boxes"), "{name}: {error}");
    }
    Ok(())
}

#[test]
fn profiles_that_are_eroded_away_are_empty() -> Outcome {
    let l = l_profile();
    let is_empty_box = |bounds: PlaneBounds| bounds.min.x > bounds.max.x;
    let ring = Profile::circle(3.0) - Profile::circle(2.0);
    for nothing in [
        l.offset(-2.5),
        l.rounded(2.5),
        l.offset(-2.5).offset(2.5),
        Profile::circle(1.0).offset(-1.5).offset(1.5),
        ring.rounded(0.6),
        ring.offset(-0.6).union_with(l.offset(-2.5), fillet(1.0)),
        l.offset(-2.5).intersection_with(&l, Blend::Chamfer { leg: 0.5 }),
        ring.offset(-0.6).shell(0.1),
        ring.offset(-0.6).filleted(0.1),
    ] {
        assert!(is_empty_box(nothing.bounds()?) && nothing.extrude(1.0).bounds()?.is_empty(), "{nothing:?}");
        assert!(nothing.revolve().bounds()?.is_empty() && nothing.column().bounds()?.is_empty(), "{nothing:?}");
        let points = [DVec2::ZERO, DVec2::splat(2.0), DVec2::new(1e6, 3.0)];
        assert_eq!(nothing.contains_all(&points)?, [false; 3], "{nothing:?}");
        assert!(nothing.values(&points)?.iter().all(|value| value.is_finite() && *value <= 0.0), "{nothing:?}");
        assert!(nothing.gradients(&points)?.iter().all(|slope| slope.is_finite()), "{nothing:?}");
        assert!(
            is_empty_box(nothing.centered().bounds()?) && !nothing.owner([0.0, 0.0])?.path.is_empty(),
            "{nothing:?}"
        );
        assert!((&nothing | Profile::circle(1.0)).contains([0.5, 0.0])?, "{nothing:?}");
    }
    Ok(())
}
