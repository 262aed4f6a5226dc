//! What goes on along an outline: numbers at equal shares of the first outline, frame by frame.

use std::path::Path;

use ::track::Outline;
use glam::DVec2;
use io::chart::Kymograph;
use io::{Picture, paint};
use scene::SceneError;

use super::flags::Shown;

/// Places along the outline: one a pixel of the first, from so many to so many.
const LEAST: f64 = 48.0;
const MOST: f64 = 720.0;

/// σ over which places are smoothed for curvature. Pixels.
const SMOOTH: f64 = 3.0;

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

/// A place between two nodes.
#[derive(Debug, Clone, Copy)]
struct Spot {
    from: usize,
    to: usize,
    part: f64,
}

impl Spot {
    fn at(&self, list: &[DVec2]) -> DVec2 {
        list[self.from].lerp(list[self.to], self.part)
    }

    fn of(&self, list: &[f64]) -> f64 {
        list[self.from] + (list[self.to] - list[self.from]) * self.part
    }
}

/// Where on an outline the places are that have come from the middles of `count` equal stretches of the first outline;
/// None where it has none.
fn spots(outline: &Outline, count: usize) -> Vec<Option<Spot>> {
    let shares = &outline.material;
    let n = shares.len();
    let mut list = vec![None; count];
    for from in 0..n {
        let to = (from + 1) % n;
        let mut step = shares[to] - shares[from];
        step -= step.round();
        // a stretch that runs back has nothing of its own
        if !(step > 0.0 && step.is_finite()) {
            continue;
        }
        let scale = count as f64;
        let (begin, end) = (
            shares[from] * scale - 0.5,
            (shares[from] + step) * scale - 0.5,
        );
        let mut place = begin.ceil();
        while place < end {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a place in the list"
            )]
            let at = place.rem_euclid(scale) as usize;
            let part = (place - begin) / (end - begin);
            if let Some(spot) = list.get_mut(at) {
                *spot = Some(Spot { from, to, part });
            }
            place += 1.0;
        }
    }
    list
}

fn edges(points: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(a, b)| (*a, *b))
}

fn length(points: &[DVec2]) -> f64 {
    edges(points).map(|(a, b)| a.distance(b)).sum()
}

/// The middle of the area.
pub(super) fn middle(points: &[DVec2]) -> DVec2 {
    let Some(&origin) = points.first() else {
        return DVec2::NAN;
    };
    let (mut area, mut sum) = (0.0, DVec2::ZERO);
    for (a, b) in edges(points) {
        let (a, b) = (a - origin, b - origin);
        area += a.perp_dot(b);
        sum += (a + b) * a.perp_dot(b);
    }
    if area.abs() > 1e-9 {
        origin + sum / (3.0 * area)
    } else {
        origin
    }
}

/// Outward normals at the nodes, whichever way they run.
fn outward(points: &[DVec2]) -> Vec<DVec2> {
    let n = points.len();
    let area: f64 = edges(points).map(|(a, b)| a.perp_dot(b)).sum();
    let normal = |i: usize| {
        let along = points[(i + 1) % n] - points[(i + n - 1) % n];
        let right = DVec2::new(along.y, -along.x).normalize_or_zero();
        if area > 0.0 { right } else { -right }
    };
    (0..n).map(normal).collect()
}

/// Curvature at the nodes, above 0 where the outline bulges: of the circle through a node and places beside it, after
/// smoothing.
fn curvature(points: &[DVec2]) -> Vec<f64> {
    let n = points.len();
    let spacing = (length(points) / n as f64).max(1e-9);
    let sigma = SMOOTH / spacing;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "less than the nodes there are"
    )]
    let reach = ((3.0 * sigma).ceil().min((n / 2) as f64) as usize).min(n / 2);
    let weight = |d: usize| (-0.5 * (d as f64 / sigma.max(1e-9)).powi(2)).exp();
    let smooth = |i: usize| {
        let (mut sum, mut all) = (points[i], 1.0);
        for d in 1..=reach {
            let w = weight(d);
            sum += w * (points[(i + d) % n] + points[(i + n - d) % n]);
            all += 2.0 * w;
        }
        sum / all
    };
    let soft: Vec<DVec2> = (0..n).map(smooth).collect();
    let area: f64 = edges(points).map(|(a, b)| a.perp_dot(b)).sum();
    let bend = |i: usize| {
        let (a, b, c) = (soft[(i + n - 1) % n], soft[i], soft[(i + 1) % n]);
        let product = a.distance(b) * b.distance(c) * c.distance(a);
        // Menger: four times the area of the triangle over the product of its sides
        let value = 2.0 * (b - a).perp_dot(c - b) / product;
        if product > 0.0 {
            value * area.signum()
        } else {
            f64::NAN
        }
    };
    (0..n).map(bend).collect()
}

/// The grey level at a place, between pixels; no number outside.
fn grey(picture: &Picture, p: DVec2) -> f64 {
    let (width, height) = picture.size();
    let last = DVec2::new(width as f64 - 1.0, height as f64 - 1.0);
    if !(p.cmpge(DVec2::ZERO).all() && p.cmple(last).all()) {
        return f64::NAN;
    }
    let corner = p.floor().min((last - 1.0).max(DVec2::ZERO));
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a pixel of the picture"
    )]
    let (x, y) = (corner.x as usize, corner.y as usize);
    let part = p - corner;
    let (right, below) = ((x + 1).min(width - 1), (y + 1).min(height - 1));
    let row = |y: usize| {
        picture.level_at(x, y) + (picture.level_at(right, y) - picture.level_at(x, y)) * part.x
    };
    row(y) + (row(below) - row(y)) * part.y
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
