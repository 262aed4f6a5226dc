//! What one step does to one mode: the stability region of each scheme.
//!
//! In its eigenbasis a linear system is a set of masses on springs. Each scheme is written down here
//! once more for a single one of them, as the matrix of its step; its largest eigenvalue in
//! magnitude says whether the mode grows. The tests hold it against the schemes at work.

use crate::Scheme;
use crate::oscillator::Oscillator;

/// One mode of motion, `μ ü + γ u̇ + λ u = −κ u − c u̇`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    /// μ.
    pub mass: f64,
    /// γ: damping the scheme knows of.
    pub damping: f64,
    /// λ: elastic stiffness.
    pub stiffness: f64,
    /// κ: stiffness in the external force, as the slope of an image or a penalty contact.
    pub slope: f64,
    /// c: damping in the external force.
    pub drag: f64,
}

impl Mode {
    /// A mode without external force.
    #[must_use]
    pub const fn free(mass: f64, damping: f64, stiffness: f64) -> Self {
        Self {
            mass,
            damping,
            stiffness,
            slope: 0.0,
            drag: 0.0,
        }
    }
}

/// The mode in units of the step: `w = dt v`.
#[derive(Clone, Copy)]
struct Scaled {
    a: f64,
    l: f64,
    k: f64,
    q: f64,
}

impl Scaled {
    fn external(self, x: f64, w: f64) -> f64 {
        -self.k * x - self.q * w
    }
}

impl Scheme {
    /// Growth of a mode over one step: the spectral radius of the step, at most 1 where stable.
    ///
    /// For [`Scheme::DormandPrince`] it is that of a sub-step of length `dt`.
    #[must_use]
    pub fn growth(self, mode: Mode, dt: f64) -> f64 {
        let Mode {
            mass,
            damping,
            stiffness,
            slope,
            drag,
        } = mode;
        if self == Self::GradientFlow {
            // γ (x⁺ − x) / dt = −λ x⁺ − κ x − c (x − x₋) / dt
            let s = damping + dt * stiffness;
            let roots = quadratic(-(s - dt * (stiffness + slope) - drag) / s, -drag / s);
            return roots;
        }
        let unit = dt * dt / mass;
        let m = Scaled {
            a: damping * dt / mass,
            l: stiffness * unit,
            k: slope * unit,
            q: drag * dt / mass,
        };
        let Scaled { a, l, k, q } = m;
        match self {
            Self::Report => quadratic(a + q + l + k - 2.0, 1.0 - a - q),
            Self::Leapfrog => {
                let s = 1.0 + 0.5 * a;
                quadratic((q + l + k - 2.0) / s, (1.0 - 0.5 * a - q) / s)
            }
            Self::Rk4 => along_roots(a + q, l + k, |z| polynomial(z, &RK4)),
            Self::DormandPrince { .. } => along_roots(a + q, l + k, |z| polynomial(z, &DP5)),
            Self::BackwardEuler => {
                let s = 1.0 + a + q + l + k;
                quadratic(-(2.0 + a + q) / s, 1.0 / s)
            }
            Self::Imex => {
                let s = 1.0 + a + l;
                quadratic((l + k + q - 1.0) / s - 1.0, (1.0 - q) / s)
            }
            Self::Newmark => radius::<2>(|[x, w]| {
                let push = -l * x + m.external(x + 0.5 * w, w);
                let step = (2.0 * push + 4.0 * w) / (4.0 + 2.0 * a + l);
                [x + step, 2.0 * step - w]
            }),
            Self::GeneralizedAlpha { rho } => alpha(m, rho),
            Self::Sbdf2 => radius::<4>(|[x, before, w, slow]| {
                let d = x - before;
                let push = 2.0 * m.external(x, w) - m.external(before, slow);
                let inertia = 0.75 * d + 0.5 * (4.0 * w - slow) + 0.5 * a * d;
                let step = (push - l * x + inertia) / (2.25 + 1.5 * a + l);
                [x + step, x, 0.5 * (3.0 * step - d), w]
            }),
            Self::LinearlyImplicit => {
                let s = 1.0 + a + l + k;
                quadratic((l + k + q - 1.0) / s - 1.0, (1.0 - q) / s)
            }
            Self::Gauss4 => along_roots(a + q, l + k, |z| {
                over(polynomial(z, &GAUSS), polynomial((-z.0, -z.1), &GAUSS))
            }),
            Self::Radau5 => along_roots(a + q, l + k, |z| {
                over(polynomial(z, &RADAU_ABOVE), polynomial(z, &RADAU_BELOW))
            }),
            // the force at the end sees the velocity before its own kick, and is kept for the next step
            Self::Exact => radius::<3>(|[x, w, push]| {
                let [x, w] = flow(m, [x, w + 0.5 * push], -l * x);
                let push = m.external(x, w);
                [x, w + 0.5 * push, push]
            }),
            Self::Etd2 => {
                let response = Oscillator::new(a, l, 1.0);
                radius::<2>(|[x, w]| {
                    let push = m.external(x, w);
                    let [later, fast] = flow(m, [x, w], push - l * x);
                    let change = m.external(later, fast) - push;
                    [
                        later + response.ramp * change,
                        fast + response.push * change,
                    ]
                })
            }
            Self::GradientFlow => f64::NAN,
        }
    }
}

