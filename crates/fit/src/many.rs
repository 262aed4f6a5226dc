//! Much work on several threads, many fits above all, with answers in order.

use std::collections::BTreeMap;
use std::num::NonZero;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

use crate::{Contour, Fit, FitError, Prepared};

/// One fit of many: an image made ready, and where to start in it.
#[derive(Debug, Clone)]
pub struct Job<'a> {
    /// The image; several jobs may share one.
    pub prepared: &'a Prepared,
    /// The start.
    pub start: &'a Contour,
}

/// Run jobs on so many threads, and hand each result over in the order of the jobs, as soon as it
/// and all before it are there. The results do not depend on the number of threads.
///
/// ```
/// use fit::{Contour, Image, Job, Options, Prepared, fit_many};
/// use glam::DVec2;
///
/// let bright = |x: usize, y: usize| (x as f64 - 30.0).hypot(y as f64 - 30.0) < 15.0;
/// let level = |(y, x)| if bright(x, y) { 200.0 } else { 50.0 };
/// let levels = field::Grid::from_shape_fn((61, 61), level);
/// let prepared = Prepared::of(&Image::grey(levels), &Options::default())?;
/// let starts = [17.0, 18.0, 19.0].map(|radius| Contour::circle(DVec2::new(31.0, 30.0), radius));
/// let jobs: Vec<Job> = starts.iter().map(|start| Job { prepared: &prepared, start }).collect();
/// let mut order = Vec::new();
/// fit_many(&jobs, 2, |index, found| order.push((index, found.is_ok())));
/// assert_eq!(order, [(0, true), (1, true), (2, true)]);
/// # Ok::<(), fit::FitError>(())
/// ```
pub fn fit_many(jobs: &[Job<'_>], threads: usize, each: impl FnMut(usize, Result<Fit, FitError>)) {
    let work = |job: &Job<'_>| job.prepared.fit(job.start);
    in_order(jobs, threads, work, each);
}

/// Do pieces of work on so many threads, and hand each answer over in the order of the work, as soon as it and all
/// before it are there. With one thread, or one piece of work, it is done on the caller's own;
/// so it is in a browser, whatever is asked for.
///
/// ```
/// let mut squares = Vec::new();
/// fit::in_order(&[3, 1, 2], 2, |number| number * number, |at, square| squares.push((at, square)));
/// assert_eq!(squares, [(0, 9), (1, 1), (2, 4)]);
/// ```
pub fn in_order<J: Sync, T: Send>(
    jobs: &[J],
    threads: usize,
    work: impl Fn(&J) -> T + Sync,
    mut each: impl FnMut(usize, T),
) {
    let threads = NonZero::new(threads.min(jobs.len())).map_or(1, NonZero::get);
    // in a browser none can be started
    if threads == 1 || cfg!(target_family = "wasm") {
        for (index, job) in jobs.iter().enumerate() {
            each(index, work(job));
        }
        return;
    }
    let (next, work) = (&AtomicUsize::new(0), &work);
    let (send, receive) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..threads {
            let send = send.clone();
            scope.spawn(move || {
                while let Some((index, job)) = {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    jobs.get(index).map(|job| (index, job))
                } {
                    // the receiver is gone: the other answers are not needed
                    if send.send((index, work(job))).is_err() {
                        break;
                    }
                }
            });
        }
        drop(send);
        let (mut waiting, mut due) = (BTreeMap::new(), 0);
        for (index, answer) in receive {
            waiting.insert(index, answer);
            while let Some(answer) = waiting.remove(&due) {
                each(due, answer);
                due += 1;
            }
        }
    });
}
