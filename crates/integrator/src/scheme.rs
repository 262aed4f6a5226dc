//! The schemes as data: names, sources, orders, and the one `match` that starts them.

use std::fmt;
use std::str::FromStr;

use crate::collocation::Collocation;
use crate::dormand_prince::DormandPrince;
use crate::euler::{Euler, Rule};
use crate::exact::{Exact, Join};
use crate::leapfrog::Leapfrog;
use crate::linear::LinearlyImplicit;
use crate::newmark::{GeneralizedAlpha, Newmark};
use crate::report::Report;
use crate::rk4::Rk4;
use crate::sbdf2::Sbdf2;
use crate::tableau::Method;
use crate::{SchemeError, Start, State, Stepper, System, limits};

/// Which scheme moves a system through time.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Scheme {
    /// Eq. 3.5 to the letter: backward difference for the damping. Order 1, explicit.
    Report,
    /// Centred differences throughout. Order 2, explicit.
    Leapfrog,
    /// Runge and Kutta's method. Order 4, explicit.
    Rk4,
    /// Sub-steps chosen by their error. Order 5, explicit; the reference.
    DormandPrince {
        /// Error allowed in a sub-step, relative to 1 and to the size of what moves.
        tolerance: f64,
    },
    /// All forces at the end of the step. Order 1.
    BackwardEuler,
    /// Elastic force and damping at the end of the step, external forces at its start. Order 1.
    Imex,
    /// The same without mass: Kass, Witkin and Terzopoulos. Order 1.
    GradientFlow,
    /// Newmark's method with β = ¼, the trapezoidal rule: keeps energy. Order 2.
    Newmark,
    /// Newmark's family with chosen damping of the highest frequencies. Order 2.
    GeneralizedAlpha {
        /// What a step leaves of the fastest motion, from 0 (nothing) to 1 (all).
        rho: f64,
    },
    /// Backward differences, external forces extrapolated. Order 2.
    Sbdf2,
    /// As imex, with the slope of the external force in the matrix. Order 1.
    LinearlyImplicit,
    /// Gauss's collocation with two stages: keeps energy. Order 4.
    Gauss4,
    /// Radau's collocation with three stages: forgets what is too fast. Order 5.
    Radau5,
    /// Each mode exactly, external forces as kicks. No error without them, order 2 with them.
    Exact,
    /// Each mode exactly, external forces linear over the step. Order 2.
    Etd2,
}

/// What there is to say about a scheme.
struct Facts {
    name: &'static str,
    summary: &'static str,
    source: &'static str,
    order: u32,
    cost: &'static str,
}

impl Scheme {
    /// Every scheme, those with a parameter at a usual value of it.
    pub const ALL: &[Self] = &[
        Self::Report,
        Self::Leapfrog,
        Self::Rk4,
        Self::DormandPrince { tolerance: 1e-9 },
        Self::BackwardEuler,
        Self::Imex,
        Self::GradientFlow,
        Self::Newmark,
        Self::GeneralizedAlpha { rho: 0.8 },
        Self::Sbdf2,
        Self::LinearlyImplicit,
        Self::Gauss4,
        Self::Radau5,
        Self::Exact,
        Self::Etd2,
    ];

