//! Narrowing: sound over random solids and boxes, and tight on the shared models.

use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec3;
use rvachev::{
    Bounds, Interval, ParamError, RFunction, Solid,
    field::{Field, Real},
    program::{Evaluator, Program, Region, Tape},
};

use crate::models::{self, Model};
use crate::support::{Random, frame_of, random_box, random_leaf, random_solid, samples};

/// Checks `region` of a program against samples; the text is what contradicts it.
pub fn contradiction(full: &Program, bounds: &Bounds, region: &Region, points: &[DVec3]) -> Option<String> {
    contradicted(bounds, region, points.iter().map(|p| (*p, full.value(*p))))
}

/// The same by the values of the program at the samples.
pub fn contradicted(
    bounds: &Bounds,
    region: &Region,
    samples: impl IntoIterator<Item = (DVec3, f64)>,
) -> Option<String> {
    for (p, value) in samples {
        let wrong = match region {
            Region::Inside => value <= 0.0,
            Region::Outside => value > 0.0,
            Region::Surface(narrowed) => (narrowed.value(p) > 0.0) != (value > 0.0),
        };
        if wrong {
            let narrowed = if let Region::Surface(narrowed) = region { narrowed.value(p) } else { f64::NAN };
            return Some(format!("{region:?} over {bounds:?}, but {value:e} at {p} (narrowed: {narrowed:e})"));
        }
    }
    None
}

pub fn check_narrowing(random: &mut Random, solid: &Solid, boxes: usize) {
    let full = solid.surface_program().unwrap();
    let field = solid.field_program().unwrap();
    let frame = frame_of(solid);
    let frame = frame.inflate(0.1 * frame.longest_side());
    for _ in 0..boxes {
        let bounds = random_box(random, &frame);
        let points = samples(random, &bounds, 40);
        let region = full.narrow(&bounds);
        if let Some(text) = contradiction(&full, &bounds, &region, &points) {
            panic!("{solid:?}: {text}");
        }
        // A part of a narrowed program narrows further, as a tree of blocks does it.
        if let Region::Surface(narrowed) = &region {
            let half = bounds.half_extents();
            let part = Bounds::from_center(bounds.min + random.vector(0.5, 1.5) * half, 0.5 * half);
            let points = samples(random, &part, 24);
            let again = narrowed.narrow(&part);
            if let Some(text) = contradiction(&full, &part, &again, &points) {
                panic!("{solid:?}, twice: {text}");
            }
        }
        // A program of true values narrows too.
        if let Some(text) = contradiction(&field, &bounds, &field.narrow(&bounds), &points) {
            panic!("{solid:?}, field: {text}");
        }
        let range = full.range(&bounds);
        for &p in &points {
            let value = full.value(p);
            assert!(range.contains(value), "{solid:?}: {value:e} at {p} is not in {range:?} of {bounds:?}");
        }
    }
}

#[test]
fn sound_over_random_leaves() {
    let mut random = Random::new(101);
    for _ in 0..300 {
        let leaf = random_leaf(&mut random);
        check_narrowing(&mut random, &leaf, 8);
    }
}

#[test]
fn sound_over_random_leaves_under_maps() {
    let mut random = Random::new(102);
    for _ in 0..500 {
        let solid = random_solid(&mut random, 0);
        check_narrowing(&mut random, &solid, 6);
    }
}

#[test]
fn sound_over_random_trees() {
    let mut random = Random::new(103);
    for depth in [1, 1, 2, 3] {
        for _ in 0..20 {
            let solid = random_solid(&mut random, depth);
            check_narrowing(&mut random, &solid, 6);
        }
    }
}

#[test]
fn sound_over_the_models() {
    let mut random = Random::new(104);
    for model in models::all() {
        check_narrowing(&mut random, &model.solid, 60);
    }
}

