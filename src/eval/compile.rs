//! Compiling: a graph becomes a scene, a field program and a surface program.
//!
//! One walk without recursion. A node that is reached twice with the same maps above it is
//! compiled once. Parameters are checked on the way, and boxes are put together from the
//! leaves up.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DAffine3, DMat3};

use super::flatten::flatten;
use super::program::{Edge, Node, Op, Program, Sides};
use super::scene::{Frame, Instance, Scene};
use crate::field::{AnyField, AnyWarp, Placement, Rule, smallest_stretch};
use crate::solid::{self, Operation};
use crate::{Bounds, ParamError, Solid, SolidError};

/// A solid's programs.
pub(crate) struct Compiled {
    pub(crate) field: Program,
    pub(crate) surface: Program,
    pub(crate) bounds: Bounds,
    /// The path to the node that makes the bounds infinite, if they are.
    pub(crate) unbounded: String,
}

/// More nodes than this are not compiled.
const LIMIT: usize = 1 << 23;

/// The programs of `solid`, compiled on first use and kept with it.
pub(crate) fn compiled(solid: &Solid) -> Result<Arc<Compiled>, SolidError> {
    let kept = solid.compiled();
    if let Some(kept) = kept.get().and_then(|any| any.clone().downcast::<Compiled>().ok()) {
        return Ok(kept);
    }
    let fresh = Arc::new(Compiler::default().compile(solid)?);
    let _ = kept.set(fresh.clone());
    Ok(fresh)
}

/// The maps above a node.
#[derive(Clone, Copy)]
struct Context {
    frame: u32,
    /// From the frame to the node's coordinates, and back.
    to_local: DAffine3,
    forward: DAffine3,
    /// Product of the smallest stretches.
    scale: f64,
}

/// What a node compiled to.
#[derive(Clone, Copy)]
struct Built {
    field: Edge,
    surface: Edge,
    /// In the frame of the node's context.
    sides: Sides,
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

#[derive(Default)]
struct Compiler {
    scene: Scene,
    contexts: Vec<Context>,
    context_of: HashMap<(u32, usize), u32>,
    built: HashMap<(u32, usize), Option<Built>>,
    field: Code,
    surface: Code,
}

/// A program under construction.
#[derive(Default)]
pub(super) struct Code {
    pub(super) nodes: Vec<Node>,
    pub(super) operands: Vec<Edge>,
    /// Where each operand decides anything, in the frame of its join.
    pub(super) decisive: Vec<Bounds>,
}

/// An operand of a join, and where it is.
#[derive(Clone, Copy)]
struct Operand {
    edge: Edge,
    sides: Sides,
}

impl Operand {
    fn flip_if(self, negate: bool) -> Operand {
        Operand { edge: self.edge.flip_if(negate), sides: self.sides.flip_if(negate) }
    }
}

impl Code {
    fn push(&mut self, node: Node) -> Edge {
        self.nodes.push(node);
        Edge::new(self.nodes.len() - 1)
    }

    fn join(&mut self, op: Op, rule: Rule, frame: u32, operands: &[Operand]) -> Operand {
        if let [only] = operands {
            return *only;
        }
        let first = self.operands.len() as u32;
        self.operands.extend(operands.iter().map(|o| o.edge));
        self.decisive.extend(operands.iter().map(|o| o.sides.decisive(op)));
        let sides = operands.iter().map(|o| o.sides).reduce(|a, b| a.join(op, b)).unwrap_or_default();
        let len = operands.len() as u32;
        Operand { edge: self.push(Node::Join { op, rule, first, len, frame, hierarchy: None }), sides }
    }

    /// Joins many operands: at once if the order does not matter, else as a balanced tree.
    fn join_all(&mut self, op: Op, rule: Rule, frame: u32, operands: &[Operand]) -> Operand {
        if matches!(rule, Rule::MinMax | Rule::Associative(_) | Rule::Distance) {
            return self.join(op, rule, frame, operands);
        }
        self.balanced(operands, |code, pair| code.join(op, rule, frame, pair))
    }

    /// Exactly one of two; folded over more, an odd number of them.
    fn either_all(&mut self, rule: Rule, frame: u32, operands: &[Operand]) -> Operand {
        self.balanced(operands, |code, pair| match *pair {
            [a, b] => {
                let first = code.join(Op::And, rule, frame, &[a, b.flip_if(true)]);
                let second = code.join(Op::And, rule, frame, &[a.flip_if(true), b]);
                code.join(Op::Or, rule, frame, &[first, second])
            }
            _ => pair[0],
        })
    }

