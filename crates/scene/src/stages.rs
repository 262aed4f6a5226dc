//! Every stage from a picture to its force, as pictures: what `snake field` writes.

use std::path::{Path, PathBuf};

use field::{EdgeForce, ForceField, ReportStages, Smoothing};
use glam::DVec2;
use image::RgbImage;

use crate::{Picture, SceneError, build, paint, ready_folder};

/// The stages of a picture's force, each a picture with a name that says what it is.
///
/// # Errors
///
/// A smoothing that the field refuses.
pub fn stages(
    picture: &Picture,
    smoothing: Smoothing,
) -> Result<Vec<(String, RgbImage)>, SceneError> {
    let refuse = |error: field::FieldError| SceneError::key("field", error);
    let mut all = vec![("0-picture".to_owned(), paint::grey(&picture.levels))];
    let rule = EdgeForce {
        smoothing,
        ..EdgeForce::as_strong_as_the_report()
    };
    let corrected = field::edge_stages(&picture.levels, &rule).map_err(refuse)?;
    all.push(("1-smoothed".to_owned(), paint::grey(&corrected.smoothed)));
    all.push((
        "2-gradient-x".to_owned(),
        paint::signed(&corrected.gradient_x),
    ));
    all.push((
        "3-gradient-y".to_owned(),
        paint::signed(&corrected.gradient_y),
    ));
    all.push((
        "4-edge-strength".to_owned(),
        paint::grey(&corrected.strength),
    ));
    push_force(&mut all, "5-force", picture, &corrected.force);
    let passes = match smoothing {
        Smoothing::Binomial(passes) => passes,
        Smoothing::Gaussian(_) => field::REPORT_PASSES,
    };
    let report: ReportStages = field::report_stages(
        &picture.levels,
        passes,
        field::REPORT_SCALE,
        field::REPORT_GAIN,
    )
    .map_err(refuse)?;
    push_force(&mut all, "6-report-force", picture, &report.force);
    Ok(all)
}

fn push_force(
    all: &mut Vec<(String, RgbImage)>,
    name: &str,
    picture: &Picture,
    force: &ForceField,
) {
    let (x, y) = force.components();
    all.push((format!("{name}-x"), paint::signed(&x)));
    all.push((format!("{name}-y"), paint::signed(&y)));
    all.push((format!("{name}-directions"), paint::wheel(&x, &y)));
    all.push((format!("{name}-arrows"), arrows(picture, force)));
}

/// The force as arrows over the picture, one every few pixels, the longest as long as their distance.
fn arrows(picture: &Picture, force: &ForceField) -> RgbImage {
    let (width, height) = picture.size();
    let pitch = (width.max(height) / 48).max(4);
    let zoom = match width.max(height) {
        ..300 => 3.0,
        300..4000 => 2.0,
        // enough pixels to see an arrow as it is
        _ => 1.0,
    };
    let mut canvas = paint::enlarged(&picture.display, zoom);
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
                paint::draw_curve(&mut canvas, &[a * zoom, b * zoom], false, 1.2, [230, 97, 1]);
            }
        }
    }
    canvas
}

/// The flag of `snake field` that says how to smooth.
const fn flag(smoothing: Smoothing) -> &'static str {
    match smoothing {
        Smoothing::Binomial(_) => "--passes",
        Smoothing::Gaussian(_) => "--sigma",
    }
}

/// Write every stage into `folder` as `NAME.png`; returns the files.
///
/// # Errors
///
/// A folder that cannot be made or written (found out first), or a smoothing that is refused.
pub fn write_stages(
    picture: &Picture,
    smoothing: Smoothing,
    folder: &Path,
) -> Result<Vec<PathBuf>, SceneError> {
    let smoothing = build::smoothing(flag(smoothing), smoothing, picture)?;
    ready_folder(folder)?;
    let mut files = Vec::new();
    for (name, image) in stages(picture, smoothing)? {
        let path = folder.join(format!("{name}.png"));
        paint::save_png(&image, &path)?;
        files.push(path);
    }
    Ok(files)
}
