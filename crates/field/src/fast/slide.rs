//! Symmetric filters over vectors that lie one after the other.
//!
//! A sum over pairs takes two loads for three operations if each sum loads its own pair. But the pairs of neighbouring
//! sums are made of the same vectors, one further on. So several neighbours are summed at a time: the vectors on one
//! side stay in registers, where one comes in as one goes out, and those on the other side are operands in memory. That
//! takes ten registers for four sums, eighteen for eight: more would be moved out and back in.

use super::vector::Lanes;

/// Vectors that [`slide`] reads on either side of those it makes, more than the filter's reach.
pub(super) const SPARE: usize = 1;

/// Sums over pairs on both sides of each of `B` vectors.
///
/// ```text
/// odd:   out[i] = Σ_{k≥1} w[k−1] · (from[c + k] − from[c − k]),                 c = i + reach + SPARE
/// even:  out[i] = w[0] · from[c] + Σ_{k≥1} w[k] · (from[c + k] + from[c − k])
/// ```
///
/// `from` holds `reach` + [`SPARE`] more vectors than there are results at either end. Sums run over k from 1 on,
/// whatever the registers.
#[inline(always)]
pub(super) fn slide_block<L: Lanes, const B: usize, const ODD: bool>(
    lanes: L,
    from: &[L::V],
    weights: &[f32],
) -> [L::V; B] {
    let mut out = [lanes.splat(0.0); B];
    let around = from.len() - B;
    if L::EIGHT_SUMS && B.is_multiple_of(8) {
        for at in (0..B).step_by(8) {
            let sums = block::<L, 8, ODD>(lanes, &from[at..at + 8 + around], weights);
            out[at..at + 8].copy_from_slice(&sums);
        }
    } else {
        for at in (0..B).step_by(4) {
            let sums = block::<L, 4, ODD>(lanes, &from[at..at + 4 + around], weights);
            out[at..at + 4].copy_from_slice(&sums);
        }
    }
    out
}

/// `R` neighbouring sums: the vector of distance k on one side of the first is that of distance k − 1 of the second.
#[inline(always)]
fn block<L: Lanes, const R: usize, const ODD: bool>(
    lanes: L,
    window: &[L::V],
    weights: &[f32],
) -> [L::V; R] {
    let center = window.len() / 2 - R / 2;
    let mut sums = [lanes.splat(0.0); R];
    let Some((&first, pairs)) = weights.split_first() else {
        return sums;
    };
    let w = lanes.splat(first);
    let used = usize::from(ODD);
    // where the vectors of the first pair lie that is not the first weight's
    let (left, right) = (center - used, center + used + 1);
    let (lefts, rest) = window.split_at(left);
    let (before, _) = rest.split_at(R);
    for j in 0..R {
        let first = if ODD {
            lanes.sub(window[center + 1 + j], before[j])
        } else {
            before[j]
        };
        sums[j] = lanes.mul(w, first);
    }
    let (now, rights) = window[right..].split_at(R);
    let mut right = [w; R];
    right.copy_from_slice(now);
    let Some(mut high) = before.first_chunk::<R>() else {
        return sums;
    };
    let (many, few) = pairs.as_chunks::<R>();
    let (afters, after_few) = rights.as_chunks::<R>();
    let (_, befores) = lefts.as_rchunks::<R>();
    for ((w, after), low) in many.iter().zip(afters).zip(befores.iter().rev()) {
        for t in 0..R {
            let w = lanes.splat(w[t]);
            for j in 0..R {
                let left = if j > t {
                    high[j - t - 1]
                } else {
                    low[R - 1 - t + j]
                };
                let pair = pair::<L, ODD>(lanes, right[(j + t) % R], left);
                sums[j] = lanes.add(sums[j], lanes.mul(w, pair));
            }
            right[t] = after[t];
        }
        high = low;
    }
    // what is left of the weights, fewer than R
    let done = R * many.len();
    let lefts = &window[left - done - few.len()..][..few.len() + R];
    for (t, &w) in few.iter().enumerate() {
        let w = lanes.splat(w);
        let lefts = &lefts[few.len() - 1 - t..][..R];
        for j in 0..R {
            let pair = pair::<L, ODD>(lanes, right[j], lefts[j]);
            sums[j] = lanes.add(sums[j], lanes.mul(w, pair));
        }
        for j in 1..R {
            right[j - 1] = right[j];
        }
        right[R - 1] = after_few[t];
    }
    sums
}

#[inline(always)]
fn pair<L: Lanes, const ODD: bool>(lanes: L, right: L::V, left: L::V) -> L::V {
    if ODD {
        lanes.sub(right, left)
    } else {
        lanes.add(right, left)
    }
}
