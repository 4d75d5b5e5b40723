//! GLB, the binary form of glTF 2.0: see the [writer](crate::io::write_glb).
//!
//! Taken are the meshes of the default scene, moved as its nodes say and turned from y upwards to z
//! upwards, with normals, colours and texture coordinates: triangles, strips and fans, and points
//! for clouds. Vertices at one position become one, as writers split them where normals differ.
//! Data beside the file and compression are not read: that is an error.

mod accessor;
mod scene;

use glam::{DAffine3, DMat3, DVec3, Vec3};
use serde_json::Value;

use self::accessor::Data;
use self::scene::nodes;
use super::ReadError;
use super::bytes::Bytes;
use super::error::{FilePlace, shown};
use super::limits::Limits;
use super::shape::{Shape, corners_of};
use super::text::position;
use super::weld::Weld;
use crate::io::LengthUnit;

const JSON: [u8; 4] = *b"JSON";
const BINARY: [u8; 4] = *b"BIN\0";

/// Where the text begins.
const TEXT: u64 = 20;

pub(super) fn read(data: &[u8], settings: &Limits<'_>) -> Result<Shape, ReadError> {
    let mut bytes = Bytes::new(data, 0);
    let magic: [u8; 4] = bytes.array("the letters glTF")?;
    if magic != *b"glTF" {
        return Err(ReadError::content(FilePlace::Byte(0), "the letters glTF", shown(&magic)));
    }
    let version = bytes.u32("a version")?;
    if version != 2 {
        return Err(ReadError::content(FilePlace::Byte(4), "version 2", version.to_string()));
    }
    bytes.u32("a length")?;
    let (mut json, mut binary) = (None, None);
    while !bytes.left().is_empty() && binary.is_none() {
        let length = bytes.u32("a length of a chunk")?;
        let kind: [u8; 4] = bytes.array("a kind of chunk")?;
        let place = bytes.place();
        let chunk = bytes.take(length as usize, "a chunk")?;
        match kind {
            JSON if json.is_none() => {
                let text: Value = serde_json::from_slice(chunk)
                    .map_err(|error| ReadError::content(place, "JSON", error.to_string()))?;
                json = Some(text);
            }
            BINARY => binary = Some(chunk),
            _ => {}
        }
    }
    let Some(json) = json else {
        return Err(ReadError::content(FilePlace::Byte(12), "a chunk of JSON", "none"));
    };
    if let Some(extension) = json["extensionsRequired"].as_array().into_iter().flatten().find(|name| !is_known(name)) {
        return Err(wrong("a file without required extensions", extension.to_string()));
    }
    let file = Data { json: &json, binary: binary.unwrap_or_default() };
    let mut parts = Vec::new();
    let mut count = [0; 2];
    for (mesh, map) in nodes(&json, settings)? {
        let primitives = json["meshes"][mesh]["primitives"].as_array();
        let Some(primitives) = primitives else {
            return Err(wrong("a mesh with primitives", format!("mesh {mesh} without")));
        };
        for primitive in primitives {
            let Some(part) = part(&file, primitive, settings)? else { continue };
            count[0] += part.triangles.len();
            count[1] += part.positions.len();
            settings.triangles(count[0])?;
            settings.points(count[1].max(parts.len()))?;
            parts.push(part.moved(&upright(&map, settings.unit)));
        }
    }
    welded(Shape::joined(parts, settings)?, settings)
}

/// Extensions that change nothing of what is taken, and that of whole numbers as positions.
fn is_known(name: &Value) -> bool {
    const LOOKS: [&str; 4] = ["KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_"];
    let known = |name: &str| LOOKS.iter().any(|look| name.starts_with(look)) || name == "KHR_mesh_quantization";
    name.as_str().is_some_and(known)
}

/// An error of the text.
fn wrong(expected: &str, found: impl Into<String>) -> ReadError {
    ReadError::content(FilePlace::Part { part: "the JSON chunk".into(), byte: TEXT }, expected, found)
}

