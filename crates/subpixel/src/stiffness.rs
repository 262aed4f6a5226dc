//! The body of the last stage: a curve that is stiff out of a rest shape and moves along its normals.

use banded::{Factor, Pentadiagonal};
use glam::DVec2;
use search::smooth::smoothed;

/// Lengths ℓ of the stiffness that are tried: waves shorter than 2π ℓ are smoothed. Pixels.
const LENGTHS: [f64; 8] = [1.4, 2.0, 2.8, 4.0, 5.6, 8.0, 11.0, 16.0];

/// What an independent number counts in the cross-validation.
const FACTOR: f64 = 1.3;

/// The rest shape is smoothed by a Gaussian of so many ℓ, and what that took away again.
const REST: f64 = 1.2;

/// Places of an edge by each node alone, and how well it is known.
pub(crate) struct Places<'a> {
    /// Where the edge is, on the normal of each node.
    pub alone: Vec<DVec2>,
    pub normals: &'a [DVec2],
    /// Fisher information of each place, above 0.
    pub information: Vec<f64>,
    pub spacing: f64,
    pub closed: bool,
}

/// A curve at rest.
pub(crate) struct Rest {
    pub points: Vec<DVec2>,
    /// Variance along the normal. Square pixels.
    pub variance: Vec<f64>,
    /// ℓ.
    pub length: f64,
}

impl Places<'_> {
    /// The curve of least energy, of the stiffness that cross-validation chooses.
    pub(crate) fn rest(&self) -> Option<Rest> {
        let mut best: Option<(f64, f64)> = None;
        for length in LENGTHS {
            let Some(score) = self.score(length) else {
                continue;
            };
            if best.is_none_or(|(known, _)| score < known) {
                best = Some((score, length));
            }
        }
        self.rest_of(best.map_or(LENGTHS[0], |(_, length)| length))
    }

    /// The curve of least energy of a given stiffness.
    pub(crate) fn rest_of(&self, length: f64) -> Option<Rest> {
        let (shape, away) = self.away(length);
        let matrix = self.matrix(length)?;
        let offsets = self.solved(&matrix, &away)?;
        let variance = matrix.inverse_diagonal()?;
        // what passes through the rest shape too
        let own: f64 = self
            .information
            .iter()
            .zip(&variance)
            .map(|(f, v)| f * v)
            .sum();
        let share = freedom(self.alone.len(), length / self.spacing, self.closed) / own;
        let points = shape.iter().zip(self.normals).zip(&offsets);
        Some(Rest {
            points: points
                .map(|((p, normal), way)| *p + *way * *normal)
                .collect(),
            variance: variance.iter().map(|v| v * share).collect(),
            length,
        })
    }

    /// Generalised cross-validation, less is better; None where too little is left to judge by.
    ///
    /// Neighbouring nodes see the same pixels, so that what is left of their places is not independent; of pairs it
    /// nearly is.
    fn score(&self, length: f64) -> Option<f64> {
        let n = self.alone.len();
        let pairs = n / 2;
        let taken = FACTOR * freedom(n, length / self.spacing, self.closed);
        let free = (pairs as f64 - taken) / pairs as f64;
        if free < 0.1 {
            return None;
        }
        let (_, away) = self.away(length);
        let offsets = self.solved(&self.matrix(length)?, &away)?;
        let misfit = |p: usize| {
            let (i, j) = (2 * p, 2 * p + 1);
            let left = |i: usize| self.information[i] * (away[i] - offsets[i]);
            (left(i) + left(j)).powi(2) / (self.information[i] + self.information[j])
        };
        Some((0..pairs).map(misfit).sum::<f64>() / (free * free))
    }

    /// The rest shape, and how far outside it the edge lies by each node alone.
    fn away(&self, length: f64) -> (Vec<DVec2>, Vec<f64>) {
        let shape = rest_shape(&self.alone, REST * length / self.spacing, self.closed);
        let both = self.alone.iter().zip(&shape).zip(self.normals);
        let away = both
            .map(|((p, rest), normal)| (*p - *rest).dot(*normal))
            .collect();
        (shape, away)
    }

    /// Information and stiffness: ½ w₂ ∫ u″² ds with w₂ = F ℓ⁴, F the mean information of a pixel.
    fn matrix(&self, length: f64) -> Option<Pentadiagonal> {
        let n = self.alone.len();
        let mean = self.information.iter().sum::<f64>() / n as f64 / self.spacing;
        let rigidity = mean * length.powi(4) / self.spacing.powi(3);
        let mut matrix = Pentadiagonal::new(n, self.closed).ok()?;
        matrix.add_diagonal(&self.information);
        let bends = if self.closed { 0..n } else { 1..n - 1 };
        for i in bends {
            matrix.add_outer(
                rigidity,
                &[((i + n - 1) % n, 1.0), (i, -2.0), ((i + 1) % n, 1.0)],
            );
        }
        Some(matrix)
    }

    fn solved(&self, matrix: &Pentadiagonal, away: &[f64]) -> Option<Vec<f64>> {
        let mut offsets: Vec<f64> = self
            .information
            .iter()
            .zip(away)
            .map(|(f, y)| f * y)
            .collect();
        Factor::new(matrix).ok()?.solve_scalars(&mut offsets);
        Some(offsets)
    }
}

