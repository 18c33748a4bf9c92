//! The arrays of glTF: rows of numbers in buffers.

use super::document::{Accessor, Buffer, Document, get};
use super::syntax;
use crate::error::{Fault, Parsed, ReadErrorKind};
use crate::text::quote;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::borrow::Cow;
use std::fs;
use std::path::{Component, Path, PathBuf};

/// The bytes of all buffers.
pub(super) struct Buffers<'a> {
    document: &'a Document,
    bytes: Vec<Cow<'a, [u8]>>,
}

/// Rows of numbers.
pub(super) struct Array {
    pub(super) width: usize,
    pub(super) count: usize,
    pub(super) values: Vec<f64>,
}

impl Array {
    /// The same if its rows have as many numbers.
    pub(super) fn of_width(self, width: usize, what: &str) -> Parsed<Self> {
        match self.width == width {
            true => Ok(self),
            false => {
                let found = format!("rows of {}", self.width);
                Err(syntax(format!("{what} in rows of {width} numbers"), found))
            }
        }
    }

    /// Colours with an opacity of one if they have none.
    pub(super) fn with_opacity(self) -> Parsed<Self> {
        match self.width {
            4 => Ok(self),
            _ => {
                let Self { count, values, .. } = self.of_width(3, "colours")?;
                let opaque = values.chunks_exact(3).flat_map(|c| [c[0], c[1], c[2], 1.0]);
                Ok(Self { width: 4, count, values: opaque.collect() })
            }
        }
    }
}

impl<'a> Buffers<'a> {
    pub(super) fn new(
        document: &'a Document,
        binary: Option<&'a [u8]>,
        folder: Option<&Path>,
    ) -> Parsed<Self> {
        let mut bytes = Vec::with_capacity(document.buffers.len());
        for (number, buffer) in document.buffers.iter().enumerate() {
            let content = content(buffer, binary.filter(|_| number == 0), folder)?;
            if content.len() < buffer.byte_length {
                let (length, found) = (buffer.byte_length, content.len());
                let expected = format!("{length} bytes in buffer {number}, found {found}");
                return Err(Fault::whole_file(ReadErrorKind::Truncated { expected }));
            }
            bytes.push(content);
        }
        Ok(Self { document, bytes })
    }

    /// Bytes in all.
    pub(super) fn size(&self) -> usize {
        self.bytes.iter().map(|bytes| bytes.len()).sum()
    }

    /// The numbers of an accessor; those that stand for fractions as such.
    pub(super) fn array(&self, number: usize) -> Parsed<Array> {
        let accessor = get(&self.document.accessors, number, "accessor")?;
        let width = match accessor.kind.as_str() {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            other => return Err(syntax("numbers or vectors", quote(other.as_bytes()))),
        };
        let component = Stored::new(accessor)?;
        let (bytes, stride) = self.rows(number, accessor, width * component.size())?;
        let row = |k: usize| {
            let row = &bytes[k * stride..];
            (0..width).map(move |i| component.value(&row[i * component.size()..]))
        };
        let values = (0..accessor.count).flat_map(row).collect();
        Ok(Array { width, count: accessor.count, values })
    }

    /// The numbers of vertices in an accessor.
    pub(super) fn indices(&self, number: usize, n_vertices: usize) -> Parsed<Vec<u32>> {
        let array = self.array(number)?.of_width(1, "vertex indices")?;
        let index = |&x: &f64| match x >= 0.0 && x.fract() == 0.0 && x < n_vertices as f64 {
            true => Ok(x as u32),
            false => {
                let (index, count) = (x.to_string(), n_vertices);
                let kind = ReadErrorKind::IndexOutOfRange { what: "vertex", index, count, base: 0 };
                Err(Fault::whole_file(kind))
            }
        };
        array.values.iter().map(index).collect()
    }

