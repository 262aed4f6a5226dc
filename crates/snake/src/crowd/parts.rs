//! Into how many parts a step is cut: by the contacts, and by nodes that have come closer to each other.

use integrator::{Limit, SchemeError, Start, State, Summary};

use super::{Crowd, CrowdError, Timing};
use crate::{Pace, Snake};

/// Share of the contacts' limit that chosen steps have: they err by the square of it.
const RESOLVED: f64 = 0.25;

/// Share of its limit that a cut step has at most.
const BELOW: f64 = 0.9;

/// Sub-steps of a step at most: a curve that needs more is taken for a mistake in the scene.
const MOST: f64 = 1000.0;

impl Crowd {
    /// Cut the step into parts below the limit of the contacts, or refuse it where it may not be cut.
    pub(super) fn cut(&mut self, limit: f64) -> Result<(), CrowdError> {
        let dt = self.timing.dt;
        let most = match self.timing.tolerance {
            Some(_) => RESOLVED * limit,
            None => limit,
        };
        if dt <= most {
            return Ok(());
        }
        let parts = (dt / (RESOLVED * limit)).ceil();
        // more would take longer than anybody waits for one step
        if self.timing.tolerance.is_none() || !(limit > 0.0 && parts < 1e9) {
            return Err(CrowdError::AboveLimit { dt, limit });
        }
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 1 and 1e9"
        )]
        let parts = parts as u64;
        self.parts = parts;
        self.cut = Some(Limit {
            dt: most,
            of: "the contacts between snakes, with a margin to resolve them",
        });
        Ok(())
    }

    /// The length of a part of a step. T.
    pub(super) const fn part(&self) -> f64 {
        self.timing.dt / self.parts as f64
    }

    /// What moves a snake of this crowd, and in how many sub-steps it makes each part of a step.
    ///
    /// Nodes that upkeep has put closer together allow shorter steps only: what the scene began with was
    /// checked, what became of it is cut.
    pub(super) fn pace(
        &self,
        snake: &mut Snake,
        state: &State,
        start: Start,
    ) -> Result<(Pace, u64), SchemeError> {
        let Timing {
            scheme, tolerance, ..
        } = self.timing;
        let Some(tolerance) = tolerance else {
            let cuts = self.cuts(snake)?;
            let dt = self.timing.dt / cuts as f64;
            return Ok((Pace::fixed(scheme, snake, state, dt, start)?, cuts));
        };
        let pace = Pace::chosen(scheme, snake, state, self.part(), tolerance)?;
        let pace = match self.cut {
            Some(limit) => pace.cut_by(limit),
            None => pace,
        };
        Ok((pace, 1))
    }

    /// How many sub-steps keep a step of this snake below its limit, with a margin where it takes more than one.
    fn cuts(&self, snake: &Snake) -> Result<u64, SchemeError> {
        let Timing {
            scheme, dt, force, ..
        } = self.timing;
        let limit = scheme.step_limit(snake).filter(|limit| dt > *limit);
        let Some(limit) = limit.filter(|_| !force) else {
            return Ok(1);
        };
        let cuts = (dt / (BELOW * limit)).ceil();
        if cuts > MOST {
            scheme.check(snake, dt, false)?;
        }
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "from 1 to MOST"
        )]
        let cuts = cuts.min(MOST) as u64;
        Ok(cuts)
    }

    /// Keep what is known of the sub-steps of a stepper that goes.
    pub(super) fn remember(&mut self, k: usize) {
        if let Some(gone) = self.members[k].pace.summary().filter(|s| s.made > 0) {
            let made = self.made.map_or(*gone, |made| made.with(gone));
            self.made = Some(made);
        }
    }

    /// What became of the sub-steps of all members, where they are chosen.
    #[must_use]
    pub fn summary(&self) -> Option<Summary> {
        let members = self.members.iter().filter_map(|m| m.pace.summary());
        let mut all = self.made.iter().chain(members);
        let first = *all.next()?;
        Some(all.fold(first, |sum, more| sum.with(more)))
    }
}
