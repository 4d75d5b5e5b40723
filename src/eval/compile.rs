//! Compiling: a graph becomes a scene, a field program and a surface program.
//!
//! One walk without recursion. A node that is reached twice with the same maps above it is
//! compiled once. Parameters are checked on the way, and boxes are put together from the
//! leaves up.

mod blends;
mod boxes;
mod check;
mod leaves;

use std::collections::HashMap;
use std::sync::{Arc, OnceLock};

use glam::DVec3;

use super::accuracy::Accuracy;
use super::apart::{Work, is_blended, measure, measured, works};
use super::coat::Coat;
use super::code::{Built, Code, snug};
use super::context::Contexts;
use super::exact::{Exact, Exactness};
use super::extent::extent;
use super::fit::fit;
use super::flatten::flatten;
use super::local::Boxes;
use super::moved_in::is_loose;
use super::palette::Palette;
use super::program::{Edge, Program};
use super::scene::Scene;
use super::sides::Sides;
use super::source::{CompileError, DistanceSource, Measured};
use crate::solid::{self, Length, Operation};
use crate::{Bounds, Cancelled, Dual, Interval, ParamError, Run, Solid, SolidError};
use rvachev_field::{AnyWarp, Rule};

/// A solid's programs.
pub(crate) struct Compiled {
    pub(crate) field: Program,
    pub(crate) surface: Program,
    pub(crate) palette: Palette,
    /// What the parts tell of the box, and the box once it was asked for.
    told: Bounds,
    bounds: OnceLock<Bounds>,
    /// The path to the node that makes the bounds infinite, if they are: it tells of none.
    pub(crate) unbounded: String,
    pub(crate) accuracy: Accuracy,
    exact: Exact,
}

impl Compiled {
    /// A box that holds the solid. Where its parts do not tell it, it is found on first use.
    pub(crate) fn bounds(&self) -> Bounds {
        match self.bounds_with(&Run::default()) {
            Ok(bounds) => bounds,
            Err(Cancelled) => unreachable!("nobody has the token"),
        }
    }

    /// The same by a run, which may be cancelled.
    pub(crate) fn bounds_with(&self, run: &Run) -> Result<Bounds, Cancelled> {
        if let Some(bounds) = self.bounds.get() {
            return Ok(*bounds);
        }
        let is_known = self.told.is_empty() || self.told.is_finite() && !is_loose(&self.surface);
        let bounds = if is_known { self.told } else { extent(&self.surface, &self.told, run)? };
        Ok(*self.bounds.get_or_init(|| bounds))
    }

    /// The point of the surface that is nearest to one where the value is the true distance: along
    /// the gradient. None elsewhere, and at the surface, where a value of 0 may also be that of a
    /// face between parts.
    pub(crate) fn foot(&self, p: DVec3) -> Option<DVec3> {
        /// How far off the surface a foot may be, in parts of the size.
        const OFF: f64 = 1e-10;
        let least = OFF * self.bounds().longest_side();
        let (value, slope) = self.surface.gradient(p);
        let is_exact = if value > 0.0 { self.exact.inside } else { self.exact.outside };
        if !is_exact || value.abs() <= least {
            return None;
        }
        let foot = p - value * slope.normalize_or_zero();
        (self.surface.value(foot).abs() <= least).then_some(foot)
    }

    /// On how many sides of the surface, inside and outside, the value is the distance.
    pub(crate) fn exact_sides(&self) -> usize {
        usize::from(self.exact.inside) + usize::from(self.exact.outside)
    }

    /// By how much a point moves along each axis at most when it moves by 1 straight away from the
    /// surface, within a box outside of the solid.
    pub(super) fn outwards(&self, bounds: &Bounds) -> DVec3 {
        if !self.exact.outside || !bounds.is_finite() || bounds.is_empty() {
            return DVec3::ONE;
        }
        let hull = [0, 1, 2].map(|axis| Interval::new(bounds.min[axis], bounds.max[axis]));
        let slopes = self.surface.evaluate(Dual::point(hull), &mut Vec::new()).gradient();
        DVec3::from_array(slopes.map(|slope| slope.magnitude().min(1.0)))
    }