/// A curve without its short waves: smoothed, and what that took away smoothed again. The ellipse that a closed curve
/// is in its longest waves, and the chord of an open one, stay as they are.
pub(crate) fn rest_shape(points: &[DVec2], sigma: f64, closed: bool) -> Vec<DVec2> {
    let base = if closed {
        ellipse(points)
    } else {
        chord(points)
    };
    let waves: Vec<DVec2> = points.iter().zip(&base).map(|(p, b)| *p - *b).collect();
    let once = smoothed(&waves, sigma, closed);
    let taken: Vec<DVec2> = waves.iter().zip(&once).map(|(p, s)| *p - *s).collect();
    let again = smoothed(&taken, sigma, closed);
    base.iter()
        .zip(once.iter().zip(&again))
        .map(|(b, (s, a))| *b + *s + *a)
        .collect()
}

/// The ellipse of a closed curve's lowest waves (\[kuhl82\]).
fn ellipse(points: &[DVec2]) -> Vec<DVec2> {
    let n = points.len() as f64;
    let turns: Vec<DVec2> = (0..points.len())
        .map(|i| DVec2::from_angle(std::f64::consts::TAU * i as f64 / n))
        .collect();
    let (mut mean, mut cosine, mut sine) = (DVec2::ZERO, DVec2::ZERO, DVec2::ZERO);
    for (p, turn) in points.iter().zip(&turns) {
        mean += *p / n;
        cosine += *p * (2.0 * turn.x / n);
        sine += *p * (2.0 * turn.y / n);
    }
    turns
        .iter()
        .map(|turn| mean + cosine * turn.x + sine * turn.y)
        .collect()
}

/// Points along the straight line between an open curve's ends.
fn chord(points: &[DVec2]) -> Vec<DVec2> {
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return Vec::new();
    };
    let gaps = (points.len() - 1).max(1) as f64;
    (0..points.len())
        .map(|i| first.lerp(*last, i as f64 / gaps))
        .collect()
}

/// How many independent numbers a curve takes from its edge: the sum over all waves of the share that passes. `length`
/// is ℓ in nodes.
fn freedom(n: usize, length: f64, closed: bool) -> f64 {
    let passes = |m: usize| {
        if closed && m <= 2 {
            return 1.0;
        }
        let k = std::f64::consts::TAU * m as f64 / n as f64 * length;
        let bent = 1.0 / (1.0 + k.powi(4));
        let smooth = 1.0 - (1.0 - (-0.5 * (REST * k).powi(2)).exp()).powi(2);
        bent + (1.0 - bent) * smooth
    };
    passes(0) + 2.0 * (1..=n / 2).map(passes).sum::<f64>()
}
