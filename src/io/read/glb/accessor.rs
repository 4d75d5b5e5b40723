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

/// An accessor whose bytes are there.
struct Elements<'a> {
    bytes: &'a [u8],
    component: Component,
    /// How many components an element has, and how many bytes are from one to the next.
    width: usize,
    stride: usize,
    count: usize,
    is_normalized: bool,
}

impl Elements<'_> {
    /// A component of an element.
    fn at(&self, element: usize, k: usize) -> f64 {
        let from = element * self.stride + k * self.component.bytes();
        let value = self.component.read(self.bytes.get(from..).unwrap_or_default());
        if self.is_normalized { (value / self.component.full()).max(-1.0) } else { value }
    }
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
        if !it["sparse"].is_null() {
            return error("one that is not sparse", &it["sparse"]);
        }
        let component = match it["componentType"].as_u64() {
            Some(5120) => Component::I8,
            Some(5121) => Component::U8,
            Some(5122) => Component::I16,
            Some(5123) => Component::U16,
            Some(5125) => Component::U32,
            Some(5126) => Component::F32,
            _ => return error("a componentType of glTF", &it["componentType"]),
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
        let view = it["bufferView"].as_u64().and_then(|view| self.json["bufferViews"].get(view as usize));
        let Some(view) = view else { return error("a bufferView that is there", &it["bufferView"]) };
        if view["buffer"].as_u64() != Some(0) || !self.json["buffers"][0]["uri"].is_null() {
            return error("data in the file itself", &view["buffer"]);
        }
        let place = |value: &Value| value.as_u64().map_or(0, |x| usize::try_from(x).unwrap_or(usize::MAX));
        let bytes = component.bytes() * width;
        let stride = place(&view["byteStride"]).max(bytes);
        let (from, length) = (place(&view["byteOffset"]), place(&view["byteLength"]));
        let view = from.checked_add(length).and_then(|end| self.binary.get(from..end));
        let inner = view.and_then(|view| view.get(place(&it["byteOffset"])..));
        let needed = count.checked_sub(1).map_or(Some(0), |last| last.checked_mul(stride)?.checked_add(bytes));
        match (inner, needed) {
            // So nothing is larger than what is there.
            (Some(inner), Some(needed)) if needed <= inner.len() => {
                settings.points(count / 3)?;
                let is_normalized = it["normalized"].as_bool().unwrap_or(false);
                Ok(Some(Elements { bytes: inner, component, width, stride, count, is_normalized }))
            }
            _ => {
                let expected = format!("{count} elements of {bytes} bytes in {} bytes of data", self.binary.len());
                error(&expected, &it["byteOffset"])
            }
        }
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
                return Err(wrong(&format!("an index from 0, of {vertices} vertices"), index.to_string()));
            }
            list.push(index as u32);
        }
        Ok(list)
    }
}
