//! What `figures --check` finds: each kind of fault is put into a copy of the committed files.
//!
//! The check itself runs every experiment and is a step of the gate of its own; here it runs the
//! quick ones.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test may stop the process"
)]

use sandbox::{
    Committed, Done, Experiment, SandboxError, committed_folder, expected_folder, faults, find,
    gallery, perform_all,
};
use std::path::Path;

/// Experiments that take a moment.
const QUICK: [&str; 6] = [
    "fig-2-1", "fig-4-1", "fig-4-2", "fig-4-3", "sec-3-2", "fig-5-1",
];

fn done(ids: &[&str]) -> Vec<Done> {
    let chosen: Vec<&'static Experiment> = ids.iter().map(|id| find(id).unwrap()).collect();
    perform_all(&chosen, &|_, _| {}).unwrap()
}

/// A copy of what is committed of some experiments, with a gallery of just these.
fn copied(folder: &Path, done: &[Done]) -> Committed {
    let committed = Committed {
        expected: folder.join("expected"),
        figures: folder.join("figures"),
        gallery: folder.join("figures.md"),
    };
    for (from, to) in [
        (expected_folder(), &committed.expected),
        (committed_folder(), &committed.figures),
    ] {
        std::fs::create_dir(to).unwrap();
        for entry in std::fs::read_dir(from).unwrap() {
            let entry = entry.unwrap();
            let name = entry.file_name().into_string().unwrap();
            let own = |one: &Done| {
                let id = one.experiment.id;
                let rest = name.strip_prefix(id).unwrap_or("none");
                rest.starts_with('.') || one.drawings.iter().any(|drawn| drawn.file == name)
            };
            if done.iter().any(own) {
                std::fs::copy(entry.path(), to.join(&name)).unwrap();
            }
        }
    }
    std::fs::write(&committed.gallery, gallery(done)).unwrap();
    committed
}

#[test]
fn quick_experiments_are_as_committed() {
    let done = done(&QUICK);
    let found = faults(&done, &Committed::here(), false);
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn every_kind_of_fault_is_found() {
    let done = done(&["fig-4-2"]);
    let faulty = |break_it: &dyn Fn(&Committed)| {
        let folder = tempfile::tempdir().unwrap();
        let committed = copied(folder.path(), &done);
        assert_eq!(faults(&done, &committed, true), [""; 0]);
        break_it(&committed);
        let found = faults(&done, &committed, true);
        assert_eq!(found.len(), 1, "{found:?}");
        found[0].clone()
    };
    let rewritten = |path: &Path, from: &str, to: &str| {
        let text = std::fs::read_to_string(path).unwrap();
        assert!(text.contains(from), "{} has no {from}", path.display());
        std::fs::write(path, text.replacen(from, to, 1)).unwrap();
    };
    let check = |found: String, says: &str| assert!(found.contains(says), "{found}");

    let found = faulty(&|c| std::fs::write(c.figures.join("fig-4-2.svg"), "<svg/>").unwrap());
    check(found, "drawn differently: docs/figures/fig-4-2.svg");
    let found = faulty(&|c| std::fs::remove_file(c.figures.join("fig-4-2.svg")).unwrap());
    check(found, "missing: docs/figures/fig-4-2.svg");
    let found = faulty(&|c| std::fs::write(c.figures.join("old.svg"), "<svg/>").unwrap());
    check(found, "drawn by no experiment: docs/figures/old.svg");
    let found = faulty(&|c| std::fs::write(&c.gallery, "nonsense\n").unwrap());
    check(found, "docs/figures.md: line 1");
    let found = faulty(&|c| rewritten(&c.gallery, "holds |", "holds  |"));
    check(found, "docs/figures.md: line");

    let numbers = done[0].record.numbers[0].tolerance.to_string();
    let found = faulty(&|c| {
        let first = format!(",{numbers}\n");
        rewritten(&c.expected.join("fig-4-2.csv"), &first, ",5\n");
    });
    check(found, "its tolerance is");
    let column = &done[0].record.tables[0].columns[1];
    let found = faulty(&|c| {
        let own = format!("{},{}\n", column.name, column.tolerance);
        let wide = format!("{},5\n", column.name);
        rewritten(&c.expected.join("fig-4-2.tolerances.csv"), &own, &wide);
    });
    check(found, "expected/fig-4-2.tolerances.csv");
    let found = faulty(&|c| {
        let value = sandbox_number(&done[0]);
        rewritten(&c.expected.join("fig-4-2.csv"), &value, ",NaN,");
    });
    check(found, "expected NaN");
}

/// The first number of a record as its cell between commas.
fn sandbox_number(done: &Done) -> String {
    let text = done.record.numbers_csv();
    let line = text.lines().nth(1).unwrap();
    let cell = line.rsplit(',').nth(2).unwrap();
    format!(",{cell},")
}

#[test]
fn a_claim_that_cannot_fail_and_one_that_does_not_hold_are_faults() {
    let mut all = done(&["fig-4-2"]);
    let found = |done: &[Done]| faults(done, &Committed::here(), false);
    assert!(found(&all).is_empty());
    all[0].findings[0].holds = false;
    assert!(found(&all)[0].contains("does not hold"));

    const ID: &str = "fig-4-2";
    fn idle(record: &sandbox::Record) -> Result<sandbox::Finding, SandboxError> {
        record.number(record.numbers[0].name.as_str())?;
        Ok(sandbox::Finding::new(true, "whatever it is"))
    }
    static CLAIMS: [sandbox::Claim; 1] = [sandbox::claim("it is so [a test]").judged(idle)];
    let experiment: &'static Experiment = Box::leak(Box::new(Experiment {
        claims: &CLAIMS,
        ..*find(ID).unwrap()
    }));
    let mut one = done(&[ID]).remove(0);
    one.experiment = experiment;
    one.findings.truncate(1);
    let said = found(&[one]);
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].contains("does not depend on"), "{said:?}");
}
