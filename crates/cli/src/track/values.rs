//! What goes on along an outline: numbers at equal shares of the first outline, frame by frame.

use std::path::Path;

use ::track::Outline;
use glam::DVec2;
use io::chart::Kymograph;
use io::{Picture, paint};
use scene::SceneError;

use super::along::{Spot, curvature, grey, length, middle, outward, spots};
use super::flags::Shown;

/// Places along the outline: one a pixel of the first, from so many to so many.
const LEAST: f64 = 48.0;
const MOST: f64 = 720.0;

/// The numbers of one object so far.
#[derive(Debug)]
pub(super) struct Values {
    of: Shown,
    id: u32,
    first: usize,
    rows: Vec<Vec<f64>>,
    /// How many places there are; known from the first outline.
    count: usize,
    /// The places in the frame before.
    before: Option<Vec<Option<DVec2>>>,
    /// Distances from the middle in the first frame.
    reach: Option<Vec<f64>>,
}

impl Values {
    pub(super) const fn new(of: Shown, id: u32, first: usize) -> Self {
        Self {
            of,
            id,
            first,
            rows: Vec::new(),
            count: 0,
            before: None,
            reach: None,
        }
    }

    /// Take the outline of a frame, if there is one.
    pub(super) fn take(&mut self, outline: Option<&Outline>, picture: Option<&Picture>) {
        let outline = outline.filter(|outline| {
            outline.points.len() > 2 && outline.material.len() == outline.points.len()
        });
        let Some(outline) = outline else {
            self.rows.push(vec![f64::NAN; self.count]);
            self.before = None;
            return;
        };
        if self.count == 0 {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "clamped to some hundreds"
            )]
            let count = length(&outline.points).clamp(LEAST, MOST).round() as usize;
            self.count = count;
            self.rows
                .iter_mut()
                .for_each(|row| *row = vec![f64::NAN; count]);
        }
        let spots = spots(outline, self.count);
        let place = |spot: &Option<Spot>| spot.as_ref().map(|spot| spot.at(&outline.points));
        let places: Vec<Option<DVec2>> = spots.iter().map(place).collect();
        let row = match self.of {
            Shown::Speed => self.speed(&places, outward(&outline.points), &spots),
            Shown::Curvature => {
                let bends = curvature(&outline.points);
                spots
                    .iter()
                    .map(|spot| spot.as_ref().map_or(f64::NAN, |spot| spot.of(&bends)))
                    .collect()
            }
            Shown::Grey => {
                let level = |p: &Option<DVec2>| {
                    p.zip(picture)
                        .map_or(f64::NAN, |(p, picture)| grey(picture, p))
                };
                places.iter().map(level).collect()
            }
            Shown::Protrusion => {
                let middle = middle(&outline.points);
                let now: Vec<f64> = places
                    .iter()
                    .map(|p| p.map_or(f64::NAN, |p| p.distance(middle)))
                    .collect();
                let first = self.reach.get_or_insert_with(|| now.clone());
                now.iter()
                    .zip(first)
                    .map(|(now, first)| now - *first)
                    .collect()
            }
        };
        self.rows.push(row);
        self.before = Some(places);
    }

    fn speed(
        &self,
        places: &[Option<DVec2>],
        normals: Vec<DVec2>,
        spots: &[Option<Spot>],
    ) -> Vec<f64> {
        let Some(before) = &self.before else {
            return vec![f64::NAN; places.len()];
        };
        let each = places.iter().zip(before).zip(spots);
        each.map(|((now, before), spot)| match (now, before, spot) {
            (Some(now), Some(before), Some(spot)) => {
                (*now - *before).dot(spot.at(&normals).normalize_or_zero())
            }
            _ => f64::NAN,
        })
        .collect()
    }

    fn chart(self) -> (Kymograph, &'static str) {
        let (title, scale, name, signed) = match self.of {
            Shown::Speed => (
                "Motion along the normal",
                "outward speed (px/frame)",
                "speed_px_per_frame",
                true,
            ),
            Shown::Curvature => ("Curvature", "curvature (1/px)", "curvature_per_px", true),
            Shown::Grey => (
                "Grey level under the outline",
                "grey level (0\u{2013}255)",
                "grey",
                false,
            ),
            Shown::Protrusion => (
                "Distance from the middle, less that at first",
                "protrusion (px)",
                "protrusion_px",
                true,
            ),
        };
        let chart = Kymograph {
            title: format!("{title}, object {}", self.id),
            scale: scale.to_owned(),
            places: "share of the first outline".to_owned(),
            first: self.first,
            rows: self.rows,
            signed,
        };
        (chart, name)
    }

    /// Write them, as a picture or as a table by the name's ending.
    pub(super) fn write(self, path: &Path) -> Result<(), SceneError> {
        let table = path
            .extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case("csv"));
        let (chart, name) = self.chart();
        if table {
            return Ok(io::write_whole(path, chart.table(name).as_bytes())?);
        }
        Ok(paint::save_png(&chart.draw(), path)?)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
