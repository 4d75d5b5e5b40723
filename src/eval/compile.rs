//! Compiling: a graph becomes a scene, a field program and a surface program.
//!
//! One walk without recursion. A node that is reached twice with the same maps above it is
//! compiled once. Parameters are checked on the way, and boxes are put together from the
//! leaves up.

mod boxes;

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::accuracy::Accuracy;
use super::apart::{Near, Work, measure, measured, works};
use super::bevel::Bevel;
use super::chamfer::Chamfer;
use super::coat::Coat;
use super::code::{Built, Code, grow, snug};
use super::context::{Contexts, is_similarity, least_stretch};
use super::exact::Exactness;
use super::extent::extent;
use super::fill::{Fill, Side, Signed};
use super::fit::fit;
use super::flatten::flatten;
use super::moved_in::is_loose;
use super::nothing::Nothing;
use super::palette::Palette;
use super::program::{Edge, Kind, Program};
use super::scene::{Instance, Scene};
use super::sides::Sides;
use super::source::{CompileError, DistanceSource, Measured};
use super::swell::Swell;
use crate::solid::{self, Length, Operation};
use crate::{Blend, Bounds, Cancelled, ParamError, Run, Solid, SolidError};
use rvachev_field::Op;
use rvachev_field::{AnyField, AnyWarp, Placement, Rule, largest_stretch};
use rvachev_num::column_times;

/// A solid's programs.
pub(crate) struct Compiled {
    pub(crate) field: Program,
    pub(crate) surface: Program,
    pub(crate) palette: Palette,
    pub(crate) bounds: Bounds,
    /// The path to the node that makes the bounds infinite, if they are.
    pub(crate) unbounded: String,
    pub(crate) accuracy: Accuracy,
}

/// Fillets are this much smaller, in radii, so that flush faces stay as they are; and no smaller than that
/// for what measuring may be off.
const FLUSH: f64 = 1e-5;
const LARGEST_MARGIN: f64 = 1e-3;

impl Compiled {
    /// The axis along which the solid is a column without end: the one axis that its box is infinite
    /// along, where its value does not depend on it.
    pub(crate) fn flat_axis(&self) -> Option<usize> {
        if self.bounds.is_empty() || self.bounds.is_finite() {
            return None;
        }
        let size = self.bounds.size();
        let mut open = (0..3).filter(|axis| size[*axis] == f64::INFINITY);
        let axis = open.next().filter(|_| open.next().is_none())?;
        let mut part = self.bounds;
        let reach = (0..3).filter(|other| *other != axis).map(|other| size[other]).fold(0.0, f64::max);
        (part.min[axis], part.max[axis]) = (-reach, reach);
        self.surface.is_even_along(axis, &part).then_some(axis)
    }
}

/// The share of the time that the walk before compiling takes: of most solids it is less.
const PREPARING: f64 = 0.05;

/// Of the time of a compilation, what the walk through the graph takes.
const WALK: f64 = 0.6;

/// More nodes than this are not compiled.
const LIMIT: usize = 1 << 23;

/// The programs of `solid`, compiled on first use and kept with it. Surfaces that lengths and fillets
/// are measured from are made by `source`, and kept with their nodes.
pub(crate) fn compile(
    solid: &Solid,
    source: &'static dyn DistanceSource,
    run: &Run,
) -> Result<Arc<Compiled>, CompileError> {
    match kept(solid) {
        Some(kept) => Ok(kept),
        None => run.install(|| compile_anew(solid, source, run)),
    }
}

/// Compiles a solid, and before it what is compiled by itself, however deep it is.
fn compile_anew(solid: &Solid, source: &'static dyn DistanceSource, run: &Run) -> Result<Arc<Compiled>, CompileError> {
    let mut exact = Exactness::default();
    exact.add(solid, &run.stage(0.0, PREPARING))?;
    let run = &run.stage(PREPARING, 1.0);
    let works = works(solid, &exact, run)?;
    let all: f64 = works.iter().map(Work::effort).sum();
    let mut done = 0.0;
    for work in works {
        run.check()?;
        let end = done + work.effort();
        match work {
            Work::Measure(node) => measure(node, &exact, source, &run.stage(done / all, end / all))?,
            Work::Compile(part) if kept(part).is_some() => {}
            Work::Compile(part) => {
                let compiled = Compiler::new(&exact, &run.stage(done / all, end / all))
                    .compile(part)
                    .map_err(|error| of_whole(solid, &exact, run, error))?;
                let _ = part.compiled().set(Arc::new(compiled));
            }
        }
        done = end;
        run.report(done / all);
    }
    kept(solid).ok_or(CompileError::Cancelled(Cancelled))
}

