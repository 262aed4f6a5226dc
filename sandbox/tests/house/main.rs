//! The house rules that matter are code: floors, doors, sizes, ledgers.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test may stop the process"
)]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Own packages and their floor: an arrow may only point to a lower one.
const FLOORS: [(&str, u32); 13] = [
    ("lanes", 0),
    ("banded", 0),
    ("field", 1),
    ("elastic", 1),
    ("outline", 1),
    ("integrator", 1),
    ("snake", 2),
    ("tracker", 3),
    ("scene", 4),
    ("cli", 5),
    ("sandbox", 5),
    ("benches", 6), // it times what the sandbox tries
    ("py", 5),
];

/// Outside crates and who may open the door to them. `*` is everybody, `test` everybody's tests.
const DOORS: [(&str, &[&str]); 22] = [
    ("glam", &["*"]),
    ("thiserror", &["*"]),
    ("ndarray", &["field", "scene", "sandbox", "benches"]),
    ("robust", &["outline"]),
    ("pulp", &["lanes", "banded", "field"]),
    ("bytemuck", &["lanes"]),
    ("rustfft", &["banded"]),
    ("serde", &["scene"]),
    ("serde_json", &["scene"]),
    ("toml", &["scene", "sandbox: test"]), // this file reads manifests
    ("image", &["scene"]),
    ("tiff", &["scene"]),
    ("strsim", &["scene"]),
    ("tempfile", &["scene", "test"]),
    ("clap", &["cli", "sandbox"]),
    ("indicatif", &["cli", "sandbox"]),
    ("plotters", &["sandbox"]),
    ("gif", &["sandbox"]),
    ("criterion", &["benches"]),
    ("diffsol", &["benches"]),
    ("ode_solvers", &["benches"]),
    ("proptest", &["test"]),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Every package of the workspace: its name and folder.
fn packages() -> Vec<(String, PathBuf)> {
    let mut folders: Vec<PathBuf> = std::fs::read_dir(root().join("crates"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    folders.extend([root().join("sandbox"), root().join("benches")]);
    let mut out: Vec<(String, PathBuf)> = folders
        .into_iter()
        .filter(|folder| folder.join("Cargo.toml").exists())
        .map(|folder| {
            let name = manifest(&folder)["package"]["name"]
                .as_str()
                .unwrap()
                .to_owned();
            (name, folder)
        })
        .collect();
    out.sort();
    out
}

fn manifest(folder: &Path) -> toml::Table {
    std::fs::read_to_string(folder.join("Cargo.toml"))
        .unwrap()
        .parse()
        .unwrap()
}

/// What a package depends on: name, whether only its tests do, and whether the workspace says how.
fn dependencies(folder: &Path) -> Vec<(String, bool, bool)> {
    let manifest = manifest(folder);
    let mut tables = vec![&manifest];
    if let Some(targets) = manifest.get("target").and_then(toml::Value::as_table) {
        tables.extend(targets.values().filter_map(toml::Value::as_table));
    }
    let mut out = Vec::new();
    for table in tables {
        for (kind, test) in [
            ("dependencies", false),
            ("build-dependencies", false),
            ("dev-dependencies", true),
        ] {
            for (name, how) in table
                .get(kind)
                .and_then(toml::Value::as_table)
                .into_iter()
                .flatten()
            {
                let shared = how
                    .get("workspace")
                    .and_then(toml::Value::as_bool)
                    .unwrap_or(false);
                out.push((name.clone(), test, shared));
            }
        }
    }
    out
}

fn floor(name: &str) -> Option<u32> {
    FLOORS
        .iter()
        .find(|(known, _)| *known == name)
        .map(|(_, floor)| *floor)
}

#[test]
fn arrows_between_crates_point_down_only() {
    for (name, folder) in packages() {
        let own = floor(&name).unwrap_or_else(|| panic!("{name} stands on no floor"));
        for (other, _, _) in dependencies(&folder) {
            if let Some(below) = floor(&other) {
                assert!(
                    below < own,
                    "{name} (floor {own}) depends on {other} (floor {below})"
                );
            }
        }
    }
}

#[test]
fn every_outside_crate_comes_in_by_its_own_door() {
    for (name, folder) in packages() {
        for (other, test, shared) in dependencies(&folder) {
            assert!(shared, "{name}: {other} should say workspace = true");
            if floor(&other).is_some() {
                continue;
            }
            let doors = DOORS
                .iter()
                .find(|(known, _)| *known == other)
                .map(|(_, doors)| *doors);
            let doors =
                doors.unwrap_or_else(|| panic!("{name}: {other} is new; decide on its door"));
            let open = doors.iter().any(|door| match *door {
                "*" => true,
                "test" => test,
                door => door == name || test && door == format!("{name}: test"),
            });
            assert!(open, "{name} may not use {other}; its doors are {doors:?}");
        }
    }
}

/// All Rust files of the workspace, with their text.
fn sources() -> Vec<(PathBuf, String)> {
    let mut out = Vec::new();
    let mut folders: Vec<PathBuf> = packages().into_iter().map(|(_, folder)| folder).collect();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() && !path.ends_with("target") {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                let text = std::fs::read_to_string(&path).unwrap();
                out.push((path, text));
            }
        }
    }
    out.sort();
    out
}

#[test]
fn no_file_is_longer_than_six_hundred_lines() {
    let long: Vec<String> = sources()
        .into_iter()
        .map(|(path, text)| (path, text.lines().count()))
        .filter(|(_, lines)| *lines > 600)
        .map(|(path, lines)| format!("{} has {lines} lines", path.display()))
        .collect();
    assert!(long.is_empty(), "{}", long.join("\n"));
}

#[test]
fn no_source_multiplies_and_adds_in_one_rounding_or_skips_a_test() {
    // put together here so that this file does not find itself
    let banned = ["mul", "ignore", "should", "todo"].map(|word| match word {
        "mul" => format!(".{word}_add("),
        "ignore" => format!("#[{word}"),
        "should" => format!("#[{word}_panic"),
        _ => format!("{word}!("),
    });
    for (path, text) in sources() {
        for (number, line) in text.lines().enumerate() {
            let code = line.split("//").next().unwrap_or_default();
            for word in &banned {
                assert!(
                    !code.contains(word.as_str()),
                    "{}:{}: {word}",
                    path.display(),
                    number + 1
                );
            }
        }
    }
}

/// Which source text defines what: for each package, all its sources in one.
fn by_package() -> BTreeMap<String, String> {
    let mut out = BTreeMap::new();
    for (name, folder) in packages() {
        let base = folder.canonicalize().unwrap();
        let all: Vec<String> = sources()
            .into_iter()
            .filter(|(path, _)| path.canonicalize().unwrap().starts_with(&base))
            .map(|(_, text)| text)
            .collect();
        out.insert(name, all.join("\n"));
    }
    out
}

/// Whether a text defines an item of that name.
fn defines(text: &str, name: &str) -> bool {
    let whole = |rest: &str| {
        let after = rest.strip_prefix(name);
        after.is_some_and(|after| !after.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
    };
    let words = [
        "fn ",
        "struct ",
        "enum ",
        "trait ",
        "const ",
        "static ",
        "type ",
        "mod ",
        "macro_rules! ",
    ];
    let item = words.iter().any(|word| {
        text.match_indices(word)
            .any(|(at, _)| whole(&text[at + word.len()..]))
    });
    // a variant of an enum or a field of a struct stands at the start of its line
    let member = || {
        text.lines().any(|line| {
            let line = line.trim_start();
            let line = line.strip_prefix("pub ").unwrap_or(line);
            whole(line) && line[name.len()..].starts_with([',', '(', ' ', ':', '=']) || line == name
        })
    };
    item || member()
}

/// The code spans of a Markdown cell.
fn spans(cell: &str) -> Vec<&str> {
    cell.split('`')
        .skip(1)
        .step_by(2)
        .filter(|span| !span.is_empty())
        .collect()
}

/// The tables of a ledger as rows of cells. A row is a line between bars; the head and its rule are left out.
fn rows(text: &str) -> Vec<Vec<String>> {
    let mut out = Vec::new();
    let mut before_rule = true;
    for line in text.lines() {
        let line = line.trim();
        if !line.starts_with('|') {
            before_rule = true;
            continue;
        }
        if line.chars().all(|c| matches!(c, '|' | '-' | ':' | ' ')) {
            before_rule = false;
            continue;
        }
        if !before_rule {
            let inner = line.trim_matches('|');
            let cells = inner.replace("\\|", "\u{1}");
            out.push(
                cells
                    .split('|')
                    .map(|cell| cell.trim().replace('\u{1}', "|"))
                    .collect(),
            );
        }
    }
    out
}

/// Everything in a ledger that is named and not there. An item is a path `crate::item` (also
/// `crate::Type::member`); a test is a plain name of small letters with an underscore.
fn missing_in(ledger: &str, packages: &BTreeMap<String, String>) -> Vec<String> {
    let mut out = Vec::new();
    for row in rows(ledger) {
        let label = row.first().cloned().unwrap_or_default();
        for span in row.iter().flat_map(|cell| spans(cell)) {
            if let Some((package, rest)) = span.split_once("::") {
                let item = rest
                    .trim_end_matches("()")
                    .rsplit("::")
                    .next()
                    .unwrap_or_default();
                match packages.get(package) {
                    None => out.push(format!("{label}: {span}: no package {package}")),
                    Some(text) if !defines(text, item) => {
                        out.push(format!("{label}: {span}: not found in {package}"));
                    }
                    Some(_) => {}
                }
            } else if is_test_name(span) {
                let text = format!("fn {span}(");
                let closed = format!("fn {span} ");
                let there = packages
                    .values()
                    .any(|all| all.contains(&text) || all.contains(&closed));
                if !there {
                    out.push(format!("{label}: no test {span}"));
                }
            }
        }
    }
    out
}

/// A test's name is a sentence: small letters, at least two underscores.
fn is_test_name(span: &str) -> bool {
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    span.chars().all(plain) && span.matches('_').count() >= 2
}

fn check_ledger(name: &str) {
    let path = root().join("docs").join(name);
    let Ok(text) = std::fs::read_to_string(&path) else {
        return;
    }; // not written yet
    let missing = missing_in(&text, &by_package());
    assert!(missing.is_empty(), "docs/{name}:\n{}", missing.join("\n"));
    let named = rows(&text)
        .iter()
        .flatten()
        .flat_map(|cell| spans(cell))
        .count();
    assert!(named > 0, "docs/{name} points to nothing");
}

#[test]
fn every_row_of_the_equation_ledger_points_to_what_exists() {
    check_ledger("equations.md");
}

#[test]
fn every_row_of_the_errata_ledger_points_to_what_exists() {
    check_ledger("errata.md");
}

#[test]
fn a_ledger_that_points_nowhere_is_found_out() {
    let sources = "/// Doc.\npub fn force() {}\npub enum End {\n    Free,\n}\n#[test]\nfn it_is_so_and_so() {}";
    let packages = BTreeMap::from([("elastic".to_owned(), sources.to_owned())]);
    let check = |row: &str| {
        missing_in(
            &format!("| eq | item | test |\n| --- | --- | --- |\n{row}\n"),
            &packages,
        )
    };
    assert!(check("| 3.2 | `elastic::force` | `it_is_so_and_so` |").is_empty());
    assert!(check("| 3.2 | `elastic::End::Free` | a word |").is_empty());
    assert_eq!(check("| 3.2 | `elastic::forc` | |").len(), 1);
    assert_eq!(check("| 3.2 | `elastic::forces` | |").len(), 1);
    assert_eq!(check("| 3.2 | `plastic::force` | |").len(), 1);
    assert_eq!(
        check("| 3.2 | `elastic::force` | `it_is_not_so` |"),
        ["3.2: no test it_is_not_so"]
    );
}

#[test]
fn every_experiment_has_its_expected_numbers() {
    for experiment in sandbox::EXPERIMENTS {
        let file = sandbox::expected_folder().join(format!("{}.csv", experiment.id));
        assert!(
            file.exists(),
            "{} is missing; REGENERATE=1 writes it",
            file.display()
        );
    }
}