/// The exact motion over one step under the force `push`.
fn flow(mode: Scaled, [x, w]: [f64; 2], push: f64) -> [f64; 2] {
    let response = Oscillator::new(mode.a, mode.l, 1.0);
    [
        x + response.kick * w + response.push * push,
        response.keep * w + response.kick * push,
    ]
}

/// Generalized-α in units of the step, with `b = dt² a`.
fn alpha(mode: Scaled, rho: f64) -> f64 {
    let Scaled { a, l, .. } = mode;
    let (m, f) = ((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0));
    let (g, beta) = (0.5 - m + f, 0.25 * (1.0 - m + f) * (1.0 - m + f));
    radius::<3>(|[x, w, b]| {
        let drag = (1.0 - f) * ((1.0 - g / beta) * w + (1.0 - 0.5 * g / beta) * b) + f * w;
        let inertia = (1.0 - m) * (w / beta + (0.5 - beta) / beta * b) - m * b;
        let push = -l * x + mode.external(x + (1.0 - f) * w, w) + inertia - a * drag;
        let s = (1.0 - m) / beta + (1.0 - f) * (g / beta * a + l);
        let step = push / s;
        let later = (step - w) / beta - (0.5 - beta) / beta * b;
        [x + step, w + (1.0 - g) * b + g * later, later]
    })
}

const RK4: [f64; 5] = [1.0, 1.0, 1.0 / 2.0, 1.0 / 6.0, 1.0 / 24.0];
const DP5: [f64; 7] = [
    1.0,
    1.0,
    1.0 / 2.0,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 600.0,
];

const GAUSS: [f64; 3] = [1.0, 1.0 / 2.0, 1.0 / 12.0];
const RADAU_ABOVE: [f64; 3] = [1.0, 2.0 / 5.0, 1.0 / 20.0];
const RADAU_BELOW: [f64; 4] = [1.0, -3.0 / 5.0, 3.0 / 20.0, -1.0 / 60.0];

/// A complex number, as far as it is needed here.
type Pair = (f64, f64);

fn times(p: Pair, q: Pair) -> Pair {
    (p.0 * q.0 - p.1 * q.1, p.0 * q.1 + p.1 * q.0)
}

fn over(p: Pair, q: Pair) -> Pair {
    let size = q.0 * q.0 + q.1 * q.1;
    let (re, im) = times(p, (q.0, -q.1));
    (re / size, im / size)
}

