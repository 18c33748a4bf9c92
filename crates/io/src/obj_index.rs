//! The indices of OBJ: from 1, relative if negative, and allowed to refer forward.

use crate::error::{Fault, Parsed, Position, ReadErrorKind};
use crate::text::{parse_integer, quote};

/// A face corner `v`, `v/vt`, `v//vn` or `v/vt/vn`, with indices as written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Corner {
    pub(crate) vertex: i64,
    pub(crate) uv: Option<i64>,
    pub(crate) normal: Option<i64>,
}

impl Corner {
    pub(crate) fn parse(token: &[u8], position: Position) -> Parsed<Self> {
        Self::read(token).ok_or_else(|| {
            Fault::syntax(position, "a face corner such as `3`, `3/1` or `3/1/2`", quote(token))
        })
    }

    fn read(token: &[u8]) -> Option<Self> {
        let mut parts = token.split(|&byte| byte == b'/');
        let vertex = parse_integer(parts.next()?)?;
        let uv = optional(parts.next())?;
        let normal = optional(parts.next())?;
        parts.next().is_none().then_some(Self { vertex, uv, normal })
    }
}

/// An index that may be absent or empty; `None` if it is not an integer.
fn optional(part: Option<&[u8]>) -> Option<Option<i64>> {
    match part {
        None | Some(b"") => Some(None),
        Some(digits) => parse_integer(digits).map(Some),
    }
}

/// Turns indices into positions in a list that is still growing.
#[derive(Debug)]
pub(crate) struct References<'a> {
    what: &'static str,
    /// References past the end of the list, to be checked when all of it is known.
    forward: Vec<Forward<'a>>,
}

#[derive(Debug)]
struct Forward<'a> {
    index: i64,
    corner: &'a [u8],
    position: Position,
}

impl<'a> References<'a> {
    pub(crate) fn new(what: &'static str) -> Self {
        Self { what, forward: Vec::new() }
    }

    /// The position that `index`, found in `corner`, refers to while the list holds `count` elements.
    pub(crate) fn resolve(
        &mut self,
        index: i64,
        corner: &'a [u8],
        count: usize,
        position: Position,
    ) -> Parsed<u32> {
        let size = i64::try_from(count).unwrap_or(i64::MAX);
        let target = if index < 0 { size.saturating_add(index) } else { index - 1 };
        if target < 0 {
            return Err(self.out_of_range(index, corner, count, position));
        }
        if target >= size {
            self.forward.push(Forward { index, corner, position });
        }
        // A position beyond 32 bits is a forward reference that the check will refuse.
        Ok(u32::try_from(target).unwrap_or(u32::MAX))
    }

    /// Checks the forward references once the whole list is known.
    pub(crate) fn check(&self, count: usize) -> Parsed<()> {
        let size = i64::try_from(count).unwrap_or(i64::MAX);
        match self.forward.iter().find(|forward| forward.index > size) {
            None => Ok(()),
            Some(forward) => {
                Err(self.out_of_range(forward.index, forward.corner, count, forward.position))
            }
        }
    }

    #[cold]
    fn out_of_range(&self, index: i64, corner: &[u8], count: usize, position: Position) -> Fault {
        // Show the digits of the file: a huge index was clamped.
        let written =
            corner.split(|&byte| byte == b'/').find(|part| parse_integer(part) == Some(index));
        let index = written.map_or_else(|| index.to_string(), |part| quote(part).replace('`', ""));
        Fault::at(
            position,
            ReadErrorKind::IndexOutOfRange { what: self.what, index, count, base: 1 },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HERE: Position = Position::Line(1);

    #[test]
    fn corners() {
        let corner = |uv, normal| Some(Corner { vertex: 3, uv, normal });
        assert_eq!(Corner::read(b"3"), corner(None, None));
        assert_eq!(Corner::read(b"3/-1/x"), None);
        assert_eq!(Corner::read(b"3/-1/2"), corner(Some(-1), Some(2)));
        assert_eq!(Corner::read(b"3//2"), corner(None, Some(2)));
        assert_eq!(Corner::read(b"/1"), None);
    }

    #[test]
    fn references_are_relative_or_checked_later() {
        let mut references = References::new("vertex");
        assert!(matches!(references.resolve(2, b"2", 5, HERE), Ok(1)));
        assert!(matches!(references.resolve(-5, b"-5", 5, HERE), Ok(0)));
        assert!(references.resolve(0, b"0", 5, HERE).is_err());
        assert!(references.resolve(-6, b"-6", 5, HERE).is_err());
        assert!(matches!(references.resolve(9, b"9", 5, HERE), Ok(8)));
        assert!(references.check(9).is_ok());
        assert!(references.check(8).is_err());
    }
}
