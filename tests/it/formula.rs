//! Formulas: trees and `.vm` texts as solids, against fidget.

use std::path::Path;

use fidget::context::{Context, Tree};
use fidget::shape::{EzShape, Shape};
use fidget::vm::{VmFunction, VmShape};
use glam::{DQuat, DVec3};
use rvachev::{
    Bounds, CellSize, Formula, MeshSettings, RFunction, Solid, SolidError,
    error::FormulaError,
    program::{Evaluator, Region, Tape},
};

use crate::support::{Random, near};

/// A third-party model; without the folder the test ends, saying so.
fn model(name: &str) -> Option<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join(name);
    let text = std::fs::read_to_string(&path).ok();
    if text.is_none() {
        println!("skipped: {} is not there", path.display());
    }
    text
}

fn fidget(text: &str) -> VmShape {
    let (context, root) = Context::from_text(&mut text.as_bytes()).expect("a sound file");
    Shape::<VmFunction>::new(&context, root).expect("its root")
}

const FLAT: Bounds =
    Bounds { min: DVec3::new(-1.0, -1.0, f64::NEG_INFINITY), max: DVec3::new(1.0, 1.0, f64::INFINITY) };

/// Values of the text by us and by fidget at random points of the cube ±`half`.
fn compare(name: &str, bounds: Bounds, half: f64) {
    let Some(text) = model(name) else { return };
    let solid = Solid::from(Formula::from_vm(&text, bounds).expect("a sound file"));
    let shape = fidget(&text);
    let (tape, mut eval) = (shape.ez_point_tape(), VmShape::new_point_eval());
    let mut random = Random::new(301);
    let points: Vec<DVec3> = (0..300).map(|_| random.vector(-half, half).as_vec3().as_dvec3()).collect();
    let [x, y, z]: [Vec<f32>; 3] = [0, 1, 2].map(|axis| points.iter().map(|p| p[axis] as f32).collect());
    let lanes = Tape::new(&solid.field_program().unwrap(), &Bounds::new(DVec3::splat(-half), DVec3::splat(half)));
    let mut values = vec![0.0; points.len()];
    Evaluator::new().values(&lanes, &x, &y, &z, &mut values).unwrap();
    println!("{name}: single precision is within {:e}", lanes.roundoff());
    assert!(lanes.roundoff() < 1e-4 * half.max(1.0).powi(4), "{:e}", lanes.roundoff());
    for (p, ours) in points.iter().zip(values) {
        let (theirs, _) = eval.eval(&tape, p.x as f32, p.y as f32, p.z as f32).unwrap();
        let truth = solid.value(*p).unwrap();
        near(f64::from(ours), truth, lanes.roundoff());
        near(f64::from(-theirs), truth, lanes.roundoff());
    }
}

#[test]
fn files_have_the_values_of_fidget() {
    for name in ["hi.vm", "quarter.vm", "prospero.vm"] {
        compare(name, FLAT, 1.0);
    }
    compare("colonnade.vm", Bounds::ALL, 1.0);
    compare("tanglecube.vm", Bounds::ALL, 3.0);
}

#[test]
fn trees_are_negative_inside() {
    let (x, y, z) = Tree::axes();
    let tree = (x.square() + y.square() + z.square()).sqrt() - 1.5;
    let ball = Solid::formula(&tree, Bounds::new(DVec3::splat(-1.5), DVec3::splat(1.5)));
    let placed = ball.rotate(DQuat::from_rotation_z(0.7)).scale(2.0).translate(DVec3::X);
    near(placed.value(DVec3::X).unwrap(), 3.0, 1e-12);
    assert!(placed.contains(DVec3::new(3.9, 0.0, 0.0)).unwrap());
    let gradient = placed.gradient(DVec3::new(1.0, 3.0, 0.0)).unwrap();
    near((gradient + DVec3::Y).length(), 0.0, 1e-12);
    assert!(placed.bounds().unwrap().contains(DVec3::new(3.9, 0.0, 0.0)));
    // And back again.
    let shape = VmShape::from(placed.to_fidget().unwrap());
    let (value, _) = VmShape::new_point_eval().eval(&shape.ez_point_tape(), 1.0, 4.0, 0.0).unwrap();
    near(f64::from(value), 1.0, 1e-5);
}

/// Rounding is told apart from small values by the scale of the formula, not by lengths.
#[test]
fn formulas_of_any_scale_are_hit() {
    let (x, y, z) = Tree::axes();
    for scale in [1e-20, 1.0, 1e12] {
        let tree = (x.square() + y.square() + z.square() - 1.0) * scale;
        let ball = Solid::formula(&tree, Bounds::new(DVec3::splat(-1.5), DVec3::splat(1.5)));
        let hit = ball.raycast(DVec3::new(0.2, 0.1, 3.0), -DVec3::Z).unwrap().expect("it is aimed at");
        assert!((hit.distance - (3.0 - 0.95f64.sqrt())).abs() < 1e-6, "{scale}: {hit:?}");
    }
}

