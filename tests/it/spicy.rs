//! Every entry of the catalogue with numbers of all sizes, one on another: an error that tells, or
//! a solid that can be asked, meshed, sliced, drawn and written; never a panic, never NaN.
//!
//! The ignored test tries as many as are asked for: `SPICY_SEEDS=0..2000`.

use glam::{DAffine3, DMat3, DVec2, DVec3};
use rvachev::{
    Bounds, Camera, CellSize, MeshSettings, Plane, Solid, catalogue,
    catalogue::{Call, Part, Value},
    io::{write_obj, write_svg},
    rad,
};

use super::battery::{Fault, Most, run, seeds, short};
use super::explicit_inputs::Chance;
use super::form::shown;

/// A value like `value`, its numbers changed now and then.
fn spiced(chance: &mut Chance, value: Value) -> Value {
    let mut number = |old: f64| if chance.below(3) == 0 { chance.number() } else { old };
    match value {
        Value::Number(old) => Value::Number(number(old)),
        Value::Angle(old) => Value::Angle(rad(number(old.radians()))),
        Value::Count(old) => {
            Value::Count(if chance.below(3) == 0 { [0, 1, 2, 3, 17, 1025][chance.below(6)] } else { old })
        }
        Value::Vector(old) => Value::Vector(DVec3::from_array(old.to_array().map(number))),
        Value::PlaneVector(old) => Value::PlaneVector(DVec2::from_array(old.to_array().map(number))),
        Value::Contours(old) => {
            let mut point = |p: DVec2| DVec2::from_array(p.to_array().map(&mut number));
            Value::Contours(old.into_iter().map(|contour| contour.into_iter().map(&mut point).collect()).collect())
        }
        Value::Points(old) => {
            Value::Points(old.into_iter().map(|p| DVec2::from_array(p.to_array().map(&mut number))).collect())
        }
        Value::Bounds(old) => {
            let [min, max] = [old.min, old.max].map(|p| DVec3::from_array(p.to_array().map(&mut number)));
            Value::Bounds(Bounds::new(min, max))
        }
        Value::Map(old) => {
            let matrix = DMat3::from_cols_array(&old.matrix3.to_cols_array().map(&mut number));
            let translation = DVec3::from_array(old.translation.to_array().map(&mut number));
            Value::Map(DAffine3::from_mat3_translation(matrix, translation))
        }
        other => other,
    }
}

/// A random entry on what was made so far.
fn next(chance: &mut Chance, operand: Option<&Solid>) -> Option<Solid> {
    let entries = catalogue();
    let entry = &entries[chance.below(entries.len())];
    let mut call = Call::of(&entry.example())?;
    call.values = call.values.into_iter().map(|value| spiced(chance, value)).collect();
    if let (Some(solid), Some(first @ Part::Solid(_))) = (operand, call.operands.first_mut()) {
        *first = solid.into();
    }
    call.make().ok().map(shown)
}

fn tells(error: impl std::fmt::Display, solid: &Solid) {
    let text = error.to_string();
    assert!(!text.contains("internal"), "{text} of {solid}");
    assert!(text.len() > 8, "{text:?} of {solid}");
}

fn use_all_ways(solid: &Solid) {
    let _ = (format!("{solid} {solid:#} {solid:?}"), solid.simplified().node_count());
    if let Err(error) = solid.prepare(&short()) {
        return tells(error, solid);
    }
    let bounds = solid.bounds().unwrap();
    assert!(!bounds.min.is_nan() && !bounds.max.is_nan(), "{bounds:?} of {solid}");
    let is_finite = bounds.is_finite();
    let frame = if is_finite { bounds } else { Bounds::from_center(DVec3::ZERO, DVec3::splat(2.0)) };
    let points = frame.corners().into_iter().chain([frame.center(), DVec3::ZERO, DVec3::new(1e-30, 1e12, -1e12)]);
    let points: Vec<DVec3> = points.collect();
    for (p, many) in points.iter().zip(solid.values(&points).unwrap()) {
        let (value, gradient) = (solid.value(*p).unwrap(), solid.gradient(*p).unwrap());
        assert!(
            value.is_finite() && many.is_finite() && !gradient.is_nan(),
            "{value} {many} {gradient} at {p}: {solid}"
        );
        let range = solid.range(&Bounds::from_center(*p, 0.1 * frame.size())).unwrap();
        assert!(range.lo() <= value && value <= range.hi(), "{value:e} at {p} is not in {range:?}: {solid}");
    }
    let settings = MeshSettings {
        cell: CellSize::LongestSide(8),
        bounds: (!is_finite).then_some(frame),
        ..MeshSettings::default()
    };
    match solid.mesh_with(&settings, &short()) {
        Ok(mesh) => {
            assert!(mesh.positions().iter().all(|p| p.is_finite()), "{solid}");
            let report = mesh.check();
            assert!(!mesh.volume().is_nan(), "volume of {solid}");
            assert!(mesh.triangles().is_empty() || report.is_closed(), "{report} of {solid}");
            write_obj(&mesh, &rvachev::SaveSettings::default(), Vec::new()).unwrap();
        }
        Err(error) => tells(error, solid),
    }
    match solid.slice_within(
        &Plane::xy(frame.center().z),
        rvachev::PlaneBounds { min: frame.min.truncate(), max: frame.max.truncate() },
    ) {
        Ok(slice) => {
            if let Ok(values) = slice.values(8) {
                assert!(values.pixels().iter().all(|v| v.is_finite()), "{solid}");
            }
            let lines = slice.contours(0.05 * frame.longest_side()).unwrap();
            write_svg(&lines, Vec::new()).unwrap();
        }
        Err(error) => tells(error, solid),
    }
    match solid.scene_with(&short()).and_then(|scene| scene.layers(&Camera::framing(&frame), 8, 8, &short())) {
        Ok(layers) => assert!(layers.depth().pixels().iter().all(|depth| !depth.is_nan()), "{solid}"),
        Err(error) => tells(error, solid),
    }
}

/// A solid of up to three random calls.
fn solid(seed: u64) -> Option<Solid> {
    let mut chance = Chance(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) + 3);
    let mut solid = next(&mut chance, None);
    for _ in 0..chance.below(3) {
        solid = next(&mut chance, solid.as_ref());
    }
    solid
}

/// Any numbers are refused more often than not.
const MOST: Most = Most { refused: 1.0, slow: 0.1 };

/// What does not hold panics.
pub(super) fn check(solid: &Solid) -> Result<(), Fault> {
    use_all_ways(solid);
    Ok(())
}

#[test]
fn entries_of_the_catalogue_take_any_numbers() {
    run(0..150, solid, check, MOST);
}

#[test]
#[ignore = "takes minutes: SPICY_SEEDS=0..2000 chooses"]
fn thousands_of_entries_take_any_numbers() {
    run(seeds("SPICY_SEEDS", 150..1000), solid, check, MOST);
}
