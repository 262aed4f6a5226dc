//! A page with a small picture of every result, the least sure first.

use std::path::{Path, PathBuf};

use io::Picture;
use io::page::{Card, Cards, Kept, Section};
use scene::SceneError;

use super::one::Found;
use super::overlay::{START, color};
use crate::commands::key;
use crate::crop::Crop;

/// Side of a small picture. Pixels.
const SIDE: u32 = 320;

/// The page as it grows; cards may come from any thread.
#[derive(Debug)]
pub(super) struct Sheet {
    path: PathBuf,
    cards: Cards,
}

/// A result on the page.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    good: bool,
    /// How sure it is; of several outlines the least sure.
    sure: f64,
    kept: Kept,
}

/// What the page ends up with besides results.
#[derive(Debug, Default)]
pub(super) struct Rest {
    /// Pictures that were refused, and why.
    pub(super) refused: Vec<(String, String)>,
    /// Pictures whose results were there already.
    pub(super) there: Vec<String>,
    /// Pictures that were not begun.
    pub(super) left: Vec<String>,
}

impl Sheet {
    /// The page that flags ask for, if they do.
    pub(super) fn of(path: Option<&PathBuf>) -> Result<Option<Self>, SceneError> {
        let Some(path) = path else { return Ok(None) };
        let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
        if ending != "html" && ending != "htm" {
            let message = format!(
                "writes HTML; the name must end in .html, got {}",
                path.display()
            );
            return Err(key("--sheet", message));
        }
        Ok(Some(Self {
            path: path.clone(),
            cards: Cards::new()?,
        }))
    }

    /// Keep a card of what was found in a picture.
    pub(super) fn keep(
        &self,
        picture: &Picture,
        name: &Path,
        found: &[Found],
    ) -> Result<Place, SceneError> {
        let points = || {
            let outlines = found.iter().filter_map(|one| one.shape.as_ref());
            let starts = found.iter().map(|one| &one.start);
            outlines
                .chain(starts)
                .flat_map(|shape| shape.first().iter().copied())
        };
        let mut crop = Crop::about(picture, points(), SIDE);
        for one in found {
            let closed = one.start.closed == Some(true);
            crop.draw(one.start.first(), closed, START);
        }
        for one in found {
            if let Some(shape) = &one.shape {
                crop.draw(shape.first(), shape.closed == Some(true), color(one));
            }
        }
        let worst = found.iter().min_by(|a, b| sure(a).total_cmp(&sure(b)));
        let unsure = found.iter().filter(|one| one.unsure.is_some()).count();
        let good = unsure == 0 && !found.is_empty();
        let card = card(name, found, unsure, worst);
        let kept = self.cards.keep(&card, &crop.image)?;
        Ok(Place {
            good,
            sure: worst.map_or(f64::NEG_INFINITY, sure),
            kept,
        })
    }

    /// Write the page.
    pub(super) fn write(self, places: &[Place], rest: &Rest) -> Result<(), SceneError> {
        let of = |good: bool| {
            let mut own: Vec<&Place> = places.iter().filter(|place| place.good == good).collect();
            own.sort_by(|a, b| a.sure.total_cmp(&b.sure));
            own.into_iter()
                .map(|place| place.kept)
                .collect::<Vec<Kept>>()
        };
        let names = |list: &[String]| {
            list.iter()
                .map(|name| (name.clone(), String::new()))
                .collect()
        };
        let titled = |title: &str, note: &str| Section {
            title: title.to_owned(),
            note: note.to_owned(),
            ..Section::default()
        };
        let order = "The least sure first: by the strength of edge that four fifths of an outline have, or of a motion \
                     by the share of it that the picture holds; of several outlines in a picture by the least sure. \
                     Starts are blue, outlines orange, purple where unsure.";
        let sections = [
            Section {
                list: rest.refused.clone(),
                ..titled("Refused", "")
            },
            Section {
                cards: of(false),
                ..titled("Unsure", order)
            },
            Section {
                cards: of(true),
                ..titled("Found", order)
            },
            Section {
                list: names(&rest.there),
                ..titled(
                    "There already",
                    "Their results were in the folder and are as they were.",
                )
            },
            Section {
                list: names(&rest.left),
                ..titled("Not begun", "")
            },
        ];
        let some = |section: &Section| !section.list.is_empty() || !section.cards.is_empty();
        let counted = |mut section: Section| {
            let count = section.list.len() + section.cards.len();
            section.title = format!("{} ({count})", section.title);
            section
        };
        let sections: Vec<Section> = sections.into_iter().filter(some).map(counted).collect();
        let all = places.len() + rest.refused.len() + rest.there.len() + rest.left.len();
        let title = match all {
            1 => "Outlines of a picture".to_owned(),
            count => format!("Outlines of {count} pictures"),
        };
        Ok(self.cards.write(&self.path, &title, &sections)?)
    }
}

/// How sure an outline is.
fn sure(found: &Found) -> f64 {
    let measured = found.measured;
    measured
        .closed
        .or(measured.held)
        .unwrap_or(f64::NEG_INFINITY)
}

/// What is said of a picture.
fn card(name: &Path, found: &[Found], unsure: usize, worst: Option<&Found>) -> Card {
    let word = match (found.len(), unsure) {
        (0, _) => "no outline".to_owned(),
        (1, 0) => "found".to_owned(),
        (1, _) => "unsure".to_owned(),
        (count, 0) => format!("{count} outlines found"),
        (count, unsure) => format!("{unsure} of {count} outlines unsure"),
    };
    let mut facts = Vec::new();
    let mut fact = |name: &str, value: Option<String>| {
        facts.extend(value.map(|value| (name.to_owned(), value)));
    };
    if let Some(one) = worst {
        let measured = one.measured;
        fact(
            "edge on four fifths",
            measured.closed.map(|v| format!("{v:.2}")),
        );
        fact(
            "on an edge",
            measured.held.map(|v| format!("{:.0} %", 100.0 * v)),
        );
        fact(
            "standard error",
            measured.error.map(|v| format!("{v:.2} px")),
        );
        let firm = one.plucked.as_ref().map(|plucked| plucked.firm());
        fact(
            "firm when plucked",
            firm.map(|v| format!("{:.0} %", 100.0 * v)),
        );
    }
    let title = io::called(name)
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    Card {
        seen: format!("{title} with its starts and outlines: {word}"),
        title,
        good: unsure == 0 && !found.is_empty(),
        word,
        facts,
        note: worst.and_then(|one| one.unsure.clone()),
    }
}
