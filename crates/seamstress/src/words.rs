//! Numbers and nouns in messages.

/// "1 face", "2 faces".
pub fn counted(count: usize, noun: &str) -> String {
    match (count, noun.strip_suffix("ex")) {
        (1, _) => format!("1 {noun}"),
        (_, Some(stem)) => format!("{count} {stem}ices"),
        (_, None) => format!("{count} {noun}s"),
    }
}

/// A number with about four digits.
pub fn rounded(x: f64) -> String {
    if x.is_nan() {
        "undefined".into()
    } else if x.is_infinite() {
        "infinite".into()
    } else if x == 0.0 {
        "0".into()
    } else if (0.001..1e5).contains(&x.abs()) {
        format!("{x:.4}")
    } else {
        format!("{x:.2e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_nouns() {
        assert_eq!(counted(1, "vertex"), "1 vertex");
        assert_eq!(counted(3, "vertex"), "3 vertices");
        assert_eq!(counted(0, "face"), "0 faces");
        assert_eq!(rounded(f64::INFINITY), "infinite");
        assert_eq!(rounded(2.345_67), "2.3457");
        assert_eq!(rounded(1.234e-12), "1.23e-12");
    }
}
