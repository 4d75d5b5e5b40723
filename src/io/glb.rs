//! GLB, the binary form of glTF 2.0.
//!
//! ```text
//!   "glTF" 2 length                    12 bytes
//!   length "JSON" {"asset": …}         what is where, filled up with blanks
//!   length "BIN"  indices              u16, or u32 for 65 535 vertices and more
//!                 positions            3 × f32
//!                 normals              3 × f32, if the mesh has them
//!                 colours              4 × u16, if the mesh has them
//!                 texture coordinates  2 × f32, if the mesh has them
//! ```
//!
//! A vertex of glTF has one of each. A vertex whose corners carry several is written several
//! times; its position is the same in all of them. Positions are written as they are, along z
//! upwards; the node that holds the mesh turns z to glTF's y and scales the unit to metres.
//! glTF's colours are linear, and are converted from sRGB.
//!
//! Source: Khronos Group, glTF 2.0 Specification (2021), 3.7 and 4.

use std::fmt::Write as _;
use std::io::{self, BufWriter, Write};

use glam::Vec3;

use super::normal::corner_normal;
use super::split::Split;
use super::unit::LengthUnit;
use super::watched::{size, watched};
use super::{SaveSettings, too_many};
use crate::Run;
use crate::geom::Mesh;

/// Writes a mesh as GLB, with normals, colours and texture coordinates if it has them; a length
/// of 1 means one [`unit`](SaveSettings::unit). The writer need not be buffered.
///
/// Vertices that no triangle uses are left out. A mesh without triangles gives a scene with an
/// empty node.
///
/// ```
/// use glam::Vec3;
/// use rvachev::io::write_glb;
/// use rvachev::{Mesh, SaveSettings};
///
/// let mesh = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]])?;
/// let mut bytes = Vec::new();
/// write_glb(&mesh, &SaveSettings::default(), &mut bytes)?;
/// assert!(bytes.starts_with(b"glTF"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// Those of the writer, and [`io::ErrorKind::InvalidInput`] for a file of more than 4 GiB, the
/// most that the format can hold.
pub fn write_glb(mesh: &Mesh, settings: &SaveSettings, out: impl Write) -> io::Result<()> {
    write_glb_on(mesh, settings, &Run::default(), out)
}

/// [`write_glb`] on a [`Run`], which is told how much is written, and may be cancelled.
///
/// # Errors
///
/// Those of [`write_glb`], and one that holds a [`Cancelled`](crate::Cancelled) if cancelled:
/// what is written by then is no whole file.
pub fn write_glb_on(mesh: &Mesh, settings: &SaveSettings, run: &Run, out: impl Write) -> io::Result<()> {
    watched(size(mesh), run, out, |run, out| written(mesh, settings, run, out))
}

fn written(mesh: &Mesh, settings: &SaveSettings, run: &Run, out: impl Write) -> io::Result<()> {
    let carried = |corner: usize, _| {
        let (t, k) = (corner / 3, corner % 3);
        let normal = corner_normal(mesh, corner).map(|n| n.to_array().map(f32::to_bits));
        let color = mesh.corner_colors().map(|colors| colors[t][k]);
        let texture = mesh.corner_texture().map(|uv| uv[t][k].map(f32::to_bits));
        (normal, color, texture)
    };
    let split = Split::new(mesh, "GLB", run, carried)?;
    let layout = Layout::new(mesh, &split);
    let mut json = layout.json(settings.unit);
    while !json.len().is_multiple_of(4) {
        json.push(' ');
    }
    let binary: u64 = layout.parts.iter().map(Part::padded).sum();
    let chunks = if binary == 0 { 20 } else { 28 };
    let length = u32::try_from(chunks + json.len() as u64 + binary).map_err(|_| too_many("GLB"))?;

    let mut out = BufWriter::with_capacity(1 << 16, out);
    out.write_all(b"glTF")?;
    for number in [2, length, json.len() as u32] {
        out.write_all(&number.to_le_bytes())?;
    }
    out.write_all(b"JSON")?;
    out.write_all(json.as_bytes())?;
    if binary > 0 {
        out.write_all(&(binary as u32).to_le_bytes())?;
        out.write_all(b"BIN\0")?;
        for part in &layout.parts {
            part.write(mesh, &split, &mut out)?;
        }
    }
    out.flush()
}

