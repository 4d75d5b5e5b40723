//! Wavefront OBJ: see the [writer](crate::io::write_obj).
//!
//! It takes v (with colours from 0 to 1 where these follow), vt, vn and f, polygons as triangles;
//! other statements of the format are skipped, and what is none is an error. Normals and texture
//! coordinates are kept if all faces have them. Faces are looked at when all vertices are known, so
//! that they may stand before these.

use glam::{DVec3, Vec3};

use super::ReadError;
use super::error::{FilePlace, shown};
use super::limits::Limits;
use super::polygon::triangles;
use super::shape::Shape;
use super::text::number;

/// A form feed stands for the end of a line that goes on in the next.
const JOINED: u8 = 0x0c;

pub(super) fn read(data: &[u8], settings: &Limits<'_>) -> Result<Shape, ReadError> {
    let text = joined(data);
    let mut object = Object::new(settings);
    let mut line = 1;
    for text in text.split(|byte| *byte == b'\n') {
        object.read(text, line)?;
        line += 1 + text.iter().filter(|byte| **byte == JOINED).count() as u64;
    }
    object.finish()
}

/// The text with lines that end in a backslash joined to the next.
fn joined(data: &[u8]) -> Vec<u8> {
    let mut text: Vec<u8> = data.iter().map(|byte| if *byte == JOINED { b' ' } else { *byte }).collect();
    for at in 0..text.len() {
        if text[at] == b'\\' {
            let end = at + 1 + usize::from(text.get(at + 1) == Some(&b'\r'));
            if text.get(end) == Some(&b'\n') {
                text[at..end].fill(b' ');
                text[end] = JOINED;
            }
        }
    }
    text
}

/// What else there is in OBJ: points, lines and curves, groups, materials, how it is drawn; and
/// what was in earlier versions.
const SKIPPED: &[&[u8]] = &[
    b"vp",
    b"cstype",
    b"deg",
    b"bmat",
    b"step",
    b"p",
    b"l",
    b"curv",
    b"curv2",
    b"surf",
    b"parm",
    b"trim",
    b"hole",
    b"scrv",
    b"sp",
    b"end",
    b"con",
    b"g",
    b"s",
    b"mg",
    b"o",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"lod",
    b"usemtl",
    b"mtllib",
    b"usemap",
    b"maplib",
    b"shadow_obj",
    b"trace_obj",
    b"ctech",
    b"stech",
    b"call",
    b"csh",
    b"fo",
    b"bsp",
    b"bzp",
    b"cdc",
    b"cdp",
    b"res",
    b"vc",
    b"newmtl",
    b"mm_gscale",
    b"xform",
];

struct Object<'a> {
    settings: &'a Limits<'a>,
    shape: Shape,
    colors: Vec<[u8; 4]>,
    has_colors: bool,
    texture: Vec<[f32; 2]>,
    normals: Vec<Vec3>,
    /// Of the corners, where all of them have some.
    corner_texture: Option<Vec<[[f32; 2]; 3]>>,
    corner_normals: Option<Vec<[Vec3; 3]>>,
    faces: Vec<Face<'a>>,
}

/// A face as it is written.
struct Face<'a> {
    line: u64,
    corners: &'a [u8],
    /// How many positions, texture vertices and normals there were before it.
    before: [usize; 3],
}

/// What a corner has none of.
const NONE: u32 = u32::MAX;

