//! How much memory the tree of cells takes.

use super::cells::{Cell, Cells, Halves, Part};
use crate::eval::Counted;

impl Cells {
    /// The bytes that the tree takes, as far as rays have asked for it.
    pub(super) fn bytes(&self) -> usize {
        let mut counted = Counted::default();
        let mut pending = vec![self.root()];
        let mut bytes = 0;
        while let Some(part) = pending.pop() {
            let halves = match part {
                Part::Inside | Part::Outside => continue,
                Part::Cell(cell) => {
                    bytes += cell.bytes(&mut counted);
                    let united = cell.known_united().unwrap_or_default();
                    bytes += united.iter().map(|cell| cell.bytes(&mut counted)).sum::<usize>();
                    let Some(halves) = cell.known_halves() else { continue };
                    halves
                }
                Part::Halves(halves) => {
                    bytes += size_of::<Halves>();
                    halves
                }
            };
            pending.extend(&halves.parts);
        }
        let sides = self.known_still().map(|still| still.parts().map(Cells::bytes).sum::<usize>());
        let apart = self.known_apart().map_or(0, |apart| {
            let parts = apart.parts().map(|cell| cell.bytes(&mut counted)).sum::<usize>();
            apart.rest.bytes() + parts
        });
        bytes + sides.unwrap_or(0) + apart
    }
}

impl Cell {
    /// The bytes that it takes without its halves.
    fn bytes(&self, counted: &mut Counted) -> usize {
        size_of::<Cell>() + self.program.bytes(counted) + self.known_tape().map_or(0, |tape| tape.bytes())
    }
}
