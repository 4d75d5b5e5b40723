//! Drawings of polylines: SVG and DXF.
//!
//! SVG has y down, so that the drawing is turned over in it; DXF has y up, as the plane has. One
//! length unit is a millimetre in both, and both say so: the size of an SVG is in mm, a DXF has
//! `$INSUNITS`.
//!
//! Sources: W3C, *Scalable Vector Graphics 1.1*; Autodesk, *DXF Reference*, Release 12, which
//! every reader knows.

use std::io::{self, Write};

use glam::DVec2;
use rvachev_num::Meter;

use crate::Run;
use crate::geom::Polyline;

/// Outlines are this part of the longest side wide.
const STROKE: f64 = 1e-3;

/// Coordinates are written to this part of the longest side, or finer: a tenth of what a laser
/// cutter resolves of a metre.
const RESOLUTION: f64 = 1e-6;

/// Writes polylines as SVG: closed ones filled, holes left open, and all of them outlined. One
/// length unit is a millimetre; coordinates are written to a millionth of the longest side.
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
/// Those of the writer; [`InvalidInput`](io::ErrorKind::InvalidInput), before anything is written,
/// for a coordinate that is not finite, or not within ±10³⁰⁰.
pub fn write_svg(lines: &[Polyline], out: impl Write) -> io::Result<()> {
    write_svg_on(lines, &Run::default(), out)
}

/// [`write_svg`] on a [`Run`], which is told how many points are written, and may be cancelled.
///
/// # Errors
///
/// Those of [`write_svg`], and one that holds a [`Cancelled`](crate::Cancelled) if cancelled:
/// what is written by then is no whole file.
pub fn write_svg_on(lines: &[Polyline], run: &Run, mut out: impl Write) -> io::Result<()> {
    let meter = metered(lines, run)?;
    check(lines)?;
    let points = || lines.iter().flat_map(|line| line.points());
    let min = points().copied().reduce(DVec2::min).unwrap_or(DVec2::ZERO);
    let max = points().copied().reduce(DVec2::max).unwrap_or(DVec2::ONE);
    // A drawing without width or height still has an outline to show.
    let longest = (max - min).max_element();
    let longest = if longest > 0.0 { longest } else { 1.0 };
    let places = (-(RESOLUTION * longest).log10()).ceil().clamp(0.0, 300.0) as usize;
    let short = |x: f64| short(x, places);
    let margin = 0.04 * longest;
    let size = max - min + 2.0 * margin;
    let [left, top] = [min.x - margin, -max.y - margin].map(short);
    let [width, height, stroke] = [size.x, size.y, STROKE * longest].map(short);
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}mm\" height=\"{height}mm\" \
         viewBox=\"{left} {top} {width} {height}\">"
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
                meter.step().map_err(io::Error::other)?;
                write!(out, "{}{} {}", if i == 0 { "M" } else { "L" }, short(p.x), short(-p.y))?;
            }
            if closed {
                write!(out, "Z")?;
            }
        }
        writeln!(out, "\"/>")?;
    }
    writeln!(out, "</svg>")
}

/// A number to so many decimal places, without zeros at the end.
fn short(x: f64, places: usize) -> String {
    let text = format!("{x:.places$}");
    let text = if places > 0 { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Writes polylines as DXF (Release 12): entities POLYLINE on the layer `0`, closed or open. One
/// length unit is a millimetre: `$INSUNITS` is 4, and `$MEASUREMENT` 1, metric.
///
/// # Errors
///
/// Those of the writer; [`InvalidInput`](io::ErrorKind::InvalidInput), before anything is written,
/// for a coordinate that is not finite, or not within ±10³⁰⁰.
pub fn write_dxf(lines: &[Polyline], out: impl Write) -> io::Result<()> {
    write_dxf_on(lines, &Run::default(), out)
}

/// [`write_dxf`] on a [`Run`], which is told how many points are written, and may be cancelled.
///
/// # Errors
///
/// Those of [`write_dxf`], and one that holds a [`Cancelled`](crate::Cancelled) if cancelled:
/// what is written by then is no whole file.
pub fn write_dxf_on(lines: &[Polyline], run: &Run, mut out: impl Write) -> io::Result<()> {
    let meter = metered(lines, run)?;
    check(lines)?;
    let mut pair = |code: u32, value: &dyn std::fmt::Display| write!(out, "{code}\n{value}\n");
    pair(0, &"SECTION")?;
    pair(2, &"HEADER")?;
    pair(9, &"$ACADVER")?;
    pair(1, &"AC1009")?;
    for (name, value) in [("$INSUNITS", 4), ("$MEASUREMENT", 1)] {
        pair(9, &name)?;
        pair(70, &value)?;
    }
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
            meter.step().map_err(io::Error::other)?;
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

/// Counts points, unless the run is cancelled.
fn metered<'a>(lines: &[Polyline], run: &'a Run) -> io::Result<Meter<'a>> {
    run.check().map_err(io::Error::other)?;
    Ok(Meter::new(run, lines.iter().map(|line| line.points().len()).sum::<usize>()))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_units_are_said() {
        let third = 1.0 / 3.0;
        let points = vec![DVec2::new(-0.0, 0.0), DVec2::new(100.0 * third, third), DVec2::new(100.0, 1e-9)];
        let lines = [Polyline::closed(points)];
        let mut svg = Vec::new();
        write_svg(&lines, &mut svg).unwrap();
        let svg = String::from_utf8(svg).unwrap();
        assert!(svg.contains("d=\"M0 0L33.3333 -0.3333L100 0Z\""), "{svg}");
        assert!(svg.contains("width=\"108mm\" height=\"8.3333mm\" viewBox=\"-4 -4.3333 108 8.3333\""), "{svg}");
        assert!(svg.contains("stroke-width=\"0.1\""), "{svg}");
        let mut dxf = Vec::new();
        write_dxf(&lines, &mut dxf).unwrap();
        let dxf = String::from_utf8(dxf).unwrap();
        assert!(dxf.contains("9\n$INSUNITS\n70\n4\n") && dxf.contains("9\n$MEASUREMENT\n70\n1\n"));
        assert_eq!([short(1e9, 0), short(-1e-9, 3), short(0.125, 6)], ["1000000000", "0", "0.125"]);
    }
}
