//! Words that no source may have.

use crate::sources;

/// What is banned, and why. Put together here so that this file does not find itself.
fn banned() -> Vec<(String, &'static str)> {
    vec![
        (
            format!("{}_add(", "mul"),
            "one rounding instead of two differs by machine",
        ),
        (
            format!("{}_add)", "mul"),
            "one rounding instead of two differs by machine",
        ),
        (format!("#[{}", "ignore"), "a test runs or is deleted"),
        (
            format!("#[{}_panic", "should"),
            "a refusal is a value and is compared",
        ),
        (format!("{}!(", "todo"), "what is not done is not committed"),
        (
            format!("{}!(", "unimplemented"),
            "what is not done is not committed",
        ),
    ]
}

/// The banned words of a text, with their lines. Comments are free.
fn found_in(text: &str) -> Vec<String> {
    let mut out = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let code = line.split("//").next().unwrap_or_default();
        for (word, why) in banned() {
            if code.contains(&word) {
                out.push(format!("{}: {word}: {why}", number + 1));
            }
        }
    }
    out
}

#[test]
fn no_source_multiplies_and_adds_in_one_rounding_or_skips_a_test() {
    for (path, text) in sources() {
        let found = found_in(&text);
        assert!(found.is_empty(), "{}:{}", path.display(), found.join("\n"));
    }
}

#[test]
fn banned_words_are_found_however_they_are_spelled() {
    let add = |before: &str, after: &str| format!("let y = {before}{}_add{after};", "mul");
    for line in [
        add("a.", "(b, c)"),
        add("f64::", "(a, b, c)"),
        add("<f64>::", "(a, b, c)"),
        add("x.map(f64::", ")"),
        format!("#[{}]", "ignore"),
        format!("#[{} = \"slow\"]", "ignore"),
    ] {
        assert_eq!(found_in(&line).len(), 1, "{line}");
    }
    assert!(found_in("// a.mul_add would round once").is_empty());
}
