//! What is chosen again and again: damping by its rule, factors by their maps.

/// When to choose again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Renewal {
    /// 0: whenever asked. T.
    every: f64,
    next: f64,
}

impl Renewal {
    /// At `next`, and then whenever so much time has passed.
    pub(crate) const fn every(every: f64, next: f64) -> Self {
        Self { every, next }
    }

    /// Whether it is time.
    pub(crate) fn is_due(&self, t: f64) -> bool {
        self.every <= 0.0 || t >= self.next
    }

    /// The same; and if it is, what comes after is meant from now on.
    pub(crate) fn meet(&mut self, t: f64) -> bool {
        let due = self.is_due(t);
        if due && self.every > 0.0 {
            // counted from the one that was due, so that steps of any length keep the pace
            let missed = ((t - self.next) / self.every).floor();
            self.next = if missed.is_finite() {
                self.next + (missed + 1.0) * self.every
            } else {
                t + self.every
            };
        }
        due
    }
}