    const fn facts(self) -> Facts {
        match self {
            Self::Report => Facts {
                name: Report::NAME,
                summary: "the report's: explicit, damping by the backward difference",
                source: "report Eq. 3.5",
                order: 1,
                cost: "one force",
            },
            Self::Leapfrog => Facts {
                name: Leapfrog::NAME,
                summary: "explicit, centred damping: the report's cost, one order more",
                source: "[hairer03]; report Eq. 3.5 with D18 and D21 put right",
                order: 2,
                cost: "one force",
            },
            Self::Rk4 => Facts {
                name: Rk4::NAME,
                summary: "explicit, four stages: smooth motion, no stiffness",
                source: "[kutta01]",
                order: 4,
                cost: "four forces",
            },
            Self::DormandPrince { .. } => Facts {
                name: DormandPrince::NAME,
                summary: "explicit, sub-steps chosen by their error: the reference",
                source: "[dormand80]",
                order: 5,
                cost: "six forces a sub-step",
            },
            Self::BackwardEuler => Facts {
                name: Rule::Backward.name(),
                summary: "all forces at the end of the step: never blows up, damps everything",
                source: "[hairer96] IV.3",
                order: 1,
                cost: "two or more external forces and solves",
            },
            Self::Imex => Facts {
                name: Rule::Imex.name(),
                summary: "elastic force at the end of the step, external at its start",
                source: "[ascher95], the first of the family",
                order: 1,
                cost: "one force, one solve",
            },
            Self::GradientFlow => Facts {
                name: Rule::GradientFlow.name(),
                summary: "downhill without mass, elastic force at the end of the step",
                source: "[kass88] Eq. 19, 20",
                order: 1,
                cost: "one force, one solve",
            },
            Self::Newmark => Facts {
                name: Newmark::NAME,
                summary: "mean acceleration: keeps energy at any step, the external force midway",
                source: "[newmark59]",
                order: 2,
                cost: "one force, one solve",
            },
            Self::GeneralizedAlpha { .. } => Facts {
                name: GeneralizedAlpha::NAME,
                summary: "Newmark's family, with chosen damping of the highest frequencies",
                source: "[chung93]",
                order: 2,
                cost: "one force, one solve",
            },
            Self::Sbdf2 => Facts {
                name: Sbdf2::NAME,
                summary: "backward differences, external forces extrapolated: the workhorse",
                source: "[ascher95]",
                order: 2,
                cost: "one force, one solve",
            },
            Self::LinearlyImplicit => Facts {
                name: LinearlyImplicit::NAME,
                summary: "the image's slope in the matrix too: large steps on stiff edges",
                source: "[baraff98]",
                order: 1,
                cost: "one force and its slope, one factor of a wider band",
            },
            Self::Gauss4 => Facts {
                name: Method::Gauss4.name(),
                summary: "two stages by one complex solve: accurate, keeps energy",
                source: "[hairer96] IV.5",
                order: 4,
                cost: "one complex solve and two external forces a round, two rounds or more",
            },
            Self::Radau5 => Facts {
                name: Method::Radau5.name(),
                summary: "three stages by a real and a complex solve: accurate however stiff",
                source: "[hairer96] IV.8",
                order: 5,
                cost: "a real and a complex solve, three external forces a round, two or more",
            },
            Self::Exact => Facts {
                name: Join::Kicks.name(),
                summary: "every mode exactly, at any step; external forces as kicks",
                source: "[strang68]; modes after [davis79]",
                order: 2,
                cost: "one force, two transforms there and two back: O(n log n), or O(n²)",
            },
            Self::Etd2 => Facts {
                name: Join::Ramp.name(),
                summary: "every mode exactly; constant external forces exactly as well",
                source: "[cox02]",
                order: 2,
                cost: "two external forces, seven transforms: O(n log n), or O(n²)",
            },
        }
    }

