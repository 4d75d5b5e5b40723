//! PLY, as text and binary in both orders: see the [writer](crate::io::write_ply).
//!
//! Of `vertex` it takes x, y, z, nx, ny, nz and red, green, blue, alpha; of `face` the list of
//! vertices, colours and owner; of `tristrips` the list of vertices; of any type. Other elements
//! and properties are skipped. Polygons become triangles: fans, where faces stand before the
//! vertices.

mod header;
mod strips;

use glam::{DVec3, Vec3};

use self::header::{Element, Encoding, Header, Kind, Number, Property};
use super::ReadError;
use super::bytes::Bytes;
use super::error::FilePlace;
use super::limits::Limits;
use super::polygon::triangles;
use super::shape::Shape;
use super::text::Words;

pub(super) fn read(data: &[u8], settings: &Limits<'_>) -> Result<Shape, ReadError> {
    let header = Header::read(data)?;
    let mut values = match header.encoding {
        Encoding::Text => Values::Text(Words::new(data, header.end, header.lines + 1)),
        Encoding::Little => Values::Binary { bytes: Bytes::new(data, header.end), is_big: false },
        Encoding::Big => Values::Binary { bytes: Bytes::new(data, header.end), is_big: true },
    };
    let mut shape = Shape::default();
    let vertices = header.elements.iter().find(|element| element.name == "vertex").map_or(0, |element| element.count);
    for element in &header.elements {
        match &element.name[..] {
            "vertex" => read_vertices(element, &mut values, settings, &mut shape)?,
            "face" => read_faces(element, &mut values, settings, vertices, &mut shape)?,
            "tristrips" => strips::read(element, &mut values, settings, vertices, &mut shape)?,
            _ => skip(element, &mut values, settings)?,
        }
    }
    Ok(shape)
}

/// The numbers of a file.
enum Values<'a> {
    Text(Words<'a>),
    Binary { bytes: Bytes<'a>, is_big: bool },
}

impl Values<'_> {
    fn place(&self) -> FilePlace {
        match self {
            Values::Text(words) => words.place(),
            Values::Binary { bytes, .. } => bytes.place(),
        }
    }

    /// The next number of a kind; 64 bits hold all kinds there are.
    fn next(&mut self, number: Number, name: &str) -> Result<f64, ReadError> {
        match self {
            Values::Text(words) => words.number(name),
            Values::Binary { bytes, is_big } => number.read(bytes, *is_big, name),
        }
    }

    /// How many numbers a list has.
    fn count(&mut self, number: Number, name: &str) -> Result<u64, ReadError> {
        let place = self.place();
        let count = self.next(number, name)?;
        if count >= 0.0 && count.fract() == 0.0 {
            return Ok(count as u64);
        }
        Err(ReadError::content(place, format!("how many of {name} there are"), count.to_string()))
    }
}

fn skip(element: &Element, values: &mut Values<'_>, settings: &Limits<'_>) -> Result<(), ReadError> {
    // Of nothing there may be any number.
    let count = if element.properties.is_empty() { 0 } else { element.count };
    for _ in 0..count {
        settings.step()?;
        for property in &element.properties {
            skip_property(property, values)?;
        }
    }
    Ok(())
}

fn skip_property(property: &Property, values: &mut Values<'_>) -> Result<(), ReadError> {
    let count = match property.kind {
        Kind::One(_) => 1,
        Kind::List { count, .. } => values.count(count, &property.name)?,
    };
    for _ in 0..count {
        values.next(property.kind.number(), &property.name)?;
    }
    Ok(())
}

/// A colour's part, from the numbers that a kind has.
fn color(number: Number, value: f64) -> u8 {
    let full = match number {
        Number::F32 | Number::F64 => 1.0,
        Number::U16 | Number::I16 => 65535.0,
        _ => 255.0,
    };
    (value / full * 255.0).round() as u8
}

const RED: [[&str; 3]; 4] =
    [["red", "r", "diffuse_red"], ["green", "g", "diffuse_green"], ["blue", "b", "diffuse_blue"], ["alpha", "a", ""]];

/// Which part of a colour a property is.
fn channel(name: &str) -> Option<usize> {
    RED.iter().position(|names| names.contains(&name))
}

