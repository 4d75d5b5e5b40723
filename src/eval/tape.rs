//! Bulk evaluation: a program made ready for a region, run over chunks of points.
//!
//! Points are given relative to the region's centre, in single precision. The maps of leaves
//! are rebased to that origin in double precision, so a small solid far from the origin of
//! coordinates is evaluated as accurately as one at it.

mod evaluator;
mod open;
mod rivals;
mod seen;
mod slices;

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use self::evaluator::Memory;
pub use self::evaluator::{Evaluator, Gradients};
use self::open::Open;
use self::rivals::Rivals;
use self::seen::Seen;
pub use self::slices::UnequalSlices;
use super::program::Program;
use super::register::{Guard, Step, schedule};
use crate::Bounds;
use rvachev_field::Op;
use rvachev_field::kernel::{CHUNK, Element};
use rvachev_field::{
    AnyField, AnyWarp, COORDINATE_LIMIT, Chunk, Joinable, Placement, Rule, VALUE_LIMIT, Zone, product, pull,
};

/// A program ready for bulk evaluation over a region: immutable, shared between threads;
/// each thread brings its own [`Evaluator`].
///
/// ```
/// use rvachev::program::{Evaluator, Tape};
/// use rvachev::{Bounds, Solid};
/// use glam::DVec3;
///
/// let program = Solid::sphere(2.0).field_program()?;
/// let region = Bounds::new(DVec3::new(0.0, -1.0, -1.0), DVec3::new(2.0, 1.0, 1.0));
/// let tape = Tape::new(&program, &region);
/// // Points are relative to the region's centre, here (1, 0, 0).
/// let (x, zero) = ([0.0, 0.5, 2.0], [0.0; 3]);
/// let mut values = [0.0; 3];
/// Evaluator::new().values(&tape, &x, &zero, &zero, &mut values)?;
/// assert_eq!(values, [1.0, 0.5, -1.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Tape {
    frames: Vec<FrameStep>,
    leaves: Vec<LeafStep>,
    steps: Vec<Step>,
    guards: Vec<Guard>,
    registers: usize,
    result: u32,
    origin: DVec3,
    roundoff: f64,
    rivals: Option<Rivals>,
    /// Whether the value is a min or max of those of leaves, negated or not: nothing else is done
    /// to them.
    is_choice: bool,
}

/// A deformation to run: from the points in slot `from` to those in the next slot.
#[derive(Clone)]
struct FrameStep {
    from: usize,
    placement: Placement,
    warp: Arc<dyn AnyWarp>,
}

#[derive(Clone)]
struct LeafStep {
    /// Its place among those of the scene.
    leaf: u32,
    slot: usize,
    placement: Placement,
    field: Arc<dyn AnyField>,
}

