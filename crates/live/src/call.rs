//! Messages of a page: what is to be done, what is asked, and the answers.

use io::shapes::{Context, Shape};
use serde::Deserialize;
use serde_json::{Value, json};

use crate::LiveError;
use crate::engine::{Engine, Show};
use crate::menu::{menu, thumb};
use crate::packet::Packet;
use crate::pictures::{FORMATS, Pictures, Tones, tile};
use crate::request::{Action, Question};
use crate::sandbox::place;
use crate::session::Session;
use crate::stage::Stage;

/// The words of a message.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Message {
    /// The number that the answer will have.
    #[serde(default)]
    id: u64,
    #[serde(default, rename = "do")]
    action: Option<Action>,
    #[serde(default)]
    ask: Option<Question>,
    #[serde(default)]
    show: Option<Show>,
    /// Open a session, whose text comes with the message.
    #[serde(default)]
    session: bool,
}

impl Engine {
    /// Carry out a message, a [`Packet`] as bytes, and answer by another one: `{"id", "ok"}` with what was asked for,
    /// or `{"id", "error"}` with a sentence.
    ///
    /// The words of a message are `{"id": 7, "do": ACTION}` with an [`Action`], or `ask` with a [`Question`], or
    /// `show` with the parts of a frame that are wanted: `{"velocities": true, "forces": true, "energies": true}`.
    pub fn call(&mut self, message: &[u8]) -> Vec<u8> {
        let mut answer = Packet::default();
        let mut id = 0;
        let done = Packet::decode(message).and_then(|packet| {
            id = packet.head.get("id").and_then(Value::as_u64).unwrap_or(0);
            let words: Message = serde_json::from_value(packet.head)
                .map_err(|error| LiveError::new(format!("this message is not known: {error}")))?;
            id = words.id;
            self.hear(words, &packet.rest, &mut answer)
        });
        answer.head = match done {
            Ok(value) => json!({"id": id, "ok": value}),
            Err(error) => {
                answer.rest.clear();
                json!({"id": id, "error": error.to_string()})
            }
        };
        answer.encode()
    }

    fn hear(
        &mut self,
        message: Message,
        rest: &[u8],
        answer: &mut Packet,
    ) -> Result<Value, LiveError> {
        if let Some(show) = message.show {
            self.show = show;
            self.changed = true;
            return Ok(Value::Null);
        }
        if message.session {
            let text =
                std::str::from_utf8(rest).map_err(|_| LiveError::new("a session must be text"))?;
            self.open_session(Session::parse(text)?);
            return Ok(Value::Null);
        }
        match (message.action, message.ask) {
            (Some(action), None) => self.perform(&action, rest).map(|()| Value::Null),
            (None, Some(question)) => self.answer(&question, answer),
            _ => Err(LiveError::new(
                "a message must have one of do, ask, show and session",
            )),
        }
    }

    fn answer(&mut self, question: &Question, packet: &mut Packet) -> Result<Value, LiveError> {
        let scene = || match &self.stage {
            Stage::Scene(scene) => Ok(scene),
            _ => Err(LiveError::new("this needs an open scene")),
        };
        let pictures = || match &self.stage {
            Stage::Pictures(pictures) => Ok(pictures),
            _ => Err(LiveError::new("this needs an open picture")),
        };
        match question {
            Question::About => Ok(match &self.stage {
                Stage::Empty => Value::Null,
                Stage::Scene(scene) => scene.about(),
                Stage::Pictures(pictures) => pictures.about(),
            }),
            Question::Menu => Ok(menu()),
            Question::Thumb { name } => thumb(name, packet),
            Question::Values { snake } => scene()?.values(*snake),
            Question::Atlas { snake } => scene()?.atlas(*snake),
            Question::Shape { snake } => scene()?.shape(*snake),
            Question::Tile {
                level,
                x,
                y,
                low,
                high,
                gamma,
            } => {
                let picture = match &self.stage {
                    Stage::Scene(scene) => scene.picture(),
                    Stage::Pictures(pictures) => Some(pictures.picture()),
                    Stage::Empty => None,
                };
                let Some(picture) = picture else {
                    return Err(LiveError::new("there is no picture"));
                };
                let tones = Tones {
                    low: *low,
                    high: *high,
                    gamma: *gamma,
                };
                packet.rest = tile(picture, *level, (*x, *y), tones)?;
                let version = match &self.stage {
                    Stage::Pictures(pictures) => pictures.version(),
                    _ => 0,
                };
                Ok(json!({"version": version}))
            }
            Question::Field { from, to, count } => {
                let (from, to) = (place(*from)?, place(*to)?);
                match &self.stage {
                    Stage::Scene(scene) => scene.arrows(from, to, *count, packet),
                    _ => pictures()?.arrows(from, to, *count, packet),
                }
            }
            Question::At { at } => match &self.stage {
                Stage::Scene(scene) => scene.at(place(*at)?),
                _ => pictures()?.at(place(*at)?),
            },
            Question::Profile { id, node } => pictures()?.profile(*id, *node),
            Question::Preview {
                drawn,
                points,
                closed,
            } => Pictures::preview(*drawn, points, *closed, packet),
            Question::Outline { id } => pictures()?.explained(*id, packet),
            Question::Formats => Ok(self.formats()),
            Question::Export { format } => {
                let (name, bytes) = self.export(format)?;
                packet.rest = bytes;
                self.saved();
                Ok(json!({"name": name}))
            }
        }
    }

    /// What can be exported now.
    fn formats(&self) -> Value {
        let of = |(name, ending, words): &(&str, &str, &str)| json!({"name": name, "ending": ending, "words": words});
        let own: Vec<Value> = match &self.stage {
            Stage::Empty => Vec::new(),
            Stage::Scene(_) => crate::sandbox::FORMATS.iter().map(of).collect(),
            Stage::Pictures(_) => FORMATS.iter().map(of).collect(),
        };
        let session = of(&(
            "session",
            ".snakes.json",
            "Session: all that was done, to be replayed",
        ));
        Value::Array(own.into_iter().chain([session]).collect())
    }

    /// The curves that are open now.
    #[must_use]
    pub fn shapes(&self) -> Vec<Shape> {
        match &self.stage {
            Stage::Empty => Vec::new(),
            Stage::Scene(scene) => scene.shapes(),
            Stage::Pictures(pictures) => pictures.shapes(),
        }
    }

    /// What formats of outlines may say of the picture that is open.
    #[must_use]
    pub fn context(&self) -> Context {
        match &self.stage {
            Stage::Pictures(pictures) => pictures.context(),
            _ => Context::default(),
        }
    }

    /// What is open as a file of that format: its name and its bytes.
    ///
    /// # Errors
    ///
    /// A format that there is not, or that cannot hold what there is.
    pub fn export(&self, format: &str) -> Result<(String, Vec<u8>), LiveError> {
        if format == "session" {
            let bytes = self.session().text().into_bytes();
            let name = match &self.stage {
                Stage::Empty => "session",
                Stage::Scene(scene) => scene.name(),
                Stage::Pictures(pictures) => pictures.name_of_first(),
            };
            return Ok((format!("{name}.snakes.json"), bytes));
        }
        match &self.stage {
            Stage::Empty => Err(LiveError::new("nothing is open")),
            Stage::Scene(scene) => scene.export(format),
            Stage::Pictures(pictures) => pictures.export(format),
        }
    }
}
