//! The schemes as data: names, sources, orders, and the one `match` that starts them.

use std::fmt;
use std::str::FromStr;

use crate::leapfrog::Leapfrog;
use crate::report::Report;
use crate::{SchemeError, Start, State, Stepper, System, limits};

/// Which scheme moves a system through time.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Scheme {
    /// Eq. 3.5 to the letter: backward difference for the damping. Order 1, explicit.
    Report,
    /// Centred differences throughout. Order 2, explicit.
    Leapfrog,
}

impl Scheme {
    /// Every scheme.
    pub const ALL: &[Self] = &[Self::Report, Self::Leapfrog];

    /// Its name in scene files and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Report => Report::NAME,
            Self::Leapfrog => Leapfrog::NAME,
        }
    }

    /// What it is, in one line.
    #[must_use]
    pub const fn summary(self) -> &'static str {
        match self {
            Self::Report => "the report's: explicit, damping by the backward difference",
            Self::Leapfrog => "explicit, centred damping: the report's cost, one order more",
        }
    }

    /// Where it comes from.
    #[must_use]
    pub const fn source(self) -> &'static str {
        match self {
            Self::Report => "report Eq. 3.5",
            Self::Leapfrog => "[hairer03] §1; report Eq. 3.5 with D18 and D21 put right",
        }
    }

    /// Order of its error: halving the step divides it by 2 to this power.
    #[must_use]
    pub const fn order(self) -> u32 {
        match self {
            Self::Report => 1,
            Self::Leapfrog => 2,
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
        match self.step_limit(system) {
            Some(limit) if dt >= limit && !force => Err(SchemeError::AboveLimit {
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
    /// with, lengths that disagree, and a start that is not finite.
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
        })
    }
}

impl fmt::Display for Scheme {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Scheme {
    type Err = SchemeError;

    fn from_str(text: &str) -> Result<Self, SchemeError> {
        if let Some(&scheme) = Self::ALL.iter().find(|scheme| scheme.name() == text) {
            return Ok(scheme);
        }
        let nearest = Self::ALL
            .iter()
            .map(|scheme| scheme.name())
            .min_by_key(|name| distance(name, text))
            .unwrap_or_default();
        Err(SchemeError::Unknown {
            name: text.to_owned(),
            nearest,
        })
    }
}

/// Letters to insert, delete or replace to turn `a` into `b`.
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