impl Tape {
    /// `program` for points in `region`; for an infinite region the origin is that of
    /// coordinates.
    #[must_use]
    pub fn new(program: &Program, region: &Bounds) -> Tape {
        let origin = if region.is_finite() && !region.is_empty() { region.center() } else { DVec3::ZERO };
        let extent = if region.is_finite() && !region.is_empty() { region.half_extents() } else { DVec3::INFINITY };
        let world = Zone::of_bounds(&Bounds::new(origin - extent, origin + extent));
        let rebase = DAffine3::from_translation(origin);
        // Slot 0 is the world; slot i + 1 the frame number i of the live ones.
        let slot_of = |frame: u32| program.frames.binary_search(&frame).map_or(0, |slot| slot + 1);
        let placed = |frame: u32, to_local: &DAffine3, of: &Placement| {
            let map = if slot_of(frame) == 0 { *to_local * rebase } else { *to_local };
            Placement::new(&map, of.scale, of.shift)
        };
        let mut seen = vec![Seen::world(world)];
        let mut frames = Vec::new();
        for frame in program.frames.iter().filter_map(|&number| program.scene.frame(number)) {
            let from = slot_of(frame.parent);
            frames.push(FrameStep {
                from,
                placement: placed(frame.parent, &frame.to_local, &Placement::IDENTITY),
                warp: frame.warp.clone(),
            });
            seen.push(seen[from].through(&frame.to_local, &*frame.warp));
        }
        let plan = schedule(program);
        let mut leaves = Vec::with_capacity(plan.steps.len());
        let mut roundoff = 0.0f64;
        let mut steps = plan.steps;
        for step in &mut steps {
            let Step::Leaf { leaf, .. } = step else { continue };
            let instance = program.instance(*leaf);
            let slot = slot_of(instance.frame);
            let Placement { scale, shift, .. } = instance.placement;
            let error = seen[slot].leaf_error(&instance.to_local, &*instance.field) * scale + 1e-7 * shift.abs();
            roundoff = roundoff.max(error);
            let place = std::mem::replace(leaf, leaves.len() as u32);
            leaves.push(LeafStep {
                leaf: place,
                slot,
                placement: placed(instance.frame, &instance.to_local, &instance.placement),
                field: instance.field.clone(),
            });
        }
        let rivals = Rivals::of(program, leaves.len());
        let is_choice = !steps.iter().any(|step| {
            matches!(step, Step::Shift { .. }) || matches!(step, Step::Fold { rule, .. } if *rule != Rule::MinMax)
        });
        let (guards, registers, result) = (plan.guards, plan.registers, plan.result);
        Tape { frames, leaves, steps, guards, registers, result, origin, roundoff, rivals, is_choice }
    }

    /// The bytes that it takes.
    pub(crate) fn bytes(&self) -> usize {
        let rivals = self.rivals.as_ref().map_or(0, Rivals::bytes);
        size_of_val(&*self.frames)
            + size_of_val(&*self.leaves)
            + size_of_val(&*self.steps)
            + size_of_val(&*self.guards)
            + rivals
    }

    /// What points are relative to.
    #[must_use]
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Makes points relative to another origin.
    pub(crate) fn recentre(&mut self, origin: DVec3) {
        let by = DAffine3::from_translation(origin - self.origin);
        let moved = |of: &Placement| Placement::new(&(of.map() * by), of.scale, of.shift);
        for frame in self.frames.iter_mut().filter(|frame| frame.from == 0) {
            frame.placement = moved(&frame.placement);
        }
        for leaf in self.leaves.iter_mut().filter(|leaf| leaf.slot == 0) {
            leaf.placement = moved(&leaf.placement);
        }
        self.origin = origin;
    }

    /// Becomes a copy of another tape, relative to another origin, in memory that it has. It has no
    /// rivals: they are of no use for gradients.
    pub(crate) fn become_recentred(&mut self, other: &Tape, origin: DVec3) {
        let (mut frames, mut leaves) = (std::mem::take(&mut self.frames), std::mem::take(&mut self.leaves));
        let (mut steps, mut guards) = (std::mem::take(&mut self.steps), std::mem::take(&mut self.guards));
        frames.clone_from(&other.frames);
        leaves.clone_from(&other.leaves);
        steps.clone_from(&other.steps);
        guards.clone_from(&other.guards);
        *self = Tape { frames, leaves, steps, guards, rivals: None, ..*other };
        self.recentre(origin);
    }

    /// Where a single-precision value of a surface program is larger than this in absolute
    /// value, its sign is that of the true value, for points of the region.
    #[must_use]
    pub fn roundoff(&self) -> f64 {
        self.roundoff
    }
}

