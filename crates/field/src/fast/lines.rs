//! Arithmetic on whole lines of `f32`, as wide as the processor has it.
//!
//! Every operation is one addition, subtraction or multiplication a lane, in a fixed order, so the result does not
//! depend on the width. All functions are inlined into the dispatched kernel: that is what gives them the wide
//! instructions.

use pulp::Simd;

/// Vectors worked on at once: eight sums in registers hide the latency of an addition.
const UNROLL: usize = 8;

/// Line lengths are multiples of this: one vector of the widest kind.
pub(super) const QUANTUM: usize = 16;

/// Room before and after a line, so that its neighbours one to either side can be read as lines too.
const PAD: usize = 16;

/// A line of a multiple of [`QUANTUM`] numbers that can be read shifted by up to [`PAD`].
#[derive(Debug, Clone, Default)]
pub(super) struct Line(Vec<f32>);

impl Line {
    pub(super) fn zeros(n: usize) -> Self {
        Self(vec![0.0; n + 2 * PAD])
    }

    #[inline(always)]
    pub(super) fn as_mut(&mut self) -> &mut [f32] {
        let n = self.0.len() - 2 * PAD;
        &mut self.0[PAD..PAD + n]
    }

    /// The line as seen from `by` places to the right.
    #[inline(always)]
    pub(super) fn shifted(&self, by: isize) -> &[f32] {
        let n = self.0.len() - 2 * PAD;
        &self.0[PAD.saturating_add_signed(by)..][..n]
    }

    #[inline(always)]
    pub(super) fn as_ref(&self) -> &[f32] {
        self.shifted(0)
    }
}

/// Sums over pairs at distance k · `step` on both sides of `at`, for a whole line at once.
///
/// ```text
/// odd:   out[c] = Σ_{k≥1} w[k−1] · (src[at + c + k·step] − src[at + c − k·step])
/// even:  out[c] = w[0] · src[at + c] + Σ_{k≥1} w[k] · (src[at + c + k·step] + src[at + c − k·step])
/// ```
#[inline(always)]
pub(super) fn filter<S: Simd, const ODD: bool>(
    simd: S,
    src: &[f32],
    at: usize,
    step: usize,
    weights: &[f32],
    out: &mut [f32],
) {
    let n = out.len();
    let (block, half) = (UNROLL * S::F32_LANES, UNROLL / 2 * S::F32_LANES);
    let mut done = 0;
    while n - done >= block {
        filter_block::<S, UNROLL, ODD>(
            simd,
            src,
            at + done,
            step,
            weights,
            &mut out[done..done + block],
        );
        done += block;
    }
    // the last block reaches back over numbers that are done: computing them again is cheaper than a narrow loop
    while n - done > half / 2 && n >= half {
        let from = done.min(n - half);
        let out = &mut out[from..from + half];
        filter_block::<S, { UNROLL / 2 }, ODD>(simd, src, at + from, step, weights, out);
        done = from + half;
    }
    while n > done {
        let out = &mut out[done..done + S::F32_LANES];
        filter_block::<S, 1, ODD>(simd, src, at + done, step, weights, out);
        done += S::F32_LANES;
    }
}

/// [`filter`] for `U` vectors.
#[inline(always)]
fn filter_block<S: Simd, const U: usize, const ODD: bool>(
    simd: S,
    src: &[f32],
    at: usize,
    step: usize,
    weights: &[f32],
    out: &mut [f32],
) {
    let mut sums = [simd.splat_f32s(0.0); U];
    let mut distance = 0;
    let mut weights = weights.iter();
    if !ODD && let Some(&w) = weights.next() {
        let (w, center) = (simd.splat_f32s(w), vectors::<S, U>(src, at));
        for u in 0..U {
            sums[u] = simd.mul_f32s(w, center[u]);
        }
    }
    for &w in weights {
        distance += step;
        let w = simd.splat_f32s(w);
        let (after, before) = (
            vectors::<S, U>(src, at + distance),
            vectors::<S, U>(src, at - distance),
        );
        for u in 0..U {
            let pair = if ODD {
                simd.sub_f32s(after[u], before[u])
            } else {
                simd.add_f32s(after[u], before[u])
            };
            sums[u] = simd.add_f32s(sums[u], simd.mul_f32s(w, pair));
        }
    }
    S::as_mut_simd_f32s(out).0.copy_from_slice(&sums);
}

/// `U` vectors from `at` on.
#[inline(always)]
fn vectors<S: Simd, const U: usize>(src: &[f32], at: usize) -> &[S::f32s] {
    &S::as_simd_f32s(&src[at..at + U * S::F32_LANES]).0[..U]
}

/// `out = a − b`.
#[inline(always)]
pub(super) fn subtract<S: Simd>(simd: S, a: &[f32], b: &[f32], out: &mut [f32]) {
    let (a, b) = (S::as_simd_f32s(a).0, S::as_simd_f32s(b).0);
    for ((o, &a), &b) in S::as_mut_simd_f32s(out).0.iter_mut().zip(a).zip(b) {
        *o = simd.sub_f32s(a, b);
    }
}

/// `out = a + 2 b + c`, or its magnitude.
#[inline(always)]
pub(super) fn average<S: Simd, const MAGNITUDE: bool>(
    simd: S,
    [a, b, c]: [&[f32]; 3],
    out: &mut [f32],
) {
    let (a, b, c) = (
        S::as_simd_f32s(a).0,
        S::as_simd_f32s(b).0,
        S::as_simd_f32s(c).0,
    );
    for (((o, &a), &b), &c) in S::as_mut_simd_f32s(out).0.iter_mut().zip(a).zip(b).zip(c) {
        let sum = simd.add_f32s(simd.add_f32s(a, c), simd.add_f32s(b, b));
        *o = if MAGNITUDE { simd.abs_f32s(sum) } else { sum };
    }
}

/// `out = √(a² + b²)`.
#[inline(always)]
pub(super) fn length<S: Simd>(simd: S, a: &[f32], b: &[f32], out: &mut [f32]) {
    let (a, b) = (S::as_simd_f32s(a).0, S::as_simd_f32s(b).0);
    for ((o, &a), &b) in S::as_mut_simd_f32s(out).0.iter_mut().zip(a).zip(b) {
        *o = simd.sqrt_f32s(simd.add_f32s(simd.mul_f32s(a, a), simd.mul_f32s(b, b)));
    }
}

/// The three lines a 1 2 1 average along a line is made of.
#[inline(always)]
pub(super) fn neighbours(line: &Line) -> [&[f32]; 3] {
    [line.shifted(-1), line.as_ref(), line.shifted(1)]
}