    /// The axis along which the solid is a column without end: the one axis that its box is
    /// infinite along, where its value does not depend on it.
    pub(crate) fn flat_axis(&self) -> Option<usize> {
        let mut part = self.bounds();
        if part.is_empty() || part.is_finite() {
            return None;
        }
        let size = part.size();
        let mut open = (0..3).filter(|axis| size[*axis] == f64::INFINITY);
        let axis = open.next().filter(|_| open.next().is_none())?;
        let reach = (0..3).filter(|other| *other != axis).map(|other| size[other]).fold(0.0, f64::max);
        (part.min[axis], part.max[axis]) = (-reach, reach);
        self.surface.is_even_along(axis, &part).then_some(axis)
    }
}

/// The share of the time that the walk before compiling takes: of most solids it is less.
const PREPARING: f64 = 0.05;

/// Of the time of a compilation, what the walk through the graph takes; the rest goes to the box.
const WALK: f64 = 0.6;

/// More nodes than this are not compiled.
const LIMIT: usize = 1 << 23;

/// The programs of `solid`, compiled on first use and kept with it. Surfaces that lengths and
/// fillets are measured from are made by `source`, and kept with their nodes.
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

/// The same, and its box is found.
pub(crate) fn compile_and_bound(
    solid: &Solid,
    source: &'static dyn DistanceSource,
    run: &Run,
) -> Result<Arc<Compiled>, CompileError> {
    let [to_compile, to_bound] = run.stages([WALK, 1.0 - WALK]);
    let programs = compile(solid, source, &to_compile)?;
    programs.bounds_with(&to_bound)?;
    Ok(programs)
}

/// Compiles a solid, and before it what is compiled by itself, however deep it is.
fn compile_anew(solid: &Solid, source: &'static dyn DistanceSource, run: &Run) -> Result<Arc<Compiled>, CompileError> {
    let mut exact = Exactness::default();
    exact.add(solid, &run.stage(0.0, PREPARING))?;
    let run = &run.stage(PREPARING, 1.0);
    let works = works(vec![solid], &exact, run)?;
    let mut workshop = Workshop { whole: solid, exact, boxes: Boxes::default(), locals: Vec::new(), source };
    workshop.work_off(&works, run)?;
    kept(solid).ok_or(CompileError::Cancelled(Cancelled))
}

/// Where the parts of a solid are compiled and measured.
struct Workshop<'a> {
    whole: &'a Solid,
    exact: Exactness,
    boxes: Boxes,
    /// What of blends is near their joints: what is known of nodes is kept as long as they are.
    locals: Vec<Solid>,
    source: &'static dyn DistanceSource,
}

