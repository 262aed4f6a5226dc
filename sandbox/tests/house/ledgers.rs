//! The ledgers of equations and errata: whatever they name is there, where they say it is.

use crate::{packages, root, sources};
use std::collections::BTreeMap;

/// The sources of a package: path below its folder, and text.
type Sources = Vec<(String, String)>;

fn by_package() -> BTreeMap<String, Sources> {
    let all = sources();
    let mut out = BTreeMap::new();
    for (name, folder) in packages() {
        let own = all.iter().filter_map(|(path, text)| {
            let below = path.strip_prefix(&folder).ok()?;
            let below = below.to_str().unwrap().replace('\\', "/");
            Some((below, text.clone()))
        });
        out.insert(name, own.collect());
    }
    out
}

/// The text of a source without its tests; empty for a file of tests.
fn shipped(path: &str, text: &str) -> String {
    let test = |part: &str| part == "tests" || part.ends_with("tests.rs") || part == "test.rs";
    if !path.starts_with("src/") || path.split('/').any(test) {
        return String::new();
    }
    let code = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
    let lines = code
        .lines()
        .map(|line| line.split("//").next().unwrap_or_default());
    lines.collect::<Vec<_>>().join("\n")
}

/// Whether a text begins with a whole word.
fn begins(text: &str, name: &str) -> bool {
    let after = text.strip_prefix(name);
    after.is_some_and(|after| !after.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
}

const ITEMS: [&str; 8] = [
    "fn ", "struct ", "enum ", "trait ", "const ", "static ", "type ", "mod ",
];

/// Whether a text defines a public item of that name.
fn defines(text: &str, name: &str) -> bool {
    text.match_indices("pub ").any(|(at, _)| {
        let rest = text[at + 4..]
            .trim_start_matches("const fn ")
            .trim_start_matches("fn ");
        let named = ITEMS.iter().any(|word| {
            let item = text[at + 4..].strip_prefix(word);
            item.is_some_and(|item| begins(item, name))
        });
        named || rest.len() < text.len() - at - 4 && begins(rest, name)
    })
}

/// The bodies of everything that a type is and can do: its definition and its `impl` blocks.
fn bodies<'a>(text: &'a str, kind: &str) -> Vec<&'a str> {
    let mut out = Vec::new();
    for word in ["struct ", "enum ", "trait ", "impl"] {
        for (at, _) in text.match_indices(word) {
            let Some(open) = text[at..].find(['{', ';']).map(|open| at + open) else {
                continue;
            };
            let head = &text[at + word.len()..open];
            // `impl<T> Trait for Type`: what stands last is the type
            let own = match word {
                "impl" => head.rsplit(" for ").next().unwrap_or_default(),
                _ => head,
            };
            let own = own.trim_start();
            let own = if own.starts_with('<') {
                own.split_once("> ").map_or(own, |(_, own)| own)
            } else {
                own
            };
            if begins(own.rsplit("::").next().unwrap_or_default().trim(), kind) {
                out.push(body(&text[open..]));
            }
        }
    }
    out
}

/// A text up to the bracket that closes its first one.
fn body(text: &str) -> &str {
    let mut depth = 0_i32;
    for (at, c) in text.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if depth <= 0 {
            return &text[..at];
        }
    }
    text
}

/// Whether a body has a method, a field or a variant of that name.
fn has_member(body: &str, name: &str) -> bool {
    let method = body
        .match_indices("fn ")
        .any(|(at, _)| begins(&body[at + 3..], name));
    method
        || body.lines().any(|line| {
            let line = line.trim_start().trim_start_matches('{').trim_start();
            begins(line.strip_prefix("pub ").unwrap_or(line), name)
        })
}

/// Whether a package has what a path says: `item`, `module::item` or `Type::member`.
fn there(sources: &Sources, path: &str) -> bool {
    let parts: Vec<&str> = path.trim_end_matches("()").split("::").collect();
    let texts = || {
        sources
            .iter()
            .map(|(path, text)| (path, shipped(path, text)))
    };
    match parts.as_slice() {
        [item] => texts().any(|(_, text)| defines(&text, item)),
        [.., kind, member] if kind.starts_with(char::is_uppercase) => texts().any(|(_, text)| {
            bodies(&text, kind)
                .iter()
                .any(|body| has_member(body, member))
        }),
        [.., module, item] => texts().any(|(path, text)| {
            let inside =
                path.ends_with(&format!("/{module}.rs")) || path.contains(&format!("/{module}/"));
            inside && defines(&text, item)
        }),
        [] => false,
    }
}

