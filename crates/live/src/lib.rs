//! Snakes under the hand: an engine that takes messages and hands out frames.
//!
//! An [`Engine`] holds what is open, a scene in motion or a picture with outlines. It carries out [`Action`]s, which
//! are kept as a [`Session`], answers [`Question`]s, moves by a clock that it is told ([`Engine::tick`]), and says
//! what is to be drawn ([`Engine::frame`]). Every action can be taken back. What was done replays to the same bytes.
//!
//! Messages, answers and frames are [`Packet`]s: words in JSON, then numbers as they are. [`Engine::call`] takes one
//! and answers by one; a server hands them on from a socket, a page from itself, a test from a list.
//!
//! The page that talks to it is in `page/`, as plain modules of JavaScript: [`PAGE`].
//!
//! Nothing here knows a socket, a browser, a file's path or the time of day.

mod arrows;
mod call;
mod clock;
mod engine;
mod error;
mod menu;
mod packet;
mod page;
mod past;
mod pictures;
mod request;
mod sandbox;
mod session;
mod stage;
mod undo;

pub use engine::Engine;
pub use error::LiveError;
pub use packet::Packet;
pub use page::{PAGE, Part};
pub use request::{Action, Body, Drawn, Frames, Outline, Pair, Question};
pub use session::Session;