/// A map of metres, y upwards, as one of another unit, z upwards. Turns by right angles and scales
/// of 1 are exact.
fn upright(map: &DAffine3, unit: LengthUnit) -> DAffine3 {
    const ROUNDING: f64 = 1e-12;
    let turn = DMat3::from_cols(DVec3::X, DVec3::Z, -DVec3::Y);
    let mut upright = DAffine3::from_mat3(turn * (1.0 / unit.meters())) * *map;
    let most = upright.matrix3.to_cols_array().into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let exact = |x: f64| {
        if x.abs() < ROUNDING * most {
            0.0
        } else if (x.abs() - 1.0).abs() < ROUNDING {
            x.signum()
        } else {
            x
        }
    };
    upright.matrix3 = DMat3::from_cols_array(&upright.matrix3.to_cols_array().map(exact));
    upright
}

/// A primitive as it is; nothing of lines.
fn part(file: &Data<'_>, primitive: &Value, settings: &Limits<'_>) -> Result<Option<Shape>, ReadError> {
    let attributes = &primitive["attributes"];
    let mode = primitive["mode"].as_u64().unwrap_or(4);
    if !matches!(mode, 0 | 4..=6) {
        return Ok(None);
    }
    let Some(positions) = file.floats::<3>(&attributes["POSITION"], settings)? else { return Ok(None) };
    let mut shape = Shape::default();
    for p in positions {
        // Single precision, of which NaN and infinity are told by the accessor's place alone.
        let place = || FilePlace::Part { part: "positions in the BIN chunk".into(), byte: 0 };
        settings.step()?;
        shape.positions.push(position(p.map(f64::from), place)?);
    }
    let count = shape.positions.len();
    let fits = |given: usize, what: &str| {
        if given == count {
            return Ok(());
        }
        Err(wrong(&format!("{what} for {count} vertices"), given.to_string()))
    };
    let normals = file.floats::<3>(&attributes["NORMAL"], settings)?;
    let normals = normals.map(|list| list.into_iter().map(Vec3::from_array).collect::<Vec<Vec3>>());
    let colors = file.colors(&attributes["COLOR_0"], settings)?;
    let texture = file.floats::<2>(&attributes["TEXCOORD_0"], settings)?;
    normals.as_ref().map_or(Ok(()), |list| fits(list.len(), "normals"))?;
    colors.as_ref().map_or(Ok(()), |list| fits(list.len(), "colours"))?;
    texture.as_ref().map_or(Ok(()), |list| fits(list.len(), "texture coordinates"))?;
    if mode == 0 {
        (shape.normals, shape.colors) = (normals, colors);
        return Ok(Some(shape));
    }
    let indices = match &primitive["indices"] {
        Value::Null => (0..count as u32).collect(),
        accessor => file.indices(accessor, count, settings)?,
    };
    let corners = |k: usize| -> [u32; 3] { [indices[k], indices[k + 1], indices[k + 2]] };
    shape.triangles = match mode {
        4 => indices.as_chunks().0.to_vec(),
        5 => (0..indices.len().saturating_sub(2))
            .map(|k| if k % 2 == 0 { corners(k) } else { [indices[k + 1], indices[k], indices[k + 2]] })
            .collect(),
        _ => (1..indices.len().saturating_sub(1)).map(|k| [indices[0], indices[k], indices[k + 1]]).collect(),
    };
    shape.corner_normals = normals.map(|list| corners_of(&shape.triangles, &list));
    shape.corner_colors = colors.map(|list| corners_of(&shape.triangles, &list));
    // Downwards in glTF, upwards in a mesh.
    let upwards = |list: Vec<[f32; 2]>| list.into_iter().map(|[u, v]| [u, 1.0 - v]).collect::<Vec<_>>();
    shape.corner_texture = texture.map(|list| corners_of(&shape.triangles, &upwards(list)));
    Ok(Some(shape))
}

/// Vertices at one position as one. What has no triangles stays as it is.
fn welded(mut shape: Shape, settings: &Limits<'_>) -> Result<Shape, ReadError> {
    if shape.triangles.is_empty() {
        return Ok(shape);
    }
    let mut weld = Weld::default();
    // As a mesh holds them.
    let mut numbers = Vec::with_capacity(shape.positions.len());
    for p in &shape.positions {
        settings.step()?;
        numbers.push(weld.vertex(p.as_vec3().as_dvec3()));
    }
    shape.triangles.iter_mut().flatten().for_each(|v| *v = numbers[*v as usize]);
    shape.positions = weld.positions;
    (shape.normals, shape.colors) = (None, None);
    Ok(shape)
}
