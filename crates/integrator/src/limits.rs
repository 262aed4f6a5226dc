//! How large a step may be, and how much damping is critical.
//!
//! An explicit scheme amplifies the stiffest motion once the step is too large for it. For the two
//! schemes of one force a step the border is exact for any profile of mass, damping and stiffness:
//! with both in the middle of the band, "stable" is "a banded matrix is positive definite", and
//! bisection finds where that ends.

use banded::{Band, Dense, Operator};

use crate::{Mode, Scheme, System};

/// Critical damping of a mode, 2 √(μ λ): rest without overshoot, as soon as possible.
///
/// The report says c = 4 for m = k = 1; it is 2 (D22). It differs from mode to mode (D23).
#[must_use]
pub fn critical_damping(mass: f64, stiffness: f64) -> f64 {
    2.0 * (mass * stiffness).sqrt()
}

/// Critical damping of a mode as the report's scheme sees it, 2 √(μ λ) − λ dt (D23).
///
/// Its backward difference takes γ dt / 2 off the mass, so less damping is critical.
#[must_use]
pub fn report_critical_damping(mass: f64, stiffness: f64, dt: f64) -> f64 {
    critical_damping(mass, stiffness) - stiffness * dt
}

/// What an explicit scheme has to cope with at each node besides the elastic force.
#[derive(Debug)]
pub(crate) struct Loads {
    /// Mass; 1 at held nodes.
    pub(crate) mass: Vec<f64>,
    /// Damping; 0 at held nodes.
    pub(crate) damping: Vec<f64>,
    /// Stiffness of penalty contacts; 0 at held nodes.
    pub(crate) contact: Vec<f64>,
    /// Damping of penalty contacts; 0 at held nodes.
    pub(crate) contact_damping: Vec<f64>,
}

impl Loads {
    pub(crate) fn new(system: &dyn System) -> Self {
        let held = system.held();
        let free = |value: f64, i: usize, instead: f64| if held[i] { instead } else { value };
        let (stiffness, damping) = system.contact_stiffness();
        let n = system.len();
        Self {
            mass: (0..n).map(|i| free(system.mass()[i], i, 1.0)).collect(),
            damping: (0..n).map(|i| free(system.damping()[i], i, 0.0)).collect(),
            contact: (0..n).map(|i| free(stiffness, i, 0.0)).collect(),
            contact_damping: (0..n).map(|i| free(damping, i, 0.0)).collect(),
        }
    }
}

/// Whether a step is stable in the report's scheme: 4 M − 2 dt C − dt² K positive definite.
///
/// Internal damping is in C as β K: exact where the body has no tether, which it leaves alone, and else a bound.
fn report_stable(system: &dyn System) -> impl Fn(f64) -> bool {
    let loads = Loads::new(system);
    let late = 2.0 * system.internal_damping();
    move |dt| {
        let diagonal = |i: usize| {
            let damping = loads.damping[i] + loads.contact_damping[i];
            4.0 * loads.mass[i] - 2.0 * dt * damping - dt * dt * loads.contact[i]
        };
        let diagonal: Vec<f64> = (0..loads.mass.len()).map(diagonal).collect();
        positive(system.stiffness(), -dt * (dt + late), &diagonal)
    }
}

/// Whether a step is stable in leapfrog: 4 M − dt² K positive definite, whatever the damping.
///
/// The damping of penalty contacts and of the body itself is evaluated half a step late and does
/// count, as in the report's.
fn leapfrog_stable(system: &dyn System) -> impl Fn(f64) -> bool {
    let loads = Loads::new(system);
    let late = 2.0 * system.internal_damping();
    move |dt| {
        let diagonal = |i: usize| {
            4.0 * loads.mass[i] - 2.0 * dt * loads.contact_damping[i] - dt * dt * loads.contact[i]
        };
        let diagonal: Vec<f64> = (0..loads.mass.len()).map(diagonal).collect();
        positive(system.stiffness(), -dt * (dt + late), &diagonal)
    }
}

/// The largest step of the report's scheme.
pub(crate) fn report(system: &dyn System) -> Option<f64> {
    largest(report_stable(system))
}

/// The largest step of leapfrog.
pub(crate) fn leapfrog(system: &dyn System) -> Option<f64> {
    largest(leapfrog_stable(system))
}