#[test]
fn what_is_undefined_is_outside() {
    let (x, y, _) = Tree::axes();
    let solid = Solid::formula(&(x.sqrt() - 1.0).max(y.ln()), Bounds::ALL);
    assert!(solid.contains(DVec3::new(0.5, 0.5, 0.0)).unwrap());
    for p in [DVec3::new(-0.5, 0.5, 0.0), DVec3::new(0.5, -0.5, 0.0)] {
        assert!(!solid.contains(p).unwrap());
        assert!(solid.gradient(p).unwrap().is_finite());
    }
    let region = Bounds::new(DVec3::new(-1.0, 0.1, 0.0), DVec3::new(0.5, 0.5, 1.0));
    assert!(matches!(solid.region(&region).unwrap(), Region::Surface(_)));
    let inside = Bounds::new(DVec3::new(0.1, 0.1, 0.0), DVec3::new(0.5, 0.5, 1.0));
    assert!(matches!(solid.region(&inside).unwrap(), Region::Inside));
}

#[test]
fn malformed_texts_name_the_line() {
    let message = |text: &str| Formula::from_vm(text, FLAT).unwrap_err().to_string();
    for (text, want) in [
        (
            "x var-x\n\n# note\n_2 sqroot x",
            "line 4, `_2 sqroot x`: expected an operation such as var-x, const, add, min or sqrt, found `sqroot`",
        ),
        ("x var-x\nr add x", "line 2, `r add x`: expected 2 operands after add, found 1"),
        ("x var-x x", "line 1, `x var-x x`: expected 0 operands after var-x, found 1"),
        ("x var-x\ny neg", "line 2, `y neg`: expected 1 operand after neg, found 0"),
        ("x var-x\r\ny neg w\r\n", "line 2, `y neg w`: expected the name of an earlier line, found `w`"),
        ("alone", "line 1, `alone`: expected an operation after the name alone, found the end of the line"),
        (
            "c const 1.5.2",
            "line 1, `c const 1.5.2`: expected a number of at most 3.4e38 in absolute value, found `1.5.2`",
        ),
        ("c const nan", "line 1, `c const nan`: expected a number of at most 3.4e38 in absolute value, found `nan`"),
        ("c const 1e39", "line 1, `c const 1e39`: expected a number of at most 3.4e38 in absolute value, found `1e39`"),
        ("# nothing\n\n", "no operation in 2 lines, expected at least one line `name operation operands…`"),
        ("", "no operation in 0 lines, expected at least one line `name operation operands…`"),
    ] {
        assert_eq!(message(text), want);
    }
    let long = format!("a {}", "é".repeat(500));
    assert!(message(&long).len() < 400);
    assert!(matches!(Formula::from_vm("a b", FLAT), Err(FormulaError::Line { line: 1, .. })));
}

#[test]
fn bad_parameters_are_named() {
    let error = |solid: Solid| match solid.value(DVec3::ZERO) {
        Err(SolidError::Parameter { path, source }) => format!("{path}: {source}"),
        other => panic!("{other:?}"),
    };
    let x = Tree::x();
    let foreign = x.clone() + Tree::from(fidget::var::Var::new());
    assert_eq!(
        error(Solid::formula(&foreign, FLAT)),
        "formula: number of variables other than x, y and z is 1, allowed: 0"
    );
    let nan = x.max(Tree::constant(-1.0).sqrt());
    assert_eq!(error(Solid::formula(&nan, FLAT)), "formula: a constant of the formula is NaN, allowed: any number");
    let empty = Bounds::new(DVec3::ONE, DVec3::ZERO);
    assert_eq!(error(Solid::formula(&x, empty)), "formula: bounds.max.x is 0, allowed: above bounds.min.x, which is 1");
    let nan = Bounds::new(DVec3::new(0.0, f64::NAN, 0.0), DVec3::ONE);
    assert_eq!(error(Solid::formula(&x, nan)), "formula: bounds.min.y is NaN, allowed: -1000000000 to 1000000000");
}

fn closed_mesh(solid: &Solid, cells: u32) -> usize {
    let settings = MeshSettings { cell: CellSize::LongestSide(cells), ..MeshSettings::default() };
    let mesh = solid.mesh(&settings).unwrap();
    let report = mesh.check();
    assert!(report.is_closed(), "{report:?}");
    mesh.triangles().len()
}

#[test]
fn the_tanglecube_is_closed() {
    let Some(text) = model("tanglecube.vm") else { return };
    let bounds = Bounds::new(DVec3::splat(-3.0), DVec3::splat(3.0));
    let solid = Solid::from(Formula::from_vm(&text, bounds).unwrap());
    assert!(closed_mesh(&solid, 24) > 1000);
}

#[test]
fn the_colonnade_is_closed() {
    let Some(text) = model("colonnade.vm") else { return };
    let bounds = Bounds::new(DVec3::splat(-1.5), DVec3::splat(1.5));
    let solid = Solid::from(Formula::from_vm(&text, bounds).unwrap());
    assert!(closed_mesh(&solid, 24) > 1000);
}

