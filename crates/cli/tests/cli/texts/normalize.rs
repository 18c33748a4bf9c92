//! What differs from run to run or from machine to machine is taken out of texts before they are compared.

use serde_json::Value;

/// Below this a number is rounding error; it prints as `~0`.
const ROUNDING_ERROR: f64 = 1e-9;

/// Values of keys with these in them depend on the machine, the release or the order of operations, not on the format.
const VOLATILE: [&str; 7] =
    ["seconds", "memory_bytes", "threads", "iterations", "worst", "by_matching", "seamstress"];

/// Longer lists end with a count.
const LONGEST_LIST: usize = 3;

/// A text: no times, no trailing spaces, numbers with a fraction to three digits.
pub(super) fn text(text: &str) -> String {
    let line = |line: &str| match line.strip_prefix("time ") {
        Some(rest) => {
            let gap: String = rest.chars().take_while(|&c| c == ' ').collect();
            format!("time {gap}[time]")
        }
        None => rounded(line.trim_end()),
    };
    text.lines().map(line).collect::<Vec<_>>().join("\n")
}

/// A report: numbers to three digits, long lists cut short, and no values that only this run has.
pub(super) fn report(json: &str) -> String {
    let mut value: Value = serde_json::from_str(json).unwrap();
    simplify(&mut value);
    serde_json::to_string_pretty(&value).unwrap()
}

fn simplify(value: &mut Value) {
    match value {
        Value::Object(entries) => {
            for (key, value) in entries {
                if VOLATILE.iter().any(|part| key.contains(part)) && !value.is_null() {
                    *value = "[differs]".into();
                } else {
                    simplify(value);
                }
            }
        }
        Value::Array(items) => {
            if items.len() > LONGEST_LIST {
                let more = items.len() - (LONGEST_LIST - 1);
                items.truncate(LONGEST_LIST - 1);
                items.push(format!("[{more} more]").into());
            }
            items.iter_mut().for_each(simplify);
        }
        Value::Number(number) if number.is_f64() => {
            let short = three_digits(number.as_f64().unwrap());
            *value = short.parse::<f64>().map_or_else(|_| short.into(), Value::from);
        }
        _ => {}
    }
}

fn three_digits(x: f64) -> String {
    if x == 0.0 {
        "0".to_owned()
    } else if x.abs() < ROUNDING_ERROR {
        "~0".to_owned()
    } else {
        format!("{x:.2e}").parse::<f64>().unwrap().to_string()
    }
}

/// The line with its numbers shortened that stand alone and have a fraction or an exponent.
fn rounded(line: &str) -> String {
    let mut out = String::new();
    let mut rest = line;
    while let Some(begin) = rest.find(|c: char| c.is_ascii_digit()) {
        let (before, from) = rest.split_at(begin);
        let (number, after) = from.split_at(number_len(from));
        let stands_alone = !before.ends_with(|c: char| c.is_alphanumeric() || "._".contains(c))
            && !after.starts_with(|c: char| c.is_alphanumeric() || c == '_');
        out.push_str(before);
        if stands_alone && number.contains(['.', 'e']) {
            out.push_str(&three_digits(number.parse().unwrap()));
        } else {
            out.push_str(number);
        }
        rest = after;
    }
    out + rest
}

/// Length of the number that a text begins with: digits, a fraction, an exponent.
fn number_len(text: &str) -> usize {
    let digits = |from: usize| text[from..].bytes().take_while(u8::is_ascii_digit).count();
    let mut len = digits(0);
    if text[len..].starts_with('.') && digits(len + 1) > 0 {
        len += 1 + digits(len + 1);
    }
    if text[len..].starts_with('e') {
        let sign = usize::from(text[len + 1..].starts_with('-'));
        if digits(len + 1 + sign) > 0 {
            len += 1 + sign + digits(len + 1 + sign);
        }
    }
    len
}

#[test]
fn only_what_differs_from_run_to_run_goes() {
    let before =
        "tau 1.16828, seams fit to 1.5e-14 of 12 edges in m0.5x.obj, 4 (4.0000 = isometry)  ";
    let after = "tau 1.17, seams fit to ~0 of 12 edges in m0.5x.obj, 4 (4 = isometry)";
    assert_eq!(text(before), after);
    assert_eq!(text("time         0.79 s, 1 thread"), "time         [time]");
    let json =
        r#"{"seconds": 1.5, "list": [1, 2, 3, 4, 5], "tau": 1.23456, "count": 7, "zero": 0.0}"#;
    let short =
        r#"{"count":7,"list":[1,2,"[3 more]"],"seconds":"[differs]","tau":1.23,"zero":0.0}"#;
    let found: Value = serde_json::from_str(&report(json)).unwrap();
    assert_eq!(found, serde_json::from_str::<Value>(short).unwrap());
}
