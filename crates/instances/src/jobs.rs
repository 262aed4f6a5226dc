//! Work that is shared among threads, with results in the order of the work whatever their number.

use std::sync::atomic::{AtomicUsize, Ordering};

/// More threads than this are not started.
const MOST: usize = 16;

/// The results of a job for each number below `count`, in their order.
pub(crate) fn map<T: Send>(count: usize, job: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let threads = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    map_on(threads, count, job)
}

/// The same on so many threads.
fn map_on<T: Send>(threads: usize, count: usize, job: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let threads = threads.clamp(1, MOST).min(count);
    if threads < 2 {
        return (0..count).map(job).collect();
    }
    let next = AtomicUsize::new(0);
    let work = || {
        let mut own = Vec::new();
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            if at >= count {
                return own;
            }
            own.push((at, job(at)));
        }
    };
    let mut all: Vec<(usize, T)> = std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads).map(|_| scope.spawn(work)).collect();
        let mut all = work();
        for other in others {
            match other.join() {
                Ok(list) => all.extend(list),
                Err(cause) => std::panic::resume_unwind(cause),
            }
        }
        all
    });
    all.sort_by_key(|(at, _)| *at);
    all.into_iter().map(|(_, one)| one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_in_order_on_any_number_of_threads() {
        let plain: Vec<usize> = (0..1000).map(|at| at * at).collect();
        for threads in [0, 1, 2, 7, 100] {
            assert_eq!(map_on(threads, 1000, |at| at * at), plain);
        }
        assert!(map_on(3, 0, |at| at).is_empty());
    }
}