/// What a chunk is evaluated to: `N` numbers a point in a register, and, behind a
/// deformation, `COORDINATES` numbers a point in a slot.
trait Mode<const N: usize> {
    type E: Element;
    const COORDINATES: usize;
    /// Values beyond the band may be nearer to 0, not nearer than the band.
    fn leaf(leaf: &LeafStep, band: f64, points: Points<'_, Self::E>, own: &mut [Self::E], out: [&mut [Self::E]; N]);
    fn frame(frame: &FrameStep, points: Points<'_, Self::E>, own: &mut [Self::E], out: &mut [Self::E]);
    fn join(op: Op, rule: Rule, negate: bool, all: [&mut [Self::E]; N], next: [&[Self::E]; N]);
}

/// Points of a chunk: three slices, or a slot behind a deformation and how many of its points
/// count.
enum Points<'a, E> {
    World([&'a [E]; 3]),
    Slot(&'a [E], usize),
}

/// The first `size` of a chunk each.
fn split<E, const K: usize>(slot: &[E], size: usize) -> [&[E]; K] {
    std::array::from_fn(|i| &slot[i * CHUNK..i * CHUNK + size])
}

fn split_mut<E, const K: usize>(slot: &mut [E], size: usize) -> [&mut [E]; K] {
    let mut rest = slot;
    std::array::from_fn(|_| {
        let (head, tail) = std::mem::take(&mut rest).split_at_mut(CHUNK);
        rest = tail;
        &mut head[..size]
    })
}

impl<'a, E> Points<'a, E> {
    fn size(&self) -> usize {
        match self {
            Points::World([x, ..]) => x.len(),
            Points::Slot(_, size) => *size,
        }
    }

    fn coordinates(&self) -> [&'a [E]; 3] {
        match self {
            Points::World(points) => *points,
            Points::Slot(slot, size) => split(slot, *size),
        }
    }
}

struct Values<E>(std::marker::PhantomData<E>);

impl Mode<1> for Values<f32> {
    type E = f32;
    const COORDINATES: usize = 3;

    fn leaf(leaf: &LeafStep, band: f64, points: Points<'_, f32>, _own: &mut [f32], out: [&mut [f32]; 1]) {
        let chunk = Chunk { points: points.coordinates(), placement: &leaf.placement, out };
        if band == f64::INFINITY { leaf.field.lanes32(chunk) } else { leaf.field.lanes32_within(chunk, band) }
    }

    fn join(op: Op, rule: Rule, negate: bool, all: [&mut [f32]; 1], next: [&[f32]; 1]) {
        Joinable::join(op, rule, negate, all, next);
    }

    fn frame(frame: &FrameStep, points: Points<'_, f32>, _own: &mut [f32], out: &mut [f32]) {
        let out = split_mut(out, points.size());
        frame.warp.lanes32(Chunk { points: points.coordinates(), placement: &frame.placement, out });
    }
}

impl Mode<1> for Values<f64> {
    type E = f64;
    const COORDINATES: usize = 3;

    fn leaf(leaf: &LeafStep, _band: f64, points: Points<'_, f64>, _own: &mut [f64], out: [&mut [f64]; 1]) {
        leaf.field.lanes64(Chunk { points: points.coordinates(), placement: &leaf.placement, out });
    }

    fn join(op: Op, rule: Rule, negate: bool, all: [&mut [f64]; 1], next: [&[f64]; 1]) {
        Joinable::join(op, rule, negate, all, next);
    }

    fn frame(frame: &FrameStep, points: Points<'_, f64>, _own: &mut [f64], out: &mut [f64]) {
        let out = split_mut(out, points.size());
        frame.warp.lanes64(Chunk { points: points.coordinates(), placement: &frame.placement, out });
    }
}

struct Slopes;

impl Mode<4> for Slopes {
    type E = f32;
    const COORDINATES: usize = 12;

    fn leaf(leaf: &LeafStep, _band: f64, points: Points<'_, f32>, own: &mut [f32], out: [&mut [f32]; 4]) {
        let chunk = Chunk { points: points.coordinates(), placement: &leaf.placement, out };
        let Points::Slot(slot, size) = points else { return leaf.field.gradients(chunk) };
        let [value, dx, dy, dz] = chunk.out;
        leaf.field.gradients(Chunk { out: split_mut(own, size), ..chunk });
        let [v, x, y, z] = split(own, size);
        value.copy_from_slice(v);
        let [a, b, c, d, e, f, g, h, i] = split::<_, 9>(&slot[3 * CHUNK..], size);
        pull([a, b, c, d, e, f, g, h, i, x, y, z], [dx, dy, dz]);
    }

    fn join(op: Op, rule: Rule, negate: bool, all: [&mut [f32]; 4], next: [&[f32]; 4]) {
        Joinable::join(op, rule, negate, all, next);
    }

    fn frame(frame: &FrameStep, points: Points<'_, f32>, own: &mut [f32], out: &mut [f32]) {
        let size = points.size();
        let chunk = Chunk { points: points.coordinates(), placement: &frame.placement, out: split_mut(out, size) };
        let Points::Slot(slot, _) = points else { return frame.warp.jacobians(chunk) };
        let [x, y, z, jacobian @ ..] = chunk.out;
        frame.warp.jacobians(Chunk { out: split_mut(own, size), ..chunk });
        let local = split::<_, 12>(own, size);
        for (to, from) in [x, y, z].into_iter().zip(local) {
            to.copy_from_slice(from);
        }
        let above = split::<_, 9>(&slot[3 * CHUNK..], size);
        let both = std::array::from_fn(|i| if i < 9 { local[i + 3] } else { above[i - 9] });
        product(both, jacobian);
    }
}

/// Balls in which no value is above 0: radii, and middles. Of one leaf in the world.
struct Balls;

impl Mode<4> for Balls {
    type E = f32;
    const COORDINATES: usize = 3;

    fn leaf(leaf: &LeafStep, _band: f64, points: Points<'_, f32>, _own: &mut [f32], out: [&mut [f32]; 4]) {
        let chunk = Chunk { points: points.coordinates(), placement: &leaf.placement, out };
        match leaf.field.empty_balls() {
            Some(field) => field.empty_balls(chunk),
            None => chunk.out.into_iter().for_each(|list| list.fill(0.0)),
        }
    }

    fn join(_op: Op, _rule: Rule, _negate: bool, _all: [&mut [f32]; 4], _next: [&[f32]; 4]) {}

    fn frame(_frame: &FrameStep, _points: Points<'_, f32>, _own: &mut [f32], _out: &mut [f32]) {}
}

fn execute<M: Mode<N>, const N: usize>(
    tape: &Tape,
    memory: &mut Memory<M::E>,
    (far, band): (&[bool], f64),
    points: [&[M::E]; 3],
    mut out: [&mut [M::E]; N],
) {
    let band = if tape.is_choice { band } else { f64::INFINITY };
    let count = points.iter().map(|p| p.len()).chain(out.iter().map(|o| o.len())).min().unwrap_or(0);
    let zero = M::E::default();
    memory.registers.resize(memory.registers.len().max(tape.registers * N * CHUNK), zero);
    memory.slots.resize(memory.slots.len().max(tape.frames.len() * M::COORDINATES * CHUNK), zero);
    memory.padded.resize(3 * CHUNK, zero);
    memory.own.resize(memory.own.len().max(M::COORDINATES * CHUNK), zero);
    let Memory { registers, slots, padded, own } = memory;
    let limit = M::E::from_f64(COORDINATE_LIMIT);
    let granule = M::E::widest();
    let mut at = 0;
    while at < count {
        let len = CHUNK.min(count - at);
        let size = len.next_multiple_of(granule);
        let mut world = points.map(|p| &p[at..at + len]);
        let near = world.iter().all(|axis| M::E::within(axis, limit));
        if len < size || !near {
            // The tail is padded with copies of its last point; coordinates are held.
            for (to, from) in split_mut::<_, 3>(padded, size).into_iter().zip(world) {
                let (head, tail) = to.split_at_mut(len);
                head.copy_from_slice(from);
                tail.fill(from[len - 1]);
                if !near {
                    to.iter_mut().for_each(|c| *c = held(*c));
                }
            }
            world = split::<_, 3>(padded, size);
        }
        chunk::<M, N>((tape, far, band), world, registers, slots, own);
        let result = &registers[tape.result as usize * N * CHUNK..][..N * CHUNK];
        for (to, from) in out.iter_mut().zip(split::<_, N>(result, len)) {
            to[at..at + len].copy_from_slice(from);
        }
        at += len;
    }
}

fn chunk<M: Mode<N>, const N: usize>(
    (tape, far, band): (&Tape, &[bool], f64),
    world: [&[M::E]; 3],
    registers: &mut [M::E],
    slots: &mut [M::E],
    own: &mut [M::E],
) {
    let coordinates = M::COORDINATES * CHUNK;
    let size = world[0].len();
    for (number, frame) in tape.frames.iter().enumerate() {
        let (before, after) = slots.split_at_mut(number * coordinates);
        let points = match frame.from {
            0 => Points::World(world),
            slot => Points::Slot(&before[(slot - 1) * coordinates..slot * coordinates], size),
        };
        M::frame(frame, points, own, &mut after[..coordinates]);
    }
    let width = N * CHUNK;
    for step in &tape.steps {
        match *step {
            Step::Leaf { leaf, to, .. } if far.get(leaf as usize) == Some(&true) => {
                registers[to as usize * width..][..size].fill(M::E::from_f64(-VALUE_LIMIT));
            }
            Step::Leaf { leaf, to, guards: [first, last] } => {
                let leaf = &tape.leaves[leaf as usize];
                let points = match leaf.slot {
                    0 => Points::World(world),
                    slot => Points::Slot(&slots[(slot - 1) * coordinates..slot * coordinates], size),
                };
                let guards = &tape.guards[first as usize..last as usize];
                if N == 1 && band < f64::INFINITY && !guards.is_empty() {
                    let open = Open::of(guards, band, &*registers, size);
                    if open.is_few(size) {
                        open.leaf::<M, N>(
                            (leaf, band),
                            points.coordinates(),
                            own,
                            &mut registers[to as usize * width..][..size],
                        );
                        continue;
                    }
                }
                M::leaf(leaf, band, points, own, split_mut(&mut registers[to as usize * width..][..width], size));
            }
            Step::Fold { op, rule, negate, from, to } => {
                let (all, next) = two(registers, to as usize * width, from as usize * width, width);
                M::join(op, rule, negate, split_mut(all, size), split(next, size));
            }
            Step::Copy { from, to } => {
                let (copy, of) = two(registers, to as usize * width, from as usize * width, width);
                for (copy, of) in split_mut::<_, N>(copy, size).into_iter().zip(split::<_, N>(of, size)) {
                    copy.copy_from_slice(of);
                }
            }
            Step::Negate { register } => {
                for list in split_mut::<_, N>(&mut registers[register as usize * width..][..width], size) {
                    list.iter_mut().for_each(|v| *v = M::E::negated(*v));
                }
            }
            Step::Shift { register, by } => {
                // Of a value with its slopes, the value alone.
                for v in &mut registers[register as usize * width..][..size] {
                    *v = v.plus(M::E::from_f64(by));
                }
            }
        }
    }
}

/// Two different ranges of one slice.
fn two<E>(all: &mut [E], a: usize, b: usize, len: usize) -> (&mut [E], &[E]) {
    if a < b {
        let (head, tail) = all.split_at_mut(b);
        (&mut head[a..a + len], &tail[..len])
    } else {
        let (head, tail) = all.split_at_mut(a);
        (&mut tail[..len], &head[b..b + len])
    }
}

/// A coordinate held within the limit; NaN becomes the limit.
fn held<E: Element>(c: E) -> E {
    let (low, high) = (E::from_f64(-COORDINATE_LIMIT), E::from_f64(COORDINATE_LIMIT));
    if c < low {
        low
    } else if c <= high {
        c
    } else {
        high
    }
}

impl std::fmt::Debug for Tape {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Tape({} leaves, {} registers)", self.leaves.len(), self.registers)
    }
}

impl std::fmt::Debug for Evaluator {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Evaluator")
    }
}
