//! What `figures --check` demands of experiments that were run.

use crate::verdict::idle;
use crate::{Done, Number, compare, gallery, real};
use std::path::{Path, PathBuf};

/// The committed files that a check reads.
#[derive(Debug, Clone)]
pub struct Committed {
    /// The expected numbers.
    pub expected: PathBuf,
    /// The drawings.
    pub figures: PathBuf,
    /// The gallery, a page of Markdown.
    pub gallery: PathBuf,
}

impl Committed {
    /// Those of the source tree this program was built from.
    #[must_use]
    pub fn here() -> Self {
        let figures = crate::committed_folder();
        Self {
            expected: crate::expected_folder(),
            gallery: figures.join("..").join("figures.md"),
            figures,
        }
    }
}

/// How heavy a committed drawing may be, in KiB: not more than a photograph.
const HEAVIEST: [(&str, usize); 2] = [("svg", 600), ("gif", 400)];

/// Everything that is wrong with experiments that were run: claims that do not hold or cannot
/// fail, numbers and tolerances that moved, drawings that are not those committed. Where `whole`,
/// `done` is the whole catalogue: the gallery must be as committed and every drawing be someone's.
#[must_use]
pub fn faults(done: &[Done], committed: &Committed, whole: bool) -> Vec<String> {
    let mut out = Vec::new();
    for one in done {
        out.extend(claims(one));
        out.extend(names(one));
        out.extend(
            one.record
                .numbers
                .iter()
                .filter_map(|number| slack(one, number)),
        );
        let moved = compare(&committed.expected, one.experiment, &one.record);
        out.extend(moved.iter().map(|moved| format!("moved: {moved}")));
        out.extend(drawings(one, &committed.figures));
    }
    if whole {
        out.extend(strays(done, &committed.figures));
        out.extend(pages(done, &committed.gallery));
    }
    out
}

/// Claims that do not hold, and those that would hold whatever a number they read is.
#[must_use]
pub fn claims(one: &Done) -> Vec<String> {
    let id = one.experiment.id;
    let judged = one.experiment.claims.iter().zip(&one.findings);
    let mut out: Vec<String> = judged
        .filter(|(_, finding)| !finding.holds)
        .map(|(claim, finding)| {
            format!(
                "{id}: does not hold: {}: {}",
                claim.says(),
                finding.measured
            )
        })
        .collect();
    let mut bare = one.record.clone();
    bare.grids.clear();
    for claim in one.experiment.claims {
        match idle(claim, &bare) {
            Ok(idle) => out.extend(idle.iter().map(|what| format!("{id}: {what}"))),
            Err(reason) => out.push(format!("{id}: {}: {reason}", claim.says())),
        }
    }
    out
}

/// Names that would break the files they are written to.
fn names(one: &Done) -> Vec<String> {
    let id = one.experiment.id;
    let numbers = one.record.numbers.iter().map(|number| &number.name);
    let columns = one.record.tables.iter().flat_map(|table| &table.columns);
    numbers
        .filter(|name| name.contains('"'))
        .chain(
            columns
                .map(|column| &column.name)
                .filter(|name| name.contains(',')),
        )
        .map(|name| format!("{id}: the name {name:?} would break its file"))
        .collect()
}

/// A tolerance that lets a number be half of itself or nothing, unless it is about rounding.
fn slack(one: &Done, number: &Number) -> Option<String> {
    let (id, width) = (one.experiment.id, number.tolerance.width(number.value));
    let wide = width > 0.5 * number.value.abs() && width > 1e-5 && number.value != 0.0;
    wide.then(|| {
        format!(
            "{id}: {}: a tolerance of {} on {} lets too much pass",
            number.name, number.tolerance, number.value
        )
    })
}

/// Drawings that are not those committed, or heavier than they may be.
fn drawings(one: &Done, folder: &Path) -> Vec<String> {
    let mut out = Vec::new();
    for drawing in &one.drawings {
        let file = &drawing.file;
        match std::fs::read(folder.join(file)) {
            Ok(bytes) if bytes == drawing.bytes => {}
            Ok(_) => out.push(format!("drawn differently: docs/figures/{file}")),
            Err(reason) => out.push(format!("missing: docs/figures/{file}: {reason}")),
        }
        let ending = file.rsplit('.').next().unwrap_or_default();
        for (kind, most) in HEAVIEST {
            if kind == ending && drawing.bytes.len() > most * 1024 {
                let size = real(drawing.bytes.len()) / 1024.0;
                out.push(format!(
                    "{file} must have at most {most} KiB, got {size:.0}"
                ));
            }
        }
    }
    out
}

/// Drawings in the folder that no experiment makes.
fn strays(done: &[Done], folder: &Path) -> Vec<String> {
    let known: Vec<&str> = done
        .iter()
        .flat_map(|one| &one.drawings)
        .map(|drawing| drawing.file.as_str())
        .collect();
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .into_iter()
        .flatten()
        .flatten()
        .filter_map(|entry| entry.file_name().into_string().ok())
        .filter(|name| !known.contains(&name.as_str()))
        .collect();
    names.sort();
    names
        .iter()
        .map(|name| format!("drawn by no experiment: docs/figures/{name}"))
        .collect()
}

/// The first line of the gallery that is not as committed.
fn pages(done: &[Done], path: &Path) -> Option<String> {
    let now = gallery(done);
    let text = match std::fs::read_to_string(path) {
        Err(reason) => return Some(format!("missing: docs/figures.md: {reason}")),
        Ok(text) => text,
    };
    if now == text {
        return None;
    }
    let line = now
        .lines()
        .zip(text.lines())
        .position(|(own, file)| own != file);
    let line = line.unwrap_or_else(|| now.lines().count().min(text.lines().count())) + 1;
    Some(format!(
        "docs/figures.md: line {line} is not what the experiments say; \
         figures --out docs/figures writes it anew"
    ))
}
