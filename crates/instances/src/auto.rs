//! Objects of which nothing is known: regions of all sizes and levels, and which of them the picture supports.

use field::Pixels;
use glam::DVec2;
use search::whole::Whole;

use crate::jobs;
use crate::judge::Verdict;
use crate::propose::{Proposal, propose, rests};
use crate::region::Region;
use crate::relief::{Relief, reliefs};
use crate::select::{Choice, select};
use crate::spans::Spans;

/// Worth from which on a region may be an object.
const WORTH: f64 = 0.58;

/// Regions count by this power of the lengths of their borders: by 1 a border within a region is worth having where it
/// is more of an edge than [`WORTH`], by 2 objects are the larger the better.
const SIZE: f64 = 1.3;

/// An object whose contrast is this share of what is usual is worth half as much.
const DIM: f64 = 0.05;

/// Price of an object, as a share of what objects are worth otherwise.
const PRICE: f64 = 0.3;

/// The whole price is paid by objects of this share of the usual contrast; by those of more, with its square less.
const STRONG: f64 = 0.35;

/// From so many pixels on, half a picture tells first whether objects are light or dark.
const LARGE: usize = 1_000_000;

/// Rounds of looking at what the objects chosen leave of other regions.
const ROUNDS: usize = 2;

/// A region that may be an object, in the picture.
#[derive(Debug, Clone)]
pub(crate) struct Candidate {
    pub spans: Spans,
    pub length: f64,
    pub verdict: Verdict,
    /// The number of its scale, and what it is there.
    level: usize,
    region: Region,
}

impl Candidate {
    /// A proposal of one scale in the picture.
    fn of(one: Proposal, level: usize, relief: &Relief, (width, height): (usize, usize)) -> Self {
        let Proposal { region, verdict } = one;
        Self {
            spans: region.spans(relief.times, (height, width)),
            length: (relief.times * verdict.sides) as f64,
            verdict,
            level,
            region,
        }
    }

    /// What it is worth, from 0 to 1, where objects have some contrast.
    fn worth(&self, usual: f64) -> f64 {
        let Verdict {
            edge,
            contrast,
            shape,
            ..
        } = self.verdict;
        edge * shape * contrast / (contrast + DIM * usual)
    }

    /// What it is worth for its size, where objects have some contrast.
    fn gain(&self, usual: f64) -> f64 {
        self.length.powf(SIZE) * (self.worth(usual) - WORTH)
    }

    /// A choice by its worth: what has little contrast counts less, and has to be larger.
    fn choice(&self, usual: f64, price: f64) -> Choice {
        let contrast = self.verdict.contrast;
        let faint = (STRONG * usual / contrast).powi(2).min(1.0);
        Choice {
            spans: self.spans.clone(),
            value: contrast / (contrast + usual) * (self.gain(usual) - price * faint),
        }
    }
}

/// Regions of one polarity at all scales.
#[derive(Debug)]
pub(crate) struct Field {
    size: (usize, usize),
    levels: Vec<Relief>,
    pub all: Vec<Candidate>,
}

/// Regions of all scales that may be objects, lighter than what surrounds them, and darker.
pub(crate) fn fields(pixels: &dyn Pixels) -> [Field; 2] {
    let whole = Whole::new(pixels, 1.0);
    let direction = main_color(&whole);
    let levels = [1.0, -1.0].map(|sign| reliefs(&whole, direction.map(|v| sign * v)));
    let count = levels[0].len();
    // the two of a scale beside each other, the finest first
    let better = better(&levels, pixels.size());
    let found = jobs::map(2 * count, |at| {
        let (side, level) = (at % 2, at / 2);
        if better.is_some_and(|better| better != side) {
            return Vec::new();
        }
        propose(&levels[side][level], level == 0, level + 1 == count)
    });
    let later = found.into_iter().enumerate();
    let size = pixels.size();
    let mut all = [Vec::new(), Vec::new()];
    for (at, list) in later {
        let (side, level) = (at % 2, at / 2);
        let new = list
            .into_iter()
            .map(|one| Candidate::of(one, level, &levels[side][level], size));
        all[side].extend(new);
    }
    let [a, b] = all;
    let [first, second] = levels;
    [(first, a), (second, b)].map(|(levels, all)| Field { size, levels, all })
}

/// Of a large picture, whether objects are lighter or darker, as its half tells.
fn better(levels: &[Vec<Relief>; 2], size: (usize, usize)) -> Option<usize> {
    if size.0 * size.1 < LARGE || levels[0].len() < 3 {
        return None;
    }
    let sums = jobs::map(2, |side| {
        let relief = &levels[side][1];
        let found = propose(relief, true, false).into_iter();
        let all: Vec<Candidate> = found
            .map(|one| Candidate::of(one, 1, relief, size))
            .collect();
        choose(&all).0
    });
    Some(usize::from(sums[1] > sums[0]))
}

impl Field {
    /// The regions without overlap that are worth most: chosen among all, then also among what the chosen leave of
    /// others.
    fn chosen(mut self) -> Vec<Spans> {
        let (_, mut chosen) = choose(&self.all);
        for _ in 0..ROUNDS {
            let more = self.rests(&chosen);
            self.all.extend(more);
            (_, chosen) = choose(&self.all);
        }
        chosen
    }

