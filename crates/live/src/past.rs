//! States of a run that has gone by, so that one can step back.

use std::collections::VecDeque;
use std::sync::Arc;

use crate::sandbox::Sandbox;

/// States that are kept at most.
const MOST: usize = 48;

/// Moments of a run. Between two of them it is run again, which leads to the same bytes.
#[derive(Debug, Clone)]
pub(crate) struct Past {
    kept: VecDeque<Arc<Sandbox>>,
    /// A state is kept every so many steps.
    every: u64,
}

impl Default for Past {
    fn default() -> Self {
        Self {
            kept: VecDeque::new(),
            every: 1,
        }
    }
}

impl Past {
    /// A run has come to this state by a step.
    pub(crate) fn stepped(&mut self, now: &Sandbox) {
        if now.steps().is_multiple_of(self.every) {
            self.keep(now);
        }
    }

    /// A run begins at this state, or goes on from it after a change.
    pub(crate) fn changed(&mut self, now: &Sandbox) {
        let same = |last: &Arc<Sandbox>| last.steps() >= now.steps();
        while self.kept.back().is_some_and(same) {
            self.kept.pop_back();
        }
        self.keep(now);
    }

    fn keep(&mut self, now: &Sandbox) {
        self.kept.push_back(Arc::new(now.clone()));
        if self.kept.len() > MOST {
            self.every *= 2;
            let mut index = 0;
            let last = self.kept.len() - 1;
            self.kept.retain(|_| {
                let keep = index == 0 || index == last || index % 2 == 1;
                index += 1;
                keep
            });
        }
    }

    /// The state at that step, or the first that is known.
    pub(crate) fn at(&mut self, step: u64) -> Option<Sandbox> {
        while self.kept.len() > 1 && self.kept.back().is_some_and(|last| last.steps() > step) {
            self.kept.pop_back();
        }
        let mut state = Sandbox::clone(self.kept.back()?);
        while state.steps() < step && state.step() {}
        Some(state)
    }
}