    fn balanced(&mut self, operands: &[Operand], mut join: impl FnMut(&mut Code, &[Operand]) -> Operand) -> Operand {
        let mut level = operands.to_vec();
        while level.len() > 1 {
            level = level.chunks(2).map(|pair| join(self, pair)).collect();
        }
        level[0]
    }
}

impl Compiler {
    fn compile(mut self, root: &Solid) -> Result<Compiled, SolidError> {
        self.contexts.push(Context { frame: 0, to_local: DAffine3::IDENTITY, forward: DAffine3::IDENTITY, scale: 1.0 });
        let step = self.scene.trail.push(root, None);
        let site = Site { solid: root, context: 0, step };
        let mut tasks = vec![Task::Visit(site)];
        while let Some(task) = tasks.pop() {
            match task {
                Task::Visit(site) => self.visit(site, &mut tasks)?,
                Task::Finish(site) => {
                    let built = self.finish(site)?;
                    self.built.insert((site.context, site.solid.address()), Some(built));
                }
            }
        }
        let built = self.of(root, 0);
        let unbounded = self.unbounded(root, step);
        let Compiler { scene, field, surface, .. } = self;
        let surface = flatten(surface, built.surface);
        let scene = Arc::new(scene);
        let (code, surface_root) = surface;
        Ok(Compiled {
            field: Program::assemble(scene.clone(), field.nodes, field.operands, built.field),
            surface: Program::assemble(scene, code.nodes, code.operands, surface_root),
            bounds: if built.sides.inside.is_empty() { Bounds::EMPTY } else { built.sides.inside },
            unbounded,
        })
    }

