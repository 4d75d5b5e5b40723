//! The second pass: the blocks' vertices in one list, and triangles between them, by the case
//! table or with fans.

use rvachev_num::jobs;

use super::corners::Vertices;
use super::lists::keep;
use super::parts::Parts;
use super::samples::Samples;
use super::sharp::{self, Found};
use super::{ExtractError, Sampler};
use crate::geom::{Findings, Mesh};
use crate::mesh::Features;
use crate::mesh::lattice::Lattice;
use crate::mesh::signs::BLOCK;
use crate::{Cancelled, Run};

/// Triangles that a thread numbers anew at once.
const AT_ONCE: usize = 1 << 12;

impl Parts<'_> {
    /// Counts the blocks that may have lost a feature.
    pub(super) fn note_lost<S: Sampler>(&mut self, sampler: &S, run: &Run) -> Result<(), Cancelled> {
        self.lost = self.lost(sampler, run)?.into_iter().map(|n| self.blocks[n]).collect();
        Ok(())
    }

    /// What the first pass found besides the vertices.
    fn findings(&self, lattice: &Lattice) -> Findings {
        Findings {
            cell: lattice.step(),
            blocks: self.blocks.len(),
            clamped_vertices: Some(self.clamped),
            possibly_lost: self.lost.len(),
            lost_at: self.lost.iter().map(|block| lattice.region(*block, BLOCK).center()).collect(),
            deviation: None,
            thin: None,
        }
    }

    /// The mesh.
    pub(super) fn join<S: Sampler>(
        mut self,
        sampler: &S,
        lattice: &Lattice,
        features: Features,
        run: &Run,
    ) -> Result<Mesh, ExtractError> {
        let [mut positions, mut normals] = self.take_vertices();
        let findings = self.findings(lattice);
        let found = match features {
            Features::Smooth => Found::Table(self.triangles_unless(|| (), run)?.unwrap_or_default()),
            Features::Sharp => {
                let is_plain = |block| sampler.is_plain(block);
                let about = (sampler.limits(), sampler.crease());
                let samples = Samples::new(&self, lattice, about, [&positions, &normals], &is_plain);
                sharp::find(&samples, sampler, &run.stage(0.0, 0.95))?
            }
        };
        let fans = match found {
            Found::Fans(fans) => fans,
            Found::Table(triangles) => {
                positions.shrink_to_fit();
                normals.shrink_to_fit();
                return Ok(Mesh::new(positions.into_vec(), triangles.into_vec())?
                    .with_normals(normals.into_vec())?
                    .with_findings(findings));
            }
        };
        let count = positions.len() as u64 + fans.count() as u64;
        if count > u64::from(u32::MAX) {
            return Err(ExtractError::TooLarge { count });
        }
        fans.add_vertices(&mut positions, &mut normals);
        let unused = fans.unused().to_vec();
        let vertices = Vertices { positions: &positions, normals: &normals };
        let (mut triangles, corners) = fans.triangles(vertices, &run.stage(0.95, 1.0))?;
        if !unused.is_empty() {
            let used = used(positions.len(), &unused);
            let number = |n: u32| used[n as usize];
            jobs::for_chunks_mut(&mut triangles, AT_ONCE, |_, some| {
                some.iter_mut().for_each(|slot| *slot = slot.map(number));
            });
            let unused: Vec<usize> = unused.iter().map(|&n| n as usize).collect();
            keep(&mut positions, &unused);
            keep(&mut normals, &unused);
        }
        // Less is not worth a copy.
        if triangles.capacity() > triangles.len() + triangles.len() / 8 {
            triangles.shrink_to_fit();
        }
        positions.shrink_to_fit();
        normals.shrink_to_fit();
        let mesh = Mesh::new(positions.into_vec(), triangles.into_vec())?
            .with_normals(normals.into_vec())?
            .with_findings(findings);
        Ok(if corners.is_empty() { mesh } else { mesh.with_corner_normals_apart(corners)? })
    }
}

/// The numbers of vertices when the ones that are not used, in ascending order, are gone.
fn used(count: usize, unused: &[u32]) -> Vec<u32> {
    let mut numbers: Vec<u32> = Vec::with_capacity(count);
    for (before, &gone) in (0..).zip(unused) {
        numbers.extend(numbers.len() as u32 - before..gone - before);
        // No triangle has it.
        numbers.push(gone - before);
    }
    numbers.extend((numbers.len() - unused.len()) as u32..(count - unused.len()) as u32);
    numbers
}
