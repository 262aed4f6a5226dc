//! Fields of a picture as pictures, as numbers, and side by side on a page; results of many pictures on another.

mod cards;
mod html;

use std::path::{Path, PathBuf};

use field::{EdgeForce, ForceField, Grid, Smoothing};
use glam::DVec2;
use html::Part;
use image::RgbImage;

use crate::numbers::{float_tiff, npy};
use crate::write::write_whole;
use crate::{IoError, Picture, paint, ready_folder};

pub use cards::{Card, Cards, Kept, Section};

/// What is written into a folder file by file, and the page that grows with it (`index.html`).
#[derive(Debug)]
pub struct Sheet<'a> {
    folder: &'a Path,
    picture: &'a Picture,
    files: Vec<PathBuf>,
    parts: Vec<Part>,
}

/// The picture itself.
const PICTURE: &str = "0-picture.png";

/// The page with everything on it.
const PAGE: &str = "index.html";

/// The files of a force field without the name they begin with.
const OF_A_FORCE: [&str; 9] = [
    "-x.png",
    "-y.png",
    "-directions.png",
    "-arrows.png",
    "-magnitude.png",
    "-potential.png",
    "-potential.npy",
    ".npy",
    ".tiff",
];

/// The files of a push without the name they begin with.
const OF_A_PUSH: [&str; 3] = ["-push.png", ".npy", ".tiff"];

/// The names of the stages that have a picture each.
const STAGES: [&str; 4] = [
    "1-smoothed",
    "2-gradient-x",
    "3-gradient-y",
    "4-edge-strength",
];

/// The names of the forces that the stages end with.
const STAGE_FORCES: [&str; 2] = ["5-force", "6-report-force"];

/// The names of all files that [`Sheet::stages`] may write.
#[must_use]
pub fn files_of_the_stages() -> Vec<String> {
    let pictures = STAGES.map(|stage| format!("{stage}.png"));
    let forces = STAGE_FORCES.into_iter().flat_map(files_of_a_force);
    pictures.into_iter().chain(forces).collect()
}

/// The names of all files that [`Sheet::force`] may write.
#[must_use]
pub fn files_of_a_force(name: &str) -> Vec<String> {
    OF_A_FORCE.map(|rest| format!("{name}{rest}")).to_vec()
}

/// The names of all files that [`Sheet::push`] writes.
#[must_use]
pub fn files_of_a_push(name: &str) -> Vec<String> {
    OF_A_PUSH.map(|rest| format!("{name}{rest}")).to_vec()
}

/// The names of the files that every sheet has.
#[must_use]
pub fn files_of_any_sheet() -> Vec<String> {
    [PICTURE, PAGE].map(str::to_owned).to_vec()
}

impl<'a> Sheet<'a> {
    /// A sheet about this picture, which is on it already.
    ///
    /// # Errors
    ///
    /// A folder that cannot be made or written.
    pub fn of(picture: &'a Picture, folder: &'a Path) -> Result<Self, IoError> {
        ready_folder(folder)?;
        let mut sheet = Self {
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
        sheet.show(PICTURE, "grey levels", &paint::grey(picture.levels()))?;
        Ok(sheet)
    }

    fn begin(&mut self, title: &str, note: String) {
        self.parts.push(Part::new(title, note));
    }

    fn show(&mut self, file: &str, caption: &str, image: &RgbImage) -> Result<(), IoError> {
        if let Some(part) = self.parts.last_mut() {
            part.show(file, caption, image)?;
        }
        self.keep(file, &paint::png(image)?)
    }

    fn keep(&mut self, name: &str, bytes: &[u8]) -> Result<(), IoError> {
        let path = self.folder.join(name);
        write_whole(&path, bytes)?;
        self.files.push(path);
        Ok(())
    }

    /// The stages of the edge force under both rules.
    ///
    /// # Errors
    ///
    /// A smoothing that is refused; a file that cannot be written.
    pub fn stages(&mut self, smoothing: Smoothing) -> Result<(), IoError> {
        let unsmoothed = EdgeForce {
            smoothing: Smoothing::Binomial(0),
            gain: EdgeForce::as_strong_as_the_report().gain,
        };
        let masked = self.picture.masked(self.picture.levels())?;
        let smoothed = masked.smoothed(smoothing)?;
        let stages = field::edge_stages(&smoothed, &unsmoothed)?;
        let sigma = smoothing.sigma();
        self.begin(
            "Stages of the edge force",
            format!("corrected rules, smoothed with a Gaussian of σ = {sigma:.2} pixels or as many passes"),
        );
        let pictures = [
            ("smoothed", paint::grey(&stages.smoothed)),
            ("derivative in x", paint::signed(&stages.gradient_x)),
            ("derivative in y", paint::signed(&stages.gradient_y)),
            ("length of the gradient", paint::grey(&stages.strength)),
        ];
        for (name, (caption, image)) in STAGES.iter().zip(pictures) {
            self.show(&format!("{name}.png"), caption, &image)?;
        }
        let energy = stages.strength.mapv(|p| -unsmoothed.gain * p);
        let force = masked.cut(&stages.force)?;
        let note = "corrected rules: the gradient of the gradient's length";
        self.force(STAGE_FORCES[0], note, &force, Some(&energy))?;
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
        self.force(STAGE_FORCES[1], &note, &report?, None)
    }

    /// A field as pictures and as numbers.
    ///
    /// # Errors
    ///
    /// A file that cannot be written.
    pub fn force(
        &mut self,
        name: &str,
        note: &str,
        field: &ForceField,
        energy: Option<&Grid>,
    ) -> Result<(), IoError> {
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
            self.show(&format!("{name}-{which}.png"), caption, &image)?;
        }
        if let Some(energy) = energy {
            let image = paint::grey(energy);
            let caption = "potential (dark: low, where a curve would lie)";
            self.show(&format!("{name}-potential.png"), caption, &image)?;
            self.keep(&format!("{name}-potential.npy"), &npy(&[energy]))?;
        }
        self.keep(&format!("{name}.npy"), &npy(&[&x, &y]))?;
        self.keep(&format!("{name}.tiff"), &float_tiff(&[&x, &y])?)
    }

    /// Which way a region pushes at each pixel, for this closed curve: as a picture with the curve,
    /// and as numbers.
    ///
    /// # Errors
    ///
    /// A file that cannot be written.
    pub fn push(
        &mut self,
        name: &str,
        note: &str,
        push: &Grid,
        curve: &[DVec2],
    ) -> Result<(), IoError> {
        let largest = push.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        self.begin(
            name,
            format!("{note}. Largest push {largest:.3}, for the curve drawn."),
        );
        let mut image = paint::signed(push);
        let wide = (f64::from(image.width().max(image.height())) / 250.0).clamp(1.0, 4.0);
        paint::draw_curve(&mut image, curve, true, wide, [0, 0, 0]);
        let caption = "push along the normal (red: joins the inside; blue: leaves it)";
        self.show(&format!("{name}-push.png"), caption, &image)?;
        self.keep(&format!("{name}.npy"), &npy(&[push]))?;
        self.keep(&format!("{name}.tiff"), &float_tiff(&[push])?)
    }

    /// Write the page, the last of the files, and say which there are.
    ///
    /// # Errors
    ///
    /// A file that cannot be written.
    pub fn end(mut self) -> Result<Vec<PathBuf>, IoError> {
        let page = html::page("From a picture to its forces", &self.parts);
        self.keep(PAGE, page.as_bytes())?;
        Ok(self.files)
    }
}

/// The force as arrows over the picture, one every few pixels, the longest as long as their
/// distance.
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
