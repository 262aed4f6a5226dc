//! `docs/figures.md`: the gallery, generated.

use crate::Done;
use crate::page::score;
use std::fmt::Write;

/// The gallery as Markdown, for a file that stands beside the folder `figures/`.
#[must_use]
pub fn gallery(done: &[Done]) -> String {
    let mut out = String::from(
        "# Figures\n\n\
         Written by `cargo run --release -p sandbox -- figures --out docs/figures`; do not edit.\n\
         Each figure is a claim: the words, the number they were judged by, the verdict. The numbers behind\n\
         them are kept in `sandbox/expected/` and compared by `figures --check`.\n\n",
    );
    let _ = writeln!(out, "{}\n", score(done));
    out.push_str("| figure | experiment | claims that hold |\n| --- | --- | --- |\n");
    for one in done {
        let held = one.findings.iter().filter(|finding| finding.holds).count();
        let _ = writeln!(
            out,
            "| {} | [{}](#{}) | {held} of {} |",
            one.experiment.place,
            one.experiment.title,
            one.experiment.id,
            one.findings.len()
        );
    }
    for one in done {
        let experiment = one.experiment;
        let _ = writeln!(
            out,
            "\n<a id=\"{}\"></a>\n\n## {} · {}\n\n{}\n",
            experiment.id, experiment.place, experiment.title, experiment.question
        );
        for drawing in &one.drawings {
            let _ = writeln!(out, "![{}](figures/{})\n", drawing.caption, drawing.file);
        }
        out.push_str("| claim | measured | says | verdict |\n| --- | --- | --- | --- |\n");
        for (claim, finding) in experiment.claims.iter().zip(&one.findings) {
            let _ = writeln!(
                out,
                "| {} | {} | {} | {} |",
                cell(claim.says()),
                cell(&finding.measured),
                cell(claim.source()),
                if finding.holds {
                    "holds"
                } else {
                    "**does not hold**"
                }
            );
        }
        let _ = writeln!(
            out,
            "\nRun it: `cargo run --release -p sandbox -- run {0}` · numbers: \
             [`{0}.csv`](../sandbox/expected/{0}.csv)",
            experiment.id
        );
    }
    out
}

fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('*', "\\*")
}
