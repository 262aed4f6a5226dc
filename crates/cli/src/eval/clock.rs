//! The CPU time that some work takes.

/// A clock that counts from when it was started.
#[derive(Debug, Clone, Copy)]
pub(super) struct Clock {
    begin: f64,
    alone: bool,
}

impl Clock {
    /// Start one: of the whole process, or if others work at the same time, of this thread alone.
    pub(super) fn start(alone: bool) -> Self {
        let begin = now(alone);
        Self { begin, alone }
    }

    /// Seconds of CPU since.
    pub(super) fn seconds(self) -> f64 {
        (now(self.alone) - self.begin).max(0.0)
    }
}

#[cfg(unix)]
fn now(alone: bool) -> f64 {
    use rustix::time::{ClockId, clock_gettime};
    let clock = if alone {
        ClockId::ProcessCPUTime
    } else {
        ClockId::ThreadCPUTime
    };
    let time = clock_gettime(clock);
    #[allow(clippy::cast_precision_loss, reason = "below 2^53 seconds")]
    let seconds = time.tv_sec as f64;
    #[allow(clippy::cast_precision_loss, reason = "below 10^9")]
    let rest = time.tv_nsec as f64;
    seconds + 1e-9 * rest
}

/// Seconds by the clock on the wall, where there is no other.
#[cfg(not(unix))]
fn now(_: bool) -> f64 {
    use std::sync::OnceLock;
    use std::time::Instant;
    static BEGIN: OnceLock<Instant> = OnceLock::new();
    BEGIN.get_or_init(Instant::now).elapsed().as_secs_f64()
}
