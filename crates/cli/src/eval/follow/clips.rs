//! Sequences with their truth and their starts.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use glam::DVec2;
use io::IoError;
use io::tracks::CtcFolder;
use score::sequences::sequences;

use super::TRUE;
use super::source::{Challenge, Source};
use crate::eval::csv::Table;
use crate::eval::set::polygon;

/// What a row is called that has no start.
pub(super) const FOUND: &str = "found";

/// A start: its name and the outlines; none if they are those of the truth of the first frame.
pub(super) type Start = (String, Vec<Vec<DVec2>>);

/// A sequence.
#[derive(Debug)]
pub(super) struct Clip {
    pub(super) name: String,
    pub(super) source: Source,
    pub(super) starts: Vec<Start>,
}

impl Clip {
    /// The files it is read from.
    pub(super) fn files(&self) -> Vec<&PathBuf> {
        match &self.source {
            Source::Files(frames) => frames.iter().flat_map(|(a, b)| [a, b]).collect(),
            Source::Challenge(challenge) => challenge.pictures.iter().collect(),
            Source::Drawn(_) => Vec::new(),
        }
    }
}

fn of_truth() -> Start {
    (TRUE.to_owned(), Vec::new())
}

/// Those that are drawn.
pub(super) fn drawn() -> Vec<Clip> {
    let clip = |sequence: score::sequences::Sequence| Clip {
        name: sequence.name.clone(),
        source: Source::Drawn(sequence),
        starts: vec![of_truth()],
    };
    sequences().into_iter().map(clip).collect()
}

/// Whether a folder's manifest has sequences of several frames.
pub(super) fn has_sequences(folder: &Path) -> Result<bool, IoError> {
    let path = folder.join("manifest.csv");
    if !path.exists() {
        return Ok(false);
    }
    let table = Table::load(&path)?;
    let (Some(_), Some(frame)) = (table.column("sequence"), table.column("frame")) else {
        return Ok(false);
    };
    let later = |row: &Vec<String>| {
        row.get(frame)
            .is_some_and(|t| t.parse().is_ok_and(|t: u64| t > 0))
    };
    Ok(table.rows.iter().any(|(_, row)| later(row)))
}

/// The sequences of a manifest, and the starts of their first frames.
pub(super) fn of_manifest(
    folder: &Path,
    inits: &[PathBuf],
    problems: &mut Vec<String>,
) -> Result<Vec<Clip>, IoError> {
    let path = folder.join("manifest.csv");
    let table = Table::load(&path)?;
    let columns = ["sequence", "frame", "file", "mask"];
    let columns = columns.map(|name| table.needed(&path, name));
    let [sequence, frame, file, mask] = columns;
    let columns = [sequence?, frame?, file?, mask?];
    let mut names: Vec<String> = Vec::new();
    let mut frames: BTreeMap<String, BTreeMap<usize, (PathBuf, PathBuf)>> = BTreeMap::new();
    for (line, row) in &table.rows {
        let [name, number, file, mask] = columns.map(|at| row.get(at).map_or("", String::as_str));
        let number = number.trim().parse::<usize>();
        let whole = [name, file, mask].iter().all(|value| !value.is_empty());
        let (Ok(number), true) = (number, whole) else {
            let message = "a sequence, the number of a frame, a picture and its mask are needed; the row is left out";
            problems.push(format!("{}: line {line}: {message}", path.display()));
            continue;
        };
        if !names.iter().any(|known| known == name) {
            names.push(name.to_owned());
        }
        let files = (folder.join(file), folder.join(mask));
        let known = frames
            .entry(name.to_owned())
            .or_default()
            .insert(number, files);
        if known.is_some() {
            let message = format!("frame {number} of {} is there twice", io::text::clip(name));
            return Err(IoError::file(&path, format!("line {line}: {message}")));
        }
    }
    let mut clips = Vec::new();
    for name in names {
        let own = frames.remove(&name).unwrap_or_default();
        let expected = (0..own.len()).find(|number| !own.contains_key(number));
        if let Some(missing) = expected {
            let message = format!(
                "{}: frames must be numbered from 0 without gaps, frame {missing} of {} is missing; the sequence is left out",
                path.display(),
                own.len()
            );
            problems.push(format!("{}: {message}", io::text::clip(&name)));
            continue;
        }
        clips.push(Clip {
            name,
            source: Source::Files(own.into_values().collect()),
            starts: vec![of_truth()],
        });
    }
    let usual = [PathBuf::from("inits.csv")];
    for name in if inits.is_empty() { &usual[..] } else { inits } {
        let within = folder.join(name);
        if within.exists() {
            starts(&within, &mut clips, problems)?;
        } else if name.exists() || !inits.is_empty() {
            starts(name, &mut clips, problems)?;
        }
    }
    Ok(clips)
}

/// The starts of one file; those of the truth come last.
fn starts(path: &Path, clips: &mut [Clip], problems: &mut Vec<String>) -> Result<(), IoError> {
    let table = Table::load(path)?;
    let columns = ["stem", "quality", "points"].map(|name| table.needed(path, name));
    let [stem, quality, points] = columns;
    let columns = [stem?, quality?, points?];
    for (line, row) in &table.rows {
        let [stem, quality, points] = columns.map(|at| row.get(at).map_or("", String::as_str));
        let clip = clips.iter_mut().find(|clip| clip.name == stem);
        let problem = match (clip, polygon(points)) {
            (Some(clip), Ok(points)) => {
                let place = clip.starts.len().saturating_sub(1);
                clip.starts
                    .insert(place, (quality.to_owned(), vec![points]));
                continue;
            }
            (None, _) => {
                let name = io::text::clip(stem);
                format!("no sequence of the manifest is called \"{name}\"")
            }
            (_, Err(problem)) => problem,
        };
        let place = format!("{}: line {line}", path.display());
        problems.push(format!("{place}: {problem}; the row is left out"));
    }
    Ok(())
}

/// The sequences of a folder as the Cell Tracking Challenge has them: pictures in `01`, truth in `01_GT/TRA` and, if
/// it is there, `01_GT/SEG`. None if there is none.
pub(super) fn of_challenge(folder: &Path) -> Result<Option<Vec<Clip>>, IoError> {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return Ok(None); // another reader of this file will say what is wrong with it
    };
    let mut names: Vec<String> = Vec::new();
    for entry in entries.flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if let Some(name) = name.strip_suffix("_GT")
            && entry.path().join("TRA").is_dir()
        {
            names.push(name.to_owned());
        }
    }
    names.sort();
    let mut clips = Vec::new();
    for name in names {
        let truth = folder.join(format!("{name}_GT"));
        let tracks = CtcFolder::open(&truth.join("TRA"))?;
        let segments = truth.join("SEG");
        let segments = segments
            .is_dir()
            .then(|| CtcFolder::open(&segments))
            .transpose()?;
        let pictures = folder.join(&name);
        clips.push(Clip {
            source: Source::Challenge(Challenge::new(pictures, tracks, segments)?),
            name,
            starts: vec![of_truth()],
        });
    }
    Ok((!clips.is_empty()).then_some(clips))
}
