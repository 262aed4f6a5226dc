//! Every stage from a picture to its force, and every kind of force field: what `snake field` writes.

mod html;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use field::{EdgeForce, ForceField, Grid, Region, RegionScratch, Smoothing};
use glam::DVec2;
use html::Part;
use image::RgbImage;

use crate::build::force::Sight;
use crate::numbers::{float_tiff, npy};
use crate::write::write_whole;
use crate::{FORCES, ForceChoice, Picture, SceneError, build, paint, ready_folder};

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
        let mut names = vec!["0-picture.png".to_owned(), "index.html".to_owned()];
        let force = |names: &mut Vec<String>, name: &str| {
            for of in ["x", "y", "directions", "arrows", "magnitude", "potential"] {
                names.push(format!("{name}-{of}.png"));
            }
            for rest in ["-potential.npy", ".npy", ".tiff"] {
                names.push(format!("{name}{rest}"));
            }
        };
        if self.stages {
            let stages = [
                "1-smoothed",
                "2-gradient-x",
                "3-gradient-y",
                "4-edge-strength",
            ];
            names.extend(stages.map(|stage| format!("{stage}.png")));
            force(&mut names, "5-force");
            force(&mut names, "6-report-force");
        }
        for (name, choice) in self.called().iter().zip(&self.kinds) {
            if choice.is_region() {
                names.extend(["-push.png", ".npy", ".tiff"].map(|rest| format!("{name}{rest}")));
            } else {
                force(&mut names, name);
            }
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

    /// Write everything into `folder`: pictures (`NAME.png`), numbers (`NAME.npy`, `NAME.tiff`), and a page with
    /// all pictures side by side (`index.html`). Each file is written whole or not at all; returns the files.
    ///
    /// # Errors
    ///
    /// A folder that cannot be made or written (found out first); a smoothing, or a kind, that is refused, by the
    /// flag.
    pub fn write(&self, picture: &Picture, folder: &Path) -> Result<Vec<PathBuf>, SceneError> {
        let flag = match self.smoothing {
            Smoothing::Binomial(_) => "--passes",
            Smoothing::Gaussian(_) => "--sigma",
        };
        let smoothing = build::smoothing(flag, self.smoothing, picture.size())?;
        let shown = |choice: &ForceChoice| choice.is_field() || choice.is_region();
        if let Some(choice) = self.kinds.iter().find(|choice| !shown(choice)) {
            let kinds = FORCES.iter().map(|kind| kind.name);
            let kinds: Vec<&str> = kinds
                .filter(|name| ForceChoice::parse(name).is_ok_and(|choice| shown(&choice)))
                .collect();
            let message = format!(
                "{} is no field of the picture; one of {} would do",
                choice.kind(),
                kinds.join(", ")
            );
            return Err(SceneError::key("--kind", message));
        }
        let curve = self.curve.clone().unwrap_or_else(|| {
            let (width, height) = picture.size();
            let middle = 0.5 * (DVec2::new(width as f64, height as f64) - 1.0);
            elastic::circle(middle, (0.3 * width.min(height) as f64).max(1.0), 120)
        });
        if let Some(message) = build::outside(&curve, picture, 0.5)
            && self.curve.is_some()
        {
            return Err(SceneError::key("--from", format!("point {message}")));
        }
        let shared = Arc::new(picture.clone());
        let sight = Sight::of(&shared)?;
        ready_folder(folder)?;
        let mut sheet = Sheet {
            folder,
            picture,
            files: Vec::new(),
            parts: Vec::new(),
        };
        let (width, height) = picture.size();
        let mut note = format!("{width} × {height} pixels");
        if let Ok(scale) = field::image_scale(picture.levels()) {
            note.push_str(&format!(
                ". Noise {:.2}, strong edges {:.1} high and {:.2} pixels wide (σ), in grey levels of 0 to 255",
                scale.noise, scale.contrast, scale.blur
            ));
        }
        sheet.begin("The picture", note);
        sheet.show("0-picture", "grey levels", &paint::grey(picture.levels()))?;
        if self.stages {
            sheet.stages(smoothing)?;
        }
        for (name, choice) in self.called().into_iter().zip(&self.kinds) {
            let known = FORCES.iter().find(|kind| kind.name == choice.kind());
            let (summary, energy) = known.map_or(("", ""), |kind| (kind.summary, kind.energy));
            let note = format!("{summary}; energy: {energy}");
            if let Some(region) = sight.region("--kind", &choice.0.kind)? {
                sheet.push(&name, &note, &*region, &curve)?;
                continue;
            }
            let Some(made) = sight.field("--kind", &choice.0.kind)? else {
                continue;
            };
            sheet.force(&name, &note, &made.field, made.energy.as_ref())?;
        }
        sheet.end()
    }
}