/// What a part of the binary holds.
#[derive(Clone, Copy, PartialEq)]
enum Content {
    ShortIndices,
    Indices,
    Positions,
    Normals,
    Colors,
    Texture,
}

/// A part of the binary: a buffer view, and the accessor of the same number.
struct Part {
    content: Content,
    /// Elements: indices or vertices.
    count: usize,
}

impl Part {
    /// Bytes of an element.
    fn stride(&self) -> u64 {
        match self.content {
            Content::ShortIndices => 2,
            Content::Indices => 4,
            Content::Positions | Content::Normals => 12,
            Content::Colors | Content::Texture => 8,
        }
    }

    fn bytes(&self) -> u64 {
        self.stride() * self.count as u64
    }

    fn padded(&self) -> u64 {
        self.bytes().next_multiple_of(4)
    }

    /// glTF's number for the type of a component, and its name for the type of an element.
    fn types(&self) -> (u32, &'static str) {
        match self.content {
            Content::ShortIndices => (5123, "SCALAR"),
            Content::Indices => (5125, "SCALAR"),
            Content::Positions | Content::Normals => (5126, "VEC3"),
            Content::Colors => (5123, "VEC4"),
            Content::Texture => (5126, "VEC2"),
        }
    }

    fn attribute(&self) -> Option<&'static str> {
        match self.content {
            Content::ShortIndices | Content::Indices => None,
            Content::Positions => Some("POSITION"),
            Content::Normals => Some("NORMAL"),
            Content::Colors => Some("COLOR_0"),
            Content::Texture => Some("TEXCOORD_0"),
        }
    }

    fn write(&self, mesh: &Mesh, split: &Split, out: &mut impl Write) -> io::Result<()> {
        match self.content {
            Content::ShortIndices => {
                for &i in &split.pairs {
                    out.write_all(&(i as u16).to_le_bytes())?;
                }
            }
            Content::Indices => {
                for &i in &split.pairs {
                    out.write_all(&i.to_le_bytes())?;
                }
            }
            _ => {
                for &corner in &split.examples {
                    self.write_vertex(mesh, corner, out)?;
                }
            }
        }
        out.write_all(&[0; 4][..(self.padded() - self.bytes()) as usize])
    }

    fn write_vertex(&self, mesh: &Mesh, corner: usize, out: &mut impl Write) -> io::Result<()> {
        let floats =
            |numbers: &[f32], out: &mut dyn Write| numbers.iter().try_for_each(|x| out.write_all(&x.to_le_bytes()));
        match (self.content, mesh.corner_colors(), mesh.corner_texture()) {
            (Content::Normals, ..) => floats(&corner_normal(mesh, corner).unwrap_or(Vec3::Z).to_array(), out),
            (Content::Colors, Some(colors), _) => {
                let [r, g, b, a] = colors[corner / 3][corner % 3];
                for x in [linear(r), linear(g), linear(b), u16::from(a) * 257] {
                    out.write_all(&x.to_le_bytes())?;
                }
                Ok(())
            }
            // Upwards in a mesh, downwards in glTF.
            (Content::Texture, _, Some(uv)) => {
                let [u, v] = uv[corner / 3][corner % 3];
                floats(&[u, 1.0 - v], out)
            }
            _ => floats(&position(mesh, corner).to_array(), out),
        }
    }
}

fn position(mesh: &Mesh, corner: usize) -> Vec3 {
    mesh.positions()[mesh.triangles()[corner / 3][corner % 3] as usize]
}

/// From sRGB, 0 to 255, to linear, 0 to 65 535.
fn linear(x: u8) -> u16 {
    let x = f64::from(x) / 255.0;
    let linear = if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) };
    (65535.0 * linear).round() as u16
}

