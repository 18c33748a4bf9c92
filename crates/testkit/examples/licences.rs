//! Checks that every dependency, on any system, may be had under a licence that `deny.toml` allows, and that
//! ARCHITECTURE.md lists every direct one.
//!
//! The same as `cargo deny check licenses`, for machines without cargo-deny. With a folder as argument, it writes there what
//! the program `seamstress` is made of on this system (`sbom.json`, in CycloneDX 1.5), and the licences of that with their
//! texts (`THIRD-PARTY.txt`).
#![allow(clippy::print_stdout)]

use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::ffi::OsStr;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
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
    let Some(folder) = std::env::args_os().nth(1) else { return Ok(()) };
    let folder = Path::new(&folder);
    let linked = linked(&cargo, root)?;
    let is_linked = |package: &&Value| linked.contains(&name_and_version(package));
    // Both workspaces have most of them.
    let parts =
        packages.iter().filter(is_linked).map(|package| (name_and_version(package), package));
    let parts: Vec<&Value> = parts.collect::<BTreeMap<_, _>>().into_values().collect();
    let sums = checksums(&fs::read_to_string(format!("{root}/Cargo.lock"))?);
    let bill = serde_json::to_string_pretty(&bill(&parts, &sums))?;
    fs::write(folder.join("sbom.json"), bill + "\n")?;
    fs::write(folder.join("THIRD-PARTY.txt"), notices(&parts)?)?;
    println!("the program is made of {} packages", linked.len());
    Ok(())
}

fn name_and_version(package: &Value) -> [String; 2] {
    ["name", "version"].map(|field| package[field].as_str().unwrap_or_default().to_owned())
}

/// The names and versions of what is in the program on this system.
fn linked(cargo: &OsStr, root: &str) -> Result<BTreeSet<[String; 2]>, Box<dyn Error>> {
    let tree = Command::new(cargo)
        .args(["tree", "--locked", "-p", "seamstress-cli", "-e", "normal", "--prefix", "none"])
        .args(["--format", "{p}"])
        .current_dir(root)
        .output()?;
    if !tree.status.success() {
        return Err(String::from_utf8_lossy(&tree.stderr).into());
    }
    let text = String::from_utf8(tree.stdout)?;
    let one = |line: &str| {
        let mut words = line.split_whitespace();
        Some([words.next()?.to_owned(), words.next()?.trim_start_matches('v').to_owned()])
    };
    Ok(text.lines().filter_map(one).collect())
}

/// The SHA-256 of packages of the registry, from a lock file.
fn checksums(lock: &str) -> BTreeMap<[String; 2], String> {
    let value = |block: &str, field: &str| {
        let begin = format!("{field} = \"");
        let line = block.lines().find_map(|line| line.strip_prefix(&begin))?;
        Some(line.trim_end_matches('"').to_owned())
    };
    let package = |block: &str| {
        Some(([value(block, "name")?, value(block, "version")?], value(block, "checksum")?))
    };
    lock.split("[[package]]").filter_map(package).collect()
}

/// Old manifests separate alternatives by a slash.
fn expression(package: &Value) -> String {
    package["license"].as_str().unwrap_or("none").replace('/', " OR ").replace("  ", " ")
}

/// A bill of materials.
fn bill(packages: &[&Value], sums: &BTreeMap<[String; 2], String>) -> Value {
    let component = |package: &&Value| {
        let [name, version] = name_and_version(package);
        let mut component = json!({
            "type": "library",
            "name": name,
            "version": version,
            "purl": format!("pkg:cargo/{name}@{version}"),
            "licenses": [{ "expression": expression(package) }],
        });
        if let Some(sum) = sums.get(&[name, version]) {
            component["hashes"] = json!([{ "alg": "SHA-256", "content": sum }]);
        }
        component
    };
    json!({
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": { "component": {
            "type": "application",
            "name": "seamstress",
            "version": env!("CARGO_PKG_VERSION"),
        } },
        "components": packages.iter().map(component).collect::<Vec<_>>(),
    })
}

/// The packages of others with their licences, and each text once.
fn notices(packages: &[&Value]) -> Result<String, Box<dyn Error>> {
    let mut texts = BTreeMap::<String, Vec<String>>::new();
    let mut list = "The program contains these packages, under the licences named:\n\n".to_owned();
    for package in packages.iter().filter(|package| !package["source"].is_null()) {
        let title = name_and_version(package).join(" ");
        let source = package["repository"].as_str().unwrap_or_default();
        writeln!(list, "{title}: {} {source}", expression(package))?;
        let manifest = Path::new(package["manifest_path"].as_str().unwrap_or_default());
        let Some(folder) = manifest.parent() else { continue };
        // What is vendored has its own, further down.
        let mut folders = vec![folder.to_owned()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder)? {
                let path = entry?.path();
                let name = path.file_name().unwrap_or_default().to_string_lossy().to_uppercase();
                let is_notice =
                    ["LICENSE", "LICENCE", "COPYING", "NOTICE"].iter().any(|n| name.starts_with(n));
                if path.is_dir() {
                    folders.push(path);
                } else if is_notice {
                    let text = String::from_utf8_lossy(&fs::read(&path)?).trim().to_owned();
                    texts.entry(text).or_default().push(title.clone());
                }
            }
        }
    }
    for (text, mut of) in texts {
        of.dedup();
        write!(list, "\n{}\n{}:\n\n{text}\n", "-".repeat(80), of.join(", "))?;
    }
    Ok(list)
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
    let expression = expression.replace('/', " OR ");
    let one = |licence: &str| allowed.contains(&licence.trim());
    expression.split(" OR ").any(|side| side.split(" AND ").all(one))
}

#[cfg(test)]
mod tests {
    use super::{allowed, bill, checksums, is_allowed};
    use serde_json::json;

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

    #[test]
    fn a_bill_has_licences_and_sums() {
        let lock = "version = 4\n\n[[package]]\nname = \"a\"\nversion = \"1.0.0\"\nchecksum = \"beef\"\n\n\
                    [[package]]\nname = \"b\"\nversion = \"2.0.0\"\n";
        let sums = checksums(lock);
        assert_eq!(sums.len(), 1);
        let packages = [
            json!({ "name": "a", "version": "1.0.0", "license": "MIT/Apache-2.0" }),
            json!({ "name": "b", "version": "2.0.0", "license": "Zlib" }),
        ];
        let bill = bill(&packages.iter().collect::<Vec<_>>(), &sums);
        let [a, b] = [0, 1].map(|k| &bill["components"][k]);
        assert_eq!(a["purl"], "pkg:cargo/a@1.0.0");
        assert_eq!(a["licenses"][0]["expression"], "MIT OR Apache-2.0");
        assert_eq!(a["hashes"][0]["content"], "beef");
        assert!(b["hashes"].is_null());
    }
}