#[test]
fn sound_at_faces_and_corners() {
    // Boxes that touch the solid with a face, and points where values are exact zeros.
    let block = Solid::cuboid(DVec3::splat(2.0));
    let program =
        (&block - Solid::cuboid(DVec3::new(2.0, 2.0, 1.0)).translate(DVec3::Z * 0.5)).surface_program().unwrap();
    let mut random = Random::new(105);
    for _ in 0..2000 {
        let corner = |random: &mut Random| DVec3::from_array([0; 3].map(|_| 0.25 * random.below(13) as f64 - 1.5));
        let bounds = Bounds::from_corners(corner(&mut random), corner(&mut random));
        let points = samples(&mut random, &bounds, 24);
        if let Some(text) = contradiction(&program, &bounds, &program.narrow(&bounds), &points) {
            panic!("{text}");
        }
    }
}

/// What a walk down to the cells of a cube finds.
#[derive(Default)]
struct Walk {
    /// Cells that may hold surface, in the order of the walk.
    kept: Vec<[u32; 3]>,
    /// Cells of these with a change of sign among 5³ samples.
    crossed: usize,
    /// Leaves of the programs of the cells kept.
    leaves: usize,
}

struct Walker<'a> {
    model: &'a Model,
    across: u32,
    evaluator: Evaluator,
    found: Walk,
}

impl Walker<'_> {
    fn bounds(&self, at: [u32; 3], side: u32) -> Bounds {
        let step = 2.0 * self.model.half / f64::from(self.across);
        let corner = |at: [u32; 3]| DVec3::from_array(at.map(f64::from)) * step - DVec3::splat(self.model.half);
        Bounds::new(corner(at), corner(at.map(|i| i + side)))
    }

    fn visit(&mut self, program: &Program, at: [u32; 3], side: u32) {
        let bounds = self.bounds(at, side);
        let Region::Surface(program) = program.narrow(&bounds) else { return };
        if side > 1 {
            let half = side / 2;
            for corner in 0..8u32 {
                self.visit(&program, std::array::from_fn(|axis| at[axis] + (corner >> axis & 1) * half), half);
            }
            return;
        }
        self.found.kept.push(at);
        self.found.leaves += program.leaf_count();
        self.found.crossed += usize::from(self.is_crossed(&program, &bounds));
    }

    fn is_crossed(&mut self, program: &Program, bounds: &Bounds) -> bool {
        const SAMPLES: u32 = 5;
        let tape = Tape::new(program, bounds);
        let quarter = bounds.size().x / f64::from(SAMPLES - 1);
        let mut local: [Vec<f64>; 3] = Default::default();
        for n in 0..SAMPLES.pow(3) {
            for (axis, index) in [n % 5, n / 5 % 5, n / 25].into_iter().enumerate() {
                local[axis].push((f64::from(index) - 2.0) * quarter);
            }
        }
        let [x, y, z] = &local;
        let mut values = vec![0.0; x.len()];
        self.evaluator.values_f64(&tape, x, y, z, &mut values).unwrap();
        let inside = values[0] > 0.0;
        values.iter().any(|v| (*v > 0.0) != inside)
    }
}

fn walk(model: &Model, across: u32) -> Walk {
    let mut walker = Walker { model, across, evaluator: Evaluator::new(), found: Walk::default() };
    walker.visit(&model.solid.surface_program().unwrap(), [0; 3], across);
    walker.found
}

/// Cells kept over cells crossed, at most, for M1 to M6.
const TIGHT: [f64; 6] = [1.05, 1.05, 1.05, 1.2, 1.2, 1.3];

