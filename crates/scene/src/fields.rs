//! What `snake field` writes: every stage from a picture to its force, and every kind of force
//! field.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use field::{Grid, Region, RegionScratch, Smoothing};
use glam::DVec2;
use io::Picture;
use io::page::{self, Sheet};

use crate::meaning::force::Sight;
use crate::{FORCES, ForceChoice, SceneError, meaning};

/// The key of [`Fields::kinds`].
const KIND: &str = "field.kind";

/// What to write about a picture's forces.
#[derive(Debug, Clone, PartialEq)]
pub struct Fields {
    /// The stages of the edge force under both rules.
    pub stages: bool,
    /// Smoothing of these stages.
    pub smoothing: Smoothing,
    /// And the field of each of these kinds; of a kind of region, its push at every pixel.
    pub kinds: Vec<ForceChoice>,
    /// The curve for regions; a circle in the middle unless given.
    pub curve: Option<Vec<DVec2>>,
}

impl Fields {
    /// Every kind that is a field or a region, with its usual numbers.
    #[must_use]
    pub fn every_kind() -> Vec<ForceChoice> {
        FORCES
            .iter()
            .filter_map(|kind| ForceChoice::parse(kind.name).ok())
            .filter(|choice| choice.is_field() || choice.is_region())
            .collect()
    }

    /// Every file that [`Fields::write`] may write into `folder`.
    #[must_use]
    pub fn files(&self, folder: &Path) -> Vec<PathBuf> {
        let mut names = page::files_of_any_sheet();
        if self.stages {
            names.extend(page::files_of_the_stages());
        }
        for (name, choice) in self.called().iter().zip(&self.kinds) {
            names.extend(if choice.is_region() {
                page::files_of_a_push(name)
            } else {
                page::files_of_a_force(name)
            });
        }
        names.into_iter().map(|name| folder.join(name)).collect()
    }

    /// What the files of each kind are called: its word, numbered where it is given again.
    fn called(&self) -> Vec<String> {
        let mut taken = BTreeMap::new();
        let name = |choice: &ForceChoice| {
            let times = taken.entry(choice.kind()).or_insert(0);
            *times += 1;
            match *times {
                1 => choice.kind().to_owned(),
                again => format!("{}-{again}", choice.kind()),
            }
        };
        self.kinds.iter().map(name).collect()
    }

    /// Write everything into `folder`: pictures (`NAME.png`), numbers (`NAME.npy`, `NAME.tiff`),
    /// and a page with all pictures side by side (`index.html`). Each file is written whole or not
    /// at all; returns the files.
    ///
    /// # Errors
    ///
    /// A folder that cannot be made or written (found out first); a smoothing, a kind or a curve
    /// that is refused, under the key `field.passes`, `field.sigma`, `field.kind` or `field.curve`.
    pub fn write(&self, picture: &Arc<Picture>, folder: &Path) -> Result<Vec<PathBuf>, SceneError> {
        let key = match self.smoothing {
            Smoothing::Binomial(_) => "field.passes",
            Smoothing::Gaussian(_) => "field.sigma",
        };
        let smoothing = meaning::smoothing(key, self.smoothing, picture.size())?;
        let shown = |choice: &ForceChoice| choice.is_field() || choice.is_region();
        if let Some(choice) = self.kinds.iter().find(|choice| !shown(choice)) {
            let kinds = FORCES.iter().map(|kind| kind.name);
            let kinds: Vec<&str> = kinds
                .filter(|name| ForceChoice::parse(name).is_ok_and(|choice| shown(&choice)))
                .collect();
            let message = format!(
                "{} is no field of the picture; needed: one of {}",
                choice.kind(),
                kinds.join(", ")
            );
            return Err(SceneError::key(KIND, message));
        }
        let curve = self.curve.clone().unwrap_or_else(|| {
            let (width, height) = picture.size();
            let middle = 0.5 * (DVec2::new(width as f64, height as f64) - 1.0);
            elastic::circle(middle, (0.3 * width.min(height) as f64).max(1.0), 120)
        });
        if let Some(message) = meaning::outside(&curve, picture, 0.5)
            && self.curve.is_some()
        {
            return Err(SceneError::key("field.curve", format!("point {message}")));
        }
        let sight = Sight::of(picture)?;
        let mut sheet = Sheet::of(picture, folder)?;
        if self.stages {
            sheet.stages(smoothing)?;
        }
        for (name, choice) in self.called().into_iter().zip(&self.kinds) {
            let known = FORCES.iter().find(|kind| kind.name == choice.kind());
            let (summary, energy) = known.map_or(("", ""), |kind| (kind.summary, kind.energy));
            let note = format!("{summary}; energy: {energy}");
            if let Some(region) = sight.region(KIND, &choice.0.kind)? {
                let push = push_of(&*region, picture.size(), &curve);
                sheet.push(&name, &note, &push, &curve)?;
                continue;
            }
            let Some(made) = sight.field(KIND, &choice.0.kind)? else {
                continue;
            };
            sheet.force(&name, &note, &made.field, made.energy.as_ref())?;
        }
        Ok(sheet.end()?)
    }
}

/// Which way a region pushes at each pixel.
fn push_of(region: &dyn Region, (width, height): (usize, usize), curve: &[DVec2]) -> Grid {
    let mut push = Grid::zeros((height, width));
    let mut scratch = RegionScratch::default();
    let (mut points, mut row_of) = (vec![DVec2::ZERO; width], vec![0.0; width]);
    for (y, mut row) in push.rows_mut().into_iter().enumerate() {
        for (x, p) in points.iter_mut().enumerate() {
            *p = DVec2::new(x as f64, y as f64);
        }
        region.push_at(curve, &points, &mut scratch, &mut row_of);
        row.iter_mut()
            .zip(&row_of)
            .for_each(|(to, &from)| *to = from);
    }
    push
}
