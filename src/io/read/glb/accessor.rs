//! Numbers of a glTF file: accessors of views of the binary chunk.

use serde_json::Value;

use super::super::ReadError;
use super::super::limits::Limits;
use super::wrong;
use crate::geom::to_byte;

/// The text and the binary chunk.
pub(super) struct Data<'a> {
    pub(super) json: &'a Value,
    pub(super) binary: &'a [u8],
}

/// The types of components, as glTF numbers them.
#[derive(Clone, Copy, PartialEq)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn of(number: &Value) -> Option<Component> {
        Some(match number.as_u64()? {
            5120 => Component::I8,
            5121 => Component::U8,
            5122 => Component::I16,
            5123 => Component::U16,
            5125 => Component::U32,
            5126 => Component::F32,
            _ => return None,
        })
    }

    fn bytes(self) -> usize {
        match self {
            Component::I8 | Component::U8 => 1,
            Component::I16 | Component::U16 => 2,
            Component::U32 | Component::F32 => 4,
        }
    }

    /// The number that stands at the beginning, as 64 bits hold it.
    fn read(self, bytes: &[u8]) -> f64 {
        match (self, bytes) {
            (Component::U8, [a, ..]) => f64::from(*a),
            (Component::I8, [a, ..]) => f64::from(*a as i8),
            (Component::U16, [a, b, ..]) => f64::from(u16::from_le_bytes([*a, *b])),
            (Component::I16, [a, b, ..]) => f64::from(i16::from_le_bytes([*a, *b])),
            (Component::U32, [a, b, c, d, ..]) => f64::from(u32::from_le_bytes([*a, *b, *c, *d])),
            (Component::F32, [a, b, c, d, ..]) => f64::from(f32::from_le_bytes([*a, *b, *c, *d])),
            _ => 0.0,
        }
    }

    /// What stands for 1 where whole numbers are parts.
    fn full(self) -> f64 {
        match self {
            Component::I8 => 127.0,
            Component::U8 => 255.0,
            Component::I16 => 32767.0,
            Component::U16 => 65535.0,
            Component::U32 | Component::F32 => 1.0,
        }
    }
}

/// Elements of an accessor that others stand for.
struct Sparse<'a> {
    /// Their numbers, which rise.
    numbers: Vec<usize>,
    /// What stands for them, one after the other.
    bytes: &'a [u8],
}

/// An accessor whose bytes are there.
struct Elements<'a> {
    bytes: &'a [u8],
    component: Component,
    /// How many components an element has, and how many bytes are from one to the next.
    width: usize,
    stride: usize,
    count: usize,
    is_normalized: bool,
    sparse: Option<Sparse<'a>>,
}

impl Elements<'_> {
    /// A component of an element.
    fn at(&self, element: usize, k: usize) -> f64 {
        let size = self.component.bytes();
        let instead = self.sparse.as_ref().and_then(|sparse| {
            let place = sparse.numbers.binary_search(&element).ok()?;
            sparse.bytes.get((place * self.width + k) * size..)
        });
        let own = || self.bytes.get(element * self.stride + k * size..).unwrap_or_default();
        let value = self.component.read(instead.unwrap_or_else(own));
        if self.is_normalized { (value / self.component.full()).max(-1.0) } else { value }
    }
}

/// A whole number, 0 if there is none.
fn place(value: &Value) -> usize {
    value.as_u64().map_or(0, |x| usize::try_from(x).unwrap_or(usize::MAX))
}

impl<'a> Data<'a> {
    fn elements(&self, accessor: &Value, settings: &Limits<'_>) -> Result<Option<Elements<'a>>, ReadError> {
        if accessor.is_null() {
            return Ok(None);
        }
        let number = accessor.as_u64().map_or(usize::MAX, |i| i as usize);
        let Some(it) = self.json["accessors"].get(number) else {
            return Err(wrong("an accessor that is there", accessor.to_string()));
        };
        let error =
            |expected: &str, found: &Value| Err(wrong(&format!("accessor {number}: {expected}"), found.to_string()));
        let Some(component) = Component::of(&it["componentType"]) else {
            return error("a componentType of glTF", &it["componentType"]);
        };
        let width = match it["type"].as_str() {
            Some("SCALAR") => 1,
            Some("VEC2") => 2,
            Some("VEC3") => 3,
            Some("VEC4") => 4,
            _ => return error("a type SCALAR, VEC2, VEC3 or VEC4", &it["type"]),
        };
        let Some(count) = it["count"].as_u64().and_then(|count| usize::try_from(count).ok()) else {
            return error("a count", &it["count"]);
        };
        let view = match self.view(it) {
            Ok(view) => view,
            Err((expected, found)) => return error(expected, found),
        };
        let bytes = component.bytes() * width;
        let stride = place(&view["byteStride"]).max(bytes);
        let inner = self.inner(view, it);
        let needed = count.checked_sub(1).map_or(Some(0), |last| last.checked_mul(stride)?.checked_add(bytes));
        match (inner, needed) {
            // So nothing is larger than what is there.
            (Some(inner), Some(needed)) if needed <= inner.len() => {
                settings.points(count / 3)?;
                let is_normalized = it["normalized"].as_bool().unwrap_or(false);
                let sparse = match self.sparse(&it["sparse"], bytes, count) {
                    Ok(sparse) => sparse,
                    Err((expected, found)) => return error(expected, found),
                };
                Ok(Some(Elements { bytes: inner, component, width, stride, count, is_normalized, sparse }))
            }
            _ => {
                let expected = format!("{count} elements of {bytes} bytes in {} bytes of data", self.binary.len());
                error(&expected, &it["byteOffset"])
            }
        }
    }

    /// The view of an accessor or of a part of one; else what was expected, and what was found.
    fn view<'b>(&'b self, it: &'b Value) -> Result<&'b Value, (&'static str, &'b Value)> {
        let view = it["bufferView"].as_u64().and_then(|view| self.json["bufferViews"].get(view as usize));
        let Some(view) = view else { return Err(("a bufferView that is there", &it["bufferView"])) };
        if view["buffer"].as_u64() != Some(0) || !self.json["buffers"][0]["uri"].is_null() {
            return Err(("data in the file itself", &view["buffer"]));
        }
        Ok(view)
    }

    /// The bytes of a view from where an accessor begins.
    fn inner(&self, view: &Value, it: &Value) -> Option<&'a [u8]> {
        let (from, length) = (place(&view["byteOffset"]), place(&view["byteLength"]));
        let view = from.checked_add(length).and_then(|end| self.binary.get(from..end));
        view.and_then(|view| view.get(place(&it["byteOffset"])..))
    }

