//! Ctrl-C: the run stops after its step, and what there is by then is written.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether the user has asked for an end.
#[derive(Debug, Clone, Default)]
pub(crate) struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Listen from now on. A second Ctrl-C ends the program at once.
    pub(crate) fn listen() -> Self {
        let stop = Self::default();
        let asked = stop.clone();
        // where nothing can listen, Ctrl-C does what it did
        let _ = ctrlc::set_handler(move || {
            if asked.0.swap(true, Ordering::Relaxed) {
                #[allow(clippy::exit, reason = "the user insists")]
                std::process::exit(130);
            }
        });
        stop
    }

    /// Whether it was asked for.
    pub(crate) fn asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// What is said then.
pub(crate) const STOPPED: &str = "stopped by Ctrl-C: what there was by then is written";