mod tests {
    use super::*;
    use ::track::{Prediction, State};

    /// A circle whose nodes are at these shares of the first.
    fn circle(center: DVec2, radius: f64, shares: &[f64]) -> Outline {
        let points = shares
            .iter()
            .map(|s| center + radius * DVec2::from_angle(s * std::f64::consts::TAU));
        Outline {
            id: 1,
            parent: None,
            points: points.collect(),
            material: shares.to_vec(),
            errors: vec![0.0; shares.len()],
            state: State::Seen,
            confidence: 1.0,
            velocity: DVec2::ZERO,
            rotation: 0.0,
            prediction: Prediction::Still,
        }
    }

    fn even(n: u32, shift: f64) -> Vec<f64> {
        (0..n)
            .map(|k| (f64::from(k) / f64::from(n) + shift).rem_euclid(1.0))
            .collect()
    }

    fn rows(of: Shown, outlines: &[Outline]) -> Vec<Vec<f64>> {
        let mut values = Values::new(of, 1, 0);
        outlines.iter().for_each(|one| values.take(Some(one), None));
        values.rows
    }

    #[test]
    fn a_circle_that_moves_and_grows_has_the_speeds_that_it_has() {
        // whichever nodes an outline has
        let list = [
            circle(DVec2::new(50.0, 50.0), 20.0, &even(90, 0.0)),
            circle(DVec2::new(53.0, 50.0), 20.0, &even(120, 0.013)),
            circle(DVec2::new(53.0, 50.0), 22.0, &even(100, 0.5)),
        ];
        let found = rows(Shown::Speed, &list);
        let count = found[0].len();
        assert_eq!(count, 126);
        assert!(found[0].iter().all(|v| v.is_nan()));
        for (k, value) in found[1].iter().enumerate() {
            let angle = (k as f64 + 0.5) / count as f64 * std::f64::consts::TAU;
            assert!((value - 3.0 * angle.cos()).abs() < 0.05, "{k}: {value}");
        }
        assert!(
            found[2].iter().all(|v| (v - 2.0).abs() < 0.05),
            "{:?}",
            found[2]
        );
        let reach = rows(Shown::Protrusion, &list);
        assert!(reach[0].iter().chain(&reach[1]).all(|v| v.abs() < 0.05));
        assert!(reach[2].iter().all(|v| (v - 2.0).abs() < 0.05));
    }

    #[test]
    fn a_circle_has_one_over_its_radius_and_a_gap_has_nothing() {
        let one = circle(DVec2::new(50.0, 50.0), 20.0, &even(126, 0.0));
        let found = rows(Shown::Curvature, std::slice::from_ref(&one));
        // smoothing draws a circle in by 1 − exp(−σ²/2r²), about 1 %
        assert!(
            found[0].iter().all(|v| (v - 0.05).abs() < 0.001),
            "{:?}",
            found[0]
        );
        let mut values = Values::new(Shown::Speed, 1, 0);
        values.take(None, None);
        values.take(Some(&one), None);
        values.take(None, None);
        values.take(Some(&one), None);
        assert!(
            values
                .rows
                .iter()
                .all(|row| row.len() == 126 && row.iter().all(|v| v.is_nan()))
        );
    }

    #[test]
    fn grey_is_that_of_the_picture_between_its_pixels() {
        let levels =
            ndarray::Array2::from_shape_fn((9, 12), |(y, x)| 3.0 * x as f64 + 2.0 * y as f64);
        let picture = Picture::from_levels(levels);
        for p in [DVec2::new(3.25, 4.5), DVec2::ZERO, DVec2::new(11.0, 8.0)] {
            assert!((grey(&picture, p) - 3.0 * p.x - 2.0 * p.y).abs() < 1e-9);
        }
        assert!(
            grey(&picture, DVec2::new(11.5, 3.0)).is_nan() && grey(&picture, DVec2::NAN).is_nan()
        );
        assert!(
            middle(&circle(DVec2::new(7.0, 5.0), 3.0, &even(40, 0.0)).points)
                .distance(DVec2::new(7.0, 5.0))
                < 1e-9
        );
    }
}
