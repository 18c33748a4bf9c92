//! Modules depend on each other in one direction: in no crate do modules side by side use each other in a circle.
#![allow(clippy::unwrap_used, reason = "a test")]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// Names from the root of a crate to a module.
type ModulePath = Vec<String>;

/// What the file of a module says about others.
#[derive(Debug, Default)]
struct Uses {
    /// Paths that begin with `crate`, `super` or `self`, or stand in a `use`.
    paths: Vec<Vec<String>>,
    /// What its `use` items bring in, by the name they give it.
    imports: BTreeMap<String, Vec<String>>,
}

#[test]
fn no_modules_use_each_other_in_a_circle() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let (mut checked, mut found) = (0, Vec::new());
    for entry in fs::read_dir(crates).unwrap() {
        let folder = entry.unwrap().path();
        let mut modules = BTreeMap::new();
        read(&folder.join("src"), &mut Vec::new(), &mut modules);
        let name = folder.file_name().unwrap().to_str().unwrap();
        found.extend(circles(&modules).into_iter().map(|circle| format!("{name}: {circle}")));
        checked += modules.len();
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
    assert!(checked > 300, "only {checked} modules were read");
}

#[test]
fn circles_are_found_and_named() {
    let crate_of = |files: &[(&str, &str)]| {
        let module = |name: &str| -> ModulePath {
            name.split('/').filter(|name| !name.is_empty()).map(str::to_owned).collect()
        };
        files.iter().map(|(name, text)| (module(name), uses(text))).collect()
    };
    let one_way = [
        ("", "mod a; mod b; pub use a::A; pub use b::B;"),
        (
            "a",
            "/// Used by `crate::b`.\npub struct A;\n#[cfg(test)]\nmod tests { use crate::b::B; }",
        ),
        ("b", "use crate::{A, c::{self, C}};\nconst TEXT: &str = \"crate::a\";"),
        ("b/inner", "use super::B;"),
        ("c", "fn f() -> crate::a::A { crate::a::A }"),
    ];
    assert_eq!(circles(&crate_of(&one_way)), [""; 0]);
    // Through the root, through a path in an expression, and among the files of a module.
    let by_root = [("", "pub use b::B;"), ("a", "use crate::B;"), ("b", "use super::a::A;")];
    assert_eq!(circles(&crate_of(&by_root)), ["a -> b (crate::B) -> a (super::a::A)"]);
    let by_path =
        [("a", "use crate::{b::{inner::X, Y}};"), ("b", ""), ("b/inner", "type T = crate::a::A;")];
    assert_eq!(circles(&crate_of(&by_path)).len(), 1);
    let inside = [
        ("m", "mod x; mod y; mod z; pub use y::Y;"),
        ("m/x", "use super::Y;"),
        ("m/y", "use super::z::Z;"),
        ("m/z", "use crate::m::x::X;"),
    ];
    let named = circles(&crate_of(&inside));
    assert_eq!(named.len(), 1);
    assert!(["m::x", "m::y", "m::z"].iter().all(|name| named[0].contains(name)), "{named:?}");
}

/// Reads the modules below a folder of sources.
fn read(folder: &Path, at: &mut ModulePath, modules: &mut BTreeMap<ModulePath, Uses>) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        if path.is_dir() {
            at.push(name);
            read(&path, at, modules);
            at.pop();
        } else if path.extension().is_some_and(|e| e == "rs") && name != "tests" {
            let is_root = ["mod", "lib", "main"].contains(&name.as_str());
            let module = at.iter().cloned().chain((!is_root).then_some(name)).collect();
            modules.insert(module, uses(&fs::read_to_string(&path).unwrap()));
        }
    }
}