    /// The path to the node that makes the solid unbounded: down through unions to the
    /// operand at fault; an intersection none of whose operands bounds it is itself.
    fn unbounded(&mut self, root: &Solid, step: u32) -> String {
        let (mut solid, mut context, mut step) = (root.clone(), 0, step);
        loop {
            let inside = |c: &Compiler, s: &Solid, context| c.of(s, context).sides.inside;
            if inside(self, &solid, context).is_finite() || inside(self, &solid, context).is_empty() {
                return String::new();
            }
            let key = (context, solid.address());
            let (position, inner) = match solid.node() {
                solid::Node::Affine { .. } | solid::Node::Warp { .. } => (0, self.context_of[&key]),
                solid::Node::Join { operation: Operation::Union, operands, .. } => {
                    let open =
                        |o: &Solid| !inside(self, o, context).is_finite() && !inside(self, o, context).is_empty();
                    match operands.iter().position(open) {
                        Some(position) => (position, context),
                        None => return self.scene.trail.path(step),
                    }
                }
                _ => return self.scene.trail.path(step),
            };
            let next = solid.node().operands()[position].clone();
            step = self.scene.trail.push(&next, Some((step, &solid, position)));
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
        let inner = match site.solid.node() {
            solid::Node::Leaf(field) => {
                field.check().map_err(|e| self.parameter(site, e))?;
                site.context
            }
            solid::Node::Affine { forward, label, .. } => {
                check_affine(forward, label).map_err(|e| self.parameter(site, e))?;
                self.affine_context(site, forward)
            }
            solid::Node::Warp { warp, .. } => self.warp_context(site, warp),
            solid::Node::Join { rule, operands, .. } => {
                rule.check().map_err(|e| self.parameter(site, e))?;
                if operands.is_empty() {
                    return Err(SolidError::EmptyJoin { path: self.scene.trail.path(site.step) });
                }
                site.context
            }
            solid::Node::Complement(_) => site.context,
        };
        tasks.push(Task::Finish(site));
        for (position, operand) in site.solid.node().operands().iter().enumerate().rev() {
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

    /// The context below a map, made once.
    fn context(&mut self, site: Site<'_>, make: impl FnOnce(&mut Compiler, Context) -> Context) -> u32 {
        let key = (site.context, site.solid.address());
        if let Some(&context) = self.context_of.get(&key) {
            return context;
        }
        let context = make(self, self.contexts[site.context as usize]);
        self.contexts.push(context);
        let number = (self.contexts.len() - 1) as u32;
        self.context_of.insert(key, number);
        number
    }

    fn affine_context(&mut self, site: Site<'_>, forward: &DAffine3) -> u32 {
        self.context(site, |_, above| Context {
            frame: above.frame,
            to_local: inverse(forward) * above.to_local,
            forward: above.forward * *forward,
            scale: above.scale * stretch(&forward.matrix3),
        })
    }

    fn warp_context(&mut self, site: Site<'_>, warp: &Arc<dyn AnyWarp>) -> u32 {
        self.context(site, |compiler, above| {
            compiler.scene.frames.push(Frame { parent: above.frame, to_local: above.to_local, warp: warp.clone() });
            Context {
                frame: compiler.scene.frames.len() as u32,
                to_local: DAffine3::IDENTITY,
                forward: DAffine3::IDENTITY,
                scale: above.scale,
            }
        })
    }

    fn finish(&mut self, site: Site<'_>) -> Result<Built, SolidError> {
        let key = (site.context, site.solid.address());
        match site.solid.node() {
            solid::Node::Leaf(field) => Ok(self.leaf(field, site)),
            solid::Node::Affine { operand, .. } => Ok(self.of(operand, self.context_of[&key])),
            solid::Node::Warp { operand, warp } => {
                let inner = self.of(operand, self.context_of[&key]);
                warp.check(&inner.sides.inside).map_err(|e| self.parameter(site, e))?;
                let forward = self.contexts[site.context as usize].forward;
                let outward = |b: &Bounds| {
                    if b.is_empty() { *b } else { snug(warp.bounds(b).transformed(&forward)) }
                };
                // A deformation of an infinite region is not followed.
                let outside = if inner.sides.outside.is_finite() { outward(&inner.sides.outside) } else { Bounds::ALL };
                Ok(Built { sides: Sides { inside: outward(&inner.sides.inside), outside }, ..inner })
            }
            solid::Node::Complement(operand) => {
                let inner = self.of(operand, site.context);
                Ok(Built {
                    field: inner.field.flip_if(true),
                    surface: inner.surface.flip_if(true),
                    sides: inner.sides.flip_if(true),
                })
            }
            solid::Node::Join { operation, rule, operands } => {
                let built: Vec<Built> = operands.iter().map(|o| self.of(o, site.context)).collect();
                Ok(self.join(*operation, Rule::from(*rule), &built, self.contexts[site.context as usize].frame))
            }
        }
    }

    fn leaf(&mut self, field: &Arc<dyn AnyField>, site: Site<'_>) -> Built {
        let context = self.contexts[site.context as usize];
        let bounds = snug(field.bounds_under(&context.forward));
        let leaf = self.scene.leaves.len() as u32;
        self.scene.leaves.push(Instance {
            field: field.clone(),
            frame: context.frame,
            to_local: context.to_local,
            scale: context.scale,
            placement: Placement::new(&context.to_local, context.scale),
            bounds,
            step: site.step,
        });
        Built {
            field: self.field.push(Node::Leaf(leaf)),
            surface: self.surface.push(Node::Leaf(leaf)),
            sides: Sides { inside: bounds, outside: Bounds::ALL },
        }
    }

    fn join(&mut self, operation: Operation, rule: Rule, built: &[Built], frame: u32) -> Built {
        // A difference is the conjunction of the first with the complements of the others.
        let negated = |i: usize| operation == Operation::Difference && i > 0;
        let pick = |edge: fn(&Built) -> Edge| -> Vec<Operand> {
            let operand = |(i, b): (usize, &Built)| Operand { edge: edge(b), sides: b.sides }.flip_if(negated(i));
            built.iter().enumerate().map(operand).collect()
        };
        let (field, surface) = (pick(|b| b.field), pick(|b| b.surface));
        let (field, surface) = if operation == Operation::SymmetricDifference {
            (self.field.either_all(rule, frame, &field), self.surface.either_all(Rule::MinMax, frame, &surface))
        } else {
            let op = if operation == Operation::Union { Op::Or } else { Op::And };
            (self.field.join_all(op, rule, frame, &field), self.surface.join(op, Rule::MinMax, frame, &surface))
        };
        Built { field: field.edge, surface: surface.edge, sides: surface.sides }
    }
}

/// A box grown by what rounding may have taken from it.
fn snug(bounds: Bounds) -> Bounds {
    if bounds.is_empty() {
        return Bounds::EMPTY;
    }
    let grow = |v: f64| if v.is_finite() { 1e-14 * v.abs() } else { 0.0 };
    let mut grown = bounds;
    for axis in 0..3 {
        let margin = grow(bounds.min[axis]).max(grow(bounds.max[axis]));
        grown.min[axis] -= margin;
        grown.max[axis] += margin;
    }
    grown
}

/// The smallest stretch, exactly 1 where nothing is stretched.
fn stretch(m: &DMat3) -> f64 {
    let stretch = smallest_stretch(m);
    if (stretch - 1.0).abs() < 1e-14 { 1.0 } else { stretch }
}

/// The inverse; a translation's is exact.
fn inverse(map: &DAffine3) -> DAffine3 {
    if map.matrix3 == DMat3::IDENTITY { DAffine3::from_translation(-map.translation) } else { map.inverse() }
}

fn check_affine(map: &DAffine3, label: &str) -> Result<(), ParamError> {
    const LARGEST: f64 = 1e9;
    for (axis, offset) in ["x", "y", "z"].into_iter().zip(map.translation.to_array()) {
        if offset.is_nan() || offset.abs() > LARGEST {
            return Err(ParamError::new(format_args!("translation.{axis}"), offset, "-1e9 to 1e9"));
        }
    }
    let name = match label {
        "scale" => "factor",
        "scale_axes" => "factors",
        "rotate" => "rotation",
        "rotate_x" | "rotate_y" | "rotate_z" => "angle",
        _ => "matrix",
    };
    if let Some(bad) = map.matrix3.to_cols_array().into_iter().find(|v| v.is_nan() || v.abs() > LARGEST) {
        return Err(ParamError::new(format_args!("{name} (an entry of the matrix)"), bad, "-1e9 to 1e9"));
    }
    let least = if map.matrix3.determinant() == 0.0 { 0.0 } else { smallest_stretch(&map.matrix3) };
    let most = 1.0 / if least > 0.0 { smallest_stretch(&map.matrix3.inverse()) } else { 1.0 };
    if !(least >= 1e-9 && least >= 1e-9 * most) {
        return Err(ParamError::new(
            format_args!("{name} (smallest stretch)"),
            if least.is_nan() { 0.0 } else { least },
            "at least 1e-9, and at least 1e-9 of the largest (the map must be invertible)",
        ));
    }
    Ok(())
}