/// What is written, and the page that grows with it.
struct Sheet<'a> {
    folder: &'a Path,
    picture: &'a Picture,
    files: Vec<PathBuf>,
    parts: Vec<Part>,
}

impl Sheet<'_> {
    fn begin(&mut self, title: &str, note: String) {
        self.parts.push(Part::new(title, note));
    }

    fn show(&mut self, name: &str, caption: &str, image: &RgbImage) -> Result<(), SceneError> {
        let file = format!("{name}.png");
        if let Some(part) = self.parts.last_mut() {
            part.show(&file, caption, image)?;
        }
        self.keep(&file, &paint::png(image)?)
    }

    fn keep(&mut self, name: &str, bytes: &[u8]) -> Result<(), SceneError> {
        let path = self.folder.join(name);
        write_whole(&path, bytes)?;
        self.files.push(path);
        Ok(())
    }

    fn stages(&mut self, smoothing: Smoothing) -> Result<(), SceneError> {
        let refuse = |error: field::FieldError| SceneError::key("field", error);
        let unsmoothed = EdgeForce {
            smoothing: Smoothing::Binomial(0),
            gain: EdgeForce::as_strong_as_the_report().gain,
        };
        let masked = self.picture.masked(self.picture.levels()).map_err(refuse)?;
        let smoothed = masked.smoothed(smoothing).map_err(refuse)?;
        let stages = field::edge_stages(&smoothed, &unsmoothed).map_err(refuse)?;
        let sigma = smoothing.sigma();
        self.begin(
            "Stages of the edge force",
            format!("corrected rules, smoothed with a Gaussian of σ = {sigma:.2} pixels or as many passes"),
        );
        for (name, caption, image) in [
            ("1-smoothed", "smoothed", paint::grey(&stages.smoothed)),
            (
                "2-gradient-x",
                "derivative in x",
                paint::signed(&stages.gradient_x),
            ),
            (
                "3-gradient-y",
                "derivative in y",
                paint::signed(&stages.gradient_y),
            ),
            (
                "4-edge-strength",
                "length of the gradient",
                paint::grey(&stages.strength),
            ),
        ] {
            self.show(name, caption, &image)?;
        }
        let energy = stages.strength.mapv(|p| -unsmoothed.gain * p);
        let force = masked.cut(&stages.force).map_err(refuse)?;
        let note = "corrected rules: the gradient of the gradient's length";
        self.force("5-force", note, &force, Some(&energy))?;
        if self.picture.valid().is_some() {
            return Ok(()); // the report's field knows no mask
        }
        let passes = match smoothing {
            Smoothing::Binomial(passes) => passes,
            Smoothing::Gaussian(_) => field::REPORT_PASSES,
        };
        let (scale, gain) = (field::REPORT_SCALE, field::REPORT_GAIN);
        let report = field::report_force(self.picture.levels(), passes, scale, gain);
        let note = format!("report rules, {passes} passes: each axis by itself; energy: none");
        self.force("6-report-force", &note, &report.map_err(refuse)?, None)
    }

    /// A field as pictures and as numbers.
    fn force(
        &mut self,
        name: &str,
        note: &str,
        field: &ForceField,
        energy: Option<&Grid>,
    ) -> Result<(), SceneError> {
        let (x, y) = field.components();
        let length = Grid::from_shape_fn(x.dim(), |at| x[at].hypot(y[at]));
        let mean = length.sum() / length.len() as f64;
        let largest = field.largest();
        self.begin(
            name,
            format!("{note}. Largest force {largest:.3}, on average {mean:.3}."),
        );
        for (which, caption, image) in [
            (
                "x",
                "x component (red right, blue left), by its root",
                paint::signed(&paint::rooted(&x)),
            ),
            (
                "y",
                "y component (red down, blue up), by its root",
                paint::signed(&paint::rooted(&y)),
            ),
            (
                "directions",
                "direction as hue, length as depth",
                paint::wheel(&x, &y),
            ),
            (
                "arrows",
                "arrows as long as the root of the force",
                arrows(self.picture, field),
            ),
            (
                "magnitude",
                "magnitude (white: largest), by its root",
                paint::grey(&paint::rooted(&length)),
            ),
        ] {
            self.show(&format!("{name}-{which}"), caption, &image)?;
        }
        if let Some(energy) = energy {
            let image = paint::grey(energy);
            let caption = "potential (dark: low, where a curve would lie)";
            self.show(&format!("{name}-potential"), caption, &image)?;
            self.keep(&format!("{name}-potential.npy"), &npy(&[energy]))?;
        }
        self.keep(&format!("{name}.npy"), &npy(&[&x, &y]))?;
        self.keep(&format!("{name}.tiff"), &float_tiff(&[&x, &y])?)
    }

    /// What a region would do with each pixel, as a picture with the curve and as numbers.
    fn push(
        &mut self,
        name: &str,
        note: &str,
        region: &dyn Region,
        curve: &[DVec2],
    ) -> Result<(), SceneError> {
        let (width, height) = self.picture.size();
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
        let largest = push.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        self.begin(
            name,
            format!("{note}. Largest push {largest:.3}, for the curve drawn."),
        );
        let mut image = paint::signed(&push);
        let wide = (f64::from(image.width().max(image.height())) / 250.0).clamp(1.0, 4.0);
        paint::draw_curve(&mut image, curve, true, wide, [0, 0, 0]);
        let caption = "push along the normal (red: joins the inside; blue: leaves it)";
        self.show(&format!("{name}-push"), caption, &image)?;
        self.keep(&format!("{name}.npy"), &npy(&[&push]))?;
        self.keep(&format!("{name}.tiff"), &float_tiff(&[&push])?)
    }

    fn end(mut self) -> Result<Vec<PathBuf>, SceneError> {
        let page = html::page("From a picture to its forces", &self.parts);
        self.keep("index.html", page.as_bytes())?;
        Ok(self.files)
    }
}

