//! Where results and progress go.

use std::error::Error;
use std::fs;
use std::path::Path;

/// A measurement, ready to be read.
#[derive(Debug, Clone)]
pub struct Section {
    /// Tables and lists in Markdown.
    pub text: String,
    /// Whether everything measured is as it should be.
    pub passed: bool,
}

impl Section {
    /// A section that passes if the list of failures is empty; the list is its end.
    pub fn new(text: impl ToString, failures: &[String]) -> Self {
        let mut text = text.to_string();
        if !failures.is_empty() {
            text += &list("Failed", failures);
        }
        Self { text, passed: failures.is_empty() }
    }
}

/// A titled list in Markdown, nothing without items.
pub fn list(title: &str, items: &[String]) -> String {
    if items.is_empty() {
        return String::new();
    }
    let items: Vec<String> = items.iter().map(|item| format!("* {item}\n")).collect();
    format!("\n{title}:\n\n{}", items.concat())
}

/// The line above the part of a page that a program writes.
const BEGIN: &str = "<!-- measured: do not edit below this line -->";
/// The line below it.
const END: &str = "<!-- end of measured -->";

/// Writes a page. Where it exists already, only the measured part of it is replaced.
///
/// # Errors
/// If the file cannot be read or written.
pub fn write_page(file: &Path, title: &str, measured: &str) -> Result<(), Box<dyn Error>> {
    let part = format!("{BEGIN}\n\n{}\n\n{END}\n", measured.trim());
    let old = match fs::read_to_string(file) {
        Ok(old) => old,
        Err(_) => format!("# {title}\n"),
    };
    let new = match (old.find(BEGIN), old.find(END)) {
        (Some(begin), Some(end)) if begin < end => {
            let rest = old[end + END.len()..].trim_start_matches('\n');
            let gap = if rest.is_empty() { "" } else { "\n" };
            format!("{}{part}{gap}{rest}", &old[..begin])
        }
        _ => format!("{}\n\n{part}", old.trim_end()),
    };
    fs::write(file, new).map_err(|e| format!("cannot write {}: {e}", file.display()))?;
    Ok(())
}

/// Shows a result on standard output.
#[expect(clippy::print_stdout, reason = "results are what this program is for")]
pub fn show(text: &str) {
    print!("{text}");
}

/// Shows a line of progress on standard error.
#[expect(clippy::print_stderr, reason = "progress goes there, apart from the results")]
pub fn progress(line: &str) {
    eprintln!("{line}");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_by_hand_stays() {
        let folder = tempfile::tempdir().unwrap();
        let page = folder.path().join("page.md");
        let read = || fs::read_to_string(&page).unwrap();
        write_page(&page, "Maps", "| first |").unwrap();
        assert_eq!(read(), format!("# Maps\n\n{BEGIN}\n\n| first |\n\n{END}\n"));
        fs::write(&page, read().replace("# Maps\n", "# Maps\n\nA note.\n") + "\nAnother.\n")
            .unwrap();
        write_page(&page, "Maps", "| second |\n").unwrap();
        let expected = format!("# Maps\n\nA note.\n\n{BEGIN}\n\n| second |\n\n{END}\n\nAnother.\n");
        assert_eq!(read(), expected);
        fs::write(&page, "# By hand\n").unwrap();
        write_page(&page, "Maps", "| third |").unwrap();
        assert_eq!(read(), format!("# By hand\n\n{BEGIN}\n\n| third |\n\n{END}\n"));
    }

    #[test]
    fn failures_are_listed() {
        let failed = Section::new("text\n", &["a: no".into()]);
        assert_eq!((failed.text.as_str(), failed.passed), ("text\n\nFailed:\n\n* a: no\n", false));
        assert!(Section::new("text", &[]).passed);
    }
}
