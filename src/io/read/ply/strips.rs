//! Strips of triangles in a PLY file.
//!
//! ```text
//!     0---2---4        Each vertex from the third on makes a triangle with the two before it, every other
//!      \ / \ / \       one turned round. −1 ends a strip; a triangle with a vertex twice is none, and
//!       1---3---5      counts.
//! ```

use super::super::ReadError;
use super::super::limits::Limits;
use super::super::shape::Shape;
use super::header::{Element, Kind};
use super::{Values, carry, expect_corners, is_corners, skip_property};

pub(super) fn read(
    element: &Element,
    values: &mut Values<'_>,
    settings: &Limits<'_>,
    vertices: u64,
    shape: &mut Shape,
) -> Result<(), ReadError> {
    expect_corners(element, "tristrips")?;
    let before = shape.triangles.len();
    for _ in 0..element.count {
        settings.step()?;
        for property in &element.properties {
            let Kind::List { count, number } = property.kind else {
                skip_property(property, values)?;
                continue;
            };
            if !is_corners(property) {
                skip_property(property, values)?;
                continue;
            }
            let (mut last, mut length) = ([0; 2], 0_u64);
            for _ in 0..values.count(count, &property.name)? {
                let place = values.place();
                let index = values.next(number, &property.name)?;
                if index == -1.0 {
                    length = 0;
                    continue;
                }
                if !(index >= 0.0 && index < vertices as f64 && index.fract() == 0.0) {
                    let expected = format!("a vertex from 0, of {vertices} vertices, or -1 behind a strip");
                    return Err(ReadError::content(place, expected, index.to_string()));
                }
                let ([a, b], c) = (last, index as u32);
                if length >= 2 && a != b && b != c && c != a {
                    settings.triangles(shape.triangles.len() + 1)?;
                    shape.triangles.push(if length.is_multiple_of(2) { [a, b, c] } else { [b, a, c] });
                }
                (last, length) = ([b, c], length + 1);
            }
        }
    }
    let counts = [before, shape.triangles.len()];
    carry(&mut shape.corner_colors, None, counts, [[255; 4]; 3]);
    carry(&mut shape.owners, None, counts, 0);
    Ok(())
}
