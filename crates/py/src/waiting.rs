//! Work without Python's lock that Ctrl-C stops, and panics as exceptions.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use pyo3::prelude::*;

use crate::errors::PanicError;

/// How often Python is asked whether the user wants to stop.
const PATIENCE: Duration = Duration::from_millis(20);

/// Work that takes less than this is waited for without a look at the user.
const SHORT: Duration = Duration::from_millis(2);

/// Where the last panic was.
static PLACE: Mutex<Option<String>> = Mutex::new(None);
/// How many pieces of work are being done; panics of others are not ours.
static WORKING: AtomicUsize = AtomicUsize::new(0);

/// Remember where panics are, and say nothing of those that become exceptions.
pub(crate) fn watch_panics() {
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        if WORKING.load(Ordering::Relaxed) == 0 {
            usual(info);
            return;
        }
        let place = info.location().map(ToString::to_string);
        let mut last = PLACE.lock().unwrap_or_else(PoisonError::into_inner);
        // of a panic that passes through several threads the first says most
        if last.is_none() {
            *last = place;
        }
    }));
}

/// Do work; a panic becomes an exception that says where.
pub(crate) fn guarded<T>(work: impl FnOnce() -> T) -> PyResult<T> {
    WORKING.fetch_add(1, Ordering::Relaxed);
    let done = catch_unwind(AssertUnwindSafe(work));
    WORKING.fetch_sub(1, Ordering::Relaxed);
    done.map_err(|payload| {
        let text = payload.downcast_ref::<&str>().map(ToString::to_string);
        let text = text.or_else(|| payload.downcast_ref::<String>().cloned());
        let place = PLACE.lock().unwrap_or_else(PoisonError::into_inner).take();
        let place = place.unwrap_or_else(|| "an unknown place".to_owned());
        let text = text.unwrap_or_else(|| "no message".to_owned());
        PanicError::new_err(format!("internal error at {place}: {text}"))
    })
}

thread_local! {
    static HELPER: RefCell<Option<Helper>> = const { RefCell::new(None) };
}

type Task = Box<dyn FnOnce() + Send>;

/// A thread that works for one of Python's, kept for its next call. A process that was forked has no such thread.
struct Helper {
    tasks: mpsc::Sender<Task>,
    process: u32,
}

/// Do work on a helper thread while this one looks after Python's signals. When the user stops it, the flag is set,
/// which fits and simulations look at; other work is left to end by itself.
pub(crate) fn attended<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&AtomicBool) -> T + Send + 'static,
) -> PyResult<T> {
    let stop = Arc::new(AtomicBool::new(false));
    let (send, receive) = mpsc::channel();
    let told = Arc::clone(&stop);
    let task: Task = Box::new(move || {
        let _ = send.send(guarded(|| work(&told)));
    });
    let refused = HELPER.with(|helper| {
        let mut helper = helper.borrow_mut();
        let process = std::process::id();
        let task = match helper.as_ref().filter(|helper| helper.process == process) {
            Some(Helper { tasks, .. }) => match tasks.send(task) {
                Ok(()) => return Ok(()),
                Err(mpsc::SendError(task)) => task,
            },
            None => task,
        };
        let (tasks, each) = mpsc::channel::<Task>();
        let thread = std::thread::Builder::new().name("pysnakes".to_owned());
        thread.spawn(move || each.into_iter().for_each(|task| task()))?;
        let sent = tasks.send(task);
        *helper = Some(Helper { tasks, process });
        sent.map_err(|_| std::io::Error::other("the helper thread is gone"))
    });
    refused?;
    let mut patience = SHORT;
    let receive = Mutex::new(receive); // so that it may be waited at without the lock
    loop {
        let waited = py.detach(|| {
            let receive = receive.lock().unwrap_or_else(PoisonError::into_inner);
            receive.recv_timeout(patience)
        });
        match waited {
            Ok(done) => return done,
            Err(RecvTimeoutError::Disconnected) => {
                return Err(PanicError::new_err(
                    "internal error: the work has ended without a word",
                ));
            }
            Err(RecvTimeoutError::Timeout) => {
                patience = PATIENCE;
                if let Err(asked) = py.check_signals() {
                    stop.store(true, Ordering::Relaxed);
                    // the next call need not wait for what is left
                    HELPER.with(|helper| helper.borrow_mut().take());
                    return Err(asked);
                }
            }
        }
    }
}

/// A panic, for the tests.
#[pyfunction]
#[pyo3(name = "_fail_on_purpose")]
pub(crate) fn fail_on_purpose(py: Python<'_>) -> PyResult<()> {
    #[allow(clippy::panic, reason = "the tests need one")]
    attended(py, |_| panic!("on purpose"))
}

/// Work of so many seconds that looks at the flag, for the tests.
#[pyfunction]
#[pyo3(name = "_sleep")]
pub(crate) fn sleep(py: Python<'_>, seconds: f64) -> PyResult<()> {
    attended(py, move |stop| {
        let mut left = seconds;
        while left > 0.0 && !stop.load(Ordering::Relaxed) {
            std::thread::sleep(Duration::from_millis(5));
            left -= 0.005;
        }
    })
}