    /// The bytes from the first row of an accessor on, and those from row to row; all rows are there.
    fn rows(&self, number: usize, accessor: &Accessor, size: usize) -> Parsed<(&[u8], usize)> {
        let (Some(view), None) = (accessor.buffer_view, &accessor.sparse) else {
            let what = format!("accessor {number} is sparse or has no data of its own");
            return Err(Fault::unsupported(None, what));
        };
        let view = get(&self.document.buffer_views, view, "buffer view")?;
        let bytes = get(&self.bytes, view.buffer, "buffer")?;
        let stride = view.byte_stride.unwrap_or(size);
        if stride < size {
            return Err(syntax(format!("rows at least {size} bytes apart"), stride.to_string()));
        }
        let end = view.byte_offset.checked_add(view.byte_length);
        let within = end.and_then(|end| bytes.get(view.byte_offset..end));
        let rows = within.and_then(|within| within.get(accessor.byte_offset..));
        let needed = match accessor.count {
            0 => Some(0),
            count => (count - 1).checked_mul(stride).and_then(|n| n.checked_add(size)),
        };
        match (rows, needed) {
            (Some(rows), Some(needed)) if needed <= rows.len() => Ok((rows, stride)),
            _ => {
                let expected = format!("{} rows in accessor {number}", accessor.count);
                Err(Fault::whole_file(ReadErrorKind::Truncated { expected }))
            }
        }
    }
}

/// A number of an accessor, as it is stored.
#[derive(Clone, Copy)]
struct Stored {
    kind: u32,
    normalized: bool,
}

impl Stored {
    fn new(accessor: &Accessor) -> Parsed<Self> {
        let Accessor { component_type: kind, normalized, .. } = *accessor;
        match kind {
            5120..=5123 | 5125 | 5126 => Ok(Self { kind, normalized }),
            other => Err(syntax("a type of numbers such as 5126", other.to_string())),
        }
    }

    fn size(self) -> usize {
        match self.kind {
            5120 | 5121 => 1,
            5122 | 5123 => 2,
            _ => 4,
        }
    }

    /// The number at the start of bytes, of which there are enough.
    fn value(self, bytes: &[u8]) -> f64 {
        let mut four = [0; 4];
        four[..self.size()].copy_from_slice(&bytes[..self.size()]);
        let [a, b, ..] = four;
        let (value, largest) = match self.kind {
            5120 => (f64::from(a as i8), f64::from(i8::MAX)),
            5121 => (f64::from(a), f64::from(u8::MAX)),
            5122 => (f64::from(i16::from_le_bytes([a, b])), f64::from(i16::MAX)),
            5123 => (f64::from(u16::from_le_bytes([a, b])), f64::from(u16::MAX)),
            5125 => (f64::from(u32::from_le_bytes(four)), 1.0),
            _ => (f64::from(f32::from_le_bytes(four)), 1.0),
        };
        if self.normalized { (value / largest).max(-1.0) } else { value }
    }
}

/// The bytes of a buffer: the binary chunk, in the text, or in a file of its own.
fn content<'a>(
    buffer: &Buffer,
    binary: Option<&'a [u8]>,
    folder: Option<&Path>,
) -> Parsed<Cow<'a, [u8]>> {
    let Some(uri) = &buffer.uri else {
        let missing = || syntax("a binary chunk, or where the bytes of a buffer are", "neither");
        return binary.map(Cow::Borrowed).ok_or_else(missing);
    };
    if let Some(data) = uri.strip_prefix("data:") {
        let text = data.split_once(";base64,").map(|(_, text)| text);
        let decoded = text.and_then(|text| STANDARD.decode(text).ok());
        return decoded
            .map(Cow::Owned)
            .ok_or_else(|| syntax("the bytes of a buffer in base 64", quote(data.as_bytes())));
    }
    let shown = quote(uri.as_bytes());
    let path = local_path(uri).ok_or_else(|| {
        let what = format!("the buffer {shown} is not in the folder of the file or below it");
        Fault::unsupported(None, what)
    })?;
    let folder = folder.ok_or_else(|| {
        let what =
            format!("the buffer {shown} is in a file of its own; read the mesh from a file too");
        Fault::unsupported(None, what)
    })?;
    match fs::read(folder.join(path)) {
        Ok(bytes) => Ok(Cow::Owned(bytes)),
        Err(cause) => {
            let cause = std::io::Error::new(cause.kind(), format!("buffer {shown}: {cause}"));
            Err(Fault::whole_file(ReadErrorKind::Io(cause)))
        }
    }
}

/// The path that a relative address stands for, if it leads no higher.
fn local_path(uri: &str) -> Option<PathBuf> {
    let mut bytes = Vec::new();
    let mut rest = uri.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(match byte {
            b'%' => {
                let digits = [rest.next()?, rest.next()?];
                u8::from_str_radix(std::str::from_utf8(&digits).ok()?, 16).ok()?
            }
            b':' => return None,
            byte => byte,
        });
    }
    let path = PathBuf::from(String::from_utf8(bytes).ok()?);
    let is_plain = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    path.components().all(is_plain).then_some(path)
}