/// What is wrong with a part as the solid tells it, by the path to it, where it does.
fn of_whole(solid: &Solid, exact: &Exactness, run: &Run, error: CompileError) -> CompileError {
    match Compiler::new(exact, run).compile(solid) {
        Err(whole @ CompileError::Solid(SolidError::Parameter { .. })) => whole,
        _ => error,
    }
}

/// The programs that were compiled before.
pub(super) fn kept(solid: &Solid) -> Option<Arc<Compiled>> {
    solid.compiled().get().and_then(|any| any.clone().downcast::<Compiled>().ok())
}

enum Task<'a> {
    Visit(Site<'a>),
    Finish(Site<'a>),
}

#[derive(Clone, Copy)]
struct Site<'a> {
    solid: &'a Solid,
    context: u32,
    step: u32,
}

struct Compiler<'e> {
    exact: &'e Exactness,
    run: &'e Run,
    scene: Scene,
    contexts: Contexts,
    /// Of leaves that are made of parts.
    coats: HashMap<u32, Coat>,
    built: HashMap<(u32, usize), Option<Built>>,
    code: Code,
    accuracy: Accuracy,
}

impl<'e> Compiler<'e> {
    fn new(exact: &'e Exactness, run: &'e Run) -> Compiler<'e> {
        Compiler {
            exact,
            run,
            scene: Scene::default(),
            contexts: Contexts::new(),
            coats: HashMap::new(),
            built: HashMap::new(),
            code: Code::default(),
            accuracy: Accuracy::default(),
        }
    }

    fn compile(mut self, root: &Solid) -> Result<Compiled, CompileError> {
        let step = self.scene.trail.push(root, None);
        let site = Site { solid: root, context: 0, step };
        let mut tasks = vec![Task::Visit(site)];
        let mut finished = 0.0;
        while let Some(task) = tasks.pop() {
            self.run.check()?;
            match task {
                Task::Visit(site) => self.visit(site, &mut tasks)?,
                Task::Finish(site) => {
                    let built = self.finish(site)?;
                    self.built.insert((site.context, site.solid.address()), Some(built));
                    // Of a part that is reached in several places there is more than one.
                    finished += 1.0;
                    self.run.report(WALK * (finished / self.exact.len() as f64).min(1.0));
                }
            }
        }
        let built = self.of(root, 0);
        let unbounded = self.unbounded(root, step);
        let Compiler { scene, code, coats, accuracy, run, .. } = self;
        let scene = Arc::new(scene);
        let program = |root: Edge| {
            let (nodes, operands, root) = flatten(&code, root, run)?;
            Ok::<_, Cancelled>(Program::assemble(scene.clone(), nodes, operands, root, Vec::new()))
        };
        let (field, surface) = (program(built.field)?, program(built.surface)?);
        let mut bounds = if built.sides.inside.is_empty() { Bounds::EMPTY } else { built.sides.inside };
        if !bounds.is_empty() && (!bounds.is_finite() || is_loose(&surface)) {
            bounds = extent(&surface, &bounds, run)?;
        }
        let unbounded = if bounds.is_finite() { String::new() } else { unbounded };
        let palette = Palette::new(surface.clone(), coats);
        Ok(Compiled { field, surface, palette, bounds, unbounded, accuracy })
    }

    /// The path to the node that makes the solid unbounded: down through unions to the
    /// operand at fault; an intersection none of whose operands bounds it is itself.
    fn unbounded(&mut self, root: &Solid, step: u32) -> String {
        let (mut solid, mut context, mut step) = (root.clone(), 0, step);
        loop {
            let open = |c: &Compiler, s: &Solid, context| {
                let inside = c.of(s, context).sides.inside;
                !inside.is_finite() && !inside.is_empty()
            };
            if !open(self, &solid, context) {
                return String::new();
            }
            let below = self.contexts.below(&solid, context).iter().copied();
            let down = match solid.node() {
                solid::Node::Affine { .. }
                | solid::Node::Warp { .. }
                | solid::Node::Named { .. }
                | solid::Node::Repeated { .. }
                | solid::Node::Toleranced { .. }
                | solid::Node::Swept { .. }
                | solid::Node::Painted { .. } => below.collect(),
                solid::Node::Join { operation: Operation::Union, operands, .. } => {
                    below.filter(|&(operand, inner)| open(self, &operands[operand], inner)).collect()
                }
                _ => Vec::new(),
            };
            let Some(&(operand, inner)) = down.first() else { return self.scene.trail.path(step) };
            let next = solid.node().parts()[operand].clone();
            step = self.scene.trail.push(&next, Some((step, &solid, operand)));
            (solid, context) = (next, inner);
        }
    }

    /// What an operand compiled to; visits put operands before their operators.
    fn of(&self, solid: &Solid, context: u32) -> Built {
        match self.built.get(&(context, solid.address())) {
            Some(Some(built)) => *built,
            _ => unreachable!("operands are compiled before operators"),
        }
    }

    fn visit<'a>(&mut self, site: Site<'a>, tasks: &mut Vec<Task<'a>>) -> Result<(), SolidError> {
        let key = (site.context, site.solid.address());
        if self.built.contains_key(&key) {
            return Ok(());
        }
        if self.built.len() >= LIMIT {
            return Err(SolidError::TooLarge { nodes: self.built.len(), limit: LIMIT });
        }
        self.built.insert(key, None);
        check(site.solid.node()).map_err(|e| self.parameter(site, e))?;
        let operands = site.solid.node().parts();
        if let (solid::Node::Join { .. } | solid::Node::Blend { .. }, []) = (site.solid.node(), operands) {
            return Err(SolidError::EmptyJoin { path: self.scene.trail.path(site.step) });
        }
        self.contexts.open(site.solid, site.context, self.exact, &mut self.scene);
        tasks.push(Task::Finish(site));
        for &(position, inner) in self.contexts.below(site.solid, site.context).iter().rev() {
            let operand = &operands[position];
            if self.built.contains_key(&(inner, operand.address())) {
                continue;
            }
            let step = self.scene.trail.push(operand, Some((site.step, site.solid, position)));
            tasks.push(Task::Visit(Site { solid: operand, context: inner, step }));
        }
        Ok(())
    }

    fn parameter(&self, site: Site<'_>, source: ParamError) -> SolidError {
        SolidError::Parameter { path: self.scene.trail.path(site.step), source }
    }

    /// An operand's programs by themselves, in its own coordinates.
    fn alone(&self, site: Site<'_>, operand: &Solid) -> Result<Arc<Compiled>, SolidError> {
        kept(operand).ok_or_else(|| SolidError::EmptyJoin { path: self.scene.trail.path(site.step) })
    }

    fn finish(&mut self, site: Site<'_>) -> Result<Built, CompileError> {
        let context = *self.contexts.get(site.context);
        let node = site.solid.node();
        let is_measured = measured(site.solid).is_some();
        let operand = |&(position, inner): &(usize, u32)| {
            let operand = &node.parts()[position];
            let mut built = self.of(operand, inner);
            // What is compiled by itself knows its box better.
            let context = self.contexts.get(inner);
            if let Some(programs) = kept(operand).filter(|_| is_measured && context.shift.is_none()) {
                let known = snug(programs.bounds.transformed(&context.forward));
                built.sides.inside = built.sides.inside.intersection(&known);
            }
            built
        };
        let below: Vec<Built> = self.contexts.below(site.solid, site.context).iter().map(operand).collect();
        match node {
            solid::Node::Leaf(field) => Ok(self.leaf(field, site)),
            solid::Node::Swept { .. } => {
                fit(site.solid, self.run)?.map_err(|e| self.parameter(site, e))?;
                let mut swept = below[0];
                swept.sides.inside = self.cut_to_support(site, swept.sides.inside);
                Ok(swept)
            }
            solid::Node::Affine { .. }
            | solid::Node::Named { .. }
            | solid::Node::Repeated { .. }
            | solid::Node::Toleranced { .. }
            | solid::Node::Painted { .. } => Ok(below[0]),
            solid::Node::Rim { caps, .. } => {
                let (&[slab, column], Some(size)) = (&below[..], caps.size()) else {
                    return Err(SolidError::EmptyJoin { path: self.scene.trail.path(site.step) }.into());
                };
                let rule = caps.times(context.scale).rule();
                Ok(self.code.rim(rule, size * context.scale, context.frame, [slab, column]))
            }
            solid::Node::Warp { warp, .. } => Ok(self.warped(site, warp, below[0])?),
            solid::Node::Complement(_) => Ok(below[0].complement()),
            solid::Node::Join { operation, rule, .. } => {
                let rule = Rule::from(*rule);
                Ok(match (context.shift, operation) {
                    (_, Operation::SymmetricDifference) => self.code.either(rule, context.frame, &below),
                    (None, _) => self.code.operation(*operation, rule, context.frame, &below),
                    // Its operands are not shifted: it is no min or max.
                    (Some(shift), _) if rule == Rule::Distance => {
                        let joined = self.code.operation(*operation, rule, context.frame, &below);
                        self.code.level(shift, joined)
                    }
                    (Some(_), _) => self.code.operation(*operation, Rule::MinMax, context.frame, &below),
                })
            }
            solid::Node::Length { length, .. } => {
                if self.exact.is_gone(site.solid) || measured(site.solid).is_some_and(|found| found.is_gone) {
                    // Of what is nowhere thicker than a wall, all is.
                    return Ok(if matches!(length, Length::Shell(_)) { below[0] } else { self.nothing(site) });
                }
                let by = match *length {
                    Length::Level(c) => return Ok(self.code.level(c * context.scale, below[0])),
                    Length::Offset(d) => d,
                    Length::Shell(t) => -t,
                    Length::Rounded(radius) => {
                        let fills = self.fills(site, Operation::Intersection, radius);
                        return Ok(self.filled(site, Operation::Intersection, &below, &fills));
                    }
                    Length::Filleted(radius) => {
                        let fills = self.fills(site, Operation::Union, radius);
                        return Ok(self.filled(site, Operation::Union, &below, &fills));
                    }
                };
                let is_shell = matches!(length, Length::Shell(_));
                let moved = match below.get(usize::from(is_shell)) {
                    Some(closed) => *closed,
                    None => self.measured(site, by),
                };
                if !is_shell {
                    return Ok(moved);
                }
                let wall = [below[0], moved.complement()];
                Ok(self.code.operation(Operation::Intersection, Rule::MinMax, context.frame, &wall))
            }
            solid::Node::Blend { operation, blend, .. } => Ok(self.blended(site, *operation, *blend, &below)?),
        }
    }

    fn warped(&self, site: Site<'_>, warp: &Arc<dyn AnyWarp>, inner: Built) -> Result<Built, SolidError> {
        warp.check(&inner.sides.inside).map_err(|e| self.parameter(site, e))?;
        let outward = |b: &Bounds| self.image(warp, site.context, b);
        let inside = self.cut_to_support(site, outward(&inner.sides.inside));
        // A deformation of an infinite region is not followed.
        let outside = if inner.sides.outside.is_finite() { outward(&inner.sides.outside) } else { Bounds::ALL };
        let sides = Sides { inside, outside };
        Ok(Built { sides, swell: inner.swell.mapped(outward), ..inner })
    }

    fn blended(
        &mut self,
        site: Site<'_>,
        operation: Operation,
        blend: Blend,
        below: &[Built],
    ) -> Result<Built, SolidError> {
        let context = *self.contexts.get(site.context);
        let (scale, frame) = (context.scale, context.frame);
        let op = operation.op();
        if let Blend::Fillet { radius } = blend {
            let fills = self.fills(site, operation, radius);
            return Ok(self.filled(site, operation, below, &fills));
        }
        let &[first, second] = below else {
            return Err(SolidError::EmptyJoin { path: self.scene.trail.path(site.step) });
        };
        let pair = [first, second];
        match blend {
            Blend::Smooth { radius } => {
                let width = radius * scale;
                let inside = if op == Op::Or { self.smooth_union(site, width, pair) } else { Bounds::ALL };
                Ok(self.code.smooth(operation, width, frame, pair, inside))
            }
            Blend::Displacement { height, falloff } => {
                let inverse = falloff.map(|f| 1.0 / (f * scale));
                let height = height * scale;
                // The disjunction of equal values −c is −(2 − √2) c.
                let rise = if op == Op::Or { height / (2.0 - std::f64::consts::SQRT_2) } else { height };
                let risen = self.risen(site, [rise; 2]);
                Ok(self.code.displacement(operation, height, inverse, frame, pair, risen))
            }
            Blend::Ricci { p } => {
                let [Some(first), Some(second)] = pair.map(|b| b.gauge) else {
                    let position = usize::from(pair[0].gauge.is_some());
                    return Err(SolidError::NoGauge { path: self.scene.trail.path(site.step), operand: position });
                };
                // Two gauges of 2^(1/p) make one of 1.
                let beyond = (1.0 / p).exp2() - 1.0;
                let risen = self.risen(site, [first * beyond, second * beyond]);
                Ok(self.code.ricci(operation, p, [first, second], frame, pair, risen))
            }
            Blend::Chamfer { leg } => {
                let face = self.chamfered(site, operation, leg)?;
                Ok(self.filled(site, operation, below, &face))
            }
            _ => Ok(self.code.operation(operation, Rule::MinMax, frame, below)),
        }
    }

    /// What a fillet adds between the operands of a node, or of a complement's.
    fn fills(&mut self, site: Site<'_>, operation: Operation, radius: f64) -> Vec<Built> {
        let Some(measured) = measured(site.solid) else { return Vec::new() };
        let is_union = operation == Operation::Union;
        let margin = margin(site.solid, &measured, radius);
        let ball = Signed { field: measured.field, sign: if is_union { 1.0 } else { -1.0 } };
        let solid::Node::Blend { blend, operands, .. } = site.solid.node() else {
            let whole = kept(&site.solid.node().operands()[0]).map_or(Bounds::EMPTY, |programs| programs.bounds);
            // What is taken away goes on beyond the surface: values are 0 where the new one is, and nowhere else.
            let (bounds, hull) = if is_union { (whole, whole) } else { (whole.inflate(radius), Bounds::ALL) };
            let fill = Fill::new(radius, ball, Vec::new(), margin).within(vec![bounds], hull);
            return vec![self.made(&(Arc::new(fill) as Arc<dyn AnyField>), site, 0.0)];
        };
        let near = Near::of(operation, *blend, operands);
        if near.boxes.is_empty() {
            return Vec::new();
        }
        let Near { boxes, hull, around, .. } = near;
        let side = |(number, field): (usize, &Arc<dyn AnyField>)| {
            let is_outside = is_union || operation == Operation::Difference && number > 0;
            let sign = if is_outside { -1.0 } else { 1.0 };
            Side { distance: Signed { field: field.clone(), sign }, bounds: around[number] }
        };
        let sides = measured.sides.iter().enumerate().map(side).collect();
        let fill = Fill::new(radius, ball, sides, margin).within(boxes, hull);
        vec![self.made(&(Arc::new(fill) as Arc<dyn AnyField>), site, 0.0)]
    }

    /// The face of a chamfer, cut off where a ball reaches that rolls along the operands.
    fn chamfered(&mut self, site: Site<'_>, operation: Operation, leg: f64) -> Result<Vec<Built>, SolidError> {
        let solid::Node::Blend { blend, operands, .. } = site.solid.node() else { return Ok(Vec::new()) };
        let [a, b] = [self.alone(site, &operands[0])?, self.alone(site, &operands[1])?];
        let signs = match operation {
            Operation::Union => [1.0, 1.0],
            Operation::Difference => [-1.0, 1.0],
            _ => [-1.0, -1.0],
        };
        let Some(measured) = measured(site.solid) else { return Ok(Vec::new()) };
        let steepest = [&a.surface, &b.surface].map(steepest);
        let chamfer = Chamfer { leg, steepest: steepest[0].max(steepest[1]) };
        let frame = self.contexts.get(site.context).frame;
        let near = Near::of(operation, *blend, operands);
        let Some(bounds) = near.boxes.first().copied() else { return Ok(Vec::new()) };
        let bevel: Arc<dyn AnyField> =
            Arc::new(Bevel::new([a.surface.clone(), b.surface.clone()], signs, chamfer, bounds));
        let ball =
            Signed { field: measured.field.clone(), sign: if operation == Operation::Union { 1.0 } else { -1.0 } };
        let margin = margin(site.solid, &measured, near.radius);
        let fill: Arc<dyn AnyField> =
            Arc::new(Fill::new(near.radius, ball, Vec::new(), margin).within(near.boxes, near.hull));
        let both = [self.made(&bevel, site, 0.0), self.made(&fill, site, 0.0)];
        Ok(vec![self.code.operation(Operation::Intersection, Rule::MinMax, frame, &both)])
    }

    /// A join of operands with what is added to it, or, for intersections and differences, taken away.
    fn filled(&mut self, site: Site<'_>, operation: Operation, below: &[Built], fills: &[Built]) -> Built {
        let frame = self.contexts.get(site.context).frame;
        let join = self.code.operation(operation, Rule::MinMax, frame, below);
        let all: Vec<Built> = [join].into_iter().chain(fills.iter().copied()).collect();
        let operation = if operation == Operation::Union { operation } else { Operation::Difference };
        self.code.operation(operation, Rule::MinMax, frame, &all)
    }

    fn leaf(&mut self, field: &Arc<dyn AnyField>, site: Site<'_>) -> Built {
        let shift = self.contexts.get(site.context).shift.unwrap_or(0.0);
        self.shifted(field, site, shift)
    }

    /// The surface of a length's operand as a leaf, its distance moved by `by`.
    fn measured(&mut self, site: Site<'_>, by: f64) -> Built {
        match measured(site.solid) {
            Some(Measured { field, .. }) => self.made(&field, site, by),
            None => self.nothing(site),
        }
    }

    fn nothing(&mut self, site: Site<'_>) -> Built {
        let nothing: Arc<dyn AnyField> = Arc::new(Nothing);
        self.shifted(&nothing, site, 0.0)
    }

    /// A leaf that is made of a node's operands and has their paint, its value moved by `by`.
    fn made(&mut self, field: &Arc<dyn AnyField>, site: Site<'_>, by: f64) -> Built {
        self.coats.insert(self.scene.leaves.len() as u32, Coat::of(site.solid));
        let matrix = &self.contexts.get(site.context).forward.matrix3;
        // The largest of a map that stretches all directions alike is known to the last bit.
        let stretch = if is_similarity(matrix) { least_stretch(matrix) } else { largest_stretch(matrix) };
        if let Some(measured) = measured(site.solid) {
            self.accuracy = self.accuracy.max(measured.accuracy.times(stretch));
        }
        let context = self.contexts.get(site.context);
        let shift = context.shift.unwrap_or(0.0) + by * context.scale;
        self.shifted(field, site, shift)
    }

    fn shifted(&mut self, field: &Arc<dyn AnyField>, site: Site<'_>, shift: f64) -> Built {
        let (leaf, growth) = self.place(field, site, shift);
        let inside = self.scene.leaves[leaf as usize].bounds;
        let edge = self.code.push(Kind::Leaf(leaf), &[]);
        // Another level of the values is another surface.
        let of_surface = if shift == 0.0 { field.of_surface() } else { None };
        let surface = of_surface.map_or(edge, |field| {
            let (leaf, _) = self.place(&field, site, shift);
            self.code.push(Kind::Leaf(leaf), &[])
        });
        let context = self.contexts.get(site.context);
        Built {
            field: edge,
            surface,
            sides: Sides { inside, outside: Bounds::ALL },
            swell: Swell::of(inside, growth),
            gauge: field.gauge_radius().filter(|_| context.shift.is_none()).map(|radius| radius * context.scale),
        }
    }

    /// Adds a leaf to the scene: its number, and how much its box grows per unit of value.
    fn place(&mut self, field: &Arc<dyn AnyField>, site: Site<'_>, shift: f64) -> (u32, DVec3) {
        let context = *self.contexts.get(site.context);
        let (axes, unit) = (context.forward.matrix3.abs(), field.growth());
        let growth = (0..3).map(|axis| column_times(axes.col(axis), unit[axis])).sum::<DVec3>() / context.scale;
        let mut bounds = snug(field.bounds_under(&context.forward));
        // A distance is no larger than that to the sides of the box.
        if shift > 0.0 || shift < 0.0 && field.exact() && is_similarity(&context.forward.matrix3) {
            bounds = grow(&bounds, growth * shift);
        }
        let number = self.scene.leaves.len() as u32;
        self.scene.leaves.push(Instance {
            number,
            field: field.clone(),
            frame: context.frame,
            to_local: context.to_local,
            placement: Placement::new(&context.to_local, context.scale, shift),
            bounds,
            step: site.step,
        });
        (number, growth)
    }
}

