//! The header of a PLY file.

use std::collections::HashSet;

use crate::error::{Fault, Missing, Parsed, Position, ReadErrorKind};
use crate::text::{Text, parse_integer, quote};

/// A PLY header, and the text cursor where the data starts.
#[derive(Debug)]
pub(crate) struct Header<'a> {
    pub(crate) encoding: Encoding,
    pub(crate) elements: Vec<Element>,
    pub(crate) data: Text<'a>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Encoding {
    Ascii,
    Binary(ByteOrder),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ByteOrder {
    Little,
    Big,
}

#[derive(Clone, Debug)]
pub(crate) struct Element {
    pub(crate) name: String,
    pub(crate) count: u64,
    pub(crate) properties: Vec<Property>,
    line: usize,
}

impl Element {
    /// Where the header declares it.
    pub(crate) fn position(&self) -> Position {
        Position::Line(self.line)
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Property {
    pub(crate) name: String,
    pub(crate) kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Scalar(Scalar),
    List { count: Scalar, item: Scalar },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn parse(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes of a binary value.
    pub(crate) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    pub(crate) fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

impl<'a> Header<'a> {
    pub(crate) fn parse(bytes: &'a [u8]) -> Parsed<Self> {
        let mut text = Text::new(bytes).without_comments();
        if !text.seek() {
            return Err(Fault::whole_file(ReadErrorKind::Empty(Missing::Content)));
        }
        let magic = text.token().unwrap_or_default();
        if magic != b"ply" {
            return Err(Fault::syntax(text.here(), "`ply`", quote(magic)));
        }
        // Binary data may start with a byte that looks like part of a line end: the first line decides.
        let carriage_return = bytes[text.offset()..].starts_with(b"\r")
            && !bytes[text.offset()..].starts_with(b"\r\n");
        let mut encoding = None;
        let mut elements: Vec<Element> = Vec::new();
        let mut names = HashSet::new();
        loop {
            if !text.next_line() {
                return Err(Fault::truncated(text.last_line(), "`end_header`"));
            }
            let statement = text.token().unwrap_or_default();
            match statement {
                b"" | b"comment" | b"obj_info" => {}
                b"format" => encoding = Some(read_encoding(&mut text)?),
                b"element" => {
                    let element = read_element(&mut text)?;
                    if !names.insert(element.name.clone()) {
                        let found = format!("a second element {}", quote(element.name.as_bytes()));
                        return Err(Fault::syntax(text.here(), "each element once", found));
                    }
                    elements.push(element);
                }
                b"property" => {
                    let property = read_property(&mut text)?;
                    match elements.last_mut() {
                        Some(element) => element.properties.push(property),
                        None => return Err(Fault::syntax(text.here(), "`element`", "`property`")),
                    }
                }
                b"end_header" => break,
                other => {
                    return Err(Fault::syntax(text.here(), "a PLY header statement", quote(other)));
                }
            }
        }
        let Some(encoding) = encoding else {
            return Err(Fault::syntax(text.here(), "a `format` statement in the header", "none"));
        };
        text.skip_tokens();
        text.pass_line_end_of_header(carriage_return);
        Ok(Self { encoding, elements, data: text })
    }

    pub(crate) fn element(&self, name: &str) -> Option<&Element> {
        self.elements.iter().find(|element| element.name == name)
    }
}

fn read_encoding(text: &mut Text<'_>) -> Parsed<Encoding> {
    let name = text.token().unwrap_or_default();
    let version = text.token().unwrap_or_default();
    let encoding = match name {
        b"ascii" => Encoding::Ascii,
        b"binary_little_endian" => Encoding::Binary(ByteOrder::Little),
        b"binary_big_endian" => Encoding::Binary(ByteOrder::Big),
        other => {
            let expected = "`ascii`, `binary_little_endian` or `binary_big_endian`";
            return Err(Fault::syntax(text.here(), expected, quote(other)));
        }
    };
    if version == b"1.0" {
        Ok(encoding)
    } else {
        Err(Fault::syntax(text.here(), "version `1.0`", quote(version)))
    }
}

fn read_element(text: &mut Text<'_>) -> Parsed<Element> {
    let name = read_name(text, "an element name")?;
    let count = text.token().unwrap_or_default();
    let count =
        parse_integer(count).and_then(|count| u64::try_from(count).ok()).ok_or_else(|| {
            Fault::syntax(text.here(), format!("the number of `{name}` elements"), quote(count))
        })?;
    Ok(Element { name, count, properties: Vec::new(), line: text.line() })
}

fn read_property(text: &mut Text<'_>) -> Parsed<Property> {
    let first = text.token().unwrap_or_default();
    let kind = if first == b"list" {
        let (count, item) = (text.token().unwrap_or_default(), text.token().unwrap_or_default());
        let (count_type, item_type) = (read_type(text, count)?, read_type(text, item)?);
        if !count_type.is_integer() {
            return Err(Fault::syntax(
                text.here(),
                "an integer type for the length of a list",
                quote(count),
            ));
        }
        Kind::List { count: count_type, item: item_type }
    } else {
        Kind::Scalar(read_type(text, first)?)
    };
    Ok(Property { name: read_name(text, "a property name")?, kind })
}

fn read_type(text: &Text<'_>, name: &[u8]) -> Parsed<Scalar> {
    Scalar::parse(name)
        .ok_or_else(|| Fault::syntax(text.here(), "a number type such as `float`", quote(name)))
}

fn read_name(text: &mut Text<'_>, expected: &str) -> Parsed<String> {
    match text.token() {
        // Names appear in messages: keep them short and printable.
        Some(name) => Ok(quote(name).trim_matches('`').to_owned()),
        None => Err(Fault::syntax(text.here(), expected, "the end of the line")),
    }
}
