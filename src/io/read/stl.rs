//! STL, binary and text: see the [writer](crate::io::write_stl).
//!
//! Some binary files begin with "solid" as text does: a file whose length is what its count of
//! facets says is binary. Facets have no vertices in common; corners at one position become one
//! vertex, so that a closed surface is closed.

use glam::DVec3;

use super::ReadError;
use super::bytes::Bytes;
use super::error::shown;
use super::limits::Limits;
use super::shape::Shape;
use super::text::{Words, position};
use super::weld::Weld;

/// Bytes before the first facet, and those of a facet.
const HEADER: usize = 84;
const FACET: usize = 50;

pub(super) fn read(data: &[u8], settings: &Limits<'_>) -> Result<Shape, ReadError> {
    let mut facets = Facets { settings, weld: Weld::default(), triangles: Vec::new() };
    if is_text(data) {
        facets.read_text(data)?
    } else {
        facets.read_binary(data)?
    }
    Ok(Shape { positions: facets.weld.positions, triangles: facets.triangles, ..Shape::default() })
}

fn is_text(data: &[u8]) -> bool {
    let claimed = data.get(HEADER - 4..HEADER).map(|n| u64::from(u32::from_le_bytes([n[0], n[1], n[2], n[3]])));
    let is_whole = claimed.is_some_and(|count| HEADER as u64 + FACET as u64 * count == data.len() as u64);
    let begins = Words::new(data, 0, 1).next().is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    // No control characters in what has facets as text.
    let is_plain = data.iter().take(1024).all(|byte| !byte.is_ascii_control() || byte.is_ascii_whitespace());
    begins && is_plain && !is_whole
}

struct Facets<'a> {
    settings: &'a Limits<'a>,
    weld: Weld,
    triangles: Vec<[u32; 3]>,
}

impl Facets<'_> {
    fn push(&mut self, corners: [DVec3; 3]) -> Result<(), ReadError> {
        self.settings.triangles(self.triangles.len() + 1)?;
        self.settings.points(self.weld.positions.len() + 3)?;
        self.triangles.push(corners.map(|corner| self.weld.vertex(corner)));
        Ok(())
    }

    fn read_binary(&mut self, data: &[u8]) -> Result<(), ReadError> {
        let mut bytes = Bytes::new(data, 0);
        bytes.take(HEADER - 4, "a header")?;
        let count = bytes.u32("a count of facets")?;
        for _ in 0..count {
            let start = bytes.place();
            let facet: [u8; FACET] = bytes.array("a facet")?;
            let mut corners = [DVec3::ZERO; 3];
            for (k, corner) in corners.iter_mut().enumerate() {
                let at = |axis: usize| {
                    let from = 12 * (k + 1) + 4 * axis;
                    f64::from(f32::from_le_bytes([facet[from], facet[from + 1], facet[from + 2], facet[from + 3]]))
                };
                *corner = position([at(0), at(1), at(2)], || start.clone())?;
            }
            self.push(corners)?;
        }
        Ok(())
    }

    fn read_text(&mut self, data: &[u8]) -> Result<(), ReadError> {
        let mut words = Words::new(data, 0, 1);
        let mut is_open = false;
        while let Some(word) = words.next() {
            let is = |keyword: &str| word.eq_ignore_ascii_case(keyword.as_bytes());
            if is("solid") || is("endsolid") {
                is_open = is("solid");
                // A name follows, of any words or none.
                words.skip_line();
                continue;
            }
            if !is("facet") {
                return Err(ReadError::content(words.place(), "facet or endsolid", shown(word)));
            }
            words.keyword("normal")?;
            for _ in 0..3 {
                // Whatever it is: the corners tell.
                words.word("a normal")?;
            }
            words.keyword("outer")?;
            words.keyword("loop")?;
            let mut corners = [DVec3::ZERO; 3];
            for corner in &mut corners {
                words.keyword("vertex")?;
                let mut coordinate = || words.number("a coordinate");
                let coordinates = [coordinate()?, coordinate()?, coordinate()?];
                *corner = position(coordinates, || words.place())?;
            }
            words.keyword("endloop")?;
            words.keyword("endfacet")?;
            self.push(corners)?;
        }
        if is_open {
            let expected = "facet or endsolid; of a file that was cut off the rest is needed";
            return Err(ReadError::content(words.place(), expected, "the end of the file"));
        }
        Ok(())
    }
}
