//! Every claim holds, every number is as expected, every figure can be drawn.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test may stop the process"
)]

use sandbox::{Done, EXPERIMENTS, accept, compare, perform_all};

fn everything() -> Vec<Done> {
    perform_all(EXPERIMENTS, &|_| {}).unwrap()
}

#[test]
fn all_claims_hold_and_all_numbers_are_as_expected() {
    let done = everything();
    assert_eq!(done.len(), EXPERIMENTS.len());
    let mut wrong = Vec::new();
    for one in &done {
        for (claim, finding) in one.experiment.claims.iter().zip(&one.findings) {
            if !finding.holds {
                wrong.push(format!(
                    "{}: {}: {}",
                    one.experiment.id, claim.says, finding.measured
                ));
            }
        }
        if std::env::var_os("REGENERATE").is_some_and(|value| value == "1") {
            accept(one.experiment, &one.record).unwrap();
        }
        wrong.extend(
            compare(one.experiment, &one.record)
                .iter()
                .map(ToString::to_string),
        );
        for name in one.record.numbers.iter().map(|number| &number.name) {
            assert!(!name.contains('"'), "{name}: a quote would break the file");
        }
        for column in one.record.tables.iter().flat_map(|table| &table.columns) {
            assert!(
                !column.name.contains(','),
                "{}: a comma would break the file",
                column.name
            );
        }
        for drawing in &one.drawings {
            // a committed drawing should not weigh more than a photograph
            let animated = std::path::Path::new(&drawing.file)
                .extension()
                .is_some_and(|ending| ending == "gif");
            let (most, bytes) = (if animated { 400 } else { 600 }, drawing.bytes.len());
            assert!(bytes <= most * 1024, "{} has {bytes} bytes", drawing.file);
        }
    }
    assert!(
        wrong.is_empty(),
        "{} wrong:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}
