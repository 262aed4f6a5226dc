//! Where fits start: as typed, or from a file of outlines, points, masks or labels.

use std::path::{Path, PathBuf};

use glam::DVec2;
use io::shapes::{self, Column, Origin, Reading, Shape};
use scene::SceneError;
use scene::field::Grid;
use scene::fit::Contour;

use super::flags::{self, Flags};
use super::said::counted;
use crate::commands::key;

/// Where a fit starts, as typed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Start {
    /// A curve of its own.
    Curve(Vec<DVec2>),
    /// A place inside an object.
    Click(DVec2),
    /// A file; its name may hold `{stem}`.
    File(PathBuf),
}

/// What stands for the name of the picture.
const STEM: &str = "{stem}";

impl std::str::FromStr for Start {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let above = |name: &str, value: f64| {
            (value > 0.0)
                .then_some(())
                .ok_or_else(|| format!("{name} must be above 0, got {value}"))
        };
        if let Some(text) = text.strip_prefix("circle:") {
            let [x, y, radius] = finite(text, "circle:X,Y,RADIUS")?;
            above("the radius", radius)?;
            return Ok(Self::Curve(
                Contour::circle(DVec2::new(x, y), radius).points,
            ));
        }
        if let Some(text) = text.strip_prefix("box:") {
            let [left, top, width, height] = finite(text, "box:LEFT,TOP,WIDTH,HEIGHT")?;
            if width <= 0.0 || height <= 0.0 {
                return Err(format!(
                    "width and height must be above 0, got {width} and {height}"
                ));
            }
            let corner = DVec2::new(left, top);
            return Ok(Self::Curve(
                Contour::rectangle(corner, corner + DVec2::new(width, height)).points,
            ));
        }
        if let Some(text) = text.strip_prefix("ellipse:") {
            let turned = text.split(',').count() == 5;
            let [x, y, rx, ry, degrees] = if turned {
                finite(text, "ellipse:X,Y,RX,RY,DEGREES")?
            } else {
                let [x, y, rx, ry] = finite(text, "ellipse:X,Y,RX,RY[,DEGREES]")?;
                [x, y, rx, ry, 0.0]
            };
            above("the first half axis", rx)?;
            above("the second half axis", ry)?;
            let turn = DVec2::from_angle(degrees.to_radians());
            let flat = Contour::ellipse(DVec2::ZERO, DVec2::new(rx, ry)).points;
            let points = flat.into_iter().map(|p| DVec2::new(x, y) + turn.rotate(p));
            return Ok(Self::Curve(points.collect()));
        }
        if let Some(text) = text.strip_prefix("polygon:") {
            let wrong =
                || format!("must be polygon:X,Y,X,Y,… with three points or more, got {text}");
            let numbers: Vec<f64> = numbers(text).ok_or_else(wrong)?;
            if numbers.len() < 6 || numbers.len() % 2 == 1 {
                return Err(wrong());
            }
            return Ok(Self::Curve(
                numbers.chunks(2).map(|p| DVec2::new(p[0], p[1])).collect(),
            ));
        }
        if let Some(text) = text.strip_prefix("click:") {
            let [x, y] = finite(text, "click:X,Y")?;
            return Ok(Self::Click(DVec2::new(x, y)));
        }
        Ok(Self::File(PathBuf::from(text)))
    }
}

/// So many finite numbers with commas between them.
fn finite<const N: usize>(text: &str, form: &str) -> Result<[f64; N], String> {
    let wrong = || format!("must be {form} with numbers, got {text}");
    numbers(text)
        .ok_or_else(wrong)?
        .try_into()
        .map_err(|_| wrong())
}

fn numbers(text: &str) -> Option<Vec<f64>> {
    let list = text
        .split(',')
        .map(|number| number.trim().parse::<f64>().ok());
    let list: Option<Vec<f64>> = list.collect();
    list.filter(|list| list.iter().all(|number| number.is_finite()))
}

impl Start {
    /// The file that is read for a picture of that name.
    pub(crate) fn file(&self, stem: &str) -> Option<PathBuf> {
        match self {
            Self::File(path) => Some(named(path, stem)),
            _ => None,
        }
    }

    /// The outlines to start from in a picture of that name, and what people should know of how they were read.
    pub(super) fn shapes(
        &self,
        flags: &Flags,
        stem: &str,
    ) -> Result<(Vec<Shape>, Vec<String>), SceneError> {
        self.outlines(&reading(flags)?, stem)
    }