    /// Its name in scene files and on the command line, without its parameter.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.facts().name
    }

    /// What it is, in one line.
    #[must_use]
    pub const fn summary(self) -> &'static str {
        self.facts().summary
    }

    /// Where it comes from: the report, or a key of the bibliography.
    #[must_use]
    pub const fn source(self) -> &'static str {
        self.facts().source
    }

    /// Order of its error: halving the step divides it by 2 to this power.
    #[must_use]
    pub const fn order(self) -> u32 {
        self.facts().order
    }

    /// What a step costs, O(n) all of it unless it says otherwise.
    #[must_use]
    pub const fn cost(self) -> &'static str {
        self.facts().cost
    }

    /// Its parameter, if it has one.
    #[must_use]
    pub const fn parameter(self) -> Option<f64> {
        match self {
            Self::DormandPrince { tolerance } => Some(tolerance),
            Self::GeneralizedAlpha { rho } => Some(rho),
            _ => None,
        }
    }

    /// The same scheme with another parameter; unchanged if it has none.
    #[must_use]
    pub const fn with_parameter(self, value: f64) -> Self {
        match self {
            Self::DormandPrince { .. } => Self::DormandPrince { tolerance: value },
            Self::GeneralizedAlpha { .. } => Self::GeneralizedAlpha { rho: value },
            other => other,
        }
    }

    /// The largest stable step; None if any step is stable.
    ///
    /// Counts elastic forces, damping and penalty contacts of the system as it is now; the slope of
    /// an image is not in it. O(n) a test, about fifty tests.
    #[must_use]
    pub fn step_limit(self, system: &dyn System) -> Option<f64> {
        match self {
            Self::Report => limits::report(system),
            Self::Leapfrog => limits::leapfrog(system),
            _ => limits::by_modes(self, system),
        }
    }

    /// Refuse a step that is no step, or not below the largest stable one unless `force`d.
    ///
    /// # Errors
    ///
    /// [`SchemeError::BadStep`], [`SchemeError::AboveLimit`].
    pub fn check(self, system: &dyn System, dt: f64, force: bool) -> Result<(), SchemeError> {
        if !(dt.is_finite() && dt > 0.0) {
            return Err(SchemeError::BadStep { dt });
        }
        if force || limits::surely_stable(self, system, dt) {
            return Ok(());
        }
        match self.step_limit(system) {
            Some(limit) if dt >= limit => Err(SchemeError::AboveLimit {
                scheme: self.name(),
                dt,
                limit,
            }),
            _ => Ok(()),
        }
    }

    /// Put the scheme to work on a system, from a state, with a step.
    ///
    /// A step above [`step_limit`](Self::step_limit) is not refused here but by
    /// [`check`](Self::check), so that a blow-up can be watched.
    ///
    /// # Errors
    ///
    /// Refuses a step that is not finite and above 0, masses and dampings the scheme cannot step
    /// with, lengths that disagree, a start that is not finite, and a matrix without a factor.
    pub fn start(
        self,
        system: &mut dyn System,
        state: &State,
        dt: f64,
        start: Start,
    ) -> Result<Box<dyn Stepper>, SchemeError> {
        Ok(match self {
            Self::Report => Box::new(Report::new(system, state, dt, start)?),
            Self::Leapfrog => Box::new(Leapfrog::new(system, state, dt, start)?),
            Self::Rk4 => Box::new(Rk4::new(system, state, dt)?),
            Self::DormandPrince { tolerance } => {
                Box::new(DormandPrince::new(system, state, dt, tolerance)?)
            }
            Self::BackwardEuler => Box::new(Euler::new(Rule::Backward, system, state, dt)?),
            Self::Imex => Box::new(Euler::new(Rule::Imex, system, state, dt)?),
            Self::GradientFlow => Box::new(Euler::new(Rule::GradientFlow, system, state, dt)?),
            Self::Newmark => Box::new(Newmark::new(system, state, dt)?),
            Self::GeneralizedAlpha { rho } => {
                Box::new(GeneralizedAlpha::new(system, state, dt, rho)?)
            }
            Self::Sbdf2 => Box::new(Sbdf2::new(system, state, dt)?),
            Self::LinearlyImplicit => Box::new(LinearlyImplicit::new(system, state, dt)?),
            Self::Gauss4 => Box::new(Collocation::new(Method::Gauss4, system, state, dt)?),
            Self::Radau5 => Box::new(Collocation::new(Method::Radau5, system, state, dt)?),
            Self::Exact => Box::new(Exact::new(Join::Kicks, system, state, dt)?),
            Self::Etd2 => Box::new(Exact::new(Join::Ramp, system, state, dt)?),
        })
    }
}

impl fmt::Display for Scheme {
    /// The name, and the parameter in parentheses: `generalized-alpha(0.8)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.parameter() {
            Some(value) => write!(f, "{}({value:?})", self.name()),
            None => f.write_str(self.name()),
        }
    }
}

impl FromStr for Scheme {
    type Err = SchemeError;

    /// A name of [`Scheme::ALL`], with another parameter in parentheses if it has one.
    fn from_str(text: &str) -> Result<Self, SchemeError> {
        let (name, parameter) = match text.strip_suffix(')').and_then(|text| text.split_once('(')) {
            Some((name, value)) => (name, value.trim().parse::<f64>().ok()),
            None => (text, None),
        };
        let plain = name.len() == text.len();
        match Self::ALL.iter().find(|scheme| scheme.name() == name.trim()) {
            Some(&scheme) if plain => Ok(scheme),
            Some(&scheme) if scheme.parameter().is_some() && parameter.is_some() => {
                Ok(scheme.with_parameter(parameter.unwrap_or_default()))
            }
            _ => Err(SchemeError::Unknown {
                name: text.to_owned(),
                nearest: nearest(name),
            }),
        }
    }
}

/// The known name with the fewest letters to insert, delete or replace.
fn nearest(text: &str) -> &'static str {
    let names = Scheme::ALL.iter().map(|scheme| scheme.name());
    names
        .min_by_key(|name| distance(name, text))
        .unwrap_or_default()
}

fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, p) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, &q) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(p != q);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}
