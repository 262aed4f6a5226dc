//! Why sub-steps are as long as they are, in words.

use std::fmt;

use crate::{Scheme, System};

/// A step no sub-step may reach, and what sets it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// The largest stable step. T.
    pub dt: f64,
    /// What is unstable beyond: "the elastic force", "the slope of the picture", "a contact".
    pub of: &'static str,
}

impl Limit {
    /// The limit of a scheme on a system as it is now; None where any step is stable.
    ///
    /// Elastic force, damping and penalty contacts count, the slope of a picture does not: whoever knows it
    /// takes the smaller of the two by [`tighter`](Self::tighter).
    #[must_use]
    pub fn of(scheme: Scheme, system: &dyn System) -> Option<Self> {
        let dt = scheme.step_limit(system)?;
        let of = if system.contact_stiffness() == (0.0, 0.0) {
            "the elastic force"
        } else {
            "the elastic force and the contacts"
        };
        Some(Self { dt, of })
    }

    /// The smaller of two.
    #[must_use]
    pub fn tighter(a: Option<Self>, b: Option<Self>) -> Option<Self> {
        match (a, b) {
            (Some(a), Some(b)) => Some(if b.dt < a.dt { b } else { a }),
            (one, other) => one.or(other),
        }
    }
}

/// What held a sub-step down.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Reason {
    /// Nothing: it is as long as the output allows.
    Output,
    /// A longer one would not be stable.
    Stability(Limit),
    /// A longer one would err by more than the tolerance.
    Accuracy,
    /// The same, because something was touched.
    Contact,
    /// It met a tolerance out of reach: it is as short as a sub-step may be.
    Floor,
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Output => f.write_str("as long as the output allows"),
            Self::Stability(Limit { dt, of }) => {
                write!(f, "below {dt:.3e}, the stability limit of {of}")
            }
            Self::Accuracy => f.write_str("a longer one would err by more than the tolerance"),
            Self::Contact => f.write_str("something is touched, and a longer one would err more"),
            Self::Floor => f.write_str("as short as a sub-step may be; the tolerance is not met"),
        }
    }
}

/// What became of a run's sub-steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// Sub-steps the state was moved by.
    pub made: u64,
    /// Sub-steps made for the estimate of the error alone, those of refused pairs included.
    pub spent: u64,
    /// Pairs that erred too much and were made again.
    pub refused: u64,
    /// Length of the shortest one. T.
    pub shortest: f64,
    /// Length of the longest one. T.
    pub longest: f64,
    /// Sub-steps held by the output, stability, accuracy, contacts, the floor.
    pub held_by: [u64; 5],
    /// The reason of the last one.
    pub reason: Reason,
}

impl Summary {
    pub(crate) const fn new() -> Self {
        Self {
            made: 0,
            spent: 0,
            refused: 0,
            shortest: f64::INFINITY,
            longest: 0.0,
            held_by: [0; 5],
            reason: Reason::Output,
        }
    }

    /// Two sub-steps of length `dt` were made.
    pub(crate) fn count(&mut self, dt: f64, reason: Reason) {
        self.made += 2;
        self.spent += 1;
        self.shortest = self.shortest.min(dt);
        self.longest = self.longest.max(dt);
        self.reason = reason;
        let which = match reason {
            Reason::Output => 0,
            Reason::Stability(_) => 1,
            Reason::Accuracy => 2,
            Reason::Contact => 3,
            Reason::Floor => 4,
        };
        self.held_by[which] += 2;
    }

    /// A pair was refused.
    pub(crate) fn refuse(&mut self) {
        self.spent += 3;
        self.refused += 1;
    }
}

impl fmt::Display for Summary {
    /// `412 sub-steps of 2.5e-3 to 2.0e-2 (12 pairs refused): 300 accuracy, 112 stability`
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.made == 0 {
            return f.write_str("no sub-steps yet");
        }
        write!(
            f,
            "{} sub-steps of {:.3e} to {:.3e} ({} pairs refused), held by",
            self.made, self.shortest, self.longest, self.refused
        )?;
        let names = ["output", "stability", "accuracy", "contacts", "the floor"];
        let mut comma = "";
        for (name, &count) in names.iter().zip(&self.held_by) {
            if count > 0 {
                write!(f, "{comma} {name} {count}")?;
                comma = ",";
            }
        }
        Ok(())
    }
}
