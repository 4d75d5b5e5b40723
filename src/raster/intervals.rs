//! Any tree over any closed solids, by the sorted layers of each pixel.
//!
//! ```text
//!   A   ----(==========)-----------(====)---->     winding number of A along the ray
//!   B   --------(==========)----------------->     of B
//! A − B ----(===)------------------(====)---->     the tree, decided between layers
//!           ^ the first change is what is seen
//! ```
//!
//! All layers of all operands are gathered, put in order pixel by pixel, and followed: a front
//! face adds 1 to its operand's winding number, a back face takes 1 away, and the operand holds
//! the places where the number is above 0. Layers at the same depth count together, so flush
//! faces leave no skin.
//!
//! The near plane may cut solids: a ray that leaves more often than it enters has begun inside.
//! Such a wall is seen from behind.

use std::cmp::Ordering;

use super::expression::{Circuit, State};
use super::layers::{Facing, LANES, LayerSource, Tile};
use super::target::{REVERSED, Target};

/// A layer of an operand at a pixel.
#[derive(Clone, Copy)]
struct Event {
    depth: f64,
    pixel: u32,
    operand: u32,
    face: u32,
    facing: Facing,
}

impl Event {
    #[inline]
    fn order(&self, other: &Event) -> Ordering {
        let key = |e: &Event| (e.operand, e.face, e.facing);
        self.depth.total_cmp(&other.depth).then_with(|| key(self).cmp(&key(other)))
    }

    /// What it adds to the winding number.
    fn turn(&self) -> i32 {
        if self.facing == Facing::Front { 1 } else { -1 }
    }
}

/// Room for the work on tiles, which a thread uses again.
#[derive(Default)]
pub(super) struct Scratch {
    /// As they come.
    found: Vec<Event>,
    /// Pixel by pixel, and where those of each pixel end.
    events: Vec<Event>,
    ends: Vec<u32>,
    follow: Follow,
}

/// Where a ray is.
#[derive(Default)]
struct Follow {
    state: State,
    winding: Vec<i32>,
}

pub(super) fn tile(circuit: &Circuit, operands: &[&dyn LayerSource], tile: &Tile, scratch: &mut Scratch) -> Target {
    let mut target = Target::new();
    gather(operands, tile, scratch);
    let Scratch { events, ends, follow, .. } = scratch;
    follow.winding.resize(operands.len(), 0);
    let mut start = 0;
    for (pixel, &end) in ends.iter().enumerate() {
        let layers = &mut events[start..end as usize];
        start = end as usize;
        if layers.is_empty() {
            continue;
        }
        sort(layers);
        target.stencil[pixel] = layers.len() as i32;
        if let Some(seen) = first_change(circuit, layers, follow) {
            target.depth[pixel] = seen.depth;
            target.operand[pixel] = seen.operand | if seen.facing == Facing::Back { REVERSED } else { 0 };
            target.face[pixel] = seen.face;
        }
    }
    target
}

/// Puts layers in order. Most pixels have two to six, too few for a sort that is a call.
#[inline]
fn sort(layers: &mut [Event]) {
    const FEW: usize = 12;
    if layers.len() > FEW {
        layers.sort_unstable_by(Event::order);
        return;
    }
    for i in 1..layers.len() {
        let event = layers[i];
        let mut j = i;
        while j > 0 && event.order(&layers[j - 1]) == Ordering::Less {
            layers[j] = layers[j - 1];
            j -= 1;
        }
        layers[j] = event;
    }
}

/// All layers in a tile by pixel, and where those of each pixel end.
fn gather(operands: &[&dyn LayerSource], tile: &Tile, scratch: &mut Scratch) {
    let Scratch { found, events, ends, .. } = scratch;
    found.clear();
    ends.clear();
    ends.resize(Tile::PIXELS, 0);
    for (number, layers) in operands.iter().enumerate().filter(|(_, layers)| layers.touches(tile)) {
        layers.layers(tile, &mut |runs| {
            for run in runs {
                for lane in 0..LANES {
                    let (depth, pixel) = (run.depth[lane], run.at as usize + lane);
                    if depth < f64::INFINITY && pixel < Tile::PIXELS {
                        let (operand, face, facing) = (number as u32, run.face, run.facing);
                        found.push(Event { depth, pixel: pixel as u32, operand, face, facing });
                        ends[pixel] += 1;
                    }
                }
            }
        });
    }
    let mut next = 0;
    for end in ends.iter_mut() {
        // First where they start; each one that is put in its place moves it on.
        next += *end;
        *end = next - *end;
    }
    // What is there is written over.
    if let Some(&any) = found.first() {
        events.resize(found.len(), any);
    }
    for event in found {
        let slot = &mut ends[event.pixel as usize];
        events[*slot as usize] = *event;
        *slot += 1;
    }
}

/// The layer at which the tree first changes between inside and outside. `layers` are in order.
fn first_change(circuit: &Circuit, layers: &[Event], follow: &mut Follow) -> Option<Event> {
    let Follow { state, winding } = follow;
    circuit.reset(state);
    for event in layers {
        winding[event.operand as usize] = 0;
    }
    // Far away every operand is outside, so it began with what the layers take away.
    for event in layers {
        winding[event.operand as usize] -= event.turn();
    }
    for (i, event) in layers.iter().enumerate() {
        // Rarely anything: the near plane has to cut a solid.
        let is_first = || layers[..i].iter().all(|other| other.operand != event.operand);
        if winding[event.operand as usize] > 0 && is_first() {
            circuit.set(state, event.operand, true);
        }
    }
    let began_inside = state.is_inside();
    for group in layers.chunk_by(|a, b| a.depth == b.depth) {
        for event in group {
            let winding = &mut winding[event.operand as usize];
            let before = *winding > 0;
            *winding += event.turn();
            if (*winding > 0) != before {
                circuit.set(state, event.operand, *winding > 0);
            }
        }
        if state.is_inside() != began_inside {
            return Some(decisive(circuit, group, winding, state));
        }
    }
    None
}

/// Of layers at the same depth, the first one without which the tree would not have changed.
fn decisive(circuit: &Circuit, group: &[Event], winding: &[i32], state: &mut State) -> Event {
    let now = state.is_inside();
    for event in group {
        let inside = winding[event.operand as usize] > 0;
        circuit.set(state, event.operand, !inside);
        let other = state.is_inside();
        circuit.set(state, event.operand, inside);
        if other != now {
            return *event;
        }
    }
    group[0]
}