#[test]
fn prospero_reads_the_same() {
    let Some(text) = model("prospero.vm") else { return };
    let formula = Formula::from_vm(&text, FLAT).unwrap();
    let solid = Solid::from(formula);
    let program = solid.surface_program().unwrap();
    let shape = fidget(&text);
    let (tape, mut eval) = (shape.ez_float_slice_tape(), VmShape::new_float_slice_eval());
    // A strip of the picture, tile by tile.
    const TILE: usize = 4;
    let step = 2.0 / 256.0;
    let (mut ink, mut decided, mut uniform) = (0, 0, 0);
    for tile in 0..256 {
        let at = DVec3::new((tile % 64) as f64, (tile / 64) as f64, 0.0) * TILE as f64;
        let corner = DVec3::new(-1.0, 0.1, 0.0) + at * step;
        let bounds = Bounds::new(corner, corner + DVec3::new(TILE as f64, TILE as f64, 0.0) * step);
        let region = program.narrow(&bounds);
        let points: Vec<DVec3> = (0..TILE * TILE)
            .map(|i| corner + DVec3::new((i % TILE) as f64 + 0.5, (i / TILE) as f64 + 0.5, 0.0) * step)
            .map(|p| p.as_vec3().as_dvec3())
            .collect();
        let [x, y, z]: [Vec<f32>; 3] = [0, 1, 2].map(|axis| points.iter().map(|p| p[axis] as f32).collect());
        let theirs = eval.eval(&tape, &x, &y, &z).unwrap();
        let mut count = 0;
        for (p, theirs) in points.iter().zip(theirs) {
            let inside = match &region {
                Region::Inside => true,
                Region::Outside => false,
                Region::Surface(narrowed) => narrowed.value(*p) > 0.0,
            };
            count += usize::from(inside);
            assert!(inside == (*theirs < 0.0) || theirs.abs() < 1e-5, "{p}: {theirs}");
        }
        ink += count;
        uniform += usize::from(count == 0 || count == TILE * TILE);
        decided += usize::from(!matches!(region, Region::Surface(_)));
    }
    println!("prospero: {ink} pixels of ink, {decided} tiles decided, {uniform} uniform");
    assert!(ink > 300 && 2 * decided > uniform);
}

/// A pawn of five parts: each as a formula, negative inside.
fn pawn_parts() -> Vec<Tree> {
    let (x, y, z) = Tree::axes();
    let ball = |at: f32, r: f32| (x.square() + y.square() + (z.clone() - at).square()).sqrt() - r;
    let disc = |at: f32, r: f32, h: f32| ((x.square() + y.square()).sqrt() - r).max((z.clone() - at).abs() - h);
    let neck = (x.square() + y.square()).sqrt() - (z.clone() * -0.15 + 0.35);
    vec![disc(-0.9, 0.6, 0.1), ball(-0.7, 0.5), neck.max(z.abs() - 0.8), disc(0.45, 0.32, 0.05), ball(0.75, 0.3)]
}

#[test]
fn r_functions_in_a_formula_narrow_like_joins() {
    let bounds = Bounds::from_center(DVec3::ZERO, DVec3::new(0.7, 0.7, 1.2));
    // Inside is negative: the union is the R-conjunction.
    let or = |a: Tree, b: Tree| a.clone() + b.clone() - (a.square() + b.square()).sqrt();
    let whole = pawn_parts().into_iter().reduce(or).expect("there are some");
    let whole = Solid::formula(&whole, bounds);
    let joined =
        Solid::union_all(pawn_parts().iter().map(|part| Solid::formula(part, bounds)), RFunction::Zero { m: 0 });
    let values = whole.field_program().unwrap();
    let [surface, of_joined] = [&whole, &joined].map(|solid| solid.surface_program().unwrap());
    let mut random = Random::new(2_026);
    let mut decided = [0, 0];
    for _ in 0..2000 {
        let part = Bounds::from_center(
            random.vector(-1.0, 1.0) * bounds.half_extents(),
            DVec3::splat(random.range(0.01, 0.1)),
        );
        let regions = [surface.narrow(&part), of_joined.narrow(&part)];
        for (count, region) in decided.iter_mut().zip(&regions) {
            *count += u32::from(!matches!(region, Region::Surface(_)));
        }
        for _ in 0..8 {
            let p = part.min + random.vector(0.0, 1.0) * part.size();
            let value = values.value(p);
            if value.abs() < 1e-12 || !bounds.contains(p) {
                continue;
            }
            let inside = match &regions[0] {
                Region::Inside => true,
                Region::Outside => false,
                Region::Surface(narrowed) => narrowed.value(p) > 0.0,
            };
            assert_eq!(inside, value > 0.0, "{value:e} at {p} of {part:?}");
        }
    }
    assert!(10 * decided[0] > 9 * decided[1], "{decided:?}");
    // The value that a user sees is that of the formula.
    let p = DVec3::new(0.3, 0.2, 0.1);
    let own = values.value(p);
    assert!((whole.value(p).unwrap() - own).abs() < 1e-15 && (own - surface.value(p)).abs() > 1e-3);
}