    /// What stands for some of an accessor's `count` elements, of so many bytes each.
    fn sparse<'b>(
        &'b self,
        it: &'b Value,
        bytes: usize,
        count: usize,
    ) -> Result<Option<Sparse<'a>>, (&'static str, &'b Value)> {
        if it.is_null() {
            return Ok(None);
        }
        let (indices, values) = (&it["indices"], &it["values"]);
        let (of_indices, of_values) =
            (self.inner(self.view(indices)?, indices), self.inner(self.view(values)?, values));
        let component = match Component::of(&indices["componentType"]) {
            Some(component @ (Component::U8 | Component::U16 | Component::U32)) => component,
            _ => return Err(("indices without sign in sparse", &indices["componentType"])),
        };
        let (of_indices, of_values) = (of_indices.unwrap_or_default(), of_values.unwrap_or_default());
        let some = place(&it["count"]);
        // So nothing is larger than what is there.
        if some > of_indices.len() / component.bytes() || some > of_values.len() / bytes {
            return Err(("as many sparse elements as there are bytes for", &it["count"]));
        }
        let numbers: Vec<usize> =
            of_indices.chunks_exact(component.bytes()).take(some).map(|own| component.read(own) as usize).collect();
        if !numbers.is_sorted_by(|a, b| a < b) || numbers.last().is_some_and(|last| *last >= count) {
            return Err(("sparse indices that rise, below the count", indices));
        }
        Ok(Some(Sparse { numbers, bytes: of_values }))
    }

    /// Finite numbers by N; nothing if there is no such accessor.
    pub(super) fn floats<const N: usize>(
        &self,
        accessor: &Value,
        settings: &Limits<'_>,
    ) -> Result<Option<Vec<[f32; N]>>, ReadError> {
        let Some(elements) = self.elements(accessor, settings)? else { return Ok(None) };
        if elements.width != N {
            let found = elements.width.to_string();
            return Err(wrong(&format!("accessor {accessor}: {N} numbers an element"), found));
        }
        let mut list = Vec::with_capacity(elements.count);
        for i in 0..elements.count {
            settings.step()?;
            let element: [f32; N] = std::array::from_fn(|k| elements.at(i, k) as f32);
            if let Some(x) = element.iter().find(|x| !x.is_finite()) {
                return Err(wrong(&format!("accessor {accessor}: finite numbers"), format!("{x} in element {i}")));
            }
            list.push(element);
        }
        Ok(Some(list))
    }

    /// Colours in sRGB, opaque if they do not say.
    pub(super) fn colors(&self, accessor: &Value, settings: &Limits<'_>) -> Result<Option<Vec<[u8; 4]>>, ReadError> {
        let Some(elements) = self.elements(accessor, settings)? else { return Ok(None) };
        if elements.width < 3 {
            return Err(wrong(&format!("accessor {accessor}: 3 or 4 numbers a colour"), elements.width.to_string()));
        }
        let color = |i: usize| {
            let alpha = if elements.width > 3 { elements.at(i, 3) } else { 1.0 };
            let [r, g, b] = [0, 1, 2].map(|k| to_byte(elements.at(i, k) as f32));
            [r, g, b, (255.0 * alpha).round() as u8]
        };
        Ok(Some((0..elements.count).map(color).collect()))
    }

    /// Indices below the number of vertices.
    pub(super) fn indices(
        &self,
        accessor: &Value,
        vertices: usize,
        settings: &Limits<'_>,
    ) -> Result<Vec<u32>, ReadError> {
        let Some(elements) = self.elements(accessor, settings)? else { return Ok(Vec::new()) };
        if elements.width != 1 || !matches!(elements.component, Component::U8 | Component::U16 | Component::U32) {
            return Err(wrong(&format!("accessor {accessor}: indices without sign"), "other numbers"));
        }
        let mut list = Vec::with_capacity(elements.count);
        for i in 0..elements.count {
            let index = elements.at(i, 0);
            if index >= vertices as f64 {
                let expected = format!("accessor {accessor}: an index from 0, of {vertices} vertices");
                return Err(wrong(&expected, format!("{index} in element {i}")));
            }
            list.push(index as u32);
        }
        Ok(list)
    }
}
