//! One damped oscillator, exactly, over any time.
//!
//! Everything an exact step needs is the response `G` to a unit kick, `G̈ + c Ġ + λ G = 0` from
//! `G = 0`, `Ġ = 1`, and its integrals. Written as the textbook does, they lose their digits where
//! roots meet, where a root is nearly zero, and where the step is short; three ways of computing
//! them, each where it is right, do not.

/// Terms of the power series; with `c t ≤ 1` and `λ t² ≤ ½` fewer than twenty matter.
const TERMS: i32 = 24;

/// What `ü + c u̇ + λ u = f` does over a time `t`, for `c ≥ 0` and `λ ≥ 0`.
///
/// ```text
/// u(t) = u + G u̇ + Q a        a = f − c u̇ − λ u at the start, without its damping: a = f − λ u
/// u̇(t) = Ġ u̇ + G a           for constant f
/// u(t) += W f′,  u̇(t) += Q f′   for a force that grows as f′ s
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Oscillator {
    /// G: position from a unit velocity. T.
    pub(crate) kick: f64,
    /// Ġ: what is left of a unit velocity.
    pub(crate) keep: f64,
    /// Q = ∫ G: position from a unit force. T².
    pub(crate) push: f64,
    /// W = ∫ Q: position from a force that grows by one a unit of time. T³.
    pub(crate) ramp: f64,
}

impl Oscillator {
    /// Over a time `t` with damping `c` and stiffness `stiffness`, both per mass.
    ///
    /// All three regimes and the double root, relative accuracy near rounding times the phase
    /// `√λ t`, whatever `t` is.
    pub(crate) fn new(c: f64, stiffness: f64, t: f64) -> Self {
        let drag = c * t;
        let square = stiffness * t * t;
        if drag <= 1.0 && square <= 0.5 {
            Self::series(c, stiffness, t)
        } else if c * c > 8.0 * stiffness {
            Self::roots(c, stiffness, t)
        } else {
            Self::waves(c, stiffness, t)
        }
    }

    /// Short times: the power series of G, term by term integrated.
    fn series(c: f64, stiffness: f64, t: f64) -> Self {
        let (mut kick, mut keep, mut push, mut ramp) = (0.0, 0.0, 0.0, 0.0);
        // terms g[k] t^k of G, from k = 0; only the last two are needed
        let (mut before, mut term) = (0.0, t);
        let mut k = 1.0;
        for _ in 0..TERMS {
            kick += term;
            keep += k * term / t;
            push += term * t / (k + 1.0);
            ramp += term * t * t / ((k + 1.0) * (k + 2.0));
            let next = -(c * t * k * term + stiffness * t * t * before) / (k * (k + 1.0));
            (before, term) = (term, next);
            k += 1.0;
        }
        Self {
            kick,
            keep,
            push,
            ramp,
        }
    }

    /// Two real roots well apart: differences of φ₁ and φ₂ at them.
    fn roots(c: f64, stiffness: f64, t: f64) -> Self {
        let root = (0.25 * c * c - stiffness).sqrt();
        let fast = -0.5 * c - root;
        let slow = stiffness / fast;
        let apart = slow - fast;
        let (p, q) = (slow * t, fast * t);
        Self {
            kick: (p.exp() - q.exp()) / apart,
            keep: (slow * p.exp() - fast * q.exp()) / apart,
            push: t * (phi1(p) - phi1(q)) / apart,
            ramp: t * t * (phi2(p) - phi2(q)) / apart,
        }
    }

    /// Everything else: complex roots, a double root, two real ones close together.
    fn waves(c: f64, stiffness: f64, t: f64) -> Self {
        let half = 0.5 * c * t;
        let square = stiffness * t * t - half * half;
        // cos and sin(ω t)/(ω t), or their hyperbolic sisters, times exp(−c t / 2)
        let (cos, sinc) = if square > 0.0 {
            let phase = square.sqrt();
            let fade = (-half).exp();
            let sinc = if phase < 1e-4 {
                1.0 - square / 6.0
            } else {
                phase.sin() / phase
            };
            (fade * phase.cos(), fade * sinc)
        } else {
            let phase = (-square).sqrt();
            let (up, down) = ((phase - half).exp(), (-phase - half).exp());
            // (eᵖ − e⁻ᵖ) / 2p, without the difference where it would cancel
            let rise = if phase < 1.0 {
                down * phi1(2.0 * phase)
            } else {
                0.5 * (up - down) / phase
            };
            (0.5 * (up + down), rise)
        };
        let kick = t * sinc;
        let keep = cos - half * sinc;
        let push = (1.0 - keep - c * kick) / stiffness;
        Self {
            kick,
            keep,
            push,
            ramp: (t - kick - c * push) / stiffness,
        }
    }
}

/// (eᶻ − 1) / z.
fn phi1(z: f64) -> f64 {
    if z.abs() < 1e-300 {
        1.0
    } else {
        z.exp_m1() / z
    }
}

/// (eᶻ − 1 − z) / z².
fn phi2(z: f64) -> f64 {
    if z.abs() < 0.5 {
        let (mut sum, mut term) = (0.0, 0.5);
        for k in 3..24 {
            sum += term;
            term *= z / f64::from(k);
        }
        sum
    } else {
        (z.exp_m1() - z) / (z * z)
    }
}
