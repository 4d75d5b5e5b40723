//! The header of a PLY file.

use super::super::ReadError;
use super::super::bytes::Bytes;
use super::super::error::{FilePlace, shown};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Encoding {
    Text,
    Little,
    Big,
}

/// The kinds of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Number {
    fn named(name: &[u8]) -> Option<Number> {
        Some(match name {
            b"char" | b"int8" => Number::I8,
            b"uchar" | b"uint8" => Number::U8,
            b"short" | b"int16" => Number::I16,
            b"ushort" | b"uint16" => Number::U16,
            b"int" | b"int32" => Number::I32,
            b"uint" | b"uint32" => Number::U32,
            b"float" | b"float32" => Number::F32,
            b"double" | b"float64" => Number::F64,
            _ => return None,
        })
    }

    /// The next number of binary data.
    pub(super) fn read(self, bytes: &mut Bytes<'_>, is_big: bool, name: &str) -> Result<f64, ReadError> {
        macro_rules! read {
            ($number:ty) => {{
                let array = bytes.array(name)?;
                f64::from(if is_big { <$number>::from_be_bytes(array) } else { <$number>::from_le_bytes(array) })
            }};
        }
        Ok(match self {
            Number::I8 => read!(i8),
            Number::U8 => read!(u8),
            Number::I16 => read!(i16),
            Number::U16 => read!(u16),
            Number::I32 => read!(i32),
            Number::U32 => read!(u32),
            Number::F32 => read!(f32),
            Number::F64 => read!(f64),
        })
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    One(Number),
    List { count: Number, number: Number },
}

impl Kind {
    pub(super) fn number(self) -> Number {
        match self {
            Kind::One(number) | Kind::List { number, .. } => number,
        }
    }
}

#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
}

#[derive(Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
    /// The line that declares it.
    pub(super) line: u64,
}

pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// The first byte after it.
    pub(super) end: usize,
    /// How many lines it has.
    pub(super) lines: u64,
}

impl Header {
    pub(super) fn read(data: &[u8]) -> Result<Header, ReadError> {
        let mut encoding = None;
        let mut elements: Vec<Element> = Vec::new();
        let (mut end, mut lines) = (0, 0);
        loop {
            lines += 1;
            let place = FilePlace::Line(lines);
            let rest = &data[end..];
            let Some(length) = rest.iter().position(|byte| *byte == b'\n') else {
                let found = if lines == 1 { shown(rest) } else { "the end of the file".into() };
                return Err(ReadError::content(place, if lines == 1 { "ply" } else { "end_header" }, found));
            };
            let line = &rest[..length];
            end += length + 1;
            let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
            let words: [&[u8]; 5] = std::array::from_fn(|_| words.next().unwrap_or_default());
            let wrong = |expected: &str| Err(ReadError::content(place.clone(), expected, shown(line)));
            if lines == 1 {
                if words[0] != b"ply" {
                    return wrong("ply");
                }
                continue;
            }
            match words {
                [b"comment" | b"obj_info" | b"", ..] => {}
                [b"format", b"ascii", ..] => encoding = Some(Encoding::Text),
                [b"format", b"binary_little_endian", ..] => encoding = Some(Encoding::Little),
                [b"format", b"binary_big_endian", ..] => encoding = Some(Encoding::Big),
                [b"element", name, count, ..] => {
                    let Some(count) = std::str::from_utf8(count).ok().and_then(|count| count.parse().ok()) else {
                        return wrong("element, a name and a count");
                    };
                    let name = String::from_utf8_lossy(name).into_owned();
                    if name == "vertex" && elements.iter().any(|element| element.name == name) {
                        return wrong("one element vertex");
                    }
                    elements.push(Element { name, count, properties: Vec::new(), line: lines });
                }
                [b"property", b"list", count, number, name] => {
                    let (Some(count), Some(number)) = (Number::named(count), Number::named(number)) else {
                        return wrong("property list, two types and a name");
                    };
                    let Some(element) = elements.last_mut() else { return wrong("an element before its properties") };
                    let name = String::from_utf8_lossy(name).into_owned();
                    element.properties.push(Property { name, kind: Kind::List { count, number } });
                }
                [b"property", number, name, ..] => {
                    let Some(number) = Number::named(number) else { return wrong("property, a type and a name") };
                    let Some(element) = elements.last_mut() else { return wrong("an element before its properties") };
                    let name = String::from_utf8_lossy(name).into_owned();
                    element.properties.push(Property { name, kind: Kind::One(number) });
                }
                [b"end_header", ..] => break,
                _ => return wrong("a line of a PLY header"),
            }
        }
        let Some(encoding) = encoding else {
            let expected = "format ascii, binary_little_endian or binary_big_endian";
            return Err(ReadError::content(FilePlace::Line(lines), expected, "the end of the header"));
        };
        Ok(Header { encoding, elements, end, lines })
    }
}
