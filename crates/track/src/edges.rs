//! Edges along the curve: from the color that was inside to the one that was outside, where the first outline had them.

use crate::palette::Feature;
use crate::ring;
use crate::tables::Strips;
use crate::window::Window;

/// How far from the first outline its edge may lie. Cells.
const NEAR: usize = 3;

/// σ along the curve of directions and of where edges lie. Nodes.
const WIDE: f64 = 2.0;
const CALM: f64 = 4.0;

/// Depth beside a node over which its colors are compared. Cells.
const DEPTH: [f64; 2] = [1.5, 5.0];

/// A slope that this share of a window does not reach is half an edge.
const HALF: f64 = 0.75;

/// The least slope of half an edge. Lightness a cell.
const LEAST: f32 = 0.7;

type Color = [f32; 3];

/// What edge each node has.
#[derive(Debug, Clone)]
pub(crate) struct Edges {
    /// Color inside less color outside, of length 1; 0 where there is no difference.
    directions: Vec<Color>,
    /// How far out from the node its edge lies. Cells.
    pub offsets: Vec<f64>,
}

/// Lightness and color of a feature.
fn color(feature: &Feature) -> Color {
    [feature[0], feature[2], feature[3]]
}

fn dot(a: &Color, b: &Color) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn unit(a: Color) -> Color {
    let size = dot(&a, &a).sqrt();
    if size > 1e-6 {
        a.map(|v| v / size)
    } else {
        [0.0; 3]
    }
}

/// How much of an edge a slope is.
pub(crate) fn strength(slope: f32, half: f32) -> f64 {
    if slope > 0.0 {
        f64::from(slope / (slope + half))
    } else {
        0.0
    }
}

/// Slope that counts as half an edge in a window.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a share of a count"
)]
pub(crate) fn half(window: &Window) -> f32 {
    let mut sizes = Vec::new();
    for y in (1..window.height.saturating_sub(1)).step_by(2) {
        for x in (1..window.width.saturating_sub(1)).step_by(2) {
            let at = |x: usize, y: usize| color(&window.features[y * window.width + x]);
            let (left, right, above, below) =
                (at(x - 1, y), at(x + 1, y), at(x, y - 1), at(x, y + 1));
            let slope = |a: Color, b: Color| -> f32 {
                a.iter().zip(b).map(|(a, b)| (b - a) * (b - a)).sum()
            };
            sizes.push(0.5 * (slope(left, right) + slope(above, below)).sqrt());
        }
    }
    if sizes.is_empty() {
        return LEAST;
    }
    let at = ((sizes.len() - 1) as f64 * HALF) as usize;
    (*sizes.select_nth_unstable_by(at, f32::total_cmp).1).max(LEAST)
}

impl Edges {
    /// The edges at a curve.
    pub(crate) fn learnt(window: &Window, strips: &Strips<'_>) -> Self {
        let directions = directions(window, strips);
        let n = strips.curve.len();
        let mut edges = Self {
            directions,
            offsets: vec![0.0; n],
        };
        edges.offsets = edges
            .beyond(window, strips, half(window))
            .into_iter()
            .map(|[offset, _]| offset)
            .collect();
        edges
    }