    /// What chosen regions leave of others.
    fn rests(&self, chosen: &[Spans]) -> Vec<Candidate> {
        let (width, height) = self.size;
        let mut taken = vec![false; width * height];
        for (row, from, to) in chosen.iter().flat_map(|spans| &spans.0) {
            taken[row * width + from..row * width + to].fill(true);
        }
        let count = self.levels.len();
        let found = jobs::map(count, |level| {
            let relief = &self.levels[level];
            let is_taken = |x: usize, y: usize| {
                let middle = |at: usize| relief.times * at + relief.times / 2;
                let (x, y) = (middle(x), middle(y));
                x < width && y < height && taken[y * width + x]
            };
            let own = self.all.iter().filter(|one| one.level == level);
            let regions: Vec<&Region> = own.map(|one| &one.region).collect();
            let list = rests(relief, level + 1 == count, &regions, is_taken).into_iter();
            list.map(|one| Candidate::of(one, level, relief, self.size))
                .collect::<Vec<_>>()
        });
        found.into_iter().flatten().collect()
    }
}

/// The regions without overlap that are worth most.
pub(crate) fn auto(pixels: &dyn Pixels) -> Vec<Spans> {
    let both = fields(pixels);
    let sums = jobs::map(both.len(), |at| choose(&both[at].all).0);
    let [first, second] = both;
    let better = if sums[1] > sums[0] { second } else { first };
    better.chosen()
}

/// The region of each point that is worth most, with the sum of what they are worth.
pub(crate) fn with_points(all: &[Candidate], points: &[DVec2]) -> (f64, Vec<Option<Spans>>) {
    let places = places(points);
    let own: Vec<Candidate> = all
        .iter()
        .filter(|one| only(&one.spans, &places).is_some())
        .cloned()
        .collect();
    let (sum, chosen) = choose(&own);
    let mut out = vec![None; points.len()];
    for spans in chosen {
        if let Some(at) = only(&spans, &places) {
            out[at] = Some(spans);
        }
    }
    (sum, out)
}

/// Points by the pixels they lie in, in rows: row, column and number.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a place in the picture"
)]
fn places(points: &[DVec2]) -> Vec<(usize, usize, usize)> {
    let place = |(at, p): (usize, &DVec2)| {
        let p = p.round().max(DVec2::ZERO);
        (p.y as usize, p.x as usize, at)
    };
    let mut out: Vec<_> = points.iter().enumerate().map(place).collect();
    out.sort_unstable();
    out
}

/// The only one of some points in a region.
fn only(spans: &Spans, places: &[(usize, usize, usize)]) -> Option<usize> {
    let mut found = None;
    for &(row, from, to) in &spans.0 {
        let first = places.partition_point(|one| (one.0, one.1) < (row, from));
        let own = places[first..].iter();
        for &(.., at) in own.take_while(|one| one.0 == row && one.1 < to) {
            if found.is_some() {
                return None;
            }
            found = Some(at);
        }
    }
    found
}

/// Choose among regions, and again when it is known what contrast objects have; with the sum of what they are worth.
fn choose(all: &[Candidate]) -> (f64, Vec<Spans>) {
    let (mut usual, mut price) = (0.0, 0.0);
    let mut chosen = Vec::new();
    for _ in 0..3 {
        let choices: Vec<Choice> = all.iter().map(|one| one.choice(usual, price)).collect();
        chosen = select(&choices);
        let contrast = |at: &usize| (all[*at].verdict.contrast, choices[*at].value);
        usual = middle(chosen.iter().map(contrast).collect());
        let gain = |at: &usize| (all[*at].gain(usual), choices[*at].value);
        price = PRICE * middle(chosen.iter().map(gain).collect());
    }
    let sum = chosen
        .iter()
        .map(|&at| all[at].choice(usual, price).value * all[at].verdict.contrast)
        .sum();
    (
        sum,
        chosen.into_iter().map(|at| all[at].spans.clone()).collect(),
    )
}

/// The number that numbers of half of all weights do not exceed, of numbers with their weights.
fn middle(mut list: Vec<(f64, f64)>) -> f64 {
    list.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = 0.5 * list.iter().map(|(_, weight)| weight.max(0.0)).sum::<f64>();
    let mut sum = 0.0;
    for (number, weight) in list {
        sum += weight.max(0.0);
        if sum >= half {
            return number;
        }
    }
    0.0
}

/// The direction of color in which a picture differs most: the first axis of its covariance, towards the lighter.
fn main_color(whole: &Whole) -> [f64; 3] {
    let channels = whole.channels();
    if channels.len() < 3 {
        return [1.0, 0.0, 0.0];
    }
    let count = channels[0].len() as f64;
    let means: Vec<f64> = channels
        .iter()
        .map(|channel| channel.sum() / count)
        .collect();
    let covariance = |i: usize, j: usize| {
        let both = channels[i].iter().zip(&channels[j]);
        both.map(|(a, b)| (a - means[i]) * (b - means[j]))
            .sum::<f64>()
            / count
    };
    let matrix: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| covariance(i, j)));
    let mut axis = [1.0, 0.1, 0.1];
    for _ in 0..64 {
        let next: [f64; 3] = std::array::from_fn(|i| (0..3).map(|j| matrix[i][j] * axis[j]).sum());
        let length = next.iter().map(|v| v * v).sum::<f64>().sqrt();
        if length <= 0.0 {
            break;
        }
        axis = next.map(|v| v / length);
    }
    if axis[0] < 0.0 {
        axis.map(|v| -v)
    } else {
        axis
    }
}
