//! What is told of each frame: written, counted, said.

use std::collections::{BTreeMap, BTreeSet};

use ::track::{Happening, Outline, State};
use io::Picture;
use io::tracks::{TrackState, Tracked};
use scene::SceneError;

use super::run::Told;
use super::sinks::{Happened, Seen, Sinks};
use crate::args::Words;

/// A start of less confidence is one that is not sure to be of an object.
const SURE: f64 = 0.5;

/// Objects beyond which what happens to each is only written.
const FEW: usize = 10;

/// A sequence that is told.
#[derive(Debug, Default)]
pub(super) struct Course {
    /// Whether new objects may come.
    pub(super) births: bool,
    pub(super) tally: Tally,
}

/// What there is to say of it in the end.
#[derive(Debug, Default)]
pub(super) struct Tally {
    pub(super) frames: usize,
    /// The last frame that was followed.
    pub(super) last: usize,
    pub(super) objects: BTreeSet<u32>,
    pub(super) broken: Vec<String>,
    pub(super) lost: BTreeSet<u32>,
    /// Objects whose starts are not sure to be of any.
    pub(super) unsure: BTreeSet<u32>,
    /// Objects whose numbers may have been exchanged.
    pub(super) uncertain: BTreeSet<u32>,
    /// Objects that were not seen in the last frame.
    pub(super) hidden: BTreeSet<u32>,
    pub(super) alive: usize,
    /// Objects that have left the frame and are waited for.
    pub(super) waited: BTreeSet<u32>,
    pub(super) divided: usize,
    pub(super) born: usize,
    /// Pixels of the last frame that do not count.
    pub(super) masked: usize,
    /// Outlines that were not seen, of all.
    pub(super) coasting: usize,
    pub(super) outlines: usize,
}

impl Course {
    /// Whether nothing is followed any more, and nothing will be.
    pub(super) fn is_over(&self) -> bool {
        self.tally.alive == 0 && self.tally.frames > 0 && !self.births
    }

    /// Write and tell a frame.
    pub(super) fn tell(
        &mut self,
        told: &Told,
        picture: Option<&Picture>,
        sinks: &mut Sinks<'_>,
        words: Words,
    ) -> Result<(), SceneError> {
        let (frame, name) = (told.index, &told.name);
        if told.missing > 0 {
            words.say(&format!(
                "note: {} missing before {name}: objects go on by as many",
                crate::fit::counted(usize::try_from(told.missing).unwrap_or(usize::MAX), "frame")
            ));
        }
        if let Some(reason) = &told.broken {
            words.say(&format!(
                "frame {frame}, {name}: {reason}; all goes on as it was going"
            ));
            self.tally.broken.push(name.clone());
        }
        if told.masked > 0 && told.masked != self.tally.masked {
            words.say(&format!(
                "frame {frame}, {name}: {} no numbers or left out, and not counted",
                match told.masked {
                    1 => "1 pixel is".to_owned(),
                    many => format!("{many} pixels are"),
                }
            ));
        }
        self.tally.masked = told.masked;
        let mut seen = Vec::new();
        for outline in &told.outlines {
            let one = tracked(frame, outline, &told.given);
            if words.verbose {
                words.detail(&format!(
                    "frame {frame}, object {}: {}, confidence {:.2}, {:?}",
                    one.id,
                    one.state.name(),
                    outline.confidence,
                    outline.prediction
                ));
            }
            seen.push(Seen {
                tracked: one,
                outline: outline.clone(),
            });
        }
        let happened: Vec<Happened> = told
            .events
            .iter()
            .map(|event| Happened {
                frame,
                id: event.id,
                word: word(&event.what),
                others: match &event.what {
                    Happening::Divided(both) => both.to_vec(),
                    Happening::Merged(other) | Happening::Uncertain(other) => vec![*other],
                    _ => Vec::new(),
                },
                confidence: event.confidence,
            })
            .collect();
        self.count(frame, &seen, &happened);
        let few = self.tally.objects.len() <= FEW;
        let told = |one: &&Happened| match one.word {
            "begun" => one.confidence < SURE,
            word => word != "skipped",
        };
        for one in happened.iter().filter(told) {
            let text = one.to_string();
            if few {
                words.say(&text);
            } else {
                words.detail(&text);
            }
        }
        sinks.frame(frame, name, picture, &seen, &happened)
    }

    fn count(&mut self, frame: usize, seen: &[Seen], happened: &[Happened]) {
        let tally = &mut self.tally;
        tally.frames += 1;
        tally.last = frame;
        tally.outlines += seen.len();
        tally.hidden.clear();
        for one in seen {
            tally.objects.insert(one.tracked.id);
            tally.waited.remove(&one.tracked.id);
            if one.tracked.state == TrackState::Coasting {
                tally.coasting += 1;
                tally.hidden.insert(one.tracked.id);
            }
        }
        for one in happened {
            match one.word {
                "lost" => {
                    tally.lost.insert(one.id);
                    tally.waited.remove(&one.id);
                }
                "left" => {
                    tally.waited.insert(one.id);
                }
                "begun" if one.confidence < SURE => {
                    tally.unsure.insert(one.id);
                }
                "uncertain" => {
                    tally.uncertain.insert(one.id);
                }
                "divided" => tally.divided += 1,
                "born" => tally.born += 1,
                _ => {}
            }
        }
        tally.alive = seen.len() + tally.waited.len();
    }
}

fn tracked(frame: usize, outline: &Outline, given: &BTreeSet<u32>) -> Tracked {
    let state = match outline.state {
        _ if given.contains(&outline.id) => TrackState::Given,
        State::Seen => TrackState::Tracked,
        State::Partly => TrackState::Partly,
        State::Coasting | State::Left => TrackState::Coasting,
    };
    let sure = outline.confidence;
    Tracked {
        frame,
        id: outline.id,
        points: outline.points.clone(),
        parent: outline.parent,
        confidence: Some(if sure.is_finite() {
            sure.clamp(0.0, 1.0)
        } else {
            0.0
        }),
        state,
        measures: BTreeMap::new(),
    }
}

/// What happened, in a word.
pub(super) const fn word(what: &Happening) -> &'static str {
    match what {
        Happening::Begun => "begun",
        Happening::Hidden => "hidden",
        Happening::Found => "found",
        Happening::Left => "left",
        Happening::Lost => "lost",
        Happening::Divided(_) => "divided",
        Happening::Born => "born",
        Happening::Merged(_) => "merged",
        Happening::Uncertain(_) => "uncertain",
        Happening::Skipped => "skipped",
        Happening::Mended => "mended",
        Happening::Remeshed => "remeshed",
        _ => "other",
    }
}
