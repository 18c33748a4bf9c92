use super::*;

fn lines(text: &[u8]) -> Vec<(usize, String)> {
    let mut text = Text::new(text).with_continuation();
    let mut tokens = Vec::new();
    while text.seek() {
        let token = text.token().unwrap();
        tokens.push((text.line(), String::from_utf8_lossy(token).into_owned()));
    }
    tokens
}

#[test]
fn every_line_end_counts_once() {
    let expected = [(1, "a".to_owned()), (2, "b".to_owned()), (4, "c".to_owned())];
    assert_eq!(lines(b"a\nb\n\nc"), expected);
    assert_eq!(lines(b"a\rb\r\rc\r"), expected);
    assert_eq!(lines(b"\xef\xbb\xbfa\r\nb\r\n\r\nc\r\n"), expected);
}

#[test]
fn comments_and_continuations() {
    assert_eq!(lines(b"a#b \\\nc"), [(1, "a".to_owned()), (2, "c".to_owned())]);
    let mut text = Text::new(b"f 1 \\ \r\n 2\\\n3\\4\nv").with_continuation();
    let tokens: Vec<_> = std::iter::from_fn(|| text.token()).collect();
    assert_eq!(tokens, [&b"f"[..], b"1", b"2", b"3\\4"]);
    assert_eq!(text.line(), 3);
    assert!(text.next_line());
    assert_eq!(text.token(), Some(&b"v"[..]));
    assert!(!text.next_line());
    assert_eq!(Text::new(b"1\\").with_continuation().skip_tokens(), 1);
    assert_eq!(Text::new(b"a#b c").without_comments().skip_tokens(), 2);
}

#[test]
fn the_end_is_the_last_line_with_text() {
    let mut text = Text::new(b"a\nb\n");
    while text.next_line() {}
    assert_eq!(text.last_line(), Position::Line(2));
    let mut text = Text::new(b"a\nb");
    while text.next_line() {}
    assert_eq!(text.last_line(), Position::Line(2));
}

#[test]
fn numbers() {
    assert_eq!(parse_number(b"-1.5e3"), Ok(-1500.0));
    assert_eq!(parse_number(b"1."), Ok(1.0));
    for token in [&b"nan"[..], b"-NaN", b"inf", b"1e999", b"-nan(ind)", b"1.#QNAN0", b"-1.#IND"] {
        assert!(parse_number(token).is_ok_and(|number| !number.is_finite()), "{token:?}");
    }
    for token in [&b"abc"[..], b"1,5", b"0x10", b"1e", b"\xff", b"nano"] {
        assert!(parse_number(token).is_err(), "{token:?}");
    }
    let fault = Text::new(b"1,5").finite("a number").unwrap_err().named("a");
    assert_eq!(
        fault.to_string(),
        "a, line 1: expected a number, found `1,5` (write decimals with a point)"
    );
    let fault = Text::new(b"1.#IND").finite("a number").unwrap_err();
    assert!(matches!(fault.kind, ReadErrorKind::NonFinite { .. }));
}

#[test]
fn integers() {
    assert_eq!(parse_integer(b"-12"), Some(-12));
    assert_eq!(parse_integer(b"+7"), Some(7));
    assert_eq!(parse_integer(b"99999999999999999999"), Some(i64::MAX));
    for token in [&b""[..], b"-", b"1.5", b"1e3", b"x"] {
        assert_eq!(parse_integer(token), None);
    }
}

#[test]
fn quotes_are_short_and_escaped() {
    assert_eq!(quote(b"a\x00\xffb"), "`a\\0\u{fffd}b`");
    assert_eq!(quote(&[b'x'; 1000]).chars().count(), 43);
    assert_eq!(quote("é".as_bytes()), "`é`");
}
