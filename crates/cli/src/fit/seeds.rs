//! Many objects in a picture: where they are looked for, and their outlines.

use std::path::PathBuf;

use glam::DVec2;
use instances::{Circle, Object, Rules, Seeds, outline_all};
use io::Picture;
use io::shapes::{Reading, Shape};
use scene::SceneError;
use score::Measures;

use super::flags::Flags;
use super::one::{Found, Measured, noted};
use super::start::{named, parts, reading};
use crate::commands::key;

/// Where many objects are looked for, as typed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Where {
    /// Wherever the program finds something.
    Auto,
    /// At the points or outlines of a file; its name may hold `{stem}`.
    File(PathBuf),
}

impl std::str::FromStr for Where {
    type Err = std::convert::Infallible;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(match text {
            "auto" => Self::Auto,
            path => Self::File(PathBuf::from(path)),
        })
    }
}

impl Where {
    /// The file that is read for a picture of that name.
    pub(crate) fn file(&self, stem: &str) -> Option<PathBuf> {
        match self {
            Self::Auto => None,
            Self::File(path) => Some(named(path, stem)),
        }
    }

    /// The outlines of all objects.
    pub(super) fn outlines(
        &self,
        picture: &Picture,
        flags: &Flags,
        stem: &str,
    ) -> Result<Vec<Found>, SceneError> {
        let rules = Rules::default();
        let (objects, shapes) = self.objects(picture, &reading(flags)?, stem)?;
        Ok(objects
            .into_iter()
            .map(|object| told(object, &shapes, &rules))
            .collect())
    }

    /// All objects, and the shapes that they were looked for at, read so.
    pub(crate) fn objects(
        &self,
        picture: &Picture,
        reading: &Reading,
        stem: &str,
    ) -> Result<(Vec<Object>, Vec<Shape>), SceneError> {
        let (seeds, shapes) = match self.file(stem) {
            None => (Seeds::Auto, Vec::new()),
            Some(path) => {
                let (shapes, _) = parts("--seeds", &path, reading)?;
                match &shapes[..] {
                    // the rows of a table that names no curve are points
                    [one] if one.closed.is_none() => {
                        let points = one.rings.iter().flatten().copied().collect();
                        (Seeds::Points(points), Vec::new())
                    }
                    _ => (seeds(&shapes)?, shapes),
                }
            }
        };
        let found = outline_all(picture, &seeds, &Rules::default());
        let found = found.map_err(|error| key("--seeds", error))?;
        Ok((found.objects, shapes))
    }
}

/// The seeds that shapes stand for: points, or circles of half the size of outlines.
fn seeds(shapes: &[Shape]) -> Result<Seeds, SceneError> {
    let points: Vec<DVec2> = shapes
        .iter()
        .filter_map(|shape| match shape.first() {
            [point] => Some(*point),
            _ => None,
        })
        .collect();
    if points.len() == shapes.len() {
        return Ok(Seeds::Points(points));
    }
    if !points.is_empty() {
        let message = "must hold points or outlines, got both";
        return Err(key("--seeds", message));
    }
    let circle = |(index, shape): (usize, &Shape)| {
        let measures = Measures::of(&shape.rings);
        let measures =
            measures.map_err(|error| key("--seeds", format!("outline {}: {error}", index + 1)))?;
        Ok(Circle {
            center: measures.centroid,
            radius: 0.25 * measures.equivalent_diameter,
        })
    };
    let circles: Result<Vec<Circle>, SceneError> = shapes.iter().enumerate().map(circle).collect();
    Ok(Seeds::Circles(circles?))
}

/// One of many objects, with the name of its seed or its number.
fn told(object: Object, seeds: &[Shape], rules: &Rules) -> Found {
    let measured = Measured {
        closed: Some(object.support.closed),
        ..Measured::default()
    };
    let unsure = (object.support.closed < rules.unsure).then(|| {
        format!(
            "unsure: four fifths of the outline have an edge of {:.2} of the strongest, needed: {:.2}",
            object.support.closed, rules.unsure
        )
    });
    let mut shape = Shape::curve(object.outline, Some(true));
    let seed = seeds.get(object.seed);
    shape.id = seed
        .and_then(|seed| seed.id.clone())
        .or_else(|| Some(object.label.to_string()));
    if let Some(seed) = seed {
        shape.label.clone_from(&seed.label);
        shape.properties.clone_from(&seed.properties);
    }
    noted(
        &mut shape,
        if unsure.is_some() { "unsure" } else { "found" },
        measured,
    );
    let start = seed.map_or_else(Shape::default, |seed| {
        Shape::curve(seed.first().to_vec(), Some(true))
    });
    Found {
        start,
        shape: Some(shape),
        fit: None,
        unsure,
        measured,
        plucked: None,
        moments: None,
    }
}
