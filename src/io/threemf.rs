//! 3MF, the 3D Manufacturing Format.
//!
//! ```text
//!   a ZIP archive
//!   ├── [Content_Types].xml
//!   ├── _rels/.rels              the model is in:
//!   └── 3D/3dmodel.model         unit, colours, vertices, triangles, as XML
//! ```
//!
//! Vertices stay shared. Colours are given to the corners, by the materials extension. Normals,
//! texture coordinates and owners have no place in the format.
//!
//! Sources: 3MF Consortium, Core Specification 1.3 and Materials Extension 1.2 (2021).

use std::io::{self, BufWriter, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use super::text::Number;
use super::unit::LengthUnit;
use super::watched::{Watched, size, staged};
use super::{SaveSettings, too_many};
use crate::Run;
use crate::geom::Mesh;

const TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>
"#;

const RELATIONS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>
"#;

/// The most that readers count, in 31 bits.
const MOST: usize = (1 << 31) - 2;

/// An archive with more bytes than this of text has 64-bit lengths.
const LARGE: usize = 1 << 31;

/// Writes a mesh as 3MF, with colours if it has them; a length of 1 means one
/// [`unit`](SaveSettings::unit). The writer need not be buffered.
///
/// The format wants a closed, manifold mesh that is oriented outward: see
/// [`Mesh::check`]. A mesh without triangles gives a file without objects.
///
/// ```
/// use rvachev::io::write_3mf;
/// use rvachev::{MeshSettings, SaveSettings, Solid};
///
/// let mesh = Solid::sphere(10.0).mesh(&MeshSettings::default())?;
/// let mut bytes = Vec::new();
/// write_3mf(&mesh, &SaveSettings::default(), &mut bytes)?;
/// assert!(bytes.starts_with(b"PK"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// Those of the writer, and [`io::ErrorKind::InvalidInput`] for a triangle with a repeated
/// index, which the format does not allow, and for more than 2³¹ − 2 vertices or triangles.
pub fn write_3mf(mesh: &Mesh, settings: &SaveSettings, out: impl Write) -> io::Result<()> {
    write_3mf_on(mesh, settings, &Run::default(), out)
}

/// [`write_3mf`] on a [`Run`], which is told how much is written, and may be cancelled.
///
/// # Errors
///
/// Those of [`write_3mf`], and one that holds a [`Cancelled`](crate::Cancelled) if cancelled:
/// what is written by then is no whole file.
pub fn write_3mf_on(mesh: &Mesh, settings: &SaveSettings, run: &Run, out: impl Write) -> io::Result<()> {
    // How far it is is told by the text, not by the archive, in which it is a fifth as long.
    staged(run, |run| written(mesh, settings, run, out))
}

fn written(mesh: &Mesh, settings: &SaveSettings, run: &Run, out: impl Write) -> io::Result<()> {
    if mesh.positions().len().max(mesh.triangles().len()) > MOST {
        return Err(too_many("3MF"));
    }
    if let Some(t) = mesh.triangles().iter().position(|&[a, b, c]| a == b || b == c || c == a) {
        let what = format!("triangle {t} has a repeated index, which 3MF does not allow");
        return Err(io::Error::new(io::ErrorKind::InvalidInput, what));
    }
    // At most: a vertex has 3 numbers of 14 digits, a triangle 3 indices and 3 colours of 10.
    let text = 100 * mesh.positions().len() + 140 * mesh.triangles().len();
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .compression_level(Some(4))
        .last_modified_time(DateTime::default());

    let mut archive = ZipWriter::new_stream(Once { out, failed: false });
    archive.start_file("[Content_Types].xml", options)?;
    archive.write_all(TYPES.as_bytes())?;
    archive.start_file("_rels/.rels", options)?;
    archive.write_all(RELATIONS.as_bytes())?;
    archive.start_file("3D/3dmodel.model", options.large_file(text > LARGE))?;
    let text = Watched::new(&mut archive, LINE * size(mesh) as u64, run);
    let mut model = BufWriter::with_capacity(1 << 16, text);
    write_model(mesh, settings.unit, &mut model)?;
    model.flush()?;
    drop(model);
    archive.finish()?.into_inner().out.flush()
}

/// Bytes of the text to a vertex or a triangle, about.
const LINE: u64 = 50;

/// A writer that fails once, and takes everything thereafter: an archive that is dropped after
/// an error tries to complete itself, and complains to the terminal if it cannot.
struct Once<W> {
    out: W,
    failed: bool,
}

impl<W: Write> Write for Once<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.failed {
            return Ok(bytes.len());
        }
        let result = self.out.write(bytes);
        self.failed = result.as_ref().is_err_and(|error| error.kind() != io::ErrorKind::Interrupted);
        result
    }

    fn flush(&mut self) -> io::Result<()> {
        if self.failed { Ok(()) } else { self.out.flush() }
    }
}

fn write_model(mesh: &Mesh, unit: LengthUnit, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, r#"<?xml version="1.0" encoding="UTF-8"?>"#)?;
    write!(out, r#"<model unit="{}" xml:lang="en-US""#, unit.name())?;
    write!(out, r#" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02""#)?;
    writeln!(out, r#" xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02">"#)?;
    writeln!(out, r#"<metadata name="Application">rvachev</metadata>"#)?;
    if mesh.triangles().is_empty() {
        return writeln!(out, "<resources/>\n<build/>\n</model>");
    }
    writeln!(out, "<resources>")?;
    let palette = mesh.corner_colors().map(palette);
    if let Some(palette) = &palette {
        writeln!(out, r#"<m:colorgroup id="1">"#)?;
        for [r, g, b, a] in palette {
            writeln!(out, r##"<m:color color="#{r:02X}{g:02X}{b:02X}{a:02X}"/>"##)?;
        }
        writeln!(out, "</m:colorgroup>")?;
    }
    // Where triangles have properties, the object has one too, for those without.
    let property = if palette.is_some() { r#" pid="1" pindex="0""# } else { "" };
    writeln!(out, r#"<object id="2" type="model"{property}>"#)?;
    writeln!(out, "<mesh>\n<vertices>")?;
    for p in mesh.positions() {
        let [x, y, z] = p.to_array().map(Number);
        writeln!(out, r#"<vertex x="{x}" y="{y}" z="{z}"/>"#)?;
    }
    writeln!(out, "</vertices>\n<triangles>")?;
    for (t, [a, b, c]) in mesh.triangles().iter().enumerate() {
        write!(out, r#"<triangle v1="{a}" v2="{b}" v3="{c}""#)?;
        if let (Some(palette), Some(colors)) = (&palette, mesh.corner_colors()) {
            let [p, q, r] = colors[t].map(|color| palette.partition_point(|c| *c < color));
            write!(out, r#" pid="1" p1="{p}""#)?;
            if (q, r) != (p, p) {
                write!(out, r#" p2="{q}" p3="{r}""#)?;
            }
        }
        writeln!(out, "/>")?;
    }
    writeln!(out, "</triangles>\n</mesh>\n</object>\n</resources>")?;
    writeln!(out, "<build>\n<item objectid=\"2\"/>\n</build>\n</model>")
}

/// The colours that occur, in order.
fn palette(colors: &[[[u8; 4]; 3]]) -> Vec<[u8; 4]> {
    let mut palette = colors.as_flattened().to_vec();
    palette.sort_unstable();
    palette.dedup();
    palette
}