/// Whether a package has a test of that name.
fn tests(sources: &Sources, name: &str) -> bool {
    sources.iter().any(|(_, text)| {
        text.match_indices("fn ").any(|(at, _)| {
            // its attributes stand on the lines before; nothing but comments between
            let before = text[..at].trim_end().lines().rev();
            let mut above = before.map(str::trim_start).take_while(|line| {
                line.starts_with('#') || line.starts_with("//") || line.starts_with(')')
            });
            begins(&text[at + 3..], name) && above.any(|line| line == "#[test]")
        })
    })
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
fn missing_in(ledger: &str, packages: &BTreeMap<String, Sources>) -> Vec<String> {
    let mut out = Vec::new();
    for row in rows(ledger) {
        let label = row.first().cloned().unwrap_or_default();
        if row.iter().any(|cell| cell.contains("no test yet")) {
            out.push(format!("{label}: has no test"));
        }
        for span in row.iter().flat_map(|cell| spans(cell)) {
            if let Some((package, rest)) = span.split_once("::") {
                match packages.get(package) {
                    None => out.push(format!("{label}: {span}: no package {package}")),
                    Some(sources) if !there(sources, rest) => {
                        out.push(format!("{label}: {span}: not found in {package}"));
                    }
                    Some(_) => {}
                }
            } else if is_test_name(span) && !packages.values().any(|all| tests(all, span)) {
                out.push(format!("{label}: no test {span}"));
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

/// What is wrong with a ledger: it cannot be read, names what is not there, or names nothing.
fn faults(path: &std::path::Path) -> Vec<String> {
    let text = match std::fs::read_to_string(path) {
        Ok(text) => text,
        Err(reason) => return vec![format!("{}: {reason}", path.display())],
    };
    let mut out = missing_in(&text, &by_package());
    if !rows(&text)
        .iter()
        .flatten()
        .any(|cell| !spans(cell).is_empty())
    {
        out.push(format!("{} points to nothing", path.display()));
    }
    out
}

#[test]
fn every_row_of_the_equation_ledger_points_to_what_exists() {
    let faults = faults(&root().join("docs/equations.md"));
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn every_row_of_the_errata_ledger_points_to_what_exists() {
    let faults = faults(&root().join("docs/errata.md"));
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn a_ledger_that_is_not_there_is_a_fault() {
    assert_eq!(faults(&root().join("docs/none.md")).len(), 1);
}

#[test]
fn a_ledger_that_points_nowhere_is_found_out() {
    let source = "/// Doc.\npub fn force() {}\npub enum End {\n    Free,\n}\n\
                  impl End {\n    pub const fn held(self) -> bool {\n        true\n    }\n}\n\
                  pub struct Other {\n    pub mass: f64,\n}\nfn hidden() {}\n\
                  #[cfg(test)]\nmod tests {\n    pub fn helper() {}\n    #[test]\n    fn it_is_so_and_so() {}\n    fn it_is_no_test() {}\n}\n";
    let packages = BTreeMap::from([(
        "elastic".to_owned(),
        vec![
            ("src/lib.rs".to_owned(), source.to_owned()),
            ("src/ends.rs".to_owned(), "pub fn tie() {}\n".to_owned()),
            (
                "tests/laws.rs".to_owned(),
                "pub struct Model {}\n".to_owned(),
            ),
        ],
    )]);
    let check = |row: &str| {
        missing_in(
            &format!("| eq | item | test |\n| --- | --- | --- |\n{row}\n"),
            &packages,
        )
    };
    for good in [
        "| 3.2 | `elastic::force` | `it_is_so_and_so` |",
        "| 3.2 | `elastic::End::Free` | a word |",
        "| 3.2 | `elastic::End::held()` | a word |",
        "| 3.2 | `elastic::Other::mass` | a word |",
        "| 3.2 | `elastic::ends::tie` | a word |",
    ] {
        assert_eq!(check(good), [""; 0], "{good}");
    }
    for bad in [
        "| 3.2 | `elastic::forc` | |",
        "| 3.2 | `elastic::forces` | |",
        "| 3.2 | `elastic::hidden` | |",
        "| 3.2 | `elastic::helper` | |",
        "| 3.2 | `elastic::Model` | |",
        "| 3.2 | `plastic::force` | |",
        "| 3.2 | `elastic::Other::Free` | |",
        "| 3.2 | `elastic::End::mass` | |",
        "| 3.2 | `elastic::Beginning::Free` | |",
        "| 3.2 | `elastic::starts::tie` | |",
        "| 3.2 | `elastic::force` | `it_is_no_test` |",
        "| 3.2 | `elastic::force` | no test yet |",
    ] {
        assert_eq!(check(bad).len(), 1, "{bad}: {:?}", check(bad));
    }
    assert_eq!(
        check("| 3.2 | `elastic::force` | `it_is_not_so` |"),
        ["3.2: no test it_is_not_so"]
    );
}
