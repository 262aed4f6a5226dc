//! The house rules that matter are code: floors, doors, sizes, ledgers, licences.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test may stop the process"
)]

use std::path::{Path, PathBuf};

mod ledgers;
mod licences;
mod sizes;
mod words;

/// Own packages, without the prefix `snakes-`, and their floor: an arrow may only point to a lower one.
const FLOORS: [(&str, u32); 26] = [
    ("lanes", 0),
    ("banded", 1),
    ("field", 2),
    ("elastic", 2),
    ("outline", 2),
    ("integrator", 2),
    ("classic", 2), // the snake of 1988
    ("flow", 3),
    ("snake", 3),
    ("score", 3),
    ("search", 3),
    ("io", 3),       // files, and the fields of a picture
    ("store", 4),    // many files as one table
    ("subpixel", 4), // the last stage of a search
    ("instances", 5),
    ("fit", 6),
    ("snakes", 8), // what users see of all below
    ("track", 7),
    ("scene", 8),
    ("live", 9),
    ("cli", 10),
    ("wasm", 10), // the page with its engine inside
    ("sandbox", 9),
    ("benches", 10), // it draws with the kit of the sandbox
    ("peers", 11),   // general solvers, which nothing else builds
    ("py", 9),       // the same for Python
];

/// Outside crates and who may open the door to them. `*` is everybody, `test` everybody's tests.
const DOORS: [(&str, &[&str]); 44] = [
    ("glam", &["*"]),
    ("thiserror", &["*"]),
    (
        "ndarray",
        &[
            "field",
            "fit",
            "flow",
            "instances",
            "io",
            "live",
            "scene",
            "score",
            "search",
            "track",
            "cli",
            "sandbox",
            "benches",
            "py",
        ],
    ),
    ("robust", &["outline"]),
    ("pulp", &["lanes", "banded", "field"]),
    ("bytemuck", &["lanes"]),
    ("rustfft", &["banded"]),
    ("serde", &["io", "scene", "live"]),
    (
        "serde_json",
        &["io", "live", "cli", "scene: test", "sandbox: test"],
    ), // what cargo metadata says
    ("toml", &["scene", "sandbox: test"]), // this file reads manifests
    ("image", &["io", "scene: test"]),
    ("tiff", &["io"]),
    ("roxmltree", &["io"]),
    ("svgtypes", &["io"]),
    ("zip", &["io"]),
    ("parquet", &["store"]),
    ("sha2", &["store"]),
    ("strsim", &["scene"]),
    ("tempfile", &["io", "test"]),
    ("clap", &["cli", "sandbox"]),
    ("clap_complete", &["cli"]),
    ("clap_mangen", &["cli"]),
    ("ctrlc", &["cli"]),
    ("indicatif", &["cli", "sandbox"]),
    ("base64", &["live"]),
    ("axum", &["cli"]),
    ("tokio", &["cli"]),
    ("getrandom", &["cli", "py"]),
    ("open", &["cli"]),
    ("tungstenite", &["cli: test"]),
    ("rustix", &["cli", "py", "benches: test"]),
    ("bytes", &["py"]), // the next ones for their features only
    ("getrandom-older", &["py"]),
    ("libc", &["py"]),
    ("serde_core", &["py"]),
    ("plotters", &["sandbox"]),
    ("gif", &["io", "sandbox"]),
    ("glob", &["cli"]),
    ("pyo3", &["py"]),
    ("numpy", &["py"]),
    ("criterion", &["benches"]),
    ("diffsol", &["peers"]),
    ("ode_solvers", &["peers"]),
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
    folders.extend(["sandbox", "benches", "benches/peers"].map(|folder| root().join(folder)));
    let mut out: Vec<(String, PathBuf)> = folders
        .into_iter()
        .filter(|folder| folder.join("Cargo.toml").exists())
        .map(|folder| {
            let name = manifest(&folder)["package"]["name"]
                .as_str()
                .unwrap()
                .trim_start_matches("snakes-")
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
fn every_test_file_is_in_a_program() {
    for (name, folder) in packages() {
        let table = manifest(&folder);
        let by_hand = table["package"].get("autotests").is_some();
        let Ok(entries) = std::fs::read_dir(folder.join("tests")) else {
            continue;
        };
        if !by_hand {
            continue;
        }
        let all = std::fs::read_to_string(folder.join("tests/all.rs")).unwrap();
        let own: Vec<&str> = table["test"].as_array().map_or(Vec::new(), |list| {
            list.iter().filter_map(|one| one["name"].as_str()).collect()
        });
        for entry in entries {
            let path = entry.unwrap().path();
            let stem = path.file_stem().unwrap().to_str().unwrap();
            if path.extension().is_some_and(|ending| ending == "rs") {
                let known = own.contains(&stem) || all.contains(&format!("mod {stem};\n"));
                assert!(known, "tests/all.rs of {name} must name {stem}");
            }
        }
    }
}

#[test]
fn every_experiment_has_its_expected_numbers() {
    for experiment in sandbox::EXPERIMENTS {
        let file = sandbox::expected_folder().join(format!("{}.csv", experiment.id));
        assert!(
            file.exists(),
            "{} is missing; figures --accept writes it",
            file.display()
        );
    }
}
