//! What comes from outside, as cargo knows it: licences, crates in more than one version, features.
//!
//! Only what is built on this machine is looked at; what another system needs besides, a gate there
//! would see.

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

/// Licences that may be had without asking: one of them is enough.
const FREE: [&str; 4] = ["MIT", "Apache-2.0", "Zlib", "BSD-2-Clause"];

/// Crates whose licence asks for something besides, and why that is fine.
const ASKED: [(&str, &str, &str); 5] = [
    (
        "tiny-keccak",
        "CC0-1.0",
        "given to the public; named by what ahash needs on systems without random numbers, and not built here",
    ),
    (
        "snap",
        "BSD-3-Clause",
        "the terms ask for their notice, which it ships, and forbid its name in praise",
    ),
    (
        "unicode-ident",
        "(MIT OR Apache-2.0) AND Unicode-3.0",
        "its tables are the Unicode Consortium's; the terms ask for their notice, which it ships",
    ),
    (
        "matchit",
        "MIT AND BSD-3-Clause",
        "a part is from Go's httprouter; the terms ask for their notice, which it ships, and forbid its name in praise",
    ),
    (
        "target-lexicon",
        "Apache-2.0 WITH LLVM-exception",
        "the exception only takes conditions away; a build script of pyo3 uses it, no program",
    ),
];

/// Crates that a build of everything but the benches has in more than one version, and why.
const TWICE: [(&str, &str); 4] = [
    (
        "getrandom",
        "temporary files and the window's socket ask for different ones",
    ),
    ("miniz_oxide", "png and flate2 ask for different ones"),
    (
        "rand_core",
        "random numbers of the window's socket and of the tests ask for different ones",
    ),
    (
        "syn",
        "macros run by the compiler only; nothing of it is in a program",
    ),
];

/// One package, with the packages it needs to be built.
struct Package {
    name: String,
    version: String,
    licence: String,
    outside: bool,
    needs: Vec<String>,
}

fn text(value: &Value, key: &str) -> String {
    value[key].as_str().unwrap_or_default().to_owned()
}

/// Every package that is built here, by its id.
fn packages() -> BTreeMap<String, Package> {
    let asked = |program: &str, arguments: &[&str]| {
        let run = Command::new(program).args(arguments).output().unwrap();
        let said = String::from_utf8_lossy(&run.stderr).into_owned();
        assert!(run.status.success(), "{program} {arguments:?}: {said}");
        String::from_utf8(run.stdout).unwrap()
    };
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let version = asked(&rustc, &["-vV"]);
    let host = version
        .lines()
        .find_map(|line| line.strip_prefix("host: "))
        .unwrap();
    let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/../Cargo.toml");
    let metadata = asked(
        &std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned()),
        &[
            "metadata",
            "--format-version=1",
            "--locked",
            "--offline",
            "--filter-platform",
            host,
            "--manifest-path",
            manifest,
        ],
    );
    let metadata: Value = serde_json::from_str(&metadata).unwrap();
    let mut needs: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for node in metadata["resolve"]["nodes"].as_array().unwrap() {
        let used = |one: &&Value| {
            let kinds = one["dep_kinds"].as_array();
            kinds.is_some_and(|kinds| kinds.iter().any(|kind| kind["kind"] != "dev"))
        };
        let all = node["deps"].as_array().unwrap();
        let ids = all.iter().filter(used).map(|one| text(one, "pkg"));
        needs.insert(text(node, "id"), ids.collect());
    }
    let all = metadata["packages"].as_array().unwrap();
    all.iter()
        .map(|one| {
            let id = text(one, "id");
            let package = Package {
                name: text(one, "name"),
                version: text(one, "version"),
                licence: text(one, "license"),
                outside: !one["source"].is_null(),
                needs: needs.remove(&id).unwrap_or_default(),
            };
            (id, package)
        })
        .collect()
}

/// Whether one of the licences offered is free.
fn is_free(licence: &str) -> bool {
    let one_of = |offered: &str| FREE.contains(&offered.trim());
    // "AND" binds several; whoever has it is asked by name
    !licence.contains(" AND ") && licence.replace('/', " OR ").split(" OR ").any(one_of)
}

#[test]
fn every_crate_from_outside_may_be_used() {
    let mut asked = BTreeSet::new();
    for package in packages().values().filter(|package| package.outside) {
        let known = ASKED
            .iter()
            .find(|(name, licence, _)| *name == package.name && *licence == package.licence);
        match known {
            Some((name, ..)) => {
                asked.insert(*name);
            }
            None => assert!(
                is_free(&package.licence),
                "{} {}: its licence {:?} is none of {FREE:?}",
                package.name,
                package.version,
                package.licence
            ),
        }
    }
    for (name, ..) in ASKED {
        assert!(
            asked.contains(name),
            "{name} is not used: take it off the list"
        );
    }
    assert!(is_free("MIT/Apache-2.0") && is_free("0BSD OR MIT"));
    assert!(!is_free("GPL-3.0-only") && !is_free("") && !is_free("MIT AND GPL-3.0-only"));
}

#[test]
fn no_crate_is_built_in_two_versions_without_a_reason() {
    let packages = packages();
    let mut open: Vec<&String> = packages
        .iter()
        .filter(|(_, package)| !package.outside && !["benches", "peers"].contains(&&*package.name))
        .map(|(id, _)| id)
        .collect();
    let mut built: BTreeSet<&String> = BTreeSet::new();
    while let Some(id) = open.pop() {
        if built.insert(id) {
            open.extend(&packages[id].needs);
        }
    }
    let mut versions: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for id in built {
        let package = &packages[id];
        let own = versions.entry(package.name.as_str()).or_default();
        own.push(package.version.as_str());
    }
    versions.retain(|_, own| own.len() > 1);
    for (name, own) in &versions {
        assert!(
            TWICE.iter().any(|(known, _)| known == name),
            "{name} is built in versions {own:?}; agree on one, or say why not"
        );
    }
    for (name, _) in TWICE {
        assert!(
            versions.contains_key(name),
            "{name} is built once now: take it off the list"
        );
    }
}

/// Crates with their features, as these packages have them when they are built.
#[cfg(unix)]
fn features(packages: &[&str]) -> BTreeSet<String> {
    let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/../Cargo.toml");
    let fixed = [
        "tree",
        "--locked",
        "--offline",
        "--prefix=none",
        "--format={p} [{f}]",
    ];
    let run = Command::new(std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned()))
        .args(fixed)
        .args(["--manifest-path", manifest])
        .args(packages)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    assert!(run.status.success(), "{packages:?}: {said}");
    let lines = String::from_utf8(run.stdout).unwrap();
    let plain = |line: &str| line.trim_end_matches(" (*)").to_owned();
    lines.lines().map(plain).collect()
}

#[cfg(unix)]
#[test]
fn the_wheel_asks_for_the_features_that_a_build_of_all_has() {
    let all = features(&["--workspace", "--exclude=peers", "--edges=normal,build,dev"]);
    let wheel = features(&["--package=snakes-py", "--edges=normal"]);
    let other: Vec<&String> = wheel.difference(&all).collect();
    assert!(
        other.is_empty(),
        "with other features than in a build of all, so the wheel compiles them, and what needs them, anew; ask for the \
         same in crates/py/Cargo.toml: {other:#?}"
    );
}
