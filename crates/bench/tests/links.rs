//! The links of the documentation: every file, heading, function and citation that it names exists.

#![allow(clippy::unwrap_used, reason = "a test, with helpers")]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// All pages of the repository, in a fixed order.
fn pages(root: &Path) -> Vec<PathBuf> {
    let mut pages = Vec::new();
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            if path.is_dir() {
                let is_made = ["target", "node_modules"].contains(&name.as_str());
                if !is_made && !name.starts_with('.') {
                    folders.push(path);
                }
            } else if name.ends_with(".md") {
                pages.push(path);
            }
        }
    }
    pages.sort();
    pages
}

/// The lines of a page outside code blocks.
fn prose(text: &str) -> impl Iterator<Item = &str> {
    let mut is_code = false;
    text.lines().filter(move |line| {
        let fence = line.trim_start().starts_with("```");
        is_code ^= fence;
        !is_code && !fence
    })
}

/// The texts and targets of the links in a page.
fn links(text: &str) -> Vec<(String, String)> {
    // A link may go over the end of a line.
    let text = prose(text).collect::<Vec<_>>().join(" ");
    let mut links = Vec::new();
    for (at, _) in text.match_indices("](") {
        let target = text[at + 2..].split(')').next().unwrap_or_default();
        let label = text[..at].rsplit('[').next().unwrap_or_default();
        links.push((label.to_owned(), target.to_owned()));
    }
    links
}

/// The anchors of a page: its headings as GitHub names them.
fn anchors(text: &str) -> BTreeSet<String> {
    let headings = prose(text).filter_map(|line| {
        let title = line.trim_start_matches('#');
        (title.len() < line.len() && title.starts_with(' ')).then(|| title.trim())
    });
    headings.map(anchor).collect()
}

fn anchor(title: &str) -> String {
    let kept = title.chars().filter(|c| c.is_alphanumeric() || [' ', '-', '_'].contains(c));
    kept.flat_map(char::to_lowercase).map(|c| if c == ' ' { '-' } else { c }).collect()
}

/// Whether a source file has a name as a whole word.
fn has_name(source: &str, name: &str) -> bool {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    source.split(|c| !is_part(c)).any(|word| word == name)
}

/// What is wrong with a link of a page; nothing for links to other sites.
fn fault(page: &Path, label: &str, target: &str) -> Option<String> {
    if target.contains("://") || target.starts_with("mailto:") {
        return None;
    }
    let (file, heading) = target.split_once('#').unwrap_or((target, ""));
    let path = if file.is_empty() { page.to_owned() } else { page.parent()?.join(file) };
    if !path.exists() {
        return Some(format!("{target}: no such file"));
    }
    let text = || fs::read_to_string(&path).unwrap_or_default();
    if !heading.is_empty() && !anchors(&text()).contains(heading) {
        return Some(format!("{target}: no such heading"));
    }
    let is_source = path.extension().is_some_and(|extension| extension == "rs");
    let text = if is_source { text() } else { return None };
    let missing = names(label).find(|name| !has_name(&text, name));
    missing.map(|name| format!("{target}: no {name} there"))
}

/// The names of functions and types in the text of a link.
fn names(label: &str) -> impl Iterator<Item = &str> {
    let code = label.split('`').skip(1).step_by(2);
    code.filter(|word| word.chars().all(|c| c.is_alphanumeric() || c == '_'))
}

/// The keys that a page cites, as in `[@levi2021; @smith2015]`.
fn citations(text: &str) -> Vec<String> {
    let text = prose(text).collect::<Vec<_>>().join(" ");
    let cited = text.split("[@").skip(1).flat_map(|rest| {
        let keys = rest.split(']').next().unwrap_or_default();
        keys.split(';').map(|key| key.trim().trim_start_matches('@').to_owned()).collect::<Vec<_>>()
    });
    cited.collect()
}

#[test]
fn every_link_and_citation_of_the_documentation_exists() {
    let root = root();
    let references = fs::read_to_string(root.join("references.bib")).unwrap();
    let mut faults = Vec::new();
    let mut count = 0;
    for page in pages(&root) {
        let text = fs::read_to_string(&page).unwrap();
        let shown = page.strip_prefix(&root).unwrap().display().to_string();
        for (label, target) in links(&text) {
            count += 1;
            faults.extend(fault(&page, &label, &target).map(|fault| format!("{shown}: {fault}")));
        }
        for key in citations(&text) {
            if !references.contains(&format!("{{{key},")) {
                faults.push(format!("{shown}: nothing cited as {key}"));
            }
        }
    }
    assert!(count > 100, "only {count} links were found");
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn broken_links_are_found() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("page.md");
    let text = "# A page\n\n## Step 2. Cut & paste\n\n[a](b.md) [`round`](code.rs)\n\n```text\n[x](y)\n```\n";
    fs::write(&page, text).unwrap();
    fs::write(folder.path().join("code.rs"), "fn rounded() {}\nfn round() {}\n").unwrap();
    let found = links(text);
    let expected = [("a", "b.md"), ("`round`", "code.rs")];
    assert_eq!(found, expected.map(|(label, target)| (label.to_owned(), target.to_owned())));
    let fault = |label: &str, target: &str| fault(&page, label, target);
    for good in ["code.rs", "#a-page", "page.md#step-2-cut--paste", "https://example.org/x"] {
        assert_eq!(fault("`round`", good), None);
    }
    assert_eq!(fault("a", "b.md").as_deref(), Some("b.md: no such file"));
    assert_eq!(fault("a", "page.md#step-3").as_deref(), Some("page.md#step-3: no such heading"));
    assert_eq!(fault("`roun`", "code.rs").as_deref(), Some("code.rs: no roun there"));
    assert_eq!(fault("`round`, `cut`", "code.rs").as_deref(), Some("code.rs: no cut there"));
    assert_eq!(fault("`code.rs`", "code.rs"), None);
    assert_eq!(
        citations("as in [@levi2021; @smith2015] and\n[@liu2008]"),
        ["levi2021", "smith2015", "liu2008"]
    );
}