/// What the file consists of.
struct Layout {
    /// Without triangles, none.
    parts: Vec<Part>,
    min: Vec3,
    max: Vec3,
    is_opaque: bool,
}

impl Layout {
    fn new(mesh: &Mesh, split: &Split) -> Layout {
        let vertices = split.examples.len();
        let mut parts = Vec::new();
        let mut part = |content: Content, count: usize| parts.push(Part { content, count });
        if !split.pairs.is_empty() {
            // The highest number of 16 bits is not allowed.
            let indices = if vertices <= 65535 { Content::ShortIndices } else { Content::Indices };
            part(indices, split.pairs.len());
            part(Content::Positions, vertices);
            if mesh.normals().is_some() || mesh.corner_normals().is_some() {
                part(Content::Normals, vertices);
            }
            if mesh.corner_colors().is_some() {
                part(Content::Colors, vertices);
            }
            if mesh.corner_texture().is_some() {
                part(Content::Texture, vertices);
            }
        }
        let (mut min, mut max) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for &corner in &split.examples {
            let p = position(mesh, corner);
            (min, max) = (min.min(p), max.max(p));
        }
        let is_opaque = mesh.corner_colors().is_none_or(|c| c.as_flattened().iter().all(|c| c[3] == 255));
        Layout { parts, min, max, is_opaque }
    }

    fn json(&self, unit: LengthUnit) -> String {
        let mut json = String::from(r#"{"asset":{"version":"2.0","generator":"rvachev"},"scene":0"#);
        if self.parts.is_empty() {
            json.push_str(r#","scenes":[{"nodes":[0]}],"nodes":[{}]}"#);
            return json;
        }
        let scale = unit.meters();
        // A quarter turn about x: z becomes y.
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let alpha = if self.is_opaque { "" } else { r#","alphaMode":"BLEND""# };
        let attributes: Vec<String> = self
            .parts
            .iter()
            .enumerate()
            .filter_map(|(i, part)| part.attribute().map(|name| format!(r#""{name}":{i}"#)))
            .collect();
        let total: u64 = self.parts.iter().map(Part::padded).sum();
        // Writing to a String cannot fail.
        let _ = write!(
            json,
            concat!(
                r#","scenes":[{{"nodes":[0]}}],"#,
                r#""nodes":[{{"mesh":0,"rotation":[{},0,0,{}],"scale":[{},{},{}]}}],"#,
                r#""meshes":[{{"primitives":[{{"attributes":{{{}}},"indices":0,"material":0}}]}}],"#,
                r#""materials":[{{"pbrMetallicRoughness":{{"metallicFactor":0,"roughnessFactor":0.6}}{}}}],"#,
                r#""buffers":[{{"byteLength":{}}}]"#
            ),
            -half,
            half,
            scale,
            scale,
            scale,
            attributes.join(","),
            alpha,
            total
        );
        let (mut views, mut accessors) = (Vec::new(), Vec::new());
        let mut offset = 0;
        for (i, part) in self.parts.iter().enumerate() {
            let target = if part.attribute().is_some() { 34962 } else { 34963 };
            let length = part.bytes();
            views.push(format!(r#"{{"buffer":0,"byteOffset":{offset},"byteLength":{length},"target":{target}}}"#));
            offset += part.padded();
            let (component, element) = part.types();
            let more = match part.content {
                Content::Positions => {
                    // As f64: the shortest digits of an f32 are another number there.
                    let list = |p: Vec3| {
                        let [x, y, z] = p.to_array().map(f64::from);
                        format!("[{x:?},{y:?},{z:?}]")
                    };
                    format!(r#","min":{},"max":{}"#, list(self.min), list(self.max))
                }
                Content::Colors => r#","normalized":true"#.into(),
                _ => String::new(),
            };
            let count = part.count;
            accessors.push(format!(
                r#"{{"bufferView":{i},"componentType":{component},"count":{count},"type":"{element}"{more}}}"#
            ));
        }
        let (views, accessors) = (views.join(","), accessors.join(","));
        let _ = write!(json, r#","bufferViews":[{views}],"accessors":[{accessors}]}}"#);
        json
    }
}
