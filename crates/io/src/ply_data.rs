//! The data of a PLY file, as text or binary, value by value.

use crate::error::{Fault, Parsed, Position, ReadErrorKind};
use crate::ply_header::{ByteOrder, Element, Kind, Scalar};
use crate::text::{Text, parse_number, quote};

/// Hands out the values of the elements in order.
pub(crate) trait Source {
    /// Starts the rows of an element.
    fn start_element(&mut self, element: &Element);
    /// Starts the next row.
    fn start_row(&mut self) -> Parsed<()>;
    /// Reads a value. A double holds every type of PLY exactly.
    fn value(&mut self, scalar: Scalar) -> Parsed<f64>;
    /// Passes one value or list.
    fn skip(&mut self, kind: Kind) -> Parsed<()>;
    /// Ends a row.
    fn end_row(&mut self) -> Parsed<()>;
    /// Checks that nothing follows the last element.
    fn finish(&mut self) -> Parsed<()>;
    /// Where the last value is.
    fn position(&self) -> Position;
    /// The last value, which is `value`, as a message shows it.
    fn last_value(&self, value: f64) -> String;

    /// Reads the length of a list.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the value is checked"
    )]
    fn length(&mut self, count: Scalar) -> Parsed<u64> {
        let value = self.value(count)?;
        if value >= 0.0 && value.fract() == 0.0 {
            Ok(value as u64)
        } else {
            Err(Fault::syntax(self.position(), "the length of a list", self.last_value(value)))
        }
    }
}

/// The element being read, for messages.
#[derive(Debug, Default)]
struct Progress {
    element: String,
    count: u64,
    rows: u64,
}

impl Progress {
    fn start(&mut self, element: &Element) {
        *self = Self { element: element.name.clone(), count: element.count, rows: 0 };
    }

    #[cold]
    fn truncated(&self, position: Position) -> Fault {
        let Self { element, count, rows } = self;
        Fault::truncated(position, format!("{count} `{element}` elements, found {rows}"))
    }
}

#[cold]
fn goes_on(position: Position, found: String) -> Fault {
    let announced = "fewer elements".to_owned();
    Fault::at(position, ReadErrorKind::CountMismatch { announced, found })
}

/// Values in text, one row a line.
pub(crate) struct Ascii<'a> {
    text: Text<'a>,
    last: &'a [u8],
    progress: Progress,
}

impl<'a> Ascii<'a> {
    pub(crate) fn new(text: Text<'a>) -> Self {
        Self { text, last: b"", progress: Progress::default() }
    }

    fn token(&mut self) -> Parsed<&'a [u8]> {
        if let Some(token) = self.text.token() {
            self.last = token;
            return Ok(token);
        }
        let expected = format!("one more value for this `{}`", self.progress.element);
        Err(self.text.missing(&expected))
    }
}

impl Source for Ascii<'_> {
    fn start_element(&mut self, element: &Element) {
        self.progress.start(element);
    }

    fn start_row(&mut self) -> Parsed<()> {
        if self.text.seek() { Ok(()) } else { Err(self.progress.truncated(self.text.last_line())) }
    }

    fn value(&mut self, _: Scalar) -> Parsed<f64> {
        let token = self.token()?;
        parse_number(token).map_err(|()| Fault::syntax(self.text.here(), "a number", quote(token)))
    }

    fn skip(&mut self, kind: Kind) -> Parsed<()> {
        let values = match kind {
            Kind::Scalar(_) => 1,
            Kind::List { count, .. } => self.length(count)?,
        };
        for _ in 0..values {
            self.token()?;
        }
        Ok(())
    }

    fn end_row(&mut self) -> Parsed<()> {
        if let Some(extra) = self.text.token() {
            let expected = format!("the end of the line after a `{}`", self.progress.element);
            return Err(Fault::syntax(self.text.here(), expected, quote(extra)));
        }
        self.progress.rows += 1;
        self.text.next_line();
        Ok(())
    }

    fn finish(&mut self) -> Parsed<()> {
        if !self.text.seek() {
            return Ok(());
        }
        let token = self.token()?;
        Err(goes_on(self.text.here(), quote(token)))
    }

    fn position(&self) -> Position {
        self.text.here()
    }

    fn last_value(&self, _: f64) -> String {
        quote(self.last)
    }
}

/// Values in binary.
pub(crate) struct Binary<'a> {
    bytes: &'a [u8],
    at: usize,
    last: usize,
    order: ByteOrder,
    progress: Progress,
}

impl<'a> Binary<'a> {
    pub(crate) fn new(bytes: &'a [u8], at: usize, order: ByteOrder) -> Self {
        Self { bytes, at, last: at, order, progress: Progress::default() }
    }

    fn take(&mut self, size: usize) -> Parsed<&'a [u8]> {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let Some(taken) = rest.get(..size) else {
            return Err(self.progress.truncated(Position::Byte(self.bytes.len())));
        };
        self.last = self.at;
        self.at += size;
        Ok(taken)
    }

    /// The next bytes, least significant first.
    fn array<const N: usize>(&mut self) -> Parsed<[u8; N]> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N)?);
        if self.order == ByteOrder::Big {
            array.reverse();
        }
        Ok(array)
    }
}

impl Source for Binary<'_> {
    fn start_element(&mut self, element: &Element) {
        self.progress.start(element);
    }

    fn start_row(&mut self) -> Parsed<()> {
        Ok(())
    }

    fn value(&mut self, scalar: Scalar) -> Parsed<f64> {
        Ok(match scalar {
            Scalar::I8 => i8::from_le_bytes(self.array()?).into(),
            Scalar::U8 => u8::from_le_bytes(self.array()?).into(),
            Scalar::I16 => i16::from_le_bytes(self.array()?).into(),
            Scalar::U16 => u16::from_le_bytes(self.array()?).into(),
            Scalar::I32 => i32::from_le_bytes(self.array()?).into(),
            Scalar::U32 => u32::from_le_bytes(self.array()?).into(),
            Scalar::F32 => f32::from_le_bytes(self.array()?).into(),
            Scalar::F64 => f64::from_le_bytes(self.array()?),
        })
    }

    fn skip(&mut self, kind: Kind) -> Parsed<()> {
        let size = match kind {
            Kind::Scalar(scalar) => scalar.size(),
            Kind::List { count, item } => {
                let length = usize::try_from(self.length(count)?).unwrap_or(usize::MAX);
                length.saturating_mul(item.size())
            }
        };
        self.take(size).map(|_| ())
    }

    fn end_row(&mut self) -> Parsed<()> {
        self.progress.rows += 1;
        Ok(())
    }

    fn finish(&mut self) -> Parsed<()> {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        if rest.iter().all(|byte| byte.is_ascii_whitespace() || *byte == 0) {
            return Ok(());
        }
        Err(goes_on(Position::Byte(self.at), format!("{} more bytes", rest.len())))
    }

    fn position(&self) -> Position {
        Position::Byte(self.last)
    }

    fn last_value(&self, value: f64) -> String {
        value.to_string()
    }
}
