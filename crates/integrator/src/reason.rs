//! Why sub-steps are as long as they are, in words.

use std::fmt;

use crate::{DormandPrince, Scheme, System};

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
            if system.internal_damping() > 0.0 {
                "the elastic force and internal damping"
            } else {
                "the elastic force"
            }
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
    /// Pairs, or sub-steps of a scheme that chooses its own, that erred too much and were made again.
    pub refused: u64,
    /// Length of the shortest one. T.
    pub shortest: f64,
    /// Length of the longest one. T.
    pub longest: f64,
    /// Sub-steps held by the output, stability, accuracy, contacts, the floor.
    pub held_by: [u64; 5],
    /// The reason of the last one.
    pub reason: Reason,
    /// What no sub-step may reach, and what sets it; None where any is stable.
    pub limit: Option<Limit>,
}

impl Summary {
    /// Of no sub-steps yet, none of which may reach `limit`.
    #[must_use]
    pub const fn new(limit: Option<Limit>) -> Self {
        Self {
            limit,
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

    /// What a scheme says that chooses its own.
    pub(crate) fn take(&mut self, own: &DormandPrince) {
        let (made, refused) = own.counts();
        let (shortest, longest, cut) = own.lengths();
        (self.made, self.spent, self.refused) = (made, refused, refused);
        (self.shortest, self.longest) = (shortest, longest);
        self.reason = if cut > self.held_by[0] {
            Reason::Output
        } else {
            Reason::Accuracy
        };
        self.held_by = [cut, 0, made - cut, 0, 0];
    }

    /// What became of the sub-steps of several runs together: those of `other` come last.
    #[must_use]
    pub fn with(&self, other: &Self) -> Self {
        let mut held_by = self.held_by;
        for (sum, more) in held_by.iter_mut().zip(other.held_by) {
            *sum += more;
        }
        Self {
            made: self.made + other.made,
            spent: self.spent + other.spent,
            refused: self.refused + other.refused,
            shortest: self.shortest.min(other.shortest),
            longest: self.longest.max(other.longest),
            held_by,
            reason: other.reason,
            limit: Limit::tighter(self.limit, other.limit),
        }
    }

    /// A pair was refused.
    pub(crate) fn refuse(&mut self) {
        self.spent += 3;
        self.refused += 1;
    }
}

impl fmt::Display for Summary {
    /// `412 sub-steps of 2.5e-3 to 2.0e-2 (12 refused), held by stability 112, accuracy 300; none may reach
    /// 2.1e-2, the stability limit of the elastic force`
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.made == 0 {
            return f.write_str("no sub-steps yet");
        }
        write!(
            f,
            "{} sub-steps of {:.3e} to {:.3e} ({} refused), held by",
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
        match self.limit {
            Some(Limit { dt, of }) => {
                write!(f, "; none may reach {dt:.3e}, the stability limit of {of}")
            }
            None => Ok(()),
        }
    }
}