fn polynomial(z: Pair, coefficients: &[f64]) -> Pair {
    coefficients.iter().rev().fold((0.0, 0.0), |sum, &c| {
        let (re, im) = times(sum, z);
        (re + c, im)
    })
}

/// Largest |R(z)| over the two roots of z² + a z + l = 0.
fn along_roots(a: f64, l: f64, growth: impl Fn(Pair) -> Pair) -> f64 {
    let size = |z: Pair| {
        let (re, im) = growth(z);
        re.hypot(im)
    };
    let square = 0.25 * a * a - l;
    if square < 0.0 {
        return size((-0.5 * a, (-square).sqrt()));
    }
    let fast = -0.5 * a - square.sqrt();
    let slow = if fast < 0.0 { l / fast } else { 0.0 };
    size((fast, 0.0)).max(size((slow, 0.0)))
}

/// Largest magnitude of the roots of z² + p z + q.
fn quadratic(p: f64, q: f64) -> f64 {
    let square = 0.25 * p * p - q;
    if square < 0.0 {
        q.abs().sqrt()
    } else {
        0.5 * p.abs() + square.sqrt()
    }
}

/// Spectral radius of a linear map of `N` numbers.
fn radius<const N: usize>(step: impl Fn([f64; N]) -> [f64; N]) -> f64 {
    let mut matrix = [[0.0; N]; N];
    for j in 0..N {
        let mut unit = [0.0; N];
        unit[j] = 1.0;
        let column = step(unit);
        for i in 0..N {
            matrix[i][j] = column[i];
        }
    }
    // Faddeev and Le Verrier: the characteristic polynomial, from the highest power down
    let mut coefficients = [0.0; N];
    let mut power = [[0.0; N]; N];
    for k in 0..N {
        let last = if k == 0 { 1.0 } else { coefficients[k - 1] };
        for (i, row) in power.iter_mut().enumerate() {
            row[i] += last;
        }
        let mut product = [[0.0; N]; N];
        for i in 0..N {
            for j in 0..N {
                product[i][j] = (0..N).map(|m| matrix[i][m] * power[m][j]).sum();
            }
        }
        power = product;
        let trace: f64 = (0..N).map(|i| power[i][i]).sum();
        coefficients[k] = -trace / (k + 1) as f64;
    }
    if N == 2 {
        return quadratic(coefficients[0], coefficients[1]);
    }
    largest_root(&coefficients)
}

/// Largest magnitude of the roots of z^N + c₀ z^(N−1) + … by Durand and Kerner's iteration.
fn largest_root<const N: usize>(coefficients: &[f64; N]) -> f64 {
    let value = |z: Pair| {
        coefficients.iter().fold((1.0, 0.0), |sum, &c| {
            let (re, im) = times(sum, z);
            (re + c, im)
        })
    };
    let bound = 1.0
        + coefficients
            .iter()
            .fold(0.0_f64, |most, c| most.max(c.abs()));
    let mut roots = [(0.0, 0.0); N];
    let mut root = (0.4, 0.9);
    for slot in &mut roots {
        *slot = (bound.min(2.0) * root.0, bound.min(2.0) * root.1);
        root = times(root, (0.4, 0.9));
    }
    for _ in 0..200 {
        let mut moved = 0.0_f64;
        for i in 0..N {
            let mut below = (1.0, 0.0);
            for j in (0..N).filter(|&j| j != i) {
                below = times(below, (roots[i].0 - roots[j].0, roots[i].1 - roots[j].1));
            }
            let size = below.0 * below.0 + below.1 * below.1;
            if size <= 0.0 {
                continue;
            }
            let (re, im) = times(value(roots[i]), (below.0, -below.1));
            let change = (re / size, im / size);
            roots[i] = (roots[i].0 - change.0, roots[i].1 - change.1);
            moved = moved.max(change.0.abs() + change.1.abs());
        }
        if moved < 1e-15 {
            break;
        }
    }
    roots.iter().map(|z| z.0.hypot(z.1)).fold(0.0, f64::max)
}
