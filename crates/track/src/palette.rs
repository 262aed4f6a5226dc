//! A palette of features: each cell is of the class of its nearest entry, and appearance is a table over classes.

/// Lightness, texture and two of color; the last two are 0 without color.
pub(crate) type Feature = [f32; 4];

/// Entries that are learnt, and rounds of learning.
const LEARNT: usize = 48;
const ROUNDS: usize = 12;

/// The most features that entries are learnt from.
pub(crate) const SAMPLE: usize = 4000;

/// Classes as near as this count as each other. Units of lightness.
const LIKE: f32 = 6.0;

/// Without color, entries of plain lightness for later frames: from, to, step.
const LATTICE: [f32; 3] = [-30.0, 130.0, 8.0];

/// Entries, and how much each counts as others.
#[derive(Debug, Clone)]
pub(crate) struct Palette {
    entries: Vec<Feature>,
    /// Share of a class that counts as each class: rows sum to 1.
    like: Vec<f32>,
}

fn apart(a: &Feature, b: &Feature) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

impl Palette {
    /// Entries learnt from samples (k-means, begun at places far apart by a fixed sequence).
    pub(crate) fn of(sample: &[Feature], color: bool) -> Self {
        let mut entries = begun(sample);
        for _ in 0..ROUNDS {
            let mut sums = vec![[0.0_f32; 5]; entries.len()];
            for one in sample {
                let sum = &mut sums[nearest(&entries, one)];
                sum.iter_mut().zip(one).for_each(|(sum, v)| *sum += v);
                sum[4] += 1.0;
            }
            for (entry, sum) in entries.iter_mut().zip(&sums) {
                if sum[4] > 0.0 {
                    entry
                        .iter_mut()
                        .zip(sum)
                        .for_each(|(v, total)| *v = total / sum4(sum));
                }
            }
        }
        if !color {
            let mut texture: Vec<f32> = sample.iter().map(|one| one[1]).collect();
            texture.sort_by(f32::total_cmp);
            let middle = texture.get(texture.len() / 2).copied().unwrap_or(0.0);
            let mut light = LATTICE[0];
            while light <= LATTICE[1] {
                entries.push([light, middle, 0.0, 0.0]);
                light += LATTICE[2];
            }
        }
        let n = entries.len();
        let mut like = Vec::with_capacity(n * n);
        for a in &entries {
            let row: Vec<f32> = entries
                .iter()
                .map(|b| (-apart(a, b) / (2.0 * LIKE * LIKE)).exp())
                .collect();
            let total: f32 = row.iter().sum();
            like.extend(row.iter().map(|v| v / total));
        }
        Self { entries, like }
    }

    pub(crate) fn len(&self) -> usize {
        self.entries.len()
    }

    pub(crate) fn entries(&self) -> &[Feature] {
        &self.entries
    }

    #[allow(clippy::cast_possible_truncation, reason = "fewer than 80 entries")]
    pub(crate) fn nearest(&self, one: &Feature) -> u8 {
        nearest(&self.entries, one) as u8
    }

    /// Counts of classes, each shared with those like it.
    pub(crate) fn shared(&self, counts: &[f32], out: &mut [f32]) {
        let n = self.len();
        out.fill(0.0);
        for (count, row) in counts.iter().zip(self.like.chunks_exact(n)) {
            if *count > 0.0 {
                out.iter_mut()
                    .zip(row)
                    .for_each(|(out, share)| *out += count * share);
            }
        }
    }
}

const fn sum4(sum: &[f32; 5]) -> f32 {
    sum[4]
}

fn nearest(entries: &[Feature], one: &Feature) -> usize {
    let (mut best, mut least) = (0, f32::INFINITY);
    for (at, entry) in entries.iter().enumerate() {
        let far = apart(entry, one);
        if far < least {
            (best, least) = (at, far);
        }
    }
    best
}

/// Entries to begin with: each far from those before (k-means++ with the numbers of splitmix64).
fn begun(sample: &[Feature]) -> Vec<Feature> {
    let mut entries = Vec::with_capacity(LEARNT);
    let mut away = vec![f32::INFINITY; sample.len()];
    let mut next = sample.first().copied();
    while let Some(last) = next.take() {
        entries.push(last);
        let mut total = 0.0_f64;
        for (away, one) in away.iter_mut().zip(sample) {
            *away = away.min(apart(one, &last));
            total += f64::from(*away);
        }
        if entries.len() == LEARNT || total <= 0.0 {
            break;
        }
        let mut left = field::drawn::uniform(0, entries.len() as u64) * total;
        let chosen = away.iter().position(|away| {
            left -= f64::from(*away);
            left < 0.0
        });
        next = sample.get(chosen.unwrap_or(sample.len() - 1)).copied();
    }
    if entries.is_empty() {
        entries.push([0.0; 4]);
    }
    entries
}