/// How much smaller a fillet of a radius is.
fn margin(solid: &Solid, measured: &Measured, radius: f64) -> f64 {
    let largest = solid.node().tolerance().unwrap_or(0.0).max(LARGEST_MARGIN * radius);
    (measured.accuracy.error + FLUSH * radius).min(largest)
}

/// How steep the values of a solid are taken to be.
fn steepest(program: &Program) -> f64 {
    if program.scene.leaves.iter().all(|leaf| leaf.field.exact() && leaf.frame == 0) { 1.0 } else { 4.0 }
}

/// What can be said about a node by itself.
fn check(node: &solid::Node) -> Result<(), ParamError> {
    match node {
        solid::Node::Leaf(field) => field.check(),
        solid::Node::Affine { forward, label, .. } => check_affine(forward, label),
        solid::Node::Join { rule, .. } => rule.check(),
        solid::Node::Blend { blend, .. } => blend.check(),
        solid::Node::Length { length, .. } => length.check(),
        solid::Node::Painted { paint, .. } => paint.check(),
        solid::Node::Toleranced { operand, tolerance, .. } => solid::check_tolerance(operand, *tolerance),
        // A deformation is checked against what it deforms, a verb's parameters where it is built.
        solid::Node::Warp { .. }
        | solid::Node::Complement(_)
        | solid::Node::Named { .. }
        | solid::Node::Repeated { .. }
        | solid::Node::Swept { .. }
        | solid::Node::Rim { .. } => Ok(()),
    }
}