/// The force as arrows over the picture, one every few pixels, the longest as long as their distance.
fn arrows(picture: &Picture, force: &ForceField) -> RgbImage {
    let (width, height) = picture.size();
    let pitch = (width.max(height) / 40).max(4);
    // so many pixels that an arrow is seen to be one
    let zoom = (20.0 / pitch as f64).ceil();
    let mut canvas = paint::enlarged(&paint::faded(&paint::grey(picture.levels())), zoom);
    let largest = force.largest().max(f64::MIN_POSITIVE);
    for row in (pitch / 2..height).step_by(pitch) {
        for column in (pitch / 2..width).step_by(pitch) {
            let at = DVec2::new(column as f64, row as f64);
            // the root, so that weak forces are seen too
            let f = force.at(at);
            let length = (f.length() / largest).sqrt() * pitch as f64;
            if length < 0.25 {
                continue;
            }
            let tip = at + f.normalize_or_zero() * length;
            let back = (at - tip) * 0.35;
            let wing = back.perp() * 0.5;
            for (a, b) in [
                (at, tip),
                (tip, tip + back + wing),
                (tip, tip + back - wing),
            ] {
                paint::draw_curve(&mut canvas, &[a * zoom, b * zoom], false, 1.2, [200, 60, 0]);
            }
        }
    }
    canvas
}
