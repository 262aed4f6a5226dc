//! How large things may be: files, arguments of public functions, exports of a crate.
//!
//! What is larger today is listed with its size. The lists may only shrink: an entry that is no
//! longer needed, or larger than needed, is a failure too.

use crate::{packages, root, sources};
use std::collections::BTreeMap;

/// Lines a file may have; up to [`MOST_LINES`] with a line among its first ten that says why.
const LINES: usize = 400;
/// Lines no file may exceed.
const MOST_LINES: usize = 600;
/// What the reason begins with.
const REASON: &str = "Long because";

/// Files longer than [`LINES`] that do not say why yet.
const LONG_TODAY: [&str; 18] = [
    "crates/cli/tests/bad_numbers.rs",
    "crates/cli/tests/commands.rs",
    "crates/elastic/tests/kernel.rs",
    "crates/field/src/sample/many.rs",
    "crates/integrator/src/adaptive.rs",
    "crates/scene/src/file/mod.rs",
    "crates/scene/tests/bodies.rs",
    "crates/scene/tests/forces.rs",
    "crates/snake/src/algebra.rs",
    "crates/snake/src/simulation/contact.rs",
    "crates/snake/src/simulation/passage.rs",
    "crates/snake/src/simulation/remesh.rs",
    "crates/snake/src/ledger.rs",
    "crates/snake/src/snake.rs",
    "crates/snake/tests/crowd.rs",
    "crates/snake/tests/hand.rs",
    "crates/snake/tests/laws.rs",
    "crates/snake/tests/maps.rs",
];

/// Arguments of a public function, `self` not counted.
const ARGUMENTS: usize = 5;
/// Public functions that take more.
const WIDE_TODAY: [&str; 1] = ["crates/integrator/src/adaptive.rs: new"];

/// Names a crate may export.
const EXPORTS: usize = 20;
/// Crates that export more, and how many.
const EXPORTS_TODAY: [(&str, usize); 11] = [
    ("banded", 21),
    ("elastic", 43),
    ("field", 83),
    ("fit", 33),
    ("integrator", 24),
    ("io", 25), // and modules of their own for outlines, sequences, films, charts
    ("outline", 38),
    ("scene", 28),
    ("snake", 57),
    ("snakes", 29), // what users see
    ("sandbox", 34),
];

/// The path of a file below the root of the workspace.
fn below(path: &std::path::Path) -> String {
    let path = path.canonicalize().unwrap();
    let root = root().canonicalize().unwrap();
    let below = path.strip_prefix(root).unwrap();
    below.to_str().unwrap().replace('\\', "/")
}

/// What is found and not listed, and what is listed and not found.
fn differences(found: &[String], listed: &[&str]) -> Vec<String> {
    let new = found
        .iter()
        .filter(|one| !listed.contains(&one.as_str()))
        .map(|one| format!("{one} is not among today's exceptions"));
    let old = listed
        .iter()
        .filter(|one| !found.iter().any(|own| own == *one))
        .map(|one| format!("{one} is an exception no longer: take it off the list"));
    new.chain(old).collect()
}

#[test]
fn no_file_is_longer_than_six_hundred_lines_or_than_four_hundred_without_a_reason() {
    let mut long = Vec::new();
    for (path, text) in sources() {
        let lines = text.lines().count();
        let name = below(&path);
        assert!(
            lines <= MOST_LINES,
            "{name} must have at most {MOST_LINES} lines, got {lines}"
        );
        let said = text.lines().take(10).any(|line| line.contains(REASON));
        if lines > LINES && !said {
            long.push(name);
        }
    }
    let wrong = differences(&long, &LONG_TODAY);
    assert!(
        wrong.is_empty(),
        "a file of more than {LINES} lines says \"{REASON} ...\" in its first ten lines:\n{}",
        wrong.join("\n")
    );
}

