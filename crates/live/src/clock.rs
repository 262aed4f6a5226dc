//! The clock of an engine: how many steps are due, and sessions that are replayed.

use crate::LiveError;
use crate::engine::Engine;
use crate::session::Session;
use crate::stage::Stage;

/// Milliseconds that steps may take in one tick, so that a page stays quick to answer.
const BUDGET: f64 = 10.0;

/// A clock that was away for longer has stood still. Milliseconds.
const LONGEST: f64 = 100.0;

/// A session that is being replayed.
#[derive(Debug, Clone)]
pub(crate) struct Replay {
    pub(crate) session: Session,
    next: usize,
}

impl Engine {
    /// So many milliseconds have passed, and the last tick took so many: make the steps that are due, but no more than
    /// a page can wait for. Whether there is something new to be drawn.
    pub fn tick(&mut self, passed: f64, took: f64) -> bool {
        if self.made > 0 && took.is_finite() && took >= 0.0 {
            let each = took.max(0.01) / f64::from(self.made);
            // not at once, since a single tick may have been held up
            let wanted = (BUDGET / each).clamp(1.0, 1e5);
            self.most = (0.5 * (self.most + wanted)).max(1.0);
        }
        self.made = 0;
        let most = whole(self.most);
        if self.replay.is_some() {
            self.go_on_replaying(most);
        } else if self.playing && self.stage.moves() {
            let passed = if passed.is_finite() {
                passed.clamp(0.0, LONGEST)
            } else {
                0.0
            };
            let due = passed / 1000.0 * self.speed * self.stage.pace();
            self.owed += due;
            let steps = whole(self.owed).min(most);
            for _ in 0..steps {
                self.made += 1;
                if !self.step() {
                    break;
                }
                self.session.steps += 1;
            }
            let done = f64::from(self.made);
            if due > 0.0 {
                let share = (done / due).min(1.0);
                // steps rarer than ticks are no delay
                if due >= 1.0 || self.owed >= 2.0 {
                    self.reached += 0.1 * (share - self.reached);
                }
            }
            self.owed -= done;
            if self.owed > f64::from(most) {
                self.owed = 0.0;
            }
            if !self.stage.moves() {
                self.playing = false;
                self.revision += 1;
                self.changed = true;
            }
        } else if self.playing && !matches!(self.stage, Stage::Scene(_)) {
            self.playing = false;
            self.changed = true;
        }
        std::mem::take(&mut self.changed)
    }

    /// Begin to replay a session; ticks carry it on.
    ///
    /// # Errors
    ///
    /// None today; a session that can be read can be begun.
    pub fn open_session(&mut self, session: Session) {
        // a page must not take it for what was open before
        let opened = self.opened + 1;
        *self = Self::new();
        self.opened = opened;
        self.replay = Some(Replay { session, next: 0 });
    }

    /// Replay a session at once, as long as `go_on` says so, which is asked every hundred steps.
    ///
    /// # Errors
    ///
    /// A message of it that cannot be carried out.
    pub fn replay(
        &mut self,
        session: &Session,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<(), LiveError> {
        self.open_session(session.clone());
        while self.replay.is_some() && go_on() {
            self.replay_steps(100)?;
        }
        Ok(())
    }

    fn go_on_replaying(&mut self, most: u32) {
        if self.replay_steps(most).is_err() {
            self.replay = None;
        }
        self.changed = true;
    }

    /// Carry a replay on by at most so many steps.
    fn replay_steps(&mut self, most: u32) -> Result<(), LiveError> {
        let Some(mut replay) = self.replay.take() else {
            return Ok(());
        };
        let mut left = most;
        // opening something begins the count anew: the messages tell of steps since then
        loop {
            let next = replay.session.messages.get(replay.next);
            let goal = next.map_or(replay.session.steps, |said| said.at);
            if self.session.steps < goal {
                if left == 0 {
                    self.replay = Some(replay);
                    return Ok(());
                }
                left -= 1;
                self.made += 1;
                if !self.step() {
                    return Err(LiveError::new(format!(
                        "the session goes on after step {} of {goal}, and nothing moves there",
                        self.session.steps
                    )));
                }
                self.session.steps += 1;
                continue;
            }
            let Some(said) = next.cloned() else {
                self.playing = false;
                return Ok(());
            };
            replay.next += 1;
            self.carry_out(&said.action, &said.file)?;
        }
    }
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "from 0 to 1e6"
)]
fn whole(steps: f64) -> u32 {
    steps.clamp(0.0, 1e6) as u32
}