/// The circles among modules of the same parent, one for each parent that has any.
fn circles(modules: &BTreeMap<ModulePath, Uses>) -> Vec<String> {
    // By parent: which child uses which, and by what path.
    let mut graphs: BTreeMap<&[String], BTreeMap<&str, BTreeMap<&str, String>>> = BTreeMap::new();
    let resolved: Vec<_> = modules
        .iter()
        .flat_map(|(from, uses)| uses.paths.iter().map(move |path| (from, path)))
        .filter_map(|(from, path)| Some((from, resolve(modules, from, path, 0)?, path)))
        .collect();
    for (from, to, path) in &resolved {
        let shared = from.iter().zip(to.iter()).take_while(|(a, b)| a == b).count();
        if let (Some(a), Some(b)) = (from.get(shared), to.get(shared)) {
            let graph = graphs.entry(&from[..shared]).or_default();
            graph.entry(a).or_default().entry(b).or_insert_with(|| path.join("::"));
        }
    }
    graphs.iter().filter_map(|(parent, graph)| circle(parent, graph)).collect()
}

/// A shortest circle of a graph, written out.
fn circle(parent: &[String], graph: &BTreeMap<&str, BTreeMap<&str, String>>) -> Option<String> {
    let around = |start: &str| {
        let mut reached = BTreeSet::new();
        let mut paths = vec![vec![start.to_owned()]];
        while !paths.is_empty() {
            let mut longer = Vec::new();
            for path in paths {
                for (&next, _) in graph.get(path.last()?.as_str()).into_iter().flatten() {
                    let path: Vec<String> = path.iter().cloned().chain([next.to_owned()]).collect();
                    if next == start {
                        return Some(path);
                    }
                    if reached.insert(next) {
                        longer.push(path);
                    }
                }
            }
            paths = longer;
        }
        None
    };
    let shortest = graph.keys().filter_map(|start| around(start)).min_by_key(Vec::len)?;
    let name = |child: &String| [parent, std::slice::from_ref(child)].concat().join("::");
    let mut text = name(&shortest[0]);
    for pair in shortest.windows(2) {
        let by = &graph[pair[0].as_str()][pair[1].as_str()];
        text += &format!(" -> {} ({by})", name(&pair[1]));
    }
    Some(text)
}

/// The module a path leads to from another: the last one on it, or the one where the name was made that a module on it
/// imports.
fn resolve(
    modules: &BTreeMap<ModulePath, Uses>,
    from: &ModulePath,
    path: &[String],
    depth: usize,
) -> Option<ModulePath> {
    const IMPORTS_OF_IMPORTS: usize = 8;
    let mut at = from.clone();
    let mut names = path;
    match path.first()?.as_str() {
        "crate" => (at, names) = (Vec::new(), &path[1..]),
        "self" => names = &path[1..],
        "super" => {}
        child if modules.contains_key(&[&from[..], &[child.to_owned()]].concat()) => {}
        _ => return None,
    }
    for name in names {
        if name == "super" {
            at.pop();
            continue;
        }
        let child = [&at[..], std::slice::from_ref(name)].concat();
        if modules.contains_key(&child) {
            at = child;
            continue;
        }
        let import = modules.get(&at).and_then(|uses| uses.imports.get(name));
        let is_new =
            |import: &&Vec<String>| depth < IMPORTS_OF_IMPORTS && import.as_slice() != path;
        return match import.filter(is_new) {
            Some(import) => resolve(modules, &at, import, depth + 1).or(Some(at)),
            None => Some(at),
        };
    }
    Some(at)
}

fn uses(text: &str) -> Uses {
    let tokens = without_tests(tokens(text));
    let mut uses = Uses::default();
    let mut at = 0;
    while at < tokens.len() {
        let is_path = ["crate", "super", "self"].contains(&tokens[at].as_str())
            && tokens.get(at + 1).is_some_and(|next| next == "::");
        if tokens[at] == "use" {
            at += 1;
            let mut imported = Vec::new();
            while at < tokens.len() && tokens[at] != ";" {
                at = if is_name(&tokens[at]) {
                    tree(&tokens, at, &[], &mut imported)
                } else {
                    at + 1
                };
            }
            uses.paths.extend(imported.iter().map(|(path, _)| path.clone()));
            uses.imports.extend(imported.into_iter().map(|(path, name)| (name, path)));
        } else if is_path {
            let mut found = Vec::new();
            at = tree(&tokens, at, &[], &mut found);
            uses.paths.extend(found.into_iter().map(|(path, _)| path));
        } else {
            at += 1;
        }
    }
    uses
}

