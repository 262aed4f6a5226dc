//! Pictures of many objects: their labels against true labels.

use std::fmt::Write as _;

use glam::DVec2;
use instances::{Circle, Rules, Seeds, outline_all};
use io::{Picture, RgbImage, paint};
use score::{Instances, THRESHOLDS, border};
use serde_json::{Value, json};

use super::clock::Clock;
use super::flags::SeedKind;
use super::rows::Way;
use super::set::Case;
use super::sheet::{FOUND, TRUTH};
use super::table::mean;
use score::table::quoted;

/// The longer side of a picture that is drawn, at least.
const SIDE: f64 = 900.0;

/// One picture of many objects.
#[derive(Debug)]
pub(super) struct Crowd {
    pub(super) stem: String,
    instances: Instances,
    outlines: Vec<Vec<DVec2>>,
    seconds: f64,
}

/// Find the objects of a picture, and compare their labels with the true ones.
///
/// # Errors
///
/// A picture or labels that cannot be read, or that do not fit.
pub(super) fn crowd(case: &Case, kind: SeedKind, way: &Way<'_>) -> Result<Crowd, String> {
    let load = |path| Picture::load(path).map_err(|error| error.to_string());
    let Some(labels) = &case.labels else {
        let message = "has no labels; needed: a file of them in the manifest's column labels";
        return Err(format!("{}: {message}", case.picture.display()));
    };
    let (picture, truth) = (load(&case.picture)?, load(labels)?);
    let truth = truth.levels().mapv(label);
    let circles = case.starts.iter().filter_map(|start| start.circle);
    let seeds = match kind {
        SeedKind::Circles => {
            let circles = circles.map(|(center, radius)| Circle { center, radius });
            Seeds::Circles(circles.collect())
        }
        SeedKind::Points => Seeds::Points(circles.map(|(center, _)| center).collect()),
        SeedKind::Auto => Seeds::Auto,
    };
    let clock = Clock::start(way.alone);
    let found = outline_all(&picture, &seeds, &Rules::default());
    let seconds = clock.seconds();
    let found = found.map_err(|error| format!("{}: {error}", case.picture.display()))?;
    let instances = Instances::of(&found.labels, &truth);
    Ok(Crowd {
        stem: case.stem.clone(),
        instances: instances.map_err(|error| format!("{}: {error}", labels.display()))?,
        outlines: found.objects.into_iter().map(|one| one.outline).collect(),
        seconds,
    })
}

/// A picture with the true outlines and, over them, those that were found.
///
/// # Errors
///
/// Files that cannot be read again.
pub(super) fn drawn(crowd: &Crowd, case: &Case) -> Result<RgbImage, String> {
    let load = |path| Picture::load(path).map_err(|error| error.to_string());
    let picture = load(&case.picture)?;
    let (width, height) = picture.size();
    let zoom = (SIDE / width.max(height) as f64).max(1.0);
    let mut image = paint::enlarged(picture.display(), zoom);
    let mut draw = |curve: &[DVec2], color| {
        let curve: Vec<DVec2> = curve.iter().map(|p| *p * zoom).collect();
        paint::draw_curve(&mut image, &curve, true, 1.5, color);
    };
    if let Some(labels) = &case.labels {
        let truth = load(labels)?.levels().mapv(label);
        let most = truth.iter().copied().max().unwrap_or(0);
        for number in 1..=most {
            let mask = truth.mapv(|label| label == number);
            border(&mask).iter().for_each(|ring| draw(ring, TRUTH));
        }
    }
    crowd.outlines.iter().for_each(|curve| draw(curve, FOUND));
    Ok(image)
}

/// The number of an object: labels are of 16 bits, levels go up to 255.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a whole number from 0 to 65535"
)]
fn label(level: f64) -> u32 {
    (257.0 * level).round() as u32
}

/// The table for people: a row a picture, and their means.
pub(super) fn text(crowds: &[Crowd]) -> String {
    let wide = crowds
        .iter()
        .map(|crowd| crowd.stem.chars().count())
        .max()
        .unwrap_or(0)
        .max(7);
    let mut text = format!("{:wide$} {:>5} {:>5}", "picture", "true", "found");
    for threshold in THRESHOLDS {
        // writing to a String cannot fail
        let _ = write!(text, "  AP {threshold:.1}");
    }
    text += "   mean  CPU s\n";
    let mut row = |name: &str, counts: [usize; 2], values: &[f64], seconds: f64| {
        let _ = write!(text, "{name:wide$} {:>5} {:>5}", counts[0], counts[1]);
        for value in values {
            let _ = write!(text, " {value:>7.4}");
        }
        let _ = writeln!(text, " {seconds:>6.3}");
    };
    for crowd in crowds {
        let counts = [crowd.instances.truth, crowd.instances.found];
        row(&crowd.stem, counts, &crowd.precisions(), crowd.seconds);
    }
    let sum = |of: &dyn Fn(&Crowd) -> usize| crowds.iter().map(of).sum();
    let counts = [
        sum(&|crowd| crowd.instances.truth),
        sum(&|crowd| crowd.instances.found),
    ];
    row(
        "all",
        counts,
        &means(crowds),
        mean(crowds.iter().map(|crowd| crowd.seconds)),
    );
    text
}

/// Each average precision and their mean, as means over the pictures.
fn means(crowds: &[Crowd]) -> Vec<f64> {
    let all: Vec<Vec<f64>> = crowds.iter().map(Crowd::precisions).collect();
    (0..=THRESHOLDS.len())
        .map(|k| mean(all.iter().map(|one| one[k])))
        .collect()
}

/// A row a picture as CSV.
pub(super) fn each(crowds: &[Crowd]) -> String {
    let mut text = String::from("stem,true,found");
    for threshold in THRESHOLDS {
        // writing to a String cannot fail
        let _ = write!(text, ",ap_{threshold:.1}");
    }
    text += ",mean_ap,cpu_seconds\n";
    for crowd in crowds {
        let Instances { truth, found, .. } = crowd.instances;
        let _ = write!(text, "{},{truth},{found}", quoted(&crowd.stem));
        for value in crowd.precisions().into_iter().chain([crowd.seconds]) {
            let _ = write!(text, ",{value:.6}");
        }
        text.push('\n');
    }
    text
}

/// The means as JSON.
pub(super) fn json(crowds: &[Crowd]) -> Value {
    let means = means(crowds);
    json!({
        "pictures": crowds.len(),
        "thresholds": THRESHOLDS,
        "average_precision": means[..THRESHOLDS.len()],
        "mean_average_precision": means[THRESHOLDS.len()],
        "cpu_seconds": mean(crowds.iter().map(|crowd| crowd.seconds)),
    })
}

impl Crowd {
    /// The average precision at each threshold, and the mean.
    fn precisions(&self) -> Vec<f64> {
        let each = THRESHOLDS
            .iter()
            .map(|&t| self.instances.average_precision(t));
        each.chain([self.instances.mean_average_precision()])
            .collect()
    }
}
