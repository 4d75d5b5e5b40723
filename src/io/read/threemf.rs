//! 3MF: see the [writer](crate::io::write_3mf).
//!
//! ```text
//!   _rels/.rels               names the model
//!   3D/3dmodel.model          unit; objects: meshes, or components, which are objects moved;
//!                             items: the objects that are built, moved
//!   3D/Objects/….model        more objects, where components and items say so by a path
//! ```
//!
//! Taken are the items' meshes with colours of colour groups and base materials, those in other
//! parts of the archive (the production extension) with them.

mod model;

use std::collections::HashMap;
use std::io::{Cursor, Read};

use glam::{DAffine3, DVec3};
use quick_xml::events::Event;
use quick_xml::reader::Reader;
use zip::ZipArchive;

use self::model::{Content, Model, Object, Placed, value};
use super::ReadError;
use super::error::{FilePlace, shown};
use super::limits::Limits;
use super::shape::Shape;
use crate::io::LengthUnit;
use crate::io::watched::Watched;

/// The model, where no relation says so.
const MODEL: &str = "3D/3dmodel.model";

/// Components within components.
const DEEPEST: usize = 64;

pub(super) fn read(data: &[u8], settings: &Limits<'_>) -> Result<(Shape, LengthUnit), ReadError> {
    let mut archive = ZipArchive::new(Cursor::new(data)).map_err(|error| {
        ReadError::content(FilePlace::Byte(0), "a ZIP archive", format!("{} ({error})", shown(data)))
    })?;
    let mut left = settings.most_bytes;
    let relations = unpacked(&mut archive, "_rels/.rels", &mut left, settings)?;
    let name = relations.and_then(|text| target(&text)).unwrap_or_else(|| MODEL.into());
    let Some(text) = unpacked(&mut archive, &name, &mut left, settings)? else {
        return Err(ReadError::content(FilePlace::Byte(0), format!("an archive with {name}"), "none"));
    };
    let model = Model::read(&text, &name, true, settings)?;
    drop(text);
    let unit = model.unit;
    let mut models = HashMap::from([(name.clone(), model)]);
    let mut wanted = models[&name].parts();
    while let Some(part) = wanted.pop() {
        if models.contains_key(&part) {
            continue;
        }
        let Some(text) = unpacked(&mut archive, &part, &mut left, settings)? else {
            return Err(models[&name].wrong(&format!("an archive with {part}"), "none"));
        };
        let model = Model::read(&text, &part, false, settings)?;
        wanted.extend(model.parts());
        models.insert(part, model);
    }
    let mut parts = Parts { models: &models, settings, shapes: Vec::new(), triangles: 0, points: 0, visited: 0 };
    for item in &models[&name].items {
        parts.push(&name, item, DAffine3::IDENTITY, 0)?;
    }
    Ok((Shape::joined(parts.shapes, settings)?, unit))
}

/// A part of the archive as text; nothing if there is none.
fn unpacked(
    archive: &mut ZipArchive<Cursor<&[u8]>>,
    name: &str,
    left: &mut u64,
    settings: &Limits<'_>,
) -> Result<Option<String>, ReadError> {
    let Some(index) = archive.index_for_name(name) else { return Ok(None) };
    let damaged = |byte: u64, found: String| {
        let place = FilePlace::Part { part: name.into(), byte };
        ReadError::content(place, "a part that can be unpacked", found)
    };
    let file = archive.by_index(index).map_err(|error| damaged(0, error.to_string()))?;
    let mut bytes = Vec::new();
    // What the archive says of the size is not believed.
    let read = Watched::new(file, 0, settings.run).take(left.saturating_add(1)).read_to_end(&mut bytes);
    settings.run.check()?;
    if let Err(error) = read {
        return Err(damaged(bytes.len() as u64, error.to_string()));
    }
    let Some(rest) = left.checked_sub(bytes.len() as u64) else {
        return Err(ReadError::Limit { what: "bytes", limit: settings.most_bytes, setting: "most_bytes" });
    };
    *left = rest;
    if let Some(text) = utf16(&bytes) {
        return Ok(Some(text));
    }
    match String::from_utf8(bytes) {
        Ok(text) => Ok(Some(text)),
        Err(error) => {
            let byte = error.utf8_error().valid_up_to() as u64;
            let place = FilePlace::Part { part: name.into(), byte };
            Err(ReadError::content(place, "text in UTF-8", "a byte that is none"))
        }
    }
}

/// Text in UTF-16, which begins with a mark of the order of its bytes; nothing of other text.
fn utf16(bytes: &[u8]) -> Option<String> {
    let (mark, rest) = bytes.split_first_chunk::<2>()?;
    let unit = match mark {
        [0xff, 0xfe] => u16::from_le_bytes,
        [0xfe, 0xff] => u16::from_be_bytes,
        _ => return None,
    };
    let (units, []) = rest.as_chunks::<2>() else { return None };
    String::from_utf16(&units.iter().map(|pair| unit(*pair)).collect::<Vec<u16>>()).ok()
}

/// The part that is the model.
fn target(relations: &str) -> Option<String> {
    let mut reader = Reader::from_str(relations);
    loop {
        match reader.read_event().ok()? {
            Event::Start(tag) | Event::Empty(tag)
                if tag.local_name().as_ref() == "Relationship"
                    && value(&tag, "Type").is_some_and(|kind| kind.ends_with("/3dmodel")) =>
            {
                return value(&tag, "Target").map(|target| target.trim_start_matches('/').to_string());
            }
            Event::Eof => return None,
            _ => {}
        }
    }
}

/// Objects behind the first ones count as so many points at least.
const LEAST_POINTS: usize = 100;
const FREE: usize = 1000;

/// The items, written out.
struct Parts<'a> {
    models: &'a HashMap<String, Model>,
    settings: &'a Limits<'a>,
    shapes: Vec<Shape>,
    triangles: usize,
    points: usize,
    /// How many objects were gone to, each as often as it is.
    visited: usize,
}

impl Parts<'_> {
    /// An object that a part of the archive places, in a place.
    fn push(&mut self, part: &str, placed: &Placed, above: DAffine3, depth: usize) -> Result<(), ReadError> {
        let (id, mut map) = (placed.object, above * placed.map);
        let from = &self.models[part];
        let part = placed.part.as_deref().unwrap_or(part);
        let model = &self.models[part];
        if model.unit != from.unit {
            map *= DAffine3::from_scale(DVec3::splat(model.unit.meters() / from.unit.meters()));
        }
        // A few objects without a mesh may stand for any number of themselves.
        self.visited += 1;
        self.settings.points(self.visited.saturating_sub(FREE).saturating_mul(LEAST_POINTS))?;
        let Some(object) = model.objects.get(&id) else {
            return Err(model.wrong("an object that is there", format!("object {id}")));
        };
        if depth > DEEPEST {
            return Err(model.wrong(&format!("components at most {DEEPEST} deep"), "more"));
        }
        let Object { content, .. } = object;
        match content {
            Content::Mesh(mesh) => {
                // Few objects may stand for any number of triangles.
                self.triangles += mesh.triangles.len();
                self.points += mesh.positions.len();
                self.settings.triangles(self.triangles)?;
                self.settings.points(self.points.max(self.shapes.len()))?;
                self.shapes.push(mesh.shape().moved(&map));
                Ok(())
            }
            Content::Components(components) => {
                for component in components {
                    self.push(part, component, map, depth + 1)?;
                }
                Ok(())
            }
        }
    }
}
