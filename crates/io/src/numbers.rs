//! What the readers of numbers per element share.

use crate::ReadError;
use crate::error::{Fault, Parsed, ReadErrorKind};
use crate::text::{Text, parse_integer, quote, refuse_nul};
use std::fs;
use std::path::Path;

/// Directions, matchings and indices per full turn: crosses.
pub(crate) const DEGREE: i64 = 4;

/// Reads a whole file and gives it to a parser with its name.
pub(crate) fn read<T>(
    path: &Path,
    parse: impl FnOnce(&[u8], &str) -> Result<T, ReadError>,
) -> Result<T, ReadError> {
    let name = path.display().to_string();
    let bytes =
        fs::read(path).map_err(|error| Fault::whole_file(ReadErrorKind::Io(error)).named(&name))?;
    parse(&bytes, &name)
}

/// The start of a text, at its first token.
pub(crate) fn begin(bytes: &[u8]) -> Parsed<Text<'_>> {
    refuse_nul(bytes)?;
    let mut text = Text::new(bytes);
    match text.seek() {
        true => Ok(text),
        false => Err(Fault::whole_file(ReadErrorKind::Empty(crate::Missing::Content))),
    }
}

/// The next whole number, on this line or a later one.
pub(crate) fn integer(text: &mut Text<'_>, expected: &str) -> Parsed<i64> {
    if !text.seek() {
        return Err(Fault::truncated(text.last_line(), expected));
    }
    let token = text.token().unwrap_or_default();
    parse_integer(token).ok_or_else(|| Fault::syntax(text.here(), expected, quote(token)))
}

/// A number of elements, which has to be that of the mesh.
pub(crate) fn count(text: &mut Text<'_>, what: &'static str, expected: usize) -> Parsed<()> {
    let found = integer(text, &format!("the number of {what}"))?;
    match usize::try_from(found) {
        Ok(found) if found == expected => Ok(()),
        _ => {
            let kind = ReadErrorKind::OtherMesh { what, expected, found: found.to_string() };
            Err(Fault::at(text.here(), kind))
        }
    }
}

/// The degree of the field, which has to be four.
pub(crate) fn degree(text: &mut Text<'_>) -> Parsed<()> {
    match integer(text, "the degree of the field")? {
        DEGREE => Ok(()),
        other => {
            let what = format!("a field of degree {other}; cross fields have degree {DEGREE}");
            Err(Fault::unsupported(Some(text.here()), what))
        }
    }
}

/// The element of a row: a number below `count`.
pub(crate) fn element(text: &mut Text<'_>, what: &'static str, count: usize) -> Parsed<u32> {
    let index = integer(text, &format!("a {what}"))?;
    match u32::try_from(index) {
        Ok(element) if (element as usize) < count => Ok(element),
        _ => {
            let kind =
                ReadErrorKind::IndexOutOfRange { what, index: index.to_string(), count, base: 0 };
            Err(Fault::at(text.here(), kind))
        }
    }
}

/// A whole number of 32 bits.
pub(crate) fn small(text: &mut Text<'_>, expected: &str) -> Parsed<i32> {
    let found = integer(text, expected)?;
    i32::try_from(found).map_err(|_| Fault::syntax(text.here(), expected, format!("`{found}`")))
}

/// Goes to the next element, of which there are `count` in all and `read` so far.
pub(crate) fn next(text: &mut Text<'_>, what: &str, count: usize, read: usize) -> Parsed<()> {
    match text.seek() {
        true => Ok(()),
        false => Err(Fault::truncated(text.last_line(), format!("{count} {what}, found {read}"))),
    }
}

/// The end of the file.
pub(crate) fn end(text: &mut Text<'_>, what: &str, count: usize) -> Parsed<()> {
    if !text.seek() {
        return Ok(());
    }
    let found = quote(text.token().unwrap_or_default());
    let announced = format!("{count} {what}");
    Err(Fault::at(text.here(), ReadErrorKind::CountMismatch { announced, found }))
}
