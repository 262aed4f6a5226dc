//! The engine: it takes messages, runs what is open by a clock, and hands out frames.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use scene::SceneText;
use serde_json::{Value, json};

use crate::LiveError;
use crate::clock::Replay;
use crate::packet::Packet;
use crate::past::Past;
use crate::pictures::Pictures;
use crate::request::{Action, Frames};
use crate::sandbox::Sandbox;
use crate::session::{Said, Session};
use crate::stage::Stage;
use crate::undo::{Before, Gesture, Undo, gesture, is_motion, opens};

/// Steps by one message at most.
const MOST_STEPS: u32 = 100_000;

/// The longest text of a scene, and the largest file. Bytes.
const MOST_TEXT: usize = 1 << 20;
const MOST_FILE: usize = 1 << 29;

/// What frames hold beside positions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Show {
    pub velocities: bool,
    pub forces: bool,
    pub energies: bool,
}

/// Scenes and outlines under the hand of a user. It knows neither sockets nor browsers nor a clock of its own, so that
/// a server, a page and tests drive the same thing.
///
/// ```
/// use live::{Action, Engine};
///
/// let mut engine = Engine::new();
/// engine.perform(&Action::shipped("soft-ball"), &[])?;
/// engine.perform(&Action::Play, &[])?;
/// while engine.steps() < 100 {
///     engine.tick(16.0, 1.0);
/// }
/// // what was done replays to the same bytes
/// let mut other = Engine::new();
/// other.replay(engine.session(), &mut || true)?;
/// assert_eq!(other.bytes(), engine.bytes());
/// # Ok::<(), live::LiveError>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Engine {
    pub(crate) stage: Stage,
    pub(crate) playing: bool,
    pub(crate) speed: f64,
    /// Steps that the clock has asked for and that were not made yet.
    pub(crate) owed: f64,
    /// Steps that a tick may make, and that the last one has made.
    pub(crate) most: f64,
    pub(crate) made: u32,
    /// Share of the speed asked for that is reached.
    pub(crate) reached: f64,
    pub(crate) session: Session,
    undo: Undo,
    past: Past,
    pub(crate) replay: Option<Replay>,
    pub(crate) show: Show,
    /// Whether there is something new to be drawn.
    pub(crate) changed: bool,
    /// Whether something was done that no export holds.
    unsaved: bool,
    /// Counts changes other than motion.
    pub(crate) revision: u64,
    /// Counts what was opened.
    pub(crate) opened: u64,
}

impl Engine {
    /// An engine with nothing open.
    #[must_use]
    pub fn new() -> Self {
        Self {
            speed: 1.0,
            most: 4.0,
            reached: 1.0,
            changed: true,
            ..Self::default()
        }
    }

    /// Carry an action out; `rest` is the file that comes with it, if one does.
    ///
    /// # Errors
    ///
    /// What cannot be done, in a sentence; nothing has changed then.
    pub fn perform(&mut self, action: &Action, rest: &[u8]) -> Result<(), LiveError> {
        self.replay = None;
        self.carry_out(action, &rest.into())
    }

    pub(crate) fn carry_out(&mut self, action: &Action, rest: &Arc<[u8]>) -> Result<(), LiveError> {
        if rest.len() > MOST_FILE {
            return Err(LiveError::new(format!(
                "a file must have at most {MOST_FILE} bytes, got {}",
                rest.len()
            )));
        }
        let gesture = gesture(action);
        let wanted = self.undo.wants(&gesture);
        // what goes on with a gesture is refused before anything has changed
        let kept = wanted || !matches!(gesture, Gesture::None | Gesture::Part(_));
        let before = kept.then(|| Before {
            gesture: gesture.clone(),
            stage: self.stage.clone(),
            past: self.past.clone(),
        });
        let done = self.act(action, rest);
        match (done, before) {
            (Err(error), before) => {
                if let Some(before) = before {
                    (self.stage, self.past) = (before.stage, before.past);
                }
                return Err(error);
            }
            (Ok(()), Some(before)) if wanted && !opens(action) => self.undo.keep(before),
            _ => {}
        }
        self.undo.after(&gesture);
        if opens(action) {
            self.unsaved = false;
        } else if !matches!(gesture, Gesture::None | Gesture::Run) {
            self.unsaved = true;
        }
        // frames that are opened one after the other are one gesture, and each of them counts
        let is_frame = matches!(action, Action::Picture { .. });
        let replaces = !wanted && !is_frame && matches!(gesture, Gesture::Part(_));
        let said = Said {
            at: self.session.steps,
            action: action.clone(),
            file: Arc::clone(rest),
        };
        self.session.say(said, replaces);
        if !is_motion(action) {
            self.revision += 1;
        }
        self.changed = true;
        Ok(())
    }