/// Walks all models; each must keep at most `allowed` times the cells that are crossed.
fn tightness(across: u32, allowed: [f64; 6]) {
    let walks = models::all().map(|model| {
        let found = walk(&model, across);
        (model, found)
    });
    let mut failures = Vec::new();
    for ((model, walk), allowed) in walks.iter().zip(allowed) {
        let (kept, crossed) = (walk.kept.len(), walk.crossed);
        let ratio = kept as f64 / crossed as f64;
        let leaves = walk.leaves as f64 / kept as f64;
        let line = format!(
            "{} at {across}³: {kept} kept, {crossed} crossed, ratio {ratio:.4}, {leaves:.3} leaves",
            model.name
        );
        println!("{line}");
        if ratio > allowed {
            failures.push(format!("{line}; allowed {allowed}"));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    // The rule of the joins does not matter.
    for (smooth, sharp) in [(2, 1), (4, 3)] {
        assert_eq!(walks[smooth].1.kept, walks[sharp].1.kept);
        let cost = walks[smooth].1.leaves as f64 / walks[sharp].1.leaves as f64;
        assert!(cost <= 1.1, "{cost}");
    }
}

#[test]
fn tight_on_the_models() {
    tightness(128, TIGHT);
}

#[test]
fn tight_on_lattices() {
    // Half a period at 16³: the cells are those of four periods at 128³.
    let mut failures = Vec::new();
    for (name, solid, size) in crate::lattices::lattices() {
        let model = Model { name: "lattice", half: 0.25 * size, solid };
        let found = walk(&model, 16);
        let ratio = found.kept.len() as f64 / found.crossed as f64;
        println!("{name}: {} kept, {} crossed, ratio {ratio:.4}", found.kept.len(), found.crossed);
        if ratio > 1.6 {
            failures.push(format!("{name}: {ratio}"));
        }
    }
    assert!(failures.is_empty(), "{failures:?}");
}

#[test]
fn tight_on_primitives() {
    let mut failures = Vec::new();
    for (name, solid, size) in crate::primitives::primitives() {
        let model = Model { name: "primitive", half: 1.1 * size, solid };
        let found = walk(&model, 32);
        let ratio = found.kept.len() as f64 / found.crossed as f64;
        println!("{name}: {} kept, {} crossed, ratio {ratio:.4}", found.kept.len(), found.crossed);
        if ratio > 1.1 {
            failures.push(format!("{name}: {ratio}"));
        }
    }
    assert!(failures.is_empty(), "{failures:?}");
}

#[test]
fn regions_that_are_infinite_or_empty_are_not_narrowed() {
    let program = (Solid::sphere(1.0) | Solid::cuboid(DVec3::ONE)).surface_program().unwrap();
    for bounds in [Bounds::ALL, Bounds::EMPTY, Bounds::new(DVec3::ZERO, DVec3::INFINITY)] {
        assert!(matches!(program.narrow(&bounds), Region::Surface(same) if same.leaf_count() == 2));
    }
    // A point is a region.
    let point = Bounds::new(DVec3::ZERO, DVec3::ZERO);
    assert!(matches!(program.narrow(&point), Region::Inside));
    let away = Bounds::new(DVec3::splat(2.0), DVec3::splat(2.0));
    assert!(matches!(program.narrow(&away), Region::Outside));
}

#[test]
fn only_what_is_near_is_left() {
    let solid =
        Solid::union_all((0..40).map(|i| Solid::sphere(0.6).translate(DVec3::X * f64::from(i))), Default::default());
    let program = solid.surface_program().unwrap();
    let near = Bounds::from_center(DVec3::new(20.5, 0.3, 0.0), DVec3::splat(0.1));
    match program.narrow(&near) {
        Region::Surface(narrowed) => {
            assert_eq!(narrowed.leaf_count(), 2);
            let owner = narrowed.owner(DVec3::new(20.2, 0.0, 0.0));
            assert_eq!(owner.path, "union[20] / translate / sphere");
        }
        other => panic!("{other:?}"),
    }
    assert_eq!(solid.region(&near).map(|r| matches!(r, Region::Surface(_))), Ok(true));
}

/// A ball that counts how often it is asked for a range.
#[derive(Debug)]
struct Asked(&'static AtomicUsize);

impl Field for Asked {
    fn name(&self) -> &'static str {
        "asked"
    }

    #[inline(always)]
    fn eval<R: Real>(&self, [x, y, z]: [R; 3]) -> R {
        -(x.square() + y.square() + z.square()).sqrt() + 1.0
    }

    fn bounds(&self) -> Bounds {
        Bounds::new(DVec3::NEG_ONE, DVec3::ONE)
    }

    fn check(&self) -> Result<(), ParamError> {
        Ok(())
    }

    fn range(&self, region: [Interval; 3]) -> Interval {
        self.0.fetch_add(1, Ordering::Relaxed);
        self.eval(region)
    }
}

/// What an operand has decided, those after it are not asked about.
#[test]
fn what_is_decided_is_not_asked_about() {
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    let plate = Solid::cuboid([4.0, 4.0, 1.0]);
    let solids = [
        (plate.intersection(Solid::new(Asked(&COUNT)), RFunction::MIN_MAX), DVec3::new(0.0, 0.0, 0.7)),
        (plate.union(Solid::new(Asked(&COUNT)), RFunction::MIN_MAX), DVec3::new(0.0, 0.0, 0.2)),
    ];
    for (number, (solid, decided)) in solids.iter().enumerate() {
        let program = solid.surface_program().unwrap();
        let asked = |centre: DVec3| {
            let before = COUNT.load(Ordering::Relaxed);
            let region = program.narrow(&Bounds::from_center(centre, DVec3::splat(0.1)));
            (matches!(region, Region::Surface(_)), COUNT.load(Ordering::Relaxed) - before)
        };
        assert_eq!(asked(*decided), (false, 0), "{number}");
        assert_eq!(asked(DVec3::new(0.0, 0.0, 0.5)).1, 1, "{number}");
    }
}

/// A chain of smooth joins of one kind, its operands small balls and blocks here and there.
fn chain(random: &mut Random, union: bool, links: usize, width: f64) -> Solid {
    let leaf = |random: &mut Random| {
        let size = random.range(0.1, 0.5);
        let own = if random.below(3) == 0 { Solid::cuboid(DVec3::splat(size)) } else { Solid::sphere(size) };
        own.translate(random.vector(-1.0, 1.0))
    };
    let first = if union { leaf(random) } else { Solid::cuboid([2.5; 3]) };
    (0..links).fold(first, |all, _| {
        let next = leaf(random);
        match (union, random.below(4)) {
            // The chain may go on in either operand.
            (true, 0) => next.smooth_union(&all, width),
            (true, _) => all.smooth_union(&next, width),
            (false, _) => all.smooth_difference(&next, width),
        }
    })
}

#[test]
fn chains_of_smooth_joins_keep_their_signs_to_the_bit() {
    let mut random = Random::new(106);
    let (mut surface, mut left, mut compared) = (0, 0, 0);
    for round in 0..60 {
        let (links, width) = ([3, 12, 60][round % 3], [0.02, 0.1, 0.4, 1.0][round % 4]);
        let union = random.below(2) == 0;
        let solid = chain(&mut random, union, links, width);
        let full = solid.surface_program().unwrap();
        assert_eq!(full.leaf_count(), links + 1);
        for _ in 0..30 {
            let half = [0.5, 0.1, 0.02][random.below(3)];
            let bounds = Bounds::from_center(random.vector(-1.2, 1.2), DVec3::splat(half));
            let region = full.narrow(&bounds);
            let mut points = samples(&mut random, &bounds, 20);
            // And points beside the surface: between one inside and one outside.
            for pair in 0..points.len() - 1 {
                let (mut inside, mut outside) = (points[pair], points[pair + 1]);
                if full.value(inside) > 0.0 && full.value(outside) <= 0.0 {
                    for _ in 0..50 {
                        let middle = inside.midpoint(outside);
                        *if full.value(middle) > 0.0 { &mut inside } else { &mut outside } = middle;
                    }
                    points.extend([inside, outside]);
                }
            }
            if let Some(text) = contradiction(&full, &bounds, &region, &points) {
                panic!("round {round}, width {width}: {text}");
            }
            let Region::Surface(narrowed) = &region else { continue };
            (surface, left) = (surface + links + 1, left + narrowed.leaf_count());
            for &p in &points {
                // Where the value of a union may be 0 or more, it is the same.
                let (value, own) = (full.value(p), narrowed.value(p));
                let same = if union { value >= 0.0 } else { value <= 0.0 };
                assert!(!same || value == own, "round {round}, width {width}: {value:e} became {own:e} at {p}");
                compared += u32::from(same);
            }
        }
    }
    assert!(compared > 3000 && 20 * left < 11 * surface, "{compared} points, {left} of {surface} leaves");
}