fn check_affine(map: &DAffine3, label: &str) -> Result<(), ParamError> {
    const LARGEST: f64 = 1e9;
    for (axis, offset) in ["x", "y", "z"].into_iter().zip(map.translation.to_array()) {
        if offset.is_nan() || offset.abs() > LARGEST {
            let allowed = match label {
                "on_ground" | "centered" => "-1e9 to 1e9, by a solid with a finite box",
                "aligned" => "-1e9 to 1e9, by faces across the same axis of two solids with finite boxes",
                _ => "-1e9 to 1e9",
            };
            return Err(ParamError::new(format_args!("translation.{axis}"), offset, allowed));
        }
    }
    let name = match label {
        "scale" => "factor",
        "scale_axes" => "factors",
        "rotate" => "rotation",
        "rotate_about" => "axis or angle",
        label if label.starts_with("rotate_") => "angle",
        _ => "matrix",
    };
    if let Some(bad) = map.matrix3.to_cols_array().into_iter().find(|v| v.is_nan() || v.abs() > LARGEST) {
        return Err(ParamError::new(format_args!("{name} (an entry of the matrix)"), bad, "-1e9 to 1e9"));
    }
    let least = if map.matrix3.determinant() == 0.0 { 0.0 } else { least_stretch(&map.matrix3) };
    let most = 1.0 / if least > 0.0 { least_stretch(&map.matrix3.inverse()) } else { 1.0 };
    if !(least >= 1e-9 && least >= 1e-9 * most) {
        return Err(ParamError::new(
            format_args!("{name} (smallest stretch)"),
            if least.is_nan() { 0.0 } else { least },
            "at least 1e-9, and at least 1e-9 of the largest (the map must be invertible)",
        ));
    }
    Ok(())
}
