//! The model of a 3MF file.

use std::collections::HashMap;

use glam::{DAffine3, DVec3};
use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;

use super::super::ReadError;
use super::super::error::{FilePlace, shown};
use super::super::limits::Limits;
use super::super::shape::Shape;
use super::super::text::{number, position};
use crate::io::LengthUnit;

/// An object and where it stands.
pub(super) struct Placed {
    /// The part of the archive that it is in, if that is another one.
    pub(super) part: Option<String>,
    pub(super) object: u32,
    pub(super) map: DAffine3,
}

pub(super) enum Content {
    Mesh(Part),
    Components(Vec<Placed>),
}

pub(super) struct Object {
    pub(super) content: Content,
    /// The colour of triangles without one, by group and place.
    color: Option<(u32, usize)>,
}

/// A mesh; corners without a colour are `None`.
#[derive(Default)]
pub(super) struct Part {
    pub(super) positions: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    colors: Vec<[Option<[u8; 4]>; 3]>,
}

impl Part {
    pub(super) fn shape(&self) -> Shape {
        let colors = || self.colors.iter().map(|corners| corners.map(|color| color.unwrap_or([255; 4]))).collect();
        let has_colors = self.colors.iter().flatten().any(Option::is_some);
        Shape {
            positions: self.positions.clone(),
            triangles: self.triangles.clone(),
            corner_colors: has_colors.then(colors),
            ..Shape::default()
        }
    }
}

pub(super) struct Model {
    name: String,
    pub(super) unit: LengthUnit,
    pub(super) objects: HashMap<u32, Object>,
    pub(super) items: Vec<Placed>,
    colors: HashMap<u32, Vec<[u8; 4]>>,
    /// Where the reader is.
    at: u64,
}

/// An attribute by its name without prefix.
pub(super) fn value(tag: &BytesStart<'_>, name: &str) -> Option<String> {
    let mut attributes = tag.attributes();
    attributes.with_checks(false);
    let found = attributes.flatten().find(|attribute| attribute.key.local_name().as_ref() == name)?;
    found.normalized_value(XmlVersion::Implicit1_0).ok().map(|value| value.into_owned())
}

