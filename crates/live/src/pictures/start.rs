//! Starts as they are drawn or read, and the outlines that are found about them.

use std::path::Path;
use std::sync::Arc;

use glam::DVec2;
use instances::{Rules, Seeds, outline_all};
use io::shapes::{self, Format, Reading, Shape};
use outline::{Place, place};
use scene::elastic::{self, Parameter};
use scene::fit::Contour;

use super::{One, Pictures};
use crate::request::Drawn;
use crate::sandbox::place as point;
use crate::{LiveError, Pair};

/// Outlines that a picture may have here.
const MOST: usize = 5000;

/// Points along an ellipse that is drawn.
const ROUND: u32 = 64;

/// A start as it is searched from. A click is one point.
pub(super) fn drawn_curve(
    drawn: Drawn,
    points: &[Pair],
    closed: bool,
) -> Result<Contour, LiveError> {
    let clicks: Vec<DVec2> = points.iter().map(|p| point(*p)).collect::<Result<_, _>>()?;
    let corners = || match clicks[..] {
        [one, other] => Ok((one, other)),
        _ => {
            let got = clicks.len();
            Err(LiveError::new(format!("a box has two corners, got {got}")))
        }
    };
    let curve = match drawn {
        Drawn::Click => match clicks[..] {
            [_] => Contour::closed(clicks),
            _ => {
                return Err(LiveError::new(format!(
                    "a click is one place, got {}",
                    clicks.len()
                )));
            }
        },
        Drawn::Line => Contour {
            points: clicks,
            closed,
        },
        Drawn::Spline => Contour {
            points: through(&clicks, closed)?,
            closed,
        },
        Drawn::Box => {
            let (one, other) = corners()?;
            Contour::rectangle(one, other)
        }
        Drawn::Ellipse => {
            let (one, other) = corners()?;
            let (center, half) = (0.5 * (one + other), 0.5 * (other - one).abs());
            let turn =
                |i| DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / f64::from(ROUND));
            Contour::closed((0..ROUND).map(|i| center + half * turn(i)).collect())
        }
    };
    Ok(curve)
}

/// The smooth curve through clicks.
fn through(clicks: &[DVec2], closed: bool) -> Result<Vec<DVec2>, LiveError> {
    let least = if closed { 3 } else { 2 };
    if clicks.len() < least {
        let got = clicks.len();
        return Err(LiveError::new(format!(
            "a curve through clicks needs at least {least} of them, got {got}"
        )));
    }
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to a small positive range first"
    )]
    let count = (0.5 * elastic::length(clicks, closed))
        .clamp(48.0, 4000.0)
        .round() as usize;
    elastic::spline(clicks, count, Parameter::ArcLength, closed).map_err(LiveError::of)
}

impl Pictures {
    /// Find the outline about a start.
    pub(super) fn start(
        &mut self,
        drawn: Drawn,
        points: &[Pair],
        closed: bool,
    ) -> Result<(), LiveError> {
        let curve = drawn_curve(drawn, points, closed)?;
        let one = self.search(&curve)?;
        self.admit(one)?;
        Ok(())
    }

    /// What a search about a curve finds.
    pub(super) fn search(&self, curve: &Contour) -> Result<One, LiveError> {
        let fit = self.prepared.fit(curve).map_err(LiveError::of)?;
        Ok(self.kept_out(One::found(&fit, &curve.points)))
    }

    /// One more outline, which moves there from its start.
    pub(super) fn admit(&mut self, mut one: One) -> Result<u32, LiveError> {
        if self.outlines.len() >= MOST {
            return Err(LiveError::new(format!(
                "a picture may have {MOST} outlines here; for more there is `snake fit`"
            )));
        }
        let id = self.next_id;
        self.next_id += 1;
        if one.label.is_empty() {
            one.label = format!("outline {id}");
        }
        self.set_out(id, &one);
        self.outlines.insert(id, Arc::new(one));
        Ok(id)
    }

    /// Find all objects that lie apart from the outlines that are there.
    pub(super) fn find_all(&mut self) -> Result<(), LiveError> {
        let rules = Rules::default();
        let found = outline_all(&*self.picture, &Seeds::Auto, &rules).map_err(LiveError::of)?;
        let is_taken = |middle: DVec2| {
            let mut closed = self.outlines.values().filter(|one| one.closed);
            closed.any(|one| place(&one.points, middle) == Place::Inside)
        };
        let ones: Vec<One> = found
            .objects
            .into_iter()
            .filter_map(|object| {
                let middle = elastic::centroid(&object.outline)?;
                (!is_taken(middle)).then(|| One::among(object, middle, rules.unsure))
            })
            .collect();
        if ones.is_empty() {
            return Err(LiveError::new(
                "no further object was found in this picture; choose Click and click inside one",
            ));
        }
        for one in ones {
            let one = self.kept_out(one);
            self.admit(one)?;
        }
        Ok(())
    }

    /// Take the outlines of a file.
    pub(super) fn start_of_file(
        &mut self,
        name: &str,
        bytes: &[u8],
        search: bool,
    ) -> Result<(), LiveError> {
        let reading = Reading {
            format: Format::by_ending(Path::new(name)),
            size: Some(self.picture.size()),
            ..Reading::default()
        };
        let read = shapes::parse_with(bytes, &reading);
        let shapes = read.map_err(|error| LiveError::new(format!("{name}: {error}")))?;
        if shapes.is_empty() {
            return Err(LiveError::new(format!("{name} has no outline")));
        }
        let mut parts: Vec<Shape> = Vec::new();
        for shape in shapes {
            parts.extend(shape.parts().map_err(LiveError::of)?);
        }
        let ones = parts.iter().map(|shape| {
            let curve = Contour {
                points: shape.first().to_vec(),
                closed: shape.closed.unwrap_or(true),
            };
            let mut one = if search {
                self.search(&curve)?
            } else {
                One::as_given(curve.points, curve.closed)
            };
            one.label = shape
                .label
                .clone()
                .or_else(|| shape.id.clone())
                .unwrap_or_default();
            Ok(one)
        });
        let ones: Vec<One> = ones.collect::<Result<_, LiveError>>()?;
        for one in ones {
            self.admit(one)?;
        }
        Ok(())
    }

    /// Search once more about an outline as it is.
    pub(super) fn search_again(&mut self, id: u32) -> Result<(), LiveError> {
        let before = self.one(id)?.clone();
        let curve = Contour {
            points: before.points.clone(),
            closed: before.closed,
        };
        let mut one = self.search(&curve)?;
        (one.label, one.class) = (before.label.clone(), before.class.clone());
        let one = self.with_pins(one, &before);
        self.set_out(id, &one);
        self.outlines.insert(id, Arc::new(one));
        Ok(())
    }
}
