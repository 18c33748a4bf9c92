//! Checks that every dependency, on any system, may be had under a licence that `deny.toml` allows, and that
//! ARCHITECTURE.md lists every direct one.
//!
//! The same as `cargo deny check licenses`, for machines without cargo-deny.
#![allow(clippy::print_stdout)]

use serde_json::Value;
use std::collections::BTreeSet;
use std::error::Error;
use std::ffi::OsStr;
use std::process::Command;

fn main() -> Result<(), Box<dyn Error>> {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    let rules = std::fs::read_to_string(format!("{root}/deny.toml"))?;
    let table = std::fs::read_to_string(format!("{root}/ARCHITECTURE.md"))?;
    let allowed = allowed(&rules).ok_or("deny.toml has no list of allowed licences")?;
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let (mut faults, mut foreign) = (Vec::new(), 0);
    // The Python package is outside the workspace, with a lock file of its own.
    let of_python = format!("{root}/crates/python");
    let packages = [packages(&cargo, root)?, packages(&cargo, &of_python)?].concat();
    for package in &packages {
        let name = package["name"].as_str().unwrap_or_default();
        if package["source"].is_null() {
            faults.extend(unlisted(package, &table).into_iter().map(|dependency| {
                format!("{name} depends on {dependency}, which ARCHITECTURE.md does not list")
            }));
            continue;
        }
        foreign += 1;
        let licence = package["license"].as_str().unwrap_or("none");
        if !is_allowed(licence, &allowed) {
            faults.push(format!("{name} has the licence {licence}"));
        }
    }
    if !faults.is_empty() {
        return Err(faults.join("\n").into());
    }
    println!("{foreign} dependencies may be had under {}", allowed.join(", "));
    Ok(())
}

/// The packages that a workspace is made of and depends on.
fn packages(cargo: &OsStr, folder: &str) -> Result<Vec<Value>, Box<dyn Error>> {
    let metadata = Command::new(cargo)
        .args(["metadata", "--locked", "--all-features", "--format-version", "1"])
        .current_dir(folder)
        .output()?;
    if !metadata.status.success() {
        return Err(String::from_utf8_lossy(&metadata.stderr).into());
    }
    let metadata: Value = serde_json::from_slice(&metadata.stdout)?;
    Ok(metadata["packages"].as_array().ok_or("no packages")?.clone())
}

/// The strings of `allow = [...]` under `[licenses]`.
fn allowed(rules: &str) -> Option<Vec<&str>> {
    let (_, section) = rules.split_once("[licenses]")?;
    let (_, list) = section.split_once("allow = [")?;
    let (list, _) = list.split_once(']')?;
    Some(list.split('"').skip(1).step_by(2).collect())
}

/// Direct dependencies from the registry without a row in the table, where rows begin with names and versions.
fn unlisted(package: &Value, table: &str) -> BTreeSet<String> {
    let dependencies = package["dependencies"].as_array().into_iter().flatten();
    let foreign = dependencies.filter(|dependency| !dependency["source"].is_null());
    let names = foreign.filter_map(|dependency| dependency["name"].as_str());
    let first_cells: Vec<&str> = table.lines().filter_map(|line| line.split('|').nth(1)).collect();
    let is_listed = |name: &&str| {
        let listed =
            |cell: &&str| cell.split(',').any(|one| one.trim().starts_with(&format!("{name} ")));
        first_cells.iter().any(listed)
    };
    names.filter(|name| !is_listed(name)).map(str::to_owned).collect()
}

/// Whether an SPDX expression can be met: all sides of AND, one side of OR, innermost brackets first.
fn is_allowed(expression: &str, allowed: &[&str]) -> bool {
    if let (Some(close), true) = (expression.find(')'), expression.contains('(')) {
        let Some(open) = expression[..close].rfind('(') else { return false };
        let inner = is_allowed(&expression[open + 1..close], allowed);
        // Both outcomes as licences of their own.
        let verdict = if inner { allowed.first().copied().unwrap_or_default() } else { "refused" };
        let rest = [&expression[..open], verdict, &expression[close + 1..]].concat();
        return is_allowed(&rest, allowed);
    }
    // Old manifests separate alternatives by a slash.
    let expression = expression.replace('/', " OR ");
    let one = |licence: &str| allowed.contains(&licence.trim());
    expression.split(" OR ").any(|side| side.split(" AND ").all(one))
}

#[cfg(test)]
mod tests {
    use super::{allowed, is_allowed};

    #[test]
    fn expressions_are_met_or_not() {
        let rules = "[licenses]\nallow = [\n  \"MIT\",\n  \"Zlib\",\n]\n";
        let allowed = allowed(rules).unwrap();
        assert_eq!(allowed, ["MIT", "Zlib"]);
        for met in ["MIT", "GPL-3.0 OR MIT", "Apache-2.0/MIT", "(MIT OR GPL-3.0) AND Zlib"] {
            assert!(is_allowed(met, &allowed), "{met}");
        }
        for refused in ["GPL-3.0", "MIT AND GPL-3.0", "(GPL-3.0 OR Apache-2.0) AND MIT", "none"] {
            assert!(!is_allowed(refused, &allowed), "{refused}");
        }
    }
}
