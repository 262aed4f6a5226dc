//! What makes the steps of a run: one of the given length, or many that are chosen.

use integrator::{Adaptive, Limit, Scheme, SchemeError, Start, State, Stepper, Summary};

use crate::{Certificate, Snake};

/// A stepper of equal steps, or one that chooses them by their error.
#[derive(Debug, Clone)]
pub enum Pace {
    /// Every step as long as the last.
    Fixed(Box<dyn Stepper>),
    /// As many sub-steps as it takes.
    Chosen(Box<Adaptive>),
}

impl Pace {
    /// Steps of `dt` as they are, without a start that loses an order unless `start` says so.
    ///
    /// # Errors
    ///
    /// As [`Scheme::start`].
    pub fn fixed(
        scheme: Scheme,
        snake: &mut Snake,
        state: &State,
        dt: f64,
        start: Start,
    ) -> Result<Self, SchemeError> {
        scheme.start(snake, state, dt, start).map(Self::Fixed)
    }

    /// Steps of `output`, each in as many sub-steps as keep below [`Certificate::limit`] and err by at most
    /// `tolerance`. L.
    ///
    /// # Errors
    ///
    /// As [`Adaptive::new`].
    pub fn chosen(
        scheme: Scheme,
        snake: &mut Snake,
        state: &State,
        output: f64,
        tolerance: f64,
    ) -> Result<Self, SchemeError> {
        let limit = Certificate::limit(snake, scheme);
        let adaptive = Adaptive::new(scheme, snake, state, output, tolerance, limit)?;
        Ok(Self::Chosen(Box::new(adaptive)))
    }

    /// The same with every sub-step shown as a step, as [`Adaptive::each`] says.
    #[must_use]
    pub fn each(self) -> Self {
        match self {
            Self::Chosen(adaptive) => Self::Chosen(Box::new(adaptive.each())),
            fixed @ Self::Fixed(_) => fixed,
        }
    }

    /// The same where `limit` is what made the output step as short as it is.
    #[must_use]
    pub fn cut_by(self, limit: Limit) -> Self {
        match self {
            Self::Chosen(adaptive) => Self::Chosen(Box::new(adaptive.cut_by(limit))),
            fixed @ Self::Fixed(_) => fixed,
        }
    }

    /// The stepper.
    pub fn stepper(&mut self) -> &mut dyn Stepper {
        match self {
            Self::Fixed(stepper) => &mut **stepper,
            Self::Chosen(adaptive) => &mut **adaptive,
        }
    }

    /// What became of sub-steps, where they are chosen.
    #[must_use]
    pub const fn summary(&self) -> Option<&Summary> {
        match self {
            Self::Fixed(_) => None,
            Self::Chosen(adaptive) => Some(adaptive.summary()),
        }
    }
}