/// Whether one test tells that `dt` is stable, which is most of the time; else the limit must be found.
pub(crate) fn surely_stable(scheme: Scheme, system: &dyn System, dt: f64) -> bool {
    match scheme {
        // a little more than asked, for the rounding of the test
        Scheme::Report => report_stable(system)(dt * (1.0 + 1e-9)),
        Scheme::Leapfrog => leapfrog_stable(system)(dt * (1.0 + 1e-9)),
        _ => false,
    }
}

/// The largest step that is still `stable`, to a relative 1e-13; None if there is no end to it.
pub(crate) fn largest(stable: impl Fn(f64) -> bool) -> Option<f64> {
    let mut low = 1.0;
    if stable(low) {
        // beyond this dt² is not a number to compute with
        while stable(2.0 * low) {
            low *= 2.0;
            if low > 1e150 {
                return None;
            }
        }
    } else {
        while !stable(low) {
            low *= 0.5;
            if low < 1e-150 {
                return Some(0.0);
            }
        }
    }
    let mut high = 2.0 * low;
    while high - low > 1e-13 * low {
        let middle = 0.5 * (low + high);
        if stable(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(low)
}

/// Whether diag(diagonal) + scale · A is positive definite.
///
/// With columns of low rank, the band alone must be as well: a limit may then come out too small,
/// never too large.
pub(crate) fn positive(a: &Operator, scale: f64, diagonal: &[f64]) -> bool {
    let mut band = a.band().clone();
    band.scale(scale);
    band.add_diagonal(diagonal);
    band.is_positive_definite() && (a.columns().is_empty() || keeps_sign(a, scale, &band))
}

/// Whether `band + scale · U S Uᵀ` is positive definite, given that `band` is.
///
/// With `Y = Uᵀ band⁻¹ U = L Lᵀ`, that is whether `I + scale · Lᵀ S L` is.
fn keeps_sign(a: &Operator, scale: f64, band: &Band) -> bool {
    let columns = a.columns();
    let k = columns.len();
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let Ok(factor) = band.factor() else {
        return false;
    };
    let solved: Vec<Vec<f64>> = columns
        .iter()
        .map(|column| {
            let mut z = column.clone();
            factor.solve_scalars(&mut z);
            z
        })
        .collect();
    let y = Dense::from_fn(k, |i, j| {
        0.5 * (dot(&columns[i], &solved[j]) + dot(&columns[j], &solved[i]))
    });
    // Y^½ instead of L: Y's eigenvectors, scaled
    let Ok(root) = y.eigen() else { return false };
    let mut products = Vec::with_capacity(k);
    for column in &solved {
        // U S Uᵀ z = A z − B z
        let (mut whole, mut part) = (vec![0.0; a.len()], vec![0.0; a.len()]);
        a.multiply_scalars_into(column, &mut whole);
        a.band().multiply_scalars_into(column, &mut part);
        products.push(
            whole
                .iter()
                .zip(&part)
                .map(|(w, p)| w - p)
                .collect::<Vec<f64>>(),
        );
    }
    // Zᵀ U S Uᵀ Z = Y S Y; in the eigenvectors q of Y, divided by √(y y'), that is Y^½ S Y^½
    let ysy =
        |i: usize, j: usize| 0.5 * (dot(&solved[i], &products[j]) + dot(&solved[j], &products[i]));
    let entry = |p: usize, q: usize| -> f64 {
        let (vp, vq) = (&root.vectors[p], &root.vectors[q]);
        let mut sum = 0.0;
        for i in 0..k {
            for j in 0..k {
                sum += vp[i] * ysy(i, j) * vq[j];
            }
        }
        let size = (root.values[p] * root.values[q]).sqrt();
        let own = if p == q { 1.0 } else { 0.0 };
        if size > 0.0 {
            own + scale * sum / size
        } else {
            own
        }
    };
    let inner = Dense::from_fn(k, entry);
    let symmetric = Dense::from_fn(k, |i, j| 0.5 * (inner[(i, j)] + inner[(j, i)]));
    symmetric
        .eigen()
        .is_ok_and(|eigen| eigen.values.iter().all(|&v| v > 0.0))
}

/// The largest step with which no mode grows, whatever mode the system may have.
///
/// A mode's stiffness, damping and contact over its mass lie between the least and the largest there
/// are (Rayleigh's quotients), so a grid over that box stands for all of them: exact for uniform mass
/// and damping but for the grid, on the safe side otherwise. Schemes that take the elastic force at
/// the end of the step are only limited by contacts.
pub(crate) fn by_modes(scheme: Scheme, system: &dyn System) -> Option<f64> {
    let loads = Loads::new(system);
    let contact = system.contact_stiffness();
    if matches!(scheme, Scheme::DormandPrince { .. }) {
        return None;
    }
    let explicit = scheme == Scheme::Rk4;
    let inner = system.internal_damping();
    if !explicit && contact == (0.0, 0.0) && inner <= 0.0 {
        return None;
    }
    let scheme = in_rounds(scheme);
    let least = loads
        .mass
        .iter()
        .fold(f64::INFINITY, |least, &m| least.min(m));
    let massless = scheme == Scheme::GradientFlow || least <= 0.0;
    // per mass, or per damping where nothing has mass
    let weight = |i: usize| {
        if massless {
            loads.damping[i]
        } else {
            loads.mass[i]
        }
    };
    let n = loads.mass.len();
    if massless
        && loads
            .damping
            .iter()
            .zip(system.held())
            .any(|(&c, &held)| c <= 0.0 && !held)
    {
        return Some(0.0); // nothing but the elastic force resists the contact, at any step
    }
    let free: Vec<usize> = (0..n).filter(|&i| !system.held()[i]).collect();
    let ends = |value: &dyn Fn(usize) -> f64| {
        let each = free.iter().map(|&i| value(i) / weight(i));
        each.fold((f64::INFINITY, 0.0_f64), |(low, high), v| {
            (low.min(v), high.max(v))
        })
    };
    let (slow, fast) = ends(&|i| loads.damping[i]);
    let (_, slope) = ends(&|i| loads.contact[i]);
    let (_, drag) = ends(&|i| loads.contact_damping[i]);
    let weights: Vec<f64> = (0..n)
        .map(|i| if system.held()[i] { 1.0 } else { weight(i) })
        .collect();
    let stiffest = if system.stiffness().columns().is_empty() {
        banded::largest_eigenvalue(system.stiffness().band(), &weights)
    } else {
        // 4 W − dt² A turns indefinite at dt² = 4 / λ
        let quadruple: Vec<f64> = weights.iter().map(|w| 4.0 * w).collect();
        largest(|dt| positive(system.stiffness(), -dt * dt, &quadruple))
            .map_or(0.0, |dt| 4.0 / (dt * dt))
    };
    if free.is_empty() || !stiffest.is_finite() {
        return None;
    }
    let share = |k: u32, of: u32| f64::from(k) / f64::from(of);
    let stable = |dt: f64, i: u32| {
        // close together at the stiff end, where the border is
        let stiffness = stiffest * (1.0 - share(i, GRID).powi(2));
        (0..=4).all(|j| {
            let damping = slow + (fast - slow) * share(j, 4);
            (0..=4).all(|k| {
                let mode = Mode {
                    mass: 1.0,
                    damping: if massless { 1.0 } else { damping },
                    stiffness,
                    slope: slope * share(k, 4),
                    drag: drag * share(k, 4) + inner * stiffness,
                };
                scheme.growth(mode, dt) <= 1.0 + MARGINAL
            })
        })
    };
    let everywhere = |dt: f64| (0..=GRID).all(|i| stable(dt, i));
    // nearly always the stiffest decides, and all others need one look
    match largest(|dt| stable(dt, 0)) {
        Some(dt) if everywhere(dt) => Some(dt),
        _ => largest(everywhere),
    }
}

/// The scheme whose border stands for one that meets contacts in rounds: rounds end where they no
/// longer approach each other, a little above. A system need not know its contacts' slope either.
fn in_rounds(scheme: Scheme) -> Scheme {
    match scheme {
        Scheme::BackwardEuler | Scheme::LinearlyImplicit => Scheme::Imex,
        Scheme::Gauss4 | Scheme::Radau5 => Scheme::Newmark,
        other => other,
    }
}

/// Stiffnesses tried between the largest and zero.
const GRID: u32 = 64;

/// Growth a step that rounding in the roots of a polynomial can feign: double roots at 1.
const MARGINAL: f64 = 1e-6;