/// Public functions of a text with the number of their arguments, `self` not counted.
fn public_functions(text: &str) -> Vec<(String, usize)> {
    let mut out = Vec::new();
    for (at, _) in text.match_indices("pub ") {
        let rest = text[at + 4..].trim_start_matches("const ");
        let Some(rest) = rest.strip_prefix("fn ") else {
            continue;
        };
        let name: String = rest
            .chars()
            .take_while(|c| c.is_alphanumeric() || *c == '_')
            .collect();
        // the bounds of a generic function may have brackets of their own
        let mut depth = 0;
        let open = rest.char_indices().find_map(|(index, c)| {
            match c {
                '<' => depth += 1,
                '>' if !rest[..index].ends_with('-') => depth -= 1,
                '(' if depth == 0 => return Some(index),
                _ => {}
            }
            None
        });
        if let Some(open) = open {
            out.push((name, arguments(&rest[open + 1..])));
        }
    }
    out
}

/// Arguments up to the closing bracket, `self` not counted.
fn arguments(text: &str) -> usize {
    let (mut depth, mut angle, mut one) = (1, 0, String::new());
    let mut all: Vec<String> = Vec::new();
    let mut before = ' ';
    for c in text.chars() {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            '<' => angle += 1,
            '>' if before != '-' => angle -= 1,
            _ => {}
        }
        before = c;
        if depth == 0 {
            break;
        }
        if c == ',' && depth == 1 && angle == 0 {
            all.push(std::mem::take(&mut one));
        } else {
            one.push(c);
        }
    }
    all.push(one);
    let own = |one: &&String| {
        let one = one.trim();
        !one.is_empty() && !matches!(one, "self" | "mut self" | "&self" | "&mut self")
    };
    all.iter().filter(own).count()
}

#[test]
fn no_public_function_takes_more_than_five_arguments() {
    let mut wide = Vec::new();
    for (path, text) in sources() {
        for (name, count) in public_functions(&text) {
            if count > ARGUMENTS {
                wide.push(format!("{}: {name}", below(&path)));
            }
        }
    }
    let wrong = differences(&wide, &WIDE_TODAY);
    assert!(
        wrong.is_empty(),
        "a public function takes at most {ARGUMENTS} arguments, then a struct:\n{}",
        wrong.join("\n")
    );
}

/// How many names the root of a crate exports.
fn exports(text: &str) -> usize {
    let mut count = 0;
    for item in text.split("\npub ").skip(1) {
        match item.strip_prefix("use ") {
            Some(used) => {
                let used = used.split(';').next().unwrap_or_default();
                let names = used
                    .split_once('{')
                    .map_or(used, |(_, names)| names.trim_end_matches(['}', '\n', ' ']));
                count += names
                    .split(',')
                    .filter(|name| !name.trim().is_empty())
                    .count();
            }
            None => count += 1,
        }
    }
    count
}

#[test]
fn no_crate_exports_more_than_twenty_names() {
    let mut large = BTreeMap::new();
    for (name, folder) in packages() {
        let Ok(text) = std::fs::read_to_string(folder.join("src/lib.rs")) else {
            continue; // a command
        };
        let count = exports(&text);
        if count > EXPORTS {
            large.insert(name, count);
        }
    }
    let today: BTreeMap<String, usize> = EXPORTS_TODAY
        .iter()
        .map(|(name, count)| ((*name).to_owned(), *count))
        .collect();
    for (name, count) in &large {
        let most = today.get(name).copied().unwrap_or(EXPORTS);
        assert!(
            *count <= most,
            "{name} must export at most {most} names, got {count}"
        );
    }
    for (name, most) in today {
        let count = large.get(&name).copied().unwrap_or(0);
        assert!(
            count == most,
            "{name} exports {count} names now: say so in the list, which has {most}"
        );
    }
}

#[test]
fn arguments_and_exports_are_counted_as_written() {
    let count = |text: &str| public_functions(text).first().map(|one| one.1);
    assert_eq!(count("pub fn a() {}"), Some(0));
    assert_eq!(count("    pub const fn a(&self, b: (u8, u8)) {}"), Some(1));
    assert_eq!(
        count("pub fn a<F: Fn(u8, u8) -> u8>(mut self, f: F, m: Map<u8, u8>,) {}"),
        Some(2)
    );
    assert_eq!(count("fn a(b: u8) {}"), None);
    let text = "//! Doc.\nmod a;\npub mod b;\npub use a::{\n    A, B,\n    C,\n};\npub use a::D;\npub fn e() {}\n";
    assert_eq!(exports(text), 6);
}
