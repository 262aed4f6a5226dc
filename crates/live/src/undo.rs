//! What can be taken back: the state before each change.

use crate::past::Past;
use crate::request::{Action, Body, Frames, Outline};
use crate::stage::Stage;

/// States that are kept at most.
const MOST: usize = 200;

/// What a change belongs to: changes of one gesture are taken back together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Gesture {
    /// Nothing that could be taken back.
    None,
    /// The run goes on, or back.
    Run,
    /// Part of the gesture of that name, as long as no other comes between.
    Part(String),
    /// The end of the gesture before it.
    End,
    /// A change of its own.
    Whole,
}

/// A state before a change.
#[derive(Debug, Clone)]
pub(crate) struct Before {
    pub gesture: Gesture,
    pub stage: Stage,
    pub past: Past,
}

/// States that can be returned to.
#[derive(Debug, Clone, Default)]
pub(crate) struct Undo {
    done: Vec<Before>,
    undone: Vec<Before>,
    /// Whether the last gesture may go on.
    open: bool,
}

impl Undo {
    /// Whether the state before a change of that gesture is to be kept.
    pub(crate) fn wants(&self, gesture: &Gesture) -> bool {
        match gesture {
            Gesture::None | Gesture::End => false,
            Gesture::Whole => true,
            Gesture::Run => self
                .done
                .last()
                .is_none_or(|last| last.gesture != Gesture::Run),
            Gesture::Part(_) => {
                !(self.open
                    && self
                        .done
                        .last()
                        .is_some_and(|last| last.gesture == *gesture))
            }
        }
    }

    /// Keep a state before a change that was made.
    pub(crate) fn keep(&mut self, before: Before) {
        self.undone.clear();
        self.done.push(before);
        if self.done.len() > MOST {
            // the first of all stays, so that all can be taken back
            self.done.remove(1);
        }
    }

    /// A change of that gesture was made.
    pub(crate) fn after(&mut self, gesture: &Gesture) {
        if *gesture != Gesture::None {
            self.open = matches!(gesture, Gesture::Part(_));
        }
    }

    /// The state before the last change; `now` is kept for [`Undo::redo`].
    pub(crate) fn undo(&mut self, now: (Stage, Past)) -> Option<Before> {
        let before = self.done.pop()?;
        let (stage, past) = now;
        self.undone.push(Before {
            gesture: before.gesture.clone(),
            stage,
            past,
        });
        self.open = false;
        Some(before)
    }

    /// The state that was left by the last [`Undo::undo`].
    pub(crate) fn redo(&mut self, now: (Stage, Past)) -> Option<Before> {
        let after = self.undone.pop()?;
        let (stage, past) = now;
        self.done.push(Before {
            gesture: after.gesture.clone(),
            stage,
            past,
        });
        self.open = false;
        Some(after)
    }

    /// How many changes can be taken back, and made again.
    pub(crate) const fn counts(&self) -> (usize, usize) {
        (self.done.len(), self.undone.len())
    }
}

/// Whether an action opens something else.
pub(crate) const fn opens(action: &Action) -> bool {
    matches!(
        action,
        Action::Scene { .. } | Action::Picture { frame: false, .. }
    )
}

/// Whether an action is motion alone, which changes nothing that a page lists.
pub(crate) const fn is_motion(action: &Action) -> bool {
    matches!(
        action,
        Action::Play
            | Action::Pause
            | Action::Speed { .. }
            | Action::Step { .. }
            | Action::Back { .. }
            | Action::Body(Body::Drag { .. } | Body::Push { .. })
            | Action::Outline(Outline::Drag { .. })
            | Action::Picture { frame: true, .. }
    )
}

/// What gesture an action belongs to.
pub(crate) fn gesture(action: &Action) -> Gesture {
    let part = |words: String| Gesture::Part(words);
    match action {
        Action::Pause | Action::Speed { .. } | Action::Undo | Action::Redo => Gesture::None,
        Action::Play | Action::Step { .. } | Action::Back { .. } => Gesture::Run,
        Action::Body(Body::Drag { snake, node, .. }) => part(format!("drag {snake} {node}")),
        Action::Body(Body::Push { .. }) => part("push".to_owned()),
        Action::Body(Body::Gravity { .. }) => part("gravity".to_owned()),
        Action::Body(Body::Wall {
            index: Some(index), ..
        }) => part(format!("wall {index}")),
        Action::Body(Body::Set { key, snake, .. }) => part(format!("set {key} {snake:?}")),
        Action::Body(Body::Plane { snake, .. }) => part(format!("plane {snake:?}")),
        Action::Body(Body::Stepping { scheme: None, .. }) => part("step".to_owned()),
        Action::Outline(Outline::Drag { id, node, .. }) => part(format!("drag {id} {node}")),
        Action::Body(Body::Drop | Body::Leave) | Action::Outline(Outline::Drop) => Gesture::End,
        Action::Frames(Frames::Go { .. }) => part("frame".to_owned()),
        Action::Picture { frame: true, .. } => part("frames".to_owned()),
        _ => Gesture::Whole,
    }
}