    fn act(&mut self, action: &Action, rest: &Arc<[u8]>) -> Result<(), LiveError> {
        match action {
            Action::Play => self.playing = true,
            Action::Pause => self.playing = false,
            Action::Step { steps } => {
                self.playing = false;
                for _ in 0..counted(*steps)? {
                    if !self.step() {
                        break;
                    }
                }
            }
            Action::Back { steps } => self.back(counted(*steps)?)?,
            Action::Speed { factor } => {
                if !(1.0 / 64.0..=64.0).contains(factor) {
                    return Err(LiveError::new(format!(
                        "the speed must be from 1/64 to 64, got {factor}"
                    )));
                }
                (self.speed, self.owed) = (*factor, 0.0);
            }
            Action::Undo => self.take_back(true)?,
            Action::Redo => self.take_back(false)?,
            Action::Reset => {
                self.stage = match &self.stage {
                    Stage::Empty => Stage::Empty,
                    Stage::Scene(scene) => Stage::Scene(Box::new(scene.again()?)),
                    Stage::Pictures(pictures) => Stage::Pictures(Box::new(pictures.again()?)),
                };
                self.begin_past();
                self.playing = false;
            }
            Action::Scene { name, text, files } => {
                let text = match text {
                    Some(text) if text.len() > MOST_TEXT => {
                        return Err(LiveError::new(format!(
                            "the text of a scene must have at most {MOST_TEXT} bytes, got {}",
                            text.len()
                        )));
                    }
                    // files that did not come with it are looked for where the program runs; a page by itself has none
                    Some(text) => SceneText::parse(name, text, Path::new("")),
                    None => SceneText::named(name),
                };
                let text = text.map_err(LiveError::of)?;
                let text = text.with_files(separate(files, rest)?);
                self.open(Stage::Scene(Box::new(Sandbox::open(&text)?)));
            }
            Action::Picture { name, frame } => match (&mut self.stage, frame) {
                (Stage::Pictures(pictures), true) => pictures.add_frame(name, rest)?,
                _ => self.open(Stage::Pictures(Box::new(Pictures::open(name, rest)?))),
            },
            Action::Body(change) => {
                let Stage::Scene(scene) = &mut self.stage else {
                    return Err(LiveError::new("this needs an open scene"));
                };
                scene.act(change)?;
                self.begin_past();
            }
            Action::Outline(change) => {
                self.pictures_mut()?.act(change, rest)?;
                self.playing = true;
            }
            Action::Frames(change) => {
                self.pictures_mut()?.frames(change)?;
                self.playing = matches!(change, Frames::Track { .. });
            }
        }
        Ok(())
    }

    fn pictures_mut(&mut self) -> Result<&mut Pictures, LiveError> {
        match &mut self.stage {
            Stage::Pictures(pictures) => Ok(pictures),
            _ => Err(LiveError::new("this needs an open picture")),
        }
    }

    /// Begin anew with what was opened.
    fn open(&mut self, stage: Stage) {
        self.playing = false;
        self.stage = stage;
        self.opened += 1;
        (self.owed, self.most, self.reached) = (0.0, 4.0, 1.0);
        (self.undo, self.past) = (Undo::default(), Past::default());
        self.session = Session::default();
        self.begin_past();
    }

    /// Steps back lead to here at least.
    fn begin_past(&mut self) {
        if let Stage::Scene(scene) = &self.stage {
            self.past.changed(scene);
        }
    }

