//! The one-dimensional chapter of the report, §4.2.1: signals, three ways to smooth, derivatives, F(x).
//!
//! A signal is a slice; sample `i` here is the report's x = i + 1. Beyond both ends it goes on as its own mirror
//! image, `S(0) = S(1)`. Signals of any length from 0 are accepted.

use crate::grid::mirrored;
use crate::smooth::{binomial_pass, convolve_line, gaussian_weights};
use std::f64::consts::PI;

/// The report's step: 100 samples, 0 up to x = 50 and 1 beyond.
///
/// The edge lies between two samples, at x = 50.5 in the report's count (D46).
#[must_use]
pub fn step() -> Vec<f64> {
    (1..=100).map(|x| if x > 50 { 1.0 } else { 0.0 }).collect()
}

/// The report's box: 100 samples, 1 where 35 < x < 65, else 0.
///
/// Samples 36 … 64 are 1, so the edges lie at 35.5 and 64.5 in the report's count (D46).
#[must_use]
pub fn box_() -> Vec<f64> {
    (1..=100)
        .map(|x| if x > 35 && x < 65 { 1.0 } else { 0.0 })
        .collect()
}

/// Smooths by the Fourier transform: every frequency times the Gaussian's own transform.
///
/// ```text
/// Ŝ(ω) ← Ŝ(ω) · e^(−σ²ω²/2),   ω = πk/n
/// ```
///
/// The mirrored signal's transform is a cosine transform, so one is used; O(n²), plain sums. A `sigma` of 0
/// gives the signal back to rounding. Report §4.2.1, first way.
#[must_use]
pub fn smooth_fourier(signal: &[f64], sigma: f64) -> Vec<f64> {
    let n = signal.len();
    // the cosine's argument is reduced exactly, in whole numbers of π/2n
    let cosine =
        |k: usize, i: usize| (PI * ((k * (2 * i + 1)) % (4 * n)) as f64 / (2 * n) as f64).cos();
    let spectrum: Vec<f64> = (0..n)
        .map(|k| {
            let omega = PI * k as f64 / n as f64;
            let sum: f64 = signal
                .iter()
                .enumerate()
                .map(|(i, s)| s * cosine(k, i))
                .sum();
            sum * (-0.5 * (sigma * omega) * (sigma * omega)).exp()
        })
        .collect();
    (0..n)
        .map(|i| {
            let waves: f64 = (1..n).map(|k| spectrum[k] * cosine(k, i)).sum();
            (spectrum[0] + 2.0 * waves) / n as f64
        })
        .collect()
}

/// Smooths by direct convolution with a sampled Gaussian of σ > 0.
///
/// The weights sum to 1 as a one-dimensional Gaussian's must (D35). For a unit step within e^(−π²σ²/2) of
/// [`smooth_fourier`], which is what sampling a Gaussian costs, and rounding. O(n · σ). Report §4.2.1, second way.
#[must_use]
pub fn smooth_direct(signal: &[f64], sigma: f64) -> Vec<f64> {
    let mut out = vec![0.0; signal.len()];
    convolve_line(signal, &gaussian_weights(sigma), &mut out);
    out
}

/// Smooths by `passes` times the mask [¼ ½ ¼].
///
/// Close to a Gaussian of σ = √(passes/2) (D36): for a unit step within 0.025/`passes`, so 1.25e-3 after the
/// report's twenty. Exact for whole numbers below 2^(53 − 2·passes). O(n · passes). Report §4.2.1, third way.
#[must_use]
pub fn smooth_binomial(signal: &[f64], passes: u32) -> Vec<f64> {
    let mut out = signal.to_vec();
    for _ in 0..passes {
        binomial_pass(&mut out);
    }
    out
}

/// First derivative by the mask [½ 0 −½] as a convolution: `(S(x+1) − S(x−1)) / 2`.
#[must_use]
pub fn first_derivative(signal: &[f64]) -> Vec<f64> {
    at_each(signal, |before, _, after| (after - before) / 2.0)
}

/// Second derivative by the mask [1 −2 1].
///
/// The report's figures 4.2 and 4.3: right for a rising edge, turned round at a falling one.
#[must_use]
pub fn second_derivative(signal: &[f64]) -> Vec<f64> {
    at_each(signal, |before, here, after| before - 2.0 * here + after)
}

/// The force of a smoothed signal: it points to the nearest edge, rising or falling.
///
/// ```text
/// F = d/dx |d(smoothed)/dx|
/// ```
///
/// Report Eq. F = ∇(|∇(G ∗ S)|), figure 4.4. The absolute value has a kink: halfway between two edges the
/// force jumps, and two edges closer than about 12 px repel each other (D47).
#[must_use]
pub fn force(smoothed: &[f64]) -> Vec<f64> {
    let strength: Vec<f64> = first_derivative(smoothed).iter().map(|d| d.abs()).collect();
    first_derivative(&strength)
}

fn at_each(signal: &[f64], stencil: impl Fn(f64, f64, f64) -> f64) -> Vec<f64> {
    let n = signal.len();
    let sample = |i: isize| signal[mirrored(i, n)];
    (0..n.cast_signed())
        .map(|i| stencil(sample(i - 1), sample(i), sample(i + 1)))
        .collect()
}

#[cfg(test)]
mod tests;
