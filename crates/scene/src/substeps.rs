//! How many sub-steps a run will take at least, where they are chosen while it runs.

use crate::SceneError;
use crate::limits::{MOST_STEPS, MOST_SUBSTEPS};
use crate::scene::Scene;

impl Scene {
    /// Refuse a time between two outputs, or a whole run, that takes more sub-steps than can be meant, even if each is
    /// as long as the scheme allows.
    pub(crate) fn check_substeps(&self) -> Result<(), SceneError> {
        let Some(limit) = self.step_limit().filter(|limit| *limit > 0.0) else {
            return Ok(());
        };
        let plan = &self.plan;
        let (time, key) = match plan.until.time {
            Some(time) if plan.each => (time, "run.time"),
            _ => (plan.dt, "run.output"),
        };
        let most = if plan.each { MOST_STEPS } else { MOST_SUBSTEPS };
        let least = time / limit;
        if least > most as f64 {
            let message = format!(
                "{time} takes {least:.3e} sub-steps or more, the largest stable one being {limit:.6}; it must take at \
                 most {most}"
            );
            return Err(SceneError::key(key, message));
        }
        Ok(())
    }
}