impl Model {
    /// The other parts of the archive that it wants objects of.
    pub(super) fn parts(&self) -> Vec<String> {
        let within = self.objects.values().flat_map(|object| match &object.content {
            Content::Mesh(_) => [].iter(),
            Content::Components(placed) => placed.iter(),
        });
        let mut all: Vec<String> = within.chain(&self.items).filter_map(|placed| placed.part.clone()).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// An error where the reader is.
    pub(super) fn wrong(&self, expected: &str, found: impl Into<String>) -> ReadError {
        ReadError::content(FilePlace::Part { part: self.name.clone(), byte: self.at }, expected, found)
    }

    /// Reads a part of the archive: that which says what is built, or one beside it.
    pub(super) fn read(text: &str, name: &str, is_main: bool, settings: &Limits<'_>) -> Result<Model, ReadError> {
        let mut model = Model {
            name: name.into(),
            unit: LengthUnit::default(),
            objects: HashMap::new(),
            items: Vec::new(),
            colors: HashMap::new(),
            at: 0,
        };
        let mut reader = Reader::from_str(text);
        let mut object: Option<(u32, Object)> = None;
        let mut group = None;
        let (mut has_model, mut has_build) = (false, false);
        // Of elements that have begun.
        let mut open: Vec<String> = Vec::new();
        loop {
            model.at = reader.buffer_position();
            let event = reader.read_event().map_err(|error| model.wrong("well-formed XML", error.to_string()))?;
            let (tag, is_empty) = match event {
                Event::Start(tag) => {
                    open.push(tag.local_name().as_ref().to_string());
                    (tag, false)
                }
                Event::Empty(tag) => (tag, true),
                Event::End(tag) => {
                    open.pop();
                    if tag.local_name().as_ref() == "object"
                        && let Some((id, object)) = object.take()
                    {
                        model.objects.insert(id, object);
                    }
                    continue;
                }
                Event::Eof if !has_model => return Err(model.wrong("a model", "the end of the part")),
                Event::Eof => {
                    if let Some(element) = open.pop() {
                        let expected = format!("</{element}>; of a file that was cut off the rest is needed");
                        return Err(model.wrong(&expected, "the end of the part"));
                    }
                    if is_main && !has_build {
                        return Err(model.wrong("a build, which says which objects there are", "the end of the part"));
                    }
                    return Ok(model);
                }
                _ => continue,
            };
            match tag.local_name().as_ref() {
                "model" => {
                    has_model = true;
                    model.unit = model.unit_of(&tag)?;
                }
                "build" => has_build = true,
                "colorgroup" | "basematerials" => {
                    let id = model.index(&tag, "id")?;
                    model.colors.insert(id, Vec::new());
                    group = Some(id);
                }
                "color" | "base" => {
                    let name = if tag.local_name().as_ref() == "color" { "color" } else { "displaycolor" };
                    let color = model.color(value(&tag, name))?;
                    group.and_then(|id| model.colors.get_mut(&id)).into_iter().for_each(|list| list.push(color));
                }
                "object" => {
                    let id = model.index(&tag, "id")?;
                    let color = match (value(&tag, "pid"), value(&tag, "pindex")) {
                        (Some(_), Some(_)) => Some((model.index(&tag, "pid")?, model.index(&tag, "pindex")? as usize)),
                        _ => None,
                    };
                    let new = Object { content: Content::Mesh(Part::default()), color };
                    if is_empty {
                        model.objects.insert(id, new);
                    } else {
                        object = Some((id, new));
                    }
                }
                "components" => {
                    if let Some((_, object)) = &mut object {
                        object.content = Content::Components(Vec::new());
                    }
                }
                "component" | "item" => {
                    let placed = model.placed(&tag)?;
                    match (&mut object, tag.local_name().as_ref()) {
                        (None, "item") => model.items.push(placed),
                        (Some((_, Object { content: Content::Components(list), .. })), "component") => {
                            settings.points(list.len() + 1)?;
                            list.push(placed);
                        }
                        _ => return Err(model.wrong("component in components, item in build", "another place")),
                    }
                }
                "vertex" => {
                    let p = [model.coordinate(&tag, "x")?, model.coordinate(&tag, "y")?, model.coordinate(&tag, "z")?];
                    let place = || FilePlace::Part { part: model.name.clone(), byte: model.at };
                    let p = position(p, place)?;
                    if let Some((_, Object { content: Content::Mesh(mesh), .. })) = &mut object {
                        settings.points(mesh.positions.len() + 1)?;
                        mesh.positions.push(p);
                    }
                }
                "triangle" => {
                    if let Some((_, Object { content: Content::Mesh(mesh), color })) = &mut object {
                        settings.triangles(mesh.triangles.len() + 1)?;
                        let corners = model.corners(&tag, mesh.positions.len())?;
                        mesh.triangles.push(corners);
                        mesh.colors.push(model.colors_of(&tag, *color)?);
                    }
                }
                _ => {}
            }
        }
    }

    fn unit_of(&self, tag: &BytesStart<'_>) -> Result<LengthUnit, ReadError> {
        let Some(name) = value(tag, "unit") else { return Ok(LengthUnit::Millimeter) };
        let found = LengthUnit::ALL.into_iter().find(|unit| unit.name() == name);
        found.ok_or_else(|| {
            self.wrong("a unit of micron, millimeter, centimeter, inch, foot, meter", shown(name.as_bytes()))
        })
    }

    fn index(&self, tag: &BytesStart<'_>, name: &str) -> Result<u32, ReadError> {
        let text = value(tag, name);
        let index = text.as_ref().and_then(|text| text.trim().parse().ok());
        index.ok_or_else(|| self.missing(&format!("{name}, a whole number,"), text))
    }

    fn missing(&self, expected: &str, found: Option<String>) -> ReadError {
        self.wrong(expected, found.map_or_else(|| "none".into(), |text| shown(text.as_bytes())))
    }

    fn coordinate(&self, tag: &BytesStart<'_>, name: &str) -> Result<f64, ReadError> {
        let text = value(tag, name);
        let found = text.as_ref().and_then(|text| number(text.trim().as_bytes()));
        found.ok_or_else(|| self.missing(&format!("{name}, a number,"), text))
    }

    fn corners(&self, tag: &BytesStart<'_>, count: usize) -> Result<[u32; 3], ReadError> {
        let corners = [self.index(tag, "v1")?, self.index(tag, "v2")?, self.index(tag, "v3")?];
        match corners.iter().find(|v| **v as usize >= count) {
            None => Ok(corners),
            Some(v) => Err(self.wrong(&format!("a vertex from 0, of {count} vertices"), v.to_string())),
        }
    }

    /// An object and a map of 12 numbers: where the axes and the origin go.
    fn placed(&self, tag: &BytesStart<'_>) -> Result<Placed, ReadError> {
        let part = value(tag, "path").map(|path| path.trim_start_matches('/').to_string());
        let object = self.index(tag, "objectid")?;
        let Some(text) = value(tag, "transform") else {
            return Ok(Placed { part, object, map: DAffine3::IDENTITY });
        };
        let numbers: Vec<f64> = text.split_whitespace().filter_map(|word| number(word.as_bytes())).collect();
        match <[f64; 12]>::try_from(numbers) {
            Ok(numbers) if numbers.iter().all(|x| x.is_finite()) => {
                Ok(Placed { part, object, map: DAffine3::from_cols_array(&numbers) })
            }
            _ => Err(self.wrong("a transform of 12 finite numbers", shown(text.as_bytes()))),
        }
    }

    /// `#RRGGBB` or `#RRGGBBAA`.
    fn color(&self, text: Option<String>) -> Result<[u8; 4], ReadError> {
        let digits = text.as_ref().and_then(|text| text.trim().strip_prefix('#'));
        let parsed = digits.and_then(|digits| match digits.len() {
            6 => u32::from_str_radix(digits, 16).ok().map(|rgb| rgb << 8 | 255),
            8 => u32::from_str_radix(digits, 16).ok(),
            _ => None,
        });
        parsed.map(u32::to_be_bytes).ok_or_else(|| self.missing("a colour as #RRGGBB or #RRGGBBAA", text))
    }

    /// The colours of a triangle's corners. Groups that are no colours give none.
    fn colors_of(
        &self,
        tag: &BytesStart<'_>,
        of_object: Option<(u32, usize)>,
    ) -> Result<[Option<[u8; 4]>; 3], ReadError> {
        let group = match (value(tag, "pid"), of_object) {
            (Some(_), _) => self.index(tag, "pid")?,
            (None, Some((group, _))) => group,
            (None, None) => return Ok([None; 3]),
        };
        let Some(colors) = self.colors.get(&group) else { return Ok([None; 3]) };
        let first = match (value(tag, "p1"), of_object) {
            (Some(_), _) => self.index(tag, "p1")? as usize,
            (None, Some((_, place))) => place,
            (None, None) => return Ok([None; 3]),
        };
        let mut places = [first; 3];
        for (place, name) in places[1..].iter_mut().zip(["p2", "p3"]) {
            if value(tag, name).is_some() {
                *place = self.index(tag, name)? as usize;
            }
        }
        match places.iter().find(|place| **place >= colors.len()) {
            None => Ok(places.map(|place| colors.get(place).copied())),
            Some(place) => {
                Err(self.wrong(&format!("a colour from 0, of {} in group {group}", colors.len()), place.to_string()))
            }
        }
    }
}
