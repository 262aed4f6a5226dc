//! Many systems at once, over threads.
//!
//! A small system does not gain from threads, thousands of them do: each is moved by one thread from start to end,
//! so that what comes out does not depend on how many there are.

use std::num::NonZeroUsize;
use std::sync::Mutex;

use crate::{Fault, State, Stepper, System};

/// Jobs a thread takes at a time: few enough to share evenly, enough to be worth asking.
const SHARE: usize = 16;

/// A system, what moves it, and where it is.
#[derive(Debug)]
pub struct Job<S> {
    /// What moves.
    pub system: S,
    /// What moves it, started on this system and state.
    pub stepper: Box<dyn Stepper>,
    /// Where it is.
    pub state: State,
    /// The fault that ended it; a job with one is left alone.
    pub fault: Option<Fault>,
}

impl<S> Job<S> {
    /// A job that nothing has happened to yet.
    #[must_use]
    pub fn new(system: S, stepper: Box<dyn Stepper>, state: State) -> Self {
        Self {
            system,
            stepper,
            state,
            fault: None,
        }
    }
}

/// Make `steps` steps of every job on so many threads; true if none ended in a fault.
///
/// A job that faults keeps the state before, and hinders no other. The same bytes for any number of threads. Threads are
/// started and ended here: some tens of microseconds, so give each many steps to make.
///
/// ```
/// use integrator::{Job, Scheme, Start, problems, run_jobs};
///
/// let mut jobs = Vec::new();
/// for k in 1..=100 {
///     let mut spring = problems::damped_spring(1.0, 0.3, f64::from(k))?;
///     let stepper = Scheme::Newmark.start(&mut spring.system, &spring.state, 0.01, Start::default())?;
///     jobs.push(Job::new(spring.system, stepper, spring.state));
/// }
/// let threads = std::thread::available_parallelism()?;
/// assert!(run_jobs(&mut jobs, 1000, threads));
/// assert_eq!(jobs[99].state.step, 1000);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn run_jobs<S: System + Send>(jobs: &mut [Job<S>], steps: u64, threads: NonZeroUsize) -> bool {
    let threads = threads.get().min(jobs.len().div_ceil(SHARE));
    let all = |jobs: &[Job<S>]| jobs.iter().all(|job| job.fault.is_none());
    if threads <= 1 {
        jobs.iter_mut().for_each(|job| follow(job, steps));
        return all(jobs);
    }
    let shares = Mutex::new(jobs.chunks_mut(SHARE));
    // a thread that cannot take a share has nothing to do
    let take = || shares.lock().ok().and_then(|mut shares| shares.next());
    let work = || {
        while let Some(share) = take() {
            share.iter_mut().for_each(|job| follow(job, steps));
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..threads {
            scope.spawn(work);
        }
        work();
    });
    all(jobs)
}

fn follow<S: System>(job: &mut Job<S>, steps: u64) {
    for _ in 0..steps {
        if job.fault.is_some() {
            return;
        }
        job.fault = job.stepper.step(&mut job.system, &mut job.state).err();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problems::{self, Springs};
    use crate::{Scheme, Start};

    fn jobs() -> Vec<Job<Springs>> {
        (0..100)
            .map(|k| {
                let scheme = Scheme::ALL[k % Scheme::ALL.len()];
                let ratio = [1.0, 2.0, 3.0 + k as f64];
                let ring = problems::ring(8 + k % 5, 1.0, 2.0, ratio).unwrap();
                let (mut system, state) = (ring.system, ring.state);
                let start = Start::SecondOrder;
                let stepper = scheme.start(&mut system, &state, 0.05, start).unwrap();
                Job::new(system, stepper, state)
            })
            .collect()
    }

    fn states(threads: usize, spoil: Option<usize>) -> (bool, Vec<State>) {
        let mut jobs = jobs();
        if let Some(one) = spoil {
            jobs[one].system.gravity.x = f64::NAN;
        }
        let good = run_jobs(&mut jobs, 20, NonZeroUsize::new(threads).unwrap());
        (good, jobs.into_iter().map(|job| job.state).collect())
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bytes() {
        let (good, alone) = states(1, None);
        assert!(good);
        for threads in [2, 3, 7, 200] {
            assert_eq!(states(threads, None), (true, alone.clone()), "{threads}");
        }
    }

    #[test]
    fn a_fault_ends_one_job_and_no_other() {
        let (_, alone) = states(1, None);
        let (good, spoilt) = states(2, Some(37));
        assert!(!good);
        for (k, (a, b)) in alone.iter().zip(&spoilt).enumerate() {
            assert_eq!(a == b, k != 37, "{k}");
            assert!(b.x.iter().all(|x| x.is_finite()));
        }
    }

    #[test]
    fn no_jobs_are_done_at_once() {
        let none: &mut [Job<Springs>] = &mut [];
        assert!(run_jobs(none, 10, NonZeroUsize::MAX));
    }
}
