//! The scenes, contours and pictures that come with the program, by name.

use io::Picture;
use io::shapes::{self, Shape};

use crate::SceneError;

macro_rules! scenes {
    ($($name:literal),* $(,)?) => {
        /// Names and texts of the shipped scenes, in the order of the report.
        pub const SCENES: &[(&str, &str)] =
            &[$(($name, include_str!(concat!("../scenes/", $name, ".toml")))),*];
    };
}

scenes![
    "very-soft-ball",
    "soft-ball",
    "rigid-ball",
    "hard-ball",
    "very-hard-ball",
    "rigid-ball-penalty",
    "rigid-ball-impact",
    "very-soft-ball-friction",
    "ringing-oval",
    "calmed-oval",
    "spinning-oval",
    "turned-oval",
    "third-order",
    "road",
    "sliding-strip",
    "bent-strip-free",
    "bent-strip-anchored",
    "hinged-strip",
    "parted-strip",
    "whole-strip",
    "stiffening-strip",
    "hardening-ball",
    "step-edge",
    "disturbing-edge",
    "apple",
    "apple-closed",
    "apple-hand",
    "apple-report",
    "pile",
    "gas-bag",
    "two-cells",
    "rope",
    "funnel",
    "dented-ring",
    "balloons",
    "growing-cell",
    "slope",
    "coarse-to-fine",
    "drowned-in-noise",
    "gap-and-corners",
];

const CONTOURS: [(&str, &str); 5] = [
    (
        "apple-report-start",
        include_str!("../pictures/apple_report_start.csv"),
    ),
    (
        "apple-over-the-stem",
        include_str!("../pictures/apple_over_the_stem.csv"),
    ),
    (
        "apple-without-the-stem",
        include_str!("../pictures/apple_without_the_stem.csv"),
    ),
    (
        "apple-whole-without-the-stem",
        include_str!("../pictures/apple_whole_without_the_stem.csv"),
    ),
    ("apple-truth", include_str!("../pictures/apple_contour.csv")),
];

/// The text of a shipped scene.
pub(crate) fn text(name: &str) -> Result<&'static str, SceneError> {
    SCENES
        .iter()
        .find(|(known, _)| *known == name)
        .map(|(_, text)| *text)
        .ok_or_else(|| SceneError::UnknownScene {
            name: name.to_owned(),
            nearest: crate::error::meant(name, SCENES.iter().map(|(known, _)| *known)),
        })
}

/// Title of a shipped scene and its place in the report, without building it.
///
/// # Errors
///
/// [`SceneError::UnknownScene`] with the nearest name.
pub fn headline(name: &str) -> Result<(String, Option<String>), SceneError> {
    let text = crate::toml_error::parse(text(name)?)?;
    Ok((text.title, text.report))
}

/// Boxes `[x0, y0, x1, y1]` of what is in the apple's way, by name: the stem, highlights, pencils,
/// the table's edge, and where its own contour has almost no contrast.
pub const APPLE_DISTURBING: [(&str, [f64; 4]); 8] = [
    ("stem", [190.0, 3.0, 232.0, 60.0]),
    ("highlight_left", [100.0, 132.0, 165.0, 200.0]),
    ("highlight_right", [340.0, 205.0, 388.0, 325.0]),
    ("pencil_left", [0.0, 440.0, 125.0, 482.0]),
    ("pencil_right", [385.0, 440.0, 511.0, 482.0]),
    ("table", [0.0, 478.0, 511.0, 511.0]),
    ("lobe", [270.0, 430.0, 330.0, 495.0]),
    ("weak_right", [415.0, 330.0, 460.0, 450.0]),
];

/// A contour that comes with the program.
///
/// # Errors
///
/// A name that none has; the message has the nearest one.
pub fn contour(name: &str) -> Result<Shape, SceneError> {
    let Some((_, text)) = CONTOURS.iter().find(|(known, _)| *known == name) else {
        let known: Vec<&str> = CONTOURS.iter().map(|(known, _)| *known).collect();
        let meant = crate::error::meant(name, known.iter().copied());
        let (name, known) = (crate::error::clip(name), known.join(", "));
        let message = format!("no shipped contour \"{name}\"{meant} (known: {known})");
        return Err(SceneError::key("shipped", message));
    };
    shapes::parse_one(text).map_err(|message| SceneError::key("shipped", message))
}

/// The pictures that come with the program, by name.
const PICTURES: [(&str, &[u8]); 2] = [
    ("apple", include_bytes!("../pictures/apple.png")),
    (
        "disturbing-edge",
        include_bytes!("../pictures/disturbing_edge.pgm"),
    ),
];

/// A picture that comes with the program.
///
/// # Errors
///
/// A name that none has; the message has the nearest one.
pub fn picture(name: &str) -> Result<Picture, SceneError> {
    let Some((_, bytes)) = PICTURES.iter().find(|(known, _)| *known == name) else {
        let known: Vec<&str> = PICTURES.iter().map(|(known, _)| *known).collect();
        let meant = crate::error::meant(name, known.iter().copied());
        let (name, known) = (crate::error::clip(name), known.join(", "));
        let message = format!("no shipped picture \"{name}\"{meant} (known: {known})");
        return Err(SceneError::key("picture.shipped", message));
    };
    Picture::decode(bytes).map_err(|message| SceneError::key("picture.shipped", message))
}
