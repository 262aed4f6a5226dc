//! The thread that the engine runs in: it takes messages of all windows in their order, keeps the clock, and hands out
//! frames.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::Mutex;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use live::{Engine, Packet};
use tokio::sync::{mpsc, watch};

/// Time between two frames.
const FRAME: Duration = Duration::from_micros(16_667);

/// Time from a frame to the next where a window has said something: what a hand does is shown without waiting for the
/// clock.
const SOON: Duration = Duration::from_millis(8);

/// Windows that are remembered, and answers of each.
const MOST_WINDOWS: usize = 32;
const MOST_ANSWERS: usize = 128;

/// Bytes of answers that are kept to be said again.
const MOST_KEPT: usize = 1 << 14;

/// A message of a window.
struct Message {
    window: String,
    bytes: Vec<u8>,
    answer: mpsc::UnboundedSender<Vec<u8>>,
}

enum Job {
    Message(Message),
    /// Hand out a frame, since somebody new is looking.
    Look,
    End,
}

/// A way to the engine.
#[derive(Debug, Clone)]
pub(super) struct Hub {
    jobs: Sender<Job>,
    frames: watch::Receiver<Arc<Vec<u8>>>,
    thread: Arc<Mutex<Option<JoinHandle<Engine>>>>,
}

impl Hub {
    /// Let the engine run.
    pub(super) fn start(engine: Engine) -> Self {
        let (jobs, queue) = channel();
        let (send, frames) = watch::channel(Arc::new(Vec::new()));
        let thread = std::thread::spawn(move || run(engine, &queue, &send));
        Self {
            jobs,
            frames,
            thread: Arc::new(Mutex::new(Some(thread))),
        }
    }

    /// The newest frame, and all that come after it.
    pub(super) fn frames(&self) -> watch::Receiver<Arc<Vec<u8>>> {
        // an engine that has ended shows nothing more
        let _ = self.jobs.send(Job::Look);
        self.frames.clone()
    }

    /// Have a message carried out; the answer goes there. False where the engine has ended.
    pub(super) fn hear(
        &self,
        window: &str,
        bytes: Vec<u8>,
        answer: &mpsc::UnboundedSender<Vec<u8>>,
    ) -> bool {
        let message = Message {
            window: window.to_owned(),
            bytes,
            answer: answer.clone(),
        };
        self.jobs.send(Job::Message(message)).is_ok()
    }

    /// End the engine's run; the engine as it was then, None where its thread has failed.
    pub(super) fn end(&self) -> Option<Engine> {
        let _ = self.jobs.send(Job::End);
        let thread = self.thread.lock().ok()?.take()?;
        thread.join().ok()
    }
}

/// A window and what it was answered: the numbers of its messages, and the answers that are kept.
struct Window {
    name: String,
    answers: VecDeque<(u64, Option<Vec<u8>>)>,
}

/// Windows by the time they were heard last.
#[derive(Default)]
struct Windows(VecDeque<Window>);

impl Windows {
    /// The answer to a message, if it was carried out already; a window that lost its connection says again what was
    /// not answered.
    fn said(&self, name: &str, id: u64) -> Option<Vec<u8>> {
        let window = self.0.iter().find(|window| window.name == name)?;
        let (_, answer) = window.answers.iter().find(|(known, _)| *known == id)?;
        let done = || {
            let words = "carried out before the connection was lost; ask once more";
            Packet::words(serde_json::json!({"id": id, "error": words})).encode()
        };
        Some(answer.clone().unwrap_or_else(done))
    }

    fn answered(&mut self, name: &str, id: u64, answer: &[u8]) {
        let at = self.0.iter().position(|window| window.name == name);
        let mut window = at
            .and_then(|at| self.0.remove(at))
            .unwrap_or_else(|| Window {
                name: name.to_owned(),
                answers: VecDeque::new(),
            });
        let kept = (answer.len() <= MOST_KEPT).then(|| answer.to_vec());
        window.answers.push_back((id, kept));
        if window.answers.len() > MOST_ANSWERS {
            window.answers.pop_front();
        }
        self.0.push_back(window);
        if self.0.len() > MOST_WINDOWS {
            self.0.pop_front();
        }
    }
}

fn run(mut engine: Engine, queue: &Receiver<Job>, frames: &watch::Sender<Arc<Vec<u8>>>) -> Engine {
    let mut windows = Windows::default();
    let (mut before, mut took) = (Instant::now(), 0.0);
    let mut due = before;
    loop {
        let now = Instant::now();
        let wait = due.saturating_duration_since(now);
        match queue.recv_timeout(wait) {
            Ok(Job::End) | Err(RecvTimeoutError::Disconnected) => return engine,
            Ok(Job::Look) => {
                let frame = engine.frame();
                frames.send_replace(Arc::new(frame));
                continue;
            }
            Ok(Job::Message(message)) => {
                hear(&mut engine, &mut windows, message);
                due = due.min(before + SOON);
                continue;
            }
            Err(RecvTimeoutError::Timeout) => {}
        }
        let now = Instant::now();
        let passed = milliseconds(now.duration_since(before));
        before = now;
        let changed = engine.tick(passed, took);
        if changed {
            let frame = engine.frame();
            frames.send_replace(Arc::new(frame));
        }
        took = milliseconds(now.elapsed());
        // no faster than frames, and no backlog where one took long
        due = (due + FRAME).max(Instant::now());
    }
}

fn hear(engine: &mut Engine, windows: &mut Windows, message: Message) {
    let Message {
        window,
        bytes,
        answer,
    } = message;
    let id = Packet::decode(&bytes)
        .ok()
        .and_then(|packet| packet.head.get("id").and_then(serde_json::Value::as_u64))
        .unwrap_or(0);
    let reply = windows.said(&window, id).unwrap_or_else(|| {
        let reply = engine.call(&bytes);
        windows.answered(&window, id, &reply);
        reply
    });
    // a window that has gone needs no answer
    let _ = answer.send(reply);
}

fn milliseconds(time: Duration) -> f64 {
    1000.0 * time.as_secs_f64()
}