    /// How far out from where it lay in the first frame the edge of each node lies, and how firmly that is known, 0 …
    /// 1; both smoothed along the curve. Cells.
    pub(crate) fn beyond(&self, window: &Window, strips: &Strips<'_>, half: f32) -> Vec<[f64; 2]> {
        let n = strips.curve.len();
        let mut sums = vec![0.0; n];
        let mut weights = vec![0.0; n];
        for i in 0..n {
            let near = NEAR.cast_signed();
            let values: Vec<f64> = (-near..=near)
                .map(|d| f64::from(self.slope(window, strips, i, d as f64 + self.offsets[i])))
                .collect();
            let best = (0..values.len())
                .max_by(|&a, &b| values[a].total_cmp(&values[b]))
                .unwrap_or(NEAR);
            if best > 0 && best + 1 < values.len() {
                let (a, b, c) = (values[best - 1], values[best], values[best + 1]);
                let bent = a - 2.0 * b + c;
                let share = if bent < -1e-9 {
                    (0.5 * (a - c) / bent).clamp(-0.5, 0.5)
                } else {
                    0.0
                };
                let firm = strength(narrow(b), half).powi(2);
                sums[i] = firm * (best as f64 - NEAR as f64 + share);
                weights[i] = firm;
            }
        }
        let (sums, weights) = (ring::along(&sums, CALM), ring::along(&weights, CALM));
        let both = sums.iter().zip(&weights);
        both.map(|(sum, weight)| [sum / (weight + 0.01), weight.sqrt()])
            .collect()
    }

    /// The same for other nodes, at places between these.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "places between nodes"
    )]
    pub(crate) fn respaced(&self, places: &[f64]) -> Self {
        let n = self.directions.len();
        let nearest = |place: &f64| self.directions[place.round() as usize % n];
        Self {
            directions: places.iter().map(nearest).collect(),
            offsets: ring::between(&self.offsets, places),
        }
    }

    /// The slope of the color of its edge so far out from a node, above 0 from inside to outside.
    pub(crate) fn slope(
        &self,
        window: &Window,
        strips: &Strips<'_>,
        node: usize,
        offset: f64,
    ) -> f32 {
        let (p, normal) = (strips.curve[node], strips.normals[node]);
        let place = |d: f64| window.feature(p + d * normal).map(|f| color(&f));
        let (Some(inner), Some(outer)) = (place(offset - 1.0), place(offset + 1.0)) else {
            return 0.0;
        };
        let across = [
            inner[0] - outer[0],
            inner[1] - outer[1],
            inner[2] - outer[2],
        ];
        0.5 * dot(&across, &self.directions[node])
    }

    /// Directions follow those at a later curve.
    pub(crate) fn learn(&mut self, window: &Window, strips: &Strips<'_>, shares: &[f32]) {
        let now = directions(window, strips);
        for ((own, now), share) in self.directions.iter_mut().zip(&now).zip(shares) {
            let mixed: Color = std::array::from_fn(|k| own[k] + share * (now[k] - own[k]));
            *own = unit(mixed);
        }
    }
}

fn directions(window: &Window, strips: &Strips<'_>) -> Vec<Color> {
    let n = strips.curve.len();
    let mean = |node: usize, sign: f64, room: f64| -> Option<Color> {
        let (mut sum, mut count) = ([0.0; 3], 0.0);
        let mut d = DEPTH[0];
        while d <= DEPTH[1] && (d <= room || d < DEPTH[0] + 1.0) {
            if let Some(f) = window.feature(strips.curve[node] + sign * d * strips.normals[node]) {
                let c = color(&f);
                (0..3).for_each(|k| sum[k] += c[k]);
                count += 1.0;
            }
            d += 1.0;
        }
        (count > 0.0).then(|| sum.map(|v: f32| v / count))
    };
    let difference = |i: usize| match (
        mean(i, -1.0, strips.room[i][0]),
        mean(i, 1.0, strips.room[i][1]),
    ) {
        (Some(a), Some(b)) => std::array::from_fn(|k| a[k] - b[k]),
        _ => [0.0; 3],
    };
    let own: Vec<Color> = (0..n).map(difference).collect();
    let channel = |k: usize| -> Vec<f64> {
        let values: Vec<f64> = own.iter().map(|color| f64::from(color[k])).collect();
        ring::along(&values, WIDE)
    };
    let smooth = [channel(0), channel(1), channel(2)];
    (0..n)
        .map(|i| unit(std::array::from_fn(|k| narrow(smooth[k][i]))))
        .collect()
}

#[allow(clippy::cast_possible_truncation, reason = "colors in f32 are enough")]
fn narrow(value: f64) -> f32 {
    value as f32
}