    /// One step of all that moves.
    pub(crate) fn step(&mut self) -> bool {
        let moved = self.stage.step();
        if moved && let Stage::Scene(scene) = &self.stage {
            self.past.stepped(scene);
        }
        self.changed |= moved;
        moved
    }

    fn back(&mut self, steps: u32) -> Result<(), LiveError> {
        let Stage::Scene(scene) = &mut self.stage else {
            return Err(LiveError::new(
                "only a scene has steps to go back; undo takes a change back",
            ));
        };
        self.playing = false;
        let goal = scene.steps().saturating_sub(u64::from(steps));
        if let Some(state) = self.past.at(goal) {
            **scene = state;
        }
        Ok(())
    }

    fn take_back(&mut self, undo: bool) -> Result<(), LiveError> {
        let now = (self.stage.clone(), self.past.clone());
        let state = if undo {
            self.undo.undo(now)
        } else {
            self.undo.redo(now)
        };
        let Some(state) = state else {
            let what = if undo { "take back" } else { "make again" };
            return Err(LiveError::new(format!("there is nothing to {what}")));
        };
        (self.stage, self.past) = (state.stage, state.past);
        if state.gesture == Gesture::Run || self.undo.counts().0 == 0 {
            self.playing = false;
        }
        Ok(())
    }

    /// What was done since something was opened.
    #[must_use]
    pub const fn session(&self) -> &Session {
        &self.session
    }

    /// Steps made by the clock since something was opened.
    #[must_use]
    pub const fn steps(&self) -> u64 {
        self.session.steps
    }

    /// Whether it runs.
    #[must_use]
    pub const fn is_playing(&self) -> bool {
        self.playing
    }

    /// Whether something was done since all was saved or opened.
    #[must_use]
    pub const fn is_unsaved(&self) -> bool {
        self.unsaved
    }

    /// What there is now is saved, or as it was opened.
    pub const fn saved(&mut self) {
        self.unsaved = false;
    }

    /// Everything that tells two states apart, as bytes.
    #[must_use]
    pub fn bytes(&self) -> Vec<u8> {
        self.stage.bytes()
    }

    /// What is to be drawn now: a [`Packet`] as bytes.
    pub fn frame(&mut self) -> Vec<u8> {
        let mut packet = Packet::default();
        let view = match &self.stage {
            Stage::Empty => Value::Null,
            Stage::Scene(scene) => scene.frame(self.show, &mut packet),
            Stage::Pictures(pictures) => pictures.frame(&mut packet),
        };
        let (undo, redo) = self.undo.counts();
        packet.head = json!({
            "frame": view, "kind": self.stage.kind(), "playing": self.playing, "speed": self.speed,
            "reached": self.reached, "undo": undo, "redo": redo, "revision": self.revision, "opened": self.opened,
            "replaying": self.replay.as_ref().map(|replay| json!([self.session.steps, replay.session.steps])),
        });
        packet.encode()
    }
}

/// A number of steps that one message may ask for.
fn counted(steps: u32) -> Result<u32, LiveError> {
    if (1..=MOST_STEPS).contains(&steps) {
        return Ok(steps);
    }
    Err(LiveError::new(format!(
        "must be from 1 to {MOST_STEPS} steps, got {steps}"
    )))
}

/// Files that came one behind the other, by their names.
fn separate(
    files: &[(String, usize)],
    mut rest: &[u8],
) -> Result<BTreeMap<String, Vec<u8>>, LiveError> {
    let mut out = BTreeMap::new();
    for (name, length) in files {
        let Some((one, more)) = rest.split_at_checked(*length) else {
            let got = rest.len();
            return Err(LiveError::new(format!(
                "{name} must be {length} bytes long, got {got}"
            )));
        };
        out.insert(name.clone(), one.to_vec());
        rest = more;
    }
    if rest.is_empty() {
        return Ok(out);
    }
    let got = rest.len();
    Err(LiveError::new(format!(
        "every file of a scene must have a name, got {got} bytes without one"
    )))
}