    /// What a network says of the pixels of a picture of that name, if the file of the start is its soft output.
    pub(super) fn probabilities(
        &self,
        flags: &Flags,
        stem: &str,
    ) -> Result<Option<Grid>, SceneError> {
        match self.file(stem) {
            Some(path) => Ok(shapes::load_soft(&path, &reading(flags)?)?),
            None => Ok(None),
        }
    }

    /// The outlines of a picture of that name, read so, and what people should know of how they were read.
    pub(crate) fn outlines(
        &self,
        reading: &Reading,
        stem: &str,
    ) -> Result<(Vec<Shape>, Vec<String>), SceneError> {
        let one = |points, closed| Ok((vec![Shape::curve(points, closed)], Vec::new()));
        match self {
            Self::Curve(points) => one(points.clone(), Some(true)),
            Self::Click(place) => one(vec![*place], None),
            Self::File(_) => {
                let path = self.file(stem).unwrap_or_default();
                let (shapes, note) = parts("--from", &path, reading)?;
                let mut notes: Vec<String> = note.into_iter().collect();
                notes.extend(holes(&path, &shapes));
                Ok((shapes, notes))
            }
        }
    }
}

/// The name of a file for a picture of that name.
pub(super) fn named(path: &Path, stem: &str) -> PathBuf {
    match path.to_str() {
        Some(text) => PathBuf::from(text.replace(STEM, stem)),
        None => path.to_owned(),
    }
}

/// The outlines of a file, each part of one an outline of its own, and what people should know of how it was read.
pub(super) fn parts(
    flag: &str,
    path: &Path,
    reading: &Reading,
) -> Result<(Vec<Shape>, Option<String>), SceneError> {
    let (found, note) = shapes::load_noted(path, reading)?;
    if found.iter().all(|shape| shape.first().is_empty()) {
        return Err(key(flag, format!("{} holds no outline", path.display())));
    }
    let mut parts = Vec::new();
    for shape in &found {
        parts.append(&mut shape.parts().map_err(|error| key(flag, error))?);
    }
    let note = note.map(|note| format!("{}: {note}", path.display()));
    Ok((parts, note))
}

/// What to say of holes, which no outline has that is found.
fn holes(path: &Path, shapes: &[Shape]) -> Option<String> {
    let holes: usize = shapes
        .iter()
        .map(|shape| shape.rings.len().max(1) - 1)
        .sum();
    let of = shapes.iter().filter(|shape| shape.rings.len() > 1).count();
    (holes > 0).then(|| {
        format!(
            "{}: {} in {} left out: an outline that is found has none",
            path.display(),
            counted(holes, "hole"),
            counted(of, "outline"),
        )
    })
}

/// How the file of the start is read.
pub(super) fn reading(flags: &Flags) -> Result<Reading, SceneError> {
    let about = flags.about.as_ref();
    Ok(Reading {
        beside: about.map(|about| about.name.clone()),
        size: about.map(|about| about.size),
        ..typed(&flags.columns, flags.origin)?
    })
}

/// What flags say of how a file is read.
pub(crate) fn typed(
    columns: &[String],
    origin: Option<flags::Origin>,
) -> Result<Reading, SceneError> {
    let columns = match columns {
        [] => None,
        [x, y] => Some((column(x), column(y))),
        list => {
            let message = format!("must be two columns as X,Y, got {}", list.join(","));
            return Err(key("--columns", message));
        }
    };
    let origin = origin.map(|origin| match origin {
        flags::Origin::Center => Origin::Center,
        flags::Origin::Corner => Origin::Corner,
    });
    Ok(Reading {
        columns,
        origin,
        ..Reading::default()
    })
}

fn column(text: &str) -> Column {
    let name = text.trim();
    name.parse()
        .map_or_else(|_| Column::Name(name.to_owned()), Column::Number)
}

/// The contour of a shape as a fit takes it.
pub(super) fn contour(shape: &Shape, flags: &Flags) -> Contour {
    let closed = match (flags.open, flags.closed) {
        (true, _) => false,
        (_, true) => true,
        _ => shape.closed.unwrap_or(true),
    };
    Contour {
        points: shape.first().to_vec(),
        closed,
    }
}

/// The name of a file without its ending.
pub(crate) fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(
        || "picture".to_owned(),
        |stem| stem.to_string_lossy().into_owned(),
    )
}
