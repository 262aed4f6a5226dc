//! Many fits on several threads, with results in order.

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
pub fn fit_many(
    jobs: &[Job<'_>],
    threads: usize,
    mut each: impl FnMut(usize, Result<Fit, FitError>),
) {
    let threads = NonZero::new(threads.min(jobs.len())).map_or(1, NonZero::get);
    if threads == 1 {
        for (index, job) in jobs.iter().enumerate() {
            each(index, job.prepared.fit(job.start));
        }
        return;
    }
    let next = &AtomicUsize::new(0);
    let (send, receive) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..threads {
            let send = send.clone();
            scope.spawn(move || {
                while let Some((index, job)) = {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    jobs.get(index).map(|job| (index, job))
                } {
                    // the receiver is gone: the other results are not needed
                    if send.send((index, job.prepared.fit(job.start))).is_err() {
                        break;
                    }
                }
            });
        }
        drop(send);
        let (mut waiting, mut due) = (BTreeMap::new(), 0);
        for (index, found) in receive {
            waiting.insert(index, found);
            while let Some(found) = waiting.remove(&due) {
                each(due, found);
                due += 1;
            }
        }
    });
}