impl<'a> Object<'a> {
    fn new(settings: &'a Limits<'a>) -> Object<'a> {
        Object {
            settings,
            shape: Shape::default(),
            colors: Vec::new(),
            has_colors: false,
            texture: Vec::new(),
            normals: Vec::new(),
            corner_texture: Some(Vec::new()),
            corner_normals: Some(Vec::new()),
            faces: Vec::new(),
        }
    }

    fn counts(&self) -> [usize; 3] {
        [self.shape.positions.len(), self.texture.len(), self.normals.len()]
    }

    fn read(&mut self, text: &'a [u8], line: u64) -> Result<(), ReadError> {
        let place = || FilePlace::Line(line);
        let text = text.split(|byte| *byte == b'#').next().unwrap_or_default();
        let mut words = text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        match words.next() {
            Some(b"v") => {
                self.settings.points(self.shape.positions.len() + 1)?;
                let ([x, y, z, r, g, b, ..], count) = numbers(words, line)?;
                if count < 3 {
                    return Err(ReadError::content(place(), "v and three coordinates", shown(text)));
                }
                self.shape.push([x, y, z], place);
                self.has_colors |= count >= 6;
                // Without, white.
                let color = if count >= 6 { [r, g, b].map(|x| (255.0 * x).round() as u8) } else { [255; 3] };
                self.colors.push([color[0], color[1], color[2], 255]);
            }
            Some(b"vt") => {
                let ([u, v, ..], count) = numbers(words, line)?;
                let uv = [u as f32, v as f32];
                if count < 1 || !uv.iter().all(|x| x.is_finite()) {
                    return Err(ReadError::content(place(), "vt and two finite numbers", shown(text)));
                }
                self.texture.push(uv);
            }
            Some(b"vn") => {
                let ([x, y, z, ..], count) = numbers(words, line)?;
                let normal = DVec3::new(x, y, z).as_vec3();
                if count < 3 || !normal.is_finite() {
                    return Err(ReadError::content(place(), "vn and three finite numbers", shown(text)));
                }
                self.normals.push(normal);
            }
            Some(b"f") => {
                // One triangle each, at least.
                self.settings.triangles(self.faces.len() + 1)?;
                let corners = text.trim_ascii_start().strip_prefix(b"f").unwrap_or_default();
                self.faces.push(Face { line, corners, before: self.counts() });
            }
            None => {}
            Some(word) if SKIPPED.contains(&word) => {}
            Some(word) => {
                let expected = "v, vt, vn, f or another statement of OBJ; a line that is none can be taken out";
                return Err(ReadError::content(place(), expected, shown(word)));
            }
        }
        Ok(())
    }

    /// Position, texture and normal of a corner, from 0.
    fn corner(&self, word: &[u8], face: &Face<'_>) -> Result<[u32; 3], ReadError> {
        let counts = self.counts();
        let mut corner = [NONE; 3];
        for (k, part) in word.split(|byte| *byte == b'/').enumerate() {
            if part.is_empty() && (1..3).contains(&k) {
                continue;
            }
            let [count, before] = [counts.get(k).copied(), face.before.get(k).copied()];
            let (count, before) = (count.unwrap_or_default(), before.unwrap_or_default());
            let index: Option<i64> = std::str::from_utf8(part).ok().and_then(|part| part.parse().ok());
            // From the last one before the face, where negative.
            let index = index.map(|index| if index < 0 { before as i64 + index } else { index - 1 });
            match index {
                Some(index) if k < 3 && (0..count as i64).contains(&index) => corner[k] = index as u32,
                _ => {
                    let what = ["vertex", "texture vertex", "normal"].get(k).unwrap_or(&"part of a corner");
                    let expected = match [count, before] {
                        [0, _] => format!("a {what} of the file, which has none"),
                        [_, 0] => format!("a {what} from 1 to {count}"),
                        _ => format!("a {what} from 1 to {count}, or from -1 to -{before}"),
                    };
                    return Err(ReadError::content(FilePlace::Line(face.line), expected, shown(word)));
                }
            }
        }
        Ok(corner)
    }

    fn push(&mut self, face: &Face<'_>, corners: &mut Vec<[u32; 3]>) -> Result<(), ReadError> {
        corners.clear();
        for word in face.corners.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()) {
            corners.push(self.corner(word, face)?);
        }
        if corners.len() < 3 {
            let found = format!("{} corners", corners.len());
            return Err(ReadError::content(FilePlace::Line(face.line), "f and at least 3 corners", found));
        }
        self.settings.triangles(self.shape.triangles.len() + corners.len() - 2)?;
        if corners.iter().any(|corner| corner[1] == NONE) {
            self.corner_texture = None;
        }
        if corners.iter().any(|corner| corner[2] == NONE) {
            self.corner_normals = None;
        }
        let (positions, found) = (&self.shape.positions, &mut self.shape.triangles);
        triangles(
            corners.len(),
            |place| positions[corners[place][0] as usize],
            |places| {
                let own = places.map(|place| corners[place]);
                found.push(own.map(|corner| corner[0]));
                if let Some(texture) = &mut self.corner_texture {
                    texture.push(own.map(|corner| self.texture[corner[1] as usize]));
                }
                if let Some(normals) = &mut self.corner_normals {
                    normals.push(own.map(|corner| self.normals[corner[2] as usize]));
                }
            },
        );
        Ok(())
    }

    fn finish(mut self) -> Result<Shape, ReadError> {
        let mut corners = Vec::new();
        for face in std::mem::take(&mut self.faces) {
            self.push(&face, &mut corners)?;
        }
        let has_faces = !self.shape.triangles.is_empty();
        self.shape.corner_texture = self.corner_texture.filter(|_| has_faces);
        self.shape.corner_normals = self.corner_normals.filter(|_| has_faces);
        self.shape.colors = self.has_colors.then_some(self.colors);
        if !has_faces && self.normals.len() == self.shape.positions.len() && !self.normals.is_empty() {
            // Points: a normal for each.
            self.shape.normals = Some(self.normals);
        }
        Ok(self.shape)
    }
}

/// The first numbers of a line, and how many there are.
fn numbers<'a>(words: impl Iterator<Item = &'a [u8]>, line: u64) -> Result<([f64; 8], usize), ReadError> {
    let (mut found, mut count) = ([0.0; 8], 0);
    for (to, word) in found.iter_mut().zip(words) {
        let value = number(word);
        *to = value.ok_or_else(|| ReadError::content(FilePlace::Line(line), "a number", shown(word)))?;
        count += 1;
    }
    Ok((found, count))
}
