//! A list of rays, taken through the tree of cells together: those whose directions are in one
//! octant meet its parts in one order.

use glam::DVec3;

use super::cells::{Cell, Cells, Part};
use super::gbuffer::Surface;
use super::job::{Ray, Span};
use super::slopes::Known;
use super::tile::{Packet, TIE, Tracer, are_told, divides, enters, nearer, searched, span};

impl Tracer {
    /// What a list of rays meets, each an origin and a unit direction.
    pub(super) fn list(&mut self, cells: &Cells, rays: &[(DVec3, DVec3)], surfaces: &mut [Surface]) {
        self.rays.clear();
        let mut inside = false;
        let mut octants: [Vec<u32>; 8] = Default::default();
        for (number, &(origin, direction)) in (0..).zip(rays) {
            let mut ray = Ray::NONE;
            if enters(&mut ray, cells, (origin, direction), None, None) {
                let octant = (0..3).map(|axis| usize::from(direction[axis] < 0.0) << axis).sum::<usize>();
                octants[octant].push(number);
                inside |= ray.inside;
            }
            self.rays.push(ray);
        }
        let eye = rays.first().map(|ray| ray.0).filter(|eye| rays.len() > 1 && rays.iter().all(|ray| ray.0 == *eye));
        let all = octants.concat();
        let apart = cells.apart().filter(|_| !inside);
        let Some(apart) = apart.filter(|apart| all.iter().all(|ray| self.starts_outside(apart, *ray))) else {
            return self.walk_list(cells, octants, eye, surfaces);
        };
        let mut again = octants.clone();
        self.walk_list(&apart.rest, octants, eye, surfaces);
        let open = self.besides(cells, apart, |_| all.clone(), surfaces);
        open.iter().for_each(|ray| surfaces[*ray as usize] = Surface::NONE);
        again.iter_mut().for_each(|rays| rays.retain(|ray| open.binary_search(ray).is_ok()));
        self.walk_list(cells, again, eye, surfaces);
    }

    /// Takes rays of a list, by the octants of their directions, through the tree.
    fn walk_list(&mut self, cells: &Cells, octants: [Vec<u32>; 8], eye: Option<DVec3>, surfaces: &mut [Surface]) {
        let Part::Cell(root) = cells.root() else { return };
        let tie = TIE * cells.bounds().longest_side();
        let mut done = vec![false; surfaces.len()];
        for (octant, list) in octants.into_iter().enumerate() {
            // Cells with the rays that may pass them: the list's tail from `first`.
            let mut lists = list;
            let mut pending: Vec<(&Cell, usize, usize)> = vec![(root, 0, lists.len())];
            while let Some((cell, first, end)) = pending.pop() {
                lists.truncate(end);
                self.spans.clear();
                for &ray in &lists[first..end] {
                    if done[ray as usize] {
                        continue;
                    }
                    if let Some((near, far)) = span(&cell.bounds, &self.rays[ray as usize]) {
                        self.spans.push(Span { ray, near, far });
                    }
                }
                if self.spans.is_empty() {
                    continue;
                }
                let mut packet = Packet::new(eye);
                self.spans.iter().for_each(|span| packet.add(&self.rays[span.ray as usize]));
                let united = packet.united(cell);
                let is_whole = united.is_some_and(are_told);
                let known = if is_whole { Known::ANY } else { packet.slopes(searched(united, cell)) };
                if !packet.inside && united.is_none() && known.slopes.falls {
                    continue;
                }
                if !is_whole && divides(cell, self.spans.len(), &known) {
                    let first = lists.len();
                    lists.extend(self.spans.iter().map(|span| span.ray));
                    let is_above = |axis: usize, _: f64| octant >> axis & 1 == 0;
                    cell.halves().far_first(&is_above, &mut |cell| pending.push((cell, first, lists.len())));
                    continue;
                }
                self.marcher.hits.clear();
                for part in united.unwrap_or(std::slice::from_ref(cell)) {
                    let rays = self.spans.iter().map(|span| span.ray);
                    self.nearer.clear();
                    self.nearer.extend(rays.filter_map(|ray| nearer(part, ray, &self.rays, surfaces, tie)));
                    if !self.nearer.is_empty() {
                        let known = if united.is_some() { packet.slopes(part) } else { known.clone() };
                        self.marcher.march(cells, part, &known, &self.rays, &self.nearer, surfaces);
                    }
                }
                for &ray in &self.marcher.hits {
                    done[ray as usize] = true;
                }
            }
        }
    }
}
