//! A tokenizer that knows its line, and the numbers in text.

use crate::error::{Fault, Parsed, Position, ReadErrorKind};

/// Reads tokens line by line, in one pass. CR, LF and CRLF end a line.
#[derive(Clone, Debug)]
pub(crate) struct Text<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
    comments: bool,
    continuation: bool,
}

impl<'a> Text<'a> {
    /// Starts at line 1, after a UTF-8 byte order mark. `#` starts a comment.
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        let at = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Self { bytes, at, line: 1, comments: true, continuation: false }
    }

    /// Lets a backslash at the end of a line join it with the next one.
    pub(crate) fn with_continuation(self) -> Self {
        Self { continuation: true, ..self }
    }

    /// Reads `#` like any other character.
    pub(crate) fn without_comments(self) -> Self {
        Self { comments: false, ..self }
    }

    /// The current line, counted from 1.
    pub(crate) fn line(&self) -> usize {
        self.line
    }

    /// The current line as a place.
    pub(crate) fn here(&self) -> Position {
        Position::Line(self.line)
    }

    /// The offset of the next byte.
    pub(crate) fn offset(&self) -> usize {
        self.at
    }

    /// The last line that holds a byte: where a file ends too early.
    pub(crate) fn last_line(&self) -> Position {
        let empty = self.at == self.bytes.len()
            && self.at > 0
            && matches!(self.bytes[self.at - 1], b'\n' | b'\r');
        Position::Line(if empty { self.line - 1 } else { self.line })
    }

    /// The next token of this line, or nothing at its end.
    pub(crate) fn token(&mut self) -> Option<&'a [u8]> {
        self.skip_blanks();
        let start = self.at;
        while let Some(&byte) = self.bytes.get(self.at) {
            if is_blank(byte) || is_line_end(byte) || self.comment_starts() || self.line_continues()
            {
                break;
            }
            self.at += 1;
        }
        (self.at > start).then(|| &self.bytes[start..self.at])
    }

    /// Gives back the last `count` bytes of the token just read.
    pub(crate) fn give_back(&mut self, count: usize) {
        self.at = self.at.saturating_sub(count);
    }

    /// What is left of this line, where a backslash or `#` means nothing, without blanks around it.
    pub(crate) fn rest_of_line(&mut self) -> &'a [u8] {
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(|&byte| is_line_end(byte)).unwrap_or(rest.len());
        self.at += length;
        rest[..length].trim_ascii()
    }

    /// Moves to the start of the next line; false at the end of the file.
    pub(crate) fn next_line(&mut self) -> bool {
        let rest = &self.bytes[self.at..];
        let Some(length) = rest.iter().position(|&byte| is_line_end(byte)) else {
            self.at = self.bytes.len();
            return false;
        };
        self.at += length;
        self.pass_line_end();
        true
    }

    /// Moves to the next token, over line ends and comments; false if there is none.
    pub(crate) fn seek(&mut self) -> bool {
        loop {
            self.skip_blanks();
            match self.bytes.get(self.at) {
                None => return false,
                Some(&byte) if is_line_end(byte) || self.comment_starts() => {
                    if !self.next_line() {
                        return false;
                    }
                }
                Some(_) => return true,
            }
        }
    }

    /// Skips the tokens of this line and of those that continue it; counts them.
    pub(crate) fn skip_tokens(&mut self) -> usize {
        let mut count = 0;
        while self.token().is_some() {
            count += 1;
        }
        count
    }

    /// The next number of this line, whatever its value.
    pub(crate) fn number(&mut self, expected: &str) -> Parsed<f64> {
        let Some(token) = self.token() else {
            return Err(self.missing(expected));
        };
        parse_number(token).map_err(|()| not_a_number(self.here(), token, expected))
    }

    /// The next number of this line, if the line goes on.
    pub(crate) fn optional_number(&mut self, expected: &str) -> Parsed<Option<f64>> {
        let Some(token) = self.token() else {
            return Ok(None);
        };
        parse_number(token).map(Some).map_err(|()| not_a_number(self.here(), token, expected))
    }

    /// The next number of this line, which must be finite.
    pub(crate) fn finite(&mut self, expected: &str) -> Parsed<f64> {
        let Some(token) = self.token() else {
            return Err(self.missing(expected));
        };
        match parse_number(token) {
            Ok(number) if number.is_finite() => Ok(number),
            Ok(_) => Err(Fault::at(self.here(), ReadErrorKind::NonFinite { found: quote(token) })),
            Err(()) => Err(not_a_number(self.here(), token, expected)),
        }
    }

    /// Passes the line end before binary data, where a line feed may already be data.
    pub(crate) fn pass_line_end_of_header(&mut self, carriage_return: bool) {
        if carriage_return && self.bytes.get(self.at) == Some(&b'\r') {
            self.at += 1;
            self.line += 1;
        } else {
            self.pass_line_end();
        }
    }

    /// The line, or the file, ends before `expected`.
    #[cold]
    pub(crate) fn missing(&self, expected: &str) -> Fault {
        if self.at < self.bytes.len() {
            Fault::syntax(self.here(), expected, "the end of the line")
        } else {
            Fault::truncated(self.last_line(), expected)
        }
    }

    fn skip_blanks(&mut self) {
        while let Some(&byte) = self.bytes.get(self.at) {
            if is_blank(byte) {
                self.at += 1;
            } else if self.line_continues() {
                self.at += 1;
                while self.bytes.get(self.at).copied().is_some_and(is_blank) {
                    self.at += 1;
                }
                self.pass_line_end();
            } else {
                return;
            }
        }
    }

    fn pass_line_end(&mut self) {
        let crlf = self.bytes[self.at..].starts_with(b"\r\n");
        let step = if crlf { 2 } else { usize::from(self.at < self.bytes.len()) };
        self.at += step;
        self.line += usize::from(step > 0);
    }

    /// Whether a comment starts here. The `#` of `1.#IND` and its kin does not start one.
    fn comment_starts(&self) -> bool {
        self.comments && self.bytes[self.at] == b'#' && {
            let after_point = self.at > 0 && self.bytes[self.at - 1] == b'.';
            let letter = self.bytes.get(self.at + 1).is_some_and(|b| b"IQSiqs".contains(b));
            !(after_point && letter)
        }
    }

    /// Whether a backslash here is the last visible character of its line.
    fn line_continues(&self) -> bool {
        self.continuation
            && self.bytes[self.at] == b'\\'
            && self.bytes[self.at + 1..]
                .iter()
                .find(|&&byte| !is_blank(byte))
                .is_none_or(|&byte| is_line_end(byte))
    }
}

fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | 0x0b | 0x0c)
}

fn is_line_end(byte: u8) -> bool {
    matches!(byte, b'\n' | b'\r')
}

/// Refuses text with NUL bytes: it is damaged, or not text.
pub(crate) fn refuse_nul(bytes: &[u8]) -> Parsed<()> {
    let Some(at) = bytes.iter().position(|&byte| byte == 0) else {
        return Ok(());
    };
    let mut before = Text::new(&bytes[..at]);
    while before.next_line() {}
    let found = format!("a NUL byte in line {}", before.line());
    Err(Fault::syntax(Position::Byte(at), "text", found))
}

/// A number in text; `nan`, `inf` and numbers too large for a double are not finite.
pub(crate) fn parse_number(token: &[u8]) -> Result<f64, ()> {
    let number = std::str::from_utf8(token).ok().and_then(|text| text.parse().ok());
    match number {
        Some(number) => Ok(number),
        None if names_non_finite(token) => Ok(f64::NAN),
        None => Err(()),
    }
}

/// Whether a token is one of the spellings of `nan` and `inf` that C libraries print.
fn names_non_finite(token: &[u8]) -> bool {
    let unsigned = token.strip_prefix(b"-").or(token.strip_prefix(b"+")).unwrap_or(token);
    let lower: Vec<u8> = unsigned.iter().take(6).map(u8::to_ascii_lowercase).collect();
    [&b"nan("[..], b"1.#ind", b"1.#inf", b"1.#qna", b"1.#sna"]
        .iter()
        .any(|name| lower.starts_with(name))
}

/// A whole number in text; numbers too large for 64 bits become the largest.
pub(crate) fn parse_integer(token: &[u8]) -> Option<i64> {
    let (negative, digits) = match token {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        _ => (false, token),
    };
    if digits.is_empty() || !digits.iter().all(u8::is_ascii_digit) {
        return None;
    }
    let size =
        digits.iter().fold(0i64, |n, d| n.saturating_mul(10).saturating_add(i64::from(d - b'0')));
    Some(if negative { -size } else { size })
}

#[cold]
fn not_a_number(position: Position, token: &[u8], expected: &str) -> Fault {
    let comma = token.contains(&b',') && token.iter().any(u8::is_ascii_digit);
    let hint = if comma { " (write decimals with a point)" } else { "" };
    Fault::syntax(position, expected, format!("{}{hint}", quote(token)))
}

/// Part of a file for a message: at most 40 characters, control characters escaped, in backticks.
pub(crate) fn quote(bytes: &[u8]) -> String {
    const LIMIT: usize = 40;
    let head = &bytes[..bytes.len().min(4 * LIMIT)];
    let text = String::from_utf8_lossy(head);
    let mut quoted = String::from("`");
    quoted.extend(text.chars().take(LIMIT).flat_map(char::escape_debug));
    if text.chars().count() > LIMIT || head.len() < bytes.len() {
        quoted.push('…');
    }
    quoted.push('`');
    quoted
}

#[cfg(test)]
mod tests;
