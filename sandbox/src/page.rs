//! The page that shows everything: one file of HTML beside the drawings, no script.

use crate::Done;
use std::fmt::Write;

const TEMPLATE: &str = include_str!("page.html");

/// The index page of a folder of figures. Drawings and tables are linked by their file names.
#[must_use]
pub fn page(done: &[Done]) -> String {
    let mut contents = String::new();
    let mut sections = String::new();
    for one in done {
        let experiment = one.experiment;
        let _ = writeln!(
            contents,
            "<a href=\"#{}\">{} <b>{}</b> {}</a>",
            experiment.id,
            mark(one.holds()),
            escape(experiment.place),
            escape(experiment.title)
        );
        section(&mut sections, one);
    }
    TEMPLATE
        .replace("{{score}}", &score(done))
        .replace("{{contents}}", &contents)
        .replace("{{sections}}", &sections)
}

/// How many claims hold, in words.
pub(crate) fn score(done: &[Done]) -> String {
    let claims: usize = done.iter().map(|one| one.findings.len()).sum();
    let held: usize = done
        .iter()
        .flat_map(|one| &one.findings)
        .filter(|finding| finding.holds)
        .count();
    let drawings: usize = done.iter().map(|one| one.drawings.len()).sum();
    format!(
        "{drawings} drawings of {} experiments; {held} of {claims} claims hold.",
        done.len()
    )
}

fn section(out: &mut String, one: &Done) {
    let experiment = one.experiment;
    let _ = writeln!(
        out,
        "<section id=\"{}\">\n<h2><span class=\"place\">{}</span>{}</h2>\n<p class=\"question\">{}</p>",
        experiment.id,
        escape(experiment.place),
        escape(experiment.title),
        escape(experiment.question)
    );
    for drawing in &one.drawings {
        let caption = escape(drawing.caption);
        let _ = writeln!(
            out,
            "<figure><a href=\"{0}\"><img src=\"{0}\" alt=\"{caption}\" loading=\"lazy\"></a>\
             <figcaption>{caption}</figcaption></figure>",
            drawing.file
        );
    }
    out.push_str(
        "<table>\n<tr><th></th><th>claim</th><th>measured</th><th class=\"source\">says</th></tr>\n",
    );
    for (claim, finding) in experiment.claims.iter().zip(&one.findings) {
        let _ = writeln!(
            out,
            "<tr><td>{}</td><td>{}</td><td class=\"measured\">{}</td><td class=\"source\">{}</td></tr>",
            mark(finding.holds),
            escape(claim.says()),
            escape(&finding.measured),
            escape(claim.source())
        );
    }
    out.push_str("</table>\n<p class=\"numbers\">Numbers: ");
    for (file, _) in one.record.files(experiment.id) {
        let _ = write!(out, "<a href=\"{file}\">{file}</a>");
    }
    out.push_str("</p>\n</section>\n");
}

fn mark(holds: bool) -> &'static str {
    if holds {
        "<span class=\"mark yes\" title=\"holds\">✓</span>"
    } else {
        "<span class=\"mark no\" title=\"does not hold\">✗</span>"
    }
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_fetches_nothing_and_runs_nothing() {
        let text = page(&[]);
        assert!(!text.contains("<script") && !text.contains("http"));
        assert!(!text.contains("{{"));
    }

    #[test]
    fn words_are_escaped() {
        assert_eq!(escape("a < b & \"c\""), "a &lt; b &amp; &quot;c&quot;");
    }
}
