//! Leaves of a scene: those of the graph, and those that are made of a node's operands.

use std::sync::Arc;

use glam::DVec3;

use super::{Compiler, Site};
use crate::Bounds;
use crate::eval::apart::measured;
use crate::eval::coat::Coat;
use crate::eval::code::{Built, grow, snug};
use crate::eval::context::{Context, is_similarity, least_stretch};
use crate::eval::nothing::Nothing;
use crate::eval::program::Kind;
use crate::eval::scene::Instance;
use crate::eval::sides::Sides;
use crate::eval::source::{Measured, Parts};
use crate::eval::swell::Swell;
use crate::solid::Operation;
use rvachev_field::{AnyField, Placement, Rule, largest_stretch};
use rvachev_num::column_times;

impl Compiler<'_> {
    pub(super) fn leaf(&mut self, field: &Arc<dyn AnyField>, site: Site<'_>) -> Built {
        let Context { moved, scale, level, .. } = *self.contexts.get(site.context);
        let moved = moved.unwrap_or_default();
        // What stays of its kind has values that are distances outside as well.
        match (moved.depth > 0.0).then(|| field.eroded(moved.depth / scale)).flatten() {
            Some(left) if field.exact() => self.shifted(&left, site, moved.shift + level),
            _ => self.shifted(field, site, moved.level() + level),
        }
    }

    /// The surface of a length's operand as a leaf, its distance moved by `by`.
    pub(super) fn measured(&mut self, site: Site<'_>, by: f64) -> Built {
        match measured(site.solid) {
            Some(Measured { parts: Some(Parts { operation, fields }), .. }) => {
                let shift = self.shift(site, by);
                let part = |(number, field)| {
                    let is_taken_away = operation == Operation::Difference && number > 0;
                    self.made_at(field, site, if is_taken_away { -shift } else { shift })
                };
                let parts: Vec<Built> = fields.iter().enumerate().map(part).collect();
                let frame = self.contexts.get(site.context).frame;
                self.code.operation(operation, Rule::MinMax, frame, &parts)
            }
            Some(Measured { field, .. }) => self.made(&field, site, by),
            None => self.nothing(site),
        }
    }

    pub(super) fn nothing(&mut self, site: Site<'_>) -> Built {
        let nothing: Arc<dyn AnyField> = Arc::new(Nothing);
        self.shifted(&nothing, site, 0.0)
    }

    /// A leaf that is made of a node's operands and has their paint, its value moved by `by`.
    pub(super) fn made(&mut self, field: &Arc<dyn AnyField>, site: Site<'_>, by: f64) -> Built {
        let shift = self.shift(site, by);
        self.made_at(field, site, shift)
    }

    /// What is added to values that are moved by `by`, in the frame's unit.
    fn shift(&self, site: Site<'_>, by: f64) -> f64 {
        let context = self.contexts.get(site.context);
        context.moved.unwrap_or_default().level() + context.level + by * context.scale
    }

    fn made_at(&mut self, field: &Arc<dyn AnyField>, site: Site<'_>, shift: f64) -> Built {
        self.coats.insert(self.scene.leaves.len() as u32, Coat::of(site.solid));
        let matrix = &self.contexts.get(site.context).forward.matrix3;
        // The largest of a map that stretches all directions alike is known to the last bit.
        let stretch = if is_similarity(matrix) { least_stretch(matrix) } else { largest_stretch(matrix) };
        if let Some(measured) = measured(site.solid) {
            self.accuracy = self.accuracy.max(measured.accuracy.times(stretch));
        }
        self.shifted(field, site, shift)
    }

    pub(super) fn shifted(&mut self, field: &Arc<dyn AnyField>, site: Site<'_>, shift: f64) -> Built {
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
            gauge: field.gauge_radius().filter(|_| context.moved.is_none()).map(|radius| radius * context.scale),
        }
    }

    /// Adds a leaf to the scene: its number, and how much its box grows per unit of value.
    pub(super) fn place(&mut self, field: &Arc<dyn AnyField>, site: Site<'_>, shift: f64) -> (u32, DVec3) {
        let context = *self.contexts.get(site.context);
        let (axes, unit) = (context.forward.matrix3.abs(), field.growth());
        let growth = (0..3).map(|axis| column_times(axes.col(axis), unit[axis])).sum::<DVec3>() / context.scale;
        let mut bounds = snug(field.bounds_under(&context.forward));
        if shift != 0.0 && field.exact() && is_similarity(&context.forward.matrix3) {
            // A distance tells of the sides of the box what it tells of the surface, however it is
            // turned.
            bounds = grow(&bounds, DVec3::splat(shift * least_stretch(&context.forward.matrix3) / context.scale));
        } else if shift > 0.0 {
            bounds = grow(&bounds, growth * shift);
        }
        let number = self.scene.leaves.len() as u32;
        self.scene.add(Instance {
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
