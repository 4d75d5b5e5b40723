//! Drawings of polylines: SVG and DXF.
//!
//! SVG has y down, so that the drawing is turned over in it; DXF has y up, as the plane has.
//! One length unit is a millimetre in both.
//!
//! Sources: W3C, *Scalable Vector Graphics 1.1*; Autodesk, *DXF Reference*, Release 12, which
//! every reader knows.

use std::io::{self, Write};

use glam::DVec2;

use crate::geom::Polyline;

/// Writes polylines as SVG: closed ones filled, holes left open, and all of them outlined.
///
/// ```
/// use glam::DVec2;
/// use rvachev::io::write_svg;
/// use rvachev::Polyline;
///
/// let triangle = Polyline::closed(vec![DVec2::ZERO, DVec2::X, DVec2::Y]);
/// let mut file = Vec::new();
/// write_svg(&[triangle], &mut file)?;
/// assert!(String::from_utf8_lossy(&file).contains("<path"));
/// # Ok::<(), std::io::Error>(())
/// ```
///
/// # Errors
///
/// Those of the writer; [`InvalidInput`](io::ErrorKind::InvalidInput), before anything is written, for a coordinate
/// that is not finite, or not within ±10³⁰⁰.
pub fn write_svg(lines: &[Polyline], mut out: impl Write) -> io::Result<()> {
    check(lines)?;
    let points = || lines.iter().flat_map(|line| line.points());
    let min = points().copied().reduce(DVec2::min).unwrap_or(DVec2::ZERO);
    let max = points().copied().reduce(DVec2::max).unwrap_or(DVec2::ONE);
    // A drawing without width or height still has an outline to show.
    let longest = (max - min).max_element();
    let longest = if longest > 0.0 { longest } else { 1.0 };
    let (margin, stroke) = (0.04 * longest, 0.004 * longest);
    let size = max - min + 2.0 * margin;
    let (left, top) = (min.x - margin, -max.y - margin);
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{}mm\" viewBox=\"{left} {top} {} {}\">",
        size.x, size.y, size.x, size.y
    )?;
    let style = format!("stroke=\"#1d2b38\" stroke-width=\"{stroke}\" stroke-linejoin=\"round\"");
    for (closed, fill) in [(true, "fill=\"#e8d5b5\" fill-rule=\"evenodd\""), (false, "fill=\"none\"")] {
        let mut chosen = lines.iter().filter(|line| line.is_closed() == closed && !line.points().is_empty()).peekable();
        if chosen.peek().is_none() {
            continue;
        }
        // One path for all, so that a hole is a hole in what is around it.
        write!(out, "<path {fill} {style} d=\"")?;
        for line in chosen {
            for (i, p) in line.points().iter().enumerate() {
                write!(out, "{}{} {}", if i == 0 { "M" } else { "L" }, p.x, -p.y)?;
            }
            if closed {
                write!(out, "Z")?;
            }
        }
        writeln!(out, "\"/>")?;
    }
    writeln!(out, "</svg>")
}

/// Writes polylines as DXF (Release 12): entities POLYLINE on the layer `0`, closed or open.
///
/// # Errors
///
/// Those of the writer; [`InvalidInput`](io::ErrorKind::InvalidInput), before anything is written, for a coordinate
/// that is not finite, or not within ±10³⁰⁰.
pub fn write_dxf(lines: &[Polyline], mut out: impl Write) -> io::Result<()> {
    check(lines)?;
    let mut pair = |code: u32, value: &dyn std::fmt::Display| write!(out, "{code}\n{value}\n");
    pair(0, &"SECTION")?;
    pair(2, &"HEADER")?;
    pair(9, &"$ACADVER")?;
    pair(1, &"AC1009")?;
    pair(0, &"ENDSEC")?;
    pair(0, &"SECTION")?;
    pair(2, &"ENTITIES")?;
    for line in lines {
        pair(0, &"POLYLINE")?;
        pair(8, &"0")?;
        pair(66, &1)?;
        for code in [10, 20, 30] {
            pair(code, &0.0)?;
        }
        pair(70, &u8::from(line.is_closed()))?;
        for p in line.points() {
            pair(0, &"VERTEX")?;
            pair(8, &"0")?;
            pair(10, &p.x)?;
            pair(20, &p.y)?;
            pair(30, &0.0)?;
        }
        pair(0, &"SEQEND")?;
        pair(8, &"0")?;
    }
    pair(0, &"ENDSEC")?;
    pair(0, &"EOF")
}

/// Beyond, sizes of drawings are no numbers any more.
const FARTHEST: f64 = 1e300;

/// An error if a point is no point: no reader takes one.
fn check(lines: &[Polyline]) -> io::Result<()> {
    let fits = |p: &DVec2| p.is_finite() && p.abs().max_element() <= FARTHEST;
    for (number, line) in lines.iter().enumerate() {
        if let Some(i) = line.points().iter().position(|p| !fits(p)) {
            let (x, y) = line.points()[i].into();
            let wrong = format!(
                "polyline {number}: point {i} is ({x}, {y}); both coordinates must be finite, and within ±1e300"
            );
            return Err(io::Error::new(io::ErrorKind::InvalidInput, wrong));
        }
    }
    Ok(())
}