fn read_vertices(
    element: &Element,
    values: &mut Values<'_>,
    settings: &Limits<'_>,
    shape: &mut Shape,
) -> Result<(), ReadError> {
    const PLACES: [&str; 6] = ["x", "y", "z", "nx", "ny", "nz"];
    let has = |name: &str| element.properties.iter().any(|property| property.name == name);
    if let Some(missing) = PLACES[..3].iter().find(|name| !has(name)) {
        let expected = format!("a property {missing} of the vertices");
        return Err(ReadError::content(FilePlace::Line(element.line), expected, "none"));
    }
    let has_normals = PLACES[3..].iter().all(|name| has(name));
    let has_colors = RED[..3].iter().all(|names| names.iter().any(|name| has(name)));
    let places: Vec<_> = element
        .properties
        .iter()
        .map(|property| (PLACES.iter().position(|name| *name == property.name), channel(&property.name)))
        .collect();
    let (mut normals, mut colors) = (Vec::new(), Vec::new());
    for _ in 0..element.count {
        settings.points(shape.positions.len() + 1)?;
        let start = values.place();
        let (mut numbers, mut paint) = ([0.0; 6], [255; 4]);
        for (property, (place, channel)) in element.properties.iter().zip(&places) {
            let Kind::One(number) = property.kind else {
                skip_property(property, values)?;
                continue;
            };
            let value = values.next(number, &property.name)?;
            if let Some(place) = place {
                numbers[*place] = value;
            } else if let Some(channel) = channel {
                paint[*channel] = color(number, value);
            }
        }
        let [x, y, z, nx, ny, nz] = numbers;
        shape.push([x, y, z], || start);
        if has_normals {
            // One that is not a number is none.
            let normal = DVec3::new(nx, ny, nz).as_vec3();
            normals.push(if normal.is_finite() { normal } else { Vec3::ZERO });
        }
        if has_colors {
            colors.push(paint);
        }
    }
    shape.normals = has_normals.then_some(normals);
    shape.colors = has_colors.then_some(colors);
    Ok(())
}

fn is_corners(property: &Property) -> bool {
    matches!(&property.name[..], "vertex_indices" | "vertex_index")
}

fn expect_corners(element: &Element, what: &str) -> Result<(), ReadError> {
    if element.properties.iter().any(is_corners) {
        return Ok(());
    }
    let expected = format!("a property list vertex_indices of the {what}");
    Err(ReadError::content(FilePlace::Line(element.line), expected, "none"))
}

/// Puts what triangles of an element carry behind what those before it did: where one has nothing,
/// the default.
fn carry<T: Clone>(all: &mut Option<Vec<T>>, own: Option<Vec<T>>, counts: [usize; 2], default: T) {
    if all.is_none() && own.is_none() {
        return;
    }
    let all = all.get_or_insert_default();
    all.resize(counts[0], default.clone());
    all.extend(own.into_iter().flatten());
    all.resize(counts[1], default);
}

fn read_faces(
    element: &Element,
    values: &mut Values<'_>,
    settings: &Limits<'_>,
    vertices: u64,
    shape: &mut Shape,
) -> Result<(), ReadError> {
    let has = |names: &[&str]| element.properties.iter().any(|property| names.contains(&&property.name[..]));
    expect_corners(element, "faces")?;
    let has_colors = RED[..3].iter().all(|names| has(names));
    let has_owners = has(&["owner"]);
    let (mut colors, mut owners) = (Vec::new(), Vec::new());
    let mut polygon = Vec::new();
    let before = shape.triangles.len();
    for _ in 0..element.count {
        let start = values.place();
        let (mut paint, mut owner) = ([255; 4], 0);
        polygon.clear();
        for property in &element.properties {
            match property.kind {
                Kind::List { count, number } if is_corners(property) => {
                    let count = values.count(count, &property.name)?;
                    for _ in 0..count {
                        let place = values.place();
                        let index = values.next(number, &property.name)?;
                        if !(index >= 0.0 && index < vertices as f64 && index.fract() == 0.0) {
                            let expected = format!("a vertex from 0, of {vertices} vertices");
                            return Err(ReadError::content(place, expected, index.to_string()));
                        }
                        polygon.push(index as u32);
                    }
                }
                Kind::One(number) => {
                    let value = values.next(number, &property.name)?;
                    if let Some(channel) = channel(&property.name) {
                        paint[channel] = color(number, value);
                    } else if property.name == "owner" {
                        owner = value as u32;
                    }
                }
                Kind::List { .. } => skip_property(property, values)?,
            }
        }
        if polygon.len() < 3 {
            let found = format!("{} vertices", polygon.len());
            return Err(ReadError::content(start, "a face of at least 3 vertices", found));
        }
        settings.triangles(shape.triangles.len() + polygon.len() - 2)?;
        let (positions, found) = (&shape.positions, &mut shape.triangles);
        let position = |place: usize| positions.get(polygon[place] as usize).copied().unwrap_or_default();
        triangles(polygon.len(), position, |places| {
            found.push(places.map(|place| polygon[place]));
            if has_colors {
                colors.push([paint; 3]);
            }
            if has_owners {
                owners.push(owner);
            }
        });
    }
    let counts = [before, shape.triangles.len()];
    carry(&mut shape.corner_colors, has_colors.then_some(colors), counts, [[255; 4]; 3]);
    carry(&mut shape.owners, has_owners.then_some(owners), counts, 0);
    Ok(())
}