impl Workshop<'_> {
    fn work_off(&mut self, works: &[Work<'_>], run: &Run) -> Result<(), CompileError> {
        let all: f64 = works.iter().map(Work::effort).sum();
        let mut done = 0.0;
        for work in works {
            run.check()?;
            let end = done + work.effort();
            let stage = run.stage(done / all, end / all);
            match *work {
                Work::Measure(node) if is_blended(node) => self.blend(node, &stage)?,
                Work::Measure(node) => measure(node, &self.exact, self.source, &stage)?,
                Work::Compile(part) => self.compile(part, &stage)?,
            }
            done = end;
            run.report(done / all);
        }
        Ok(())
    }

    fn compile(&self, part: &Solid, run: &Run) -> Result<(), CompileError> {
        let [to_walk, to_bound] = run.stages([WALK, 1.0 - WALK]);
        if kept(part).is_none() {
            let compiled = Compiler::new(&self.exact, &to_walk)
                .compile(part)
                .map_err(|error| of_whole(self.whole, &self.exact, run, error))?;
            let _ = part.compiled().set(Arc::new(compiled));
        }
        // What is made of it asks for its box.
        if let Some(programs) = kept(part).filter(|_| part.address() != self.whole.address()) {
            programs.bounds_with(&to_bound)?;
        }
        Ok(())
    }

    /// Measures what is between the operands of a blend, whose own blends have been measured, from
    /// what of them is near the joint.
    fn blend(&mut self, node: &Solid, run: &Run) -> Result<(), CompileError> {
        if measured(node).is_some() {
            return Ok(());
        }
        let Some(local) = self.boxes.local(node, run)? else { return Ok(()) };
        self.locals.push(local.clone());
        self.exact.add(&local, run)?;
        let parts = local.node().operands().iter().chain(local.node().ball()).collect();
        let [to_work, to_measure] = run.stages([0.5, 0.5]);
        self.work_off(&works(parts, &self.exact, run)?, &to_work)?;
        measure(&local, &self.exact, self.source, &to_measure)?;
        if let Some(found) = measured(&local).filter(|_| local.address() != node.address()) {
            let _ = node.measured().set(Arc::new(Measured { local: Some(local), ..found }));
        }
        Ok(())
    }
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
                    self.run.report((finished / self.exact.len() as f64).min(1.0));
                }
            }
        }
        let built = self.of(root, 0);
        let unbounded = self.unbounded(root, step);
        let exact = self.exact.of(root);
        let Compiler { scene, code, coats, accuracy, run, .. } = self;
        let scene = Arc::new(scene);
        let program = |root: Edge| {
            let (nodes, operands, root) = flatten(&code, root, run)?;
            Ok::<_, Cancelled>(Program::assemble(scene.clone(), nodes, operands, root, Vec::new()))
        };
        let (field, surface) = (program(built.field)?, program(built.surface)?);
        let told = if built.sides.inside.is_empty() { Bounds::EMPTY } else { built.sides.inside };
        let palette = Palette::new(surface.clone(), coats);
        Ok(Compiled { field, surface, palette, told, bounds: OnceLock::new(), unbounded, accuracy, exact })
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
        check::check_node(site.solid.node()).map_err(|e| self.parameter(site, e))?;
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
            if let Some(programs) = kept(operand).filter(|_| is_measured && context.moved.is_none()) {
                let known = snug(programs.bounds().transformed(&context.forward));
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
                Ok(match (context.moved, operation) {
                    (_, Operation::SymmetricDifference) => self.code.either(rule, context.frame, &below),
                    (None, _) => self.code.operation(*operation, rule, context.frame, &below),
                    // Its operands are not shifted: it is no min or max.
                    (Some(moved), _) if rule == Rule::Distance => {
                        let joined = self.code.operation(*operation, rule, context.frame, &below);
                        let inner = self.contexts.below(site.solid, site.context).first().map(|(_, inner)| *inner);
                        let done = inner.and_then(|inner| self.contexts.get(inner).moved).unwrap_or_default();
                        self.code.level(moved.level() + done.depth + context.level, joined)
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
                    Length::Rounded(_) | Length::Filleted(_) if self.exact.is_closed(site.solid) => {
                        return Ok(below[0]);
                    }
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
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::distance::{compiled, compiled_with};
    use crate::rad;

    #[test]
    fn values_do_not_wait_for_the_box() {
        let bent = || Solid::superellipsoid([0.5, 0.7, 2.0], 0.4, 0.6).twist(rad(0.6)).bend(0.3, rad(0.5));
        let knows_box = |solid: &Solid| kept(solid).is_some_and(|programs| programs.bounds.get().is_some());
        let solid = bent();
        assert!(solid.value(DVec3::ZERO).unwrap() > 0.0 && !knows_box(&solid));
        let box_of = solid.bounds().unwrap();
        assert!(knows_box(&solid) && box_of == compiled_with(&bent(), &Run::default()).unwrap().bounds());
        // What is made of it finds it by its own run, also if it was compiled before.
        let solid = bent();
        compiled(&solid).unwrap();
        compiled(&solid.offset(0.1)).unwrap();
        assert!(knows_box(&solid));
        let run = Run::default();
        run.cancel.cancel();
        let solid = bent();
        compiled(&solid).unwrap();
        assert!(compiled_with(&solid, &run).is_err() && !knows_box(&solid));
    }
}