/// Reads a path with whatever braces it ends in: adds each whole path with the name it is given; returns the place after
/// it.
fn tree(
    tokens: &[String],
    mut at: usize,
    before: &[String],
    found: &mut Vec<(Vec<String>, String)>,
) -> usize {
    let mut path = [before, &tokens[at..=at]].concat();
    at += 1;
    while tokens.get(at).is_some_and(|token| token == "::") {
        at += 1;
        match tokens.get(at).map(String::as_str) {
            Some("{") => {
                at += 1;
                while at < tokens.len() && tokens[at] != "}" {
                    at = if is_name(&tokens[at]) { tree(tokens, at, &path, found) } else { at + 1 };
                }
                return at + 1;
            }
            Some(name) if is_name(name) => path.push(name.to_owned()),
            _ => break,
        }
        at += 1;
    }
    if path.len() > 1 && path.last().is_some_and(|last| last == "self") {
        path.pop();
    }
    let mut name = path.last().cloned().unwrap_or_default();
    if tokens.get(at).is_some_and(|token| token == "as") {
        name = tokens.get(at + 1).cloned().unwrap_or_default();
        at += 2;
    }
    found.push((path, name));
    at
}

fn is_name(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Names, `::` and single marks, without comments, texts and letters.
fn tokens(text: &str) -> Vec<String> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if first == '"' {
            quoted(rest)
        } else if let Some(length) = letter(rest) {
            length
        } else if is_name(rest) || first.is_numeric() {
            let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_');
            let length = end.unwrap_or(rest.len());
            tokens.push(rest[..length].to_owned());
            length
        } else {
            let length = if rest.starts_with("::") { 2 } else { first.len_utf8() };
            if !first.is_whitespace() {
                tokens.push(rest[..length].to_owned());
            }
            length
        };
        rest = &rest[length..];
    }
    tokens
}

/// Length of a text in double quotes.
fn quoted(rest: &str) -> usize {
    let mut is_escaped = false;
    for (at, c) in rest.char_indices().skip(1) {
        match c {
            _ if is_escaped => is_escaped = false,
            '\\' => is_escaped = true,
            '"' => return at + 1,
            _ => {}
        }
    }
    rest.len()
}

/// Length of a letter in single quotes; none for a lifetime.
fn letter(rest: &str) -> Option<usize> {
    let inside = rest.strip_prefix('\'')?;
    if let Some(escaped) = inside.strip_prefix('\\') {
        // The first letter of the escape may be a quote itself.
        return escaped[1..].find('\'').map(|end| end + 4);
    }
    let c = inside.chars().next()?;
    inside[c.len_utf8()..].starts_with('\'').then_some(c.len_utf8() + 2)
}

/// Without the modules that are compiled for tests only.
fn without_tests(tokens: Vec<String>) -> Vec<String> {
    let marker = ["#", "[", "cfg", "(", "test", ")", "]"];
    let mut kept = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        let is_marked = tokens[at..].iter().zip(marker).filter(|(a, b)| a == b).count() == 7;
        let body = tokens[at..].iter().position(|t| t == "{" || t == ";");
        let is_module = tokens.get(at + 7).is_some_and(|t| t == "mod");
        if let (true, true, Some(body)) = (is_marked, is_module, body) {
            at += body;
            let mut depth = 0;
            loop {
                match tokens.get(at).map(String::as_str) {
                    Some("{") => depth += 1,
                    Some("}") => depth -= 1,
                    None => break,
                    _ => {}
                }
                at += 1;
                if depth == 0 {
                    break;
                }
            }
        } else {
            kept.push(tokens[at].clone());
            at += 1;
        }
    }
    kept
}
