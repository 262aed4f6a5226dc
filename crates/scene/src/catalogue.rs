//! The scenes and contours that come with the program, by name.

use crate::{Contour, SceneError};

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
    "very-soft-ball-friction",
    "ringing-oval",
    "bent-strip-free",
    "bent-strip-anchored",
    "hinged-strip",
    "parted-strip",
    "whole-strip",
    "step-edge",
    "apple",
    "apple-closed",
    "apple-report",
];

const CONTOURS: [(&str, &str); 3] = [
    (
        "apple-report-start",
        include_str!("../pictures/apple_report_start.csv"),
    ),
    (
        "apple-over-the-stem",
        include_str!("../pictures/apple_over_the_stem.csv"),
    ),
    ("apple-truth", include_str!("../pictures/apple_contour.csv")),
];

/// The text of a shipped scene.
pub(crate) fn text(name: &str) -> Result<&'static str, SceneError> {
    SCENES
        .iter()
        .find(|(known, _)| *known == name)
        .map(|(_, text)| *text)
        .ok_or_else(|| {
            let nearest = crate::error::nearest(name, SCENES.iter().map(|(known, _)| *known));
            SceneError::UnknownScene {
                name: name.to_owned(),
                nearest: nearest.to_owned(),
            }
        })
}

/// A contour that comes with the program.
///
/// # Errors
///
/// A name that none has; the message has the nearest one.
pub fn contour(name: &str) -> Result<Contour, SceneError> {
    let Some((_, text)) = CONTOURS.iter().find(|(known, _)| *known == name) else {
        let nearest = crate::error::nearest(name, CONTOURS.iter().map(|(known, _)| *known));
        let message = format!("no shipped contour \"{name}\"; did you mean \"{nearest}\"?");
        return Err(SceneError::key("shipped", message));
    };
    Contour::parse(text).map_err(|message| SceneError::key("shipped", message))
}
