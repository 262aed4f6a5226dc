//! Running experiments: one, or all of them on the processors there are.

use crate::{Artefact, Body, Experiment, Finding, Record, SandboxError};
use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// A drawing as bytes.
#[derive(Debug, Clone)]
pub struct Drawn {
    /// The file's name.
    pub file: String,
    /// One line under it.
    pub caption: &'static str,
    /// The file.
    pub bytes: Vec<u8>,
}

/// An experiment that was run, judged and drawn.
#[derive(Debug, Clone)]
pub struct Done {
    /// Which.
    pub experiment: &'static Experiment,
    /// What it left.
    pub record: Record,
    /// One for each claim, in order.
    pub findings: Vec<Finding>,
    /// Its drawings.
    pub drawings: Vec<Drawn>,
    /// How long it took.
    pub took: Duration,
}

impl Done {
    /// Whether every claim holds.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.findings.iter().all(|finding| finding.holds)
    }

    /// A line for each claim: whether it holds, where it comes from, what was measured.
    #[must_use]
    pub fn told(&self) -> String {
        let claims = self.experiment.claims.iter().zip(&self.findings);
        let lines = claims.map(|(claim, finding)| {
            let verdict = if finding.holds {
                "holds"
            } else {
                "DOES NOT HOLD"
            };
            let (says, source) = (claim.says(), claim.source());
            format!("{verdict}: {says} ({source}): {}", finding.measured)
        });
        lines.collect::<Vec<_>>().join("\n")
    }
}

/// The committed drawings in the source tree this program was built from.
#[must_use]
pub fn committed_folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("..")
        .join("docs")
        .join("figures")
}

/// Runs, judges and draws one experiment.
///
/// # Errors
///
/// When a crate below refuses what the experiment asks, or a claim or drawing asks for something
/// that was not recorded.
pub fn perform(experiment: &'static Experiment) -> Result<Done, SandboxError> {
    performed(experiment).map_err(|reason| SandboxError::In {
        experiment: experiment.id,
        reason: Box::new(reason),
    })
}

fn performed(experiment: &'static Experiment) -> Result<Done, SandboxError> {
    let start = Instant::now();
    let record = (experiment.run)()?;
    let findings = experiment
        .claims
        .iter()
        .map(|claim| claim.judge(&record))
        .collect::<Result<Vec<Finding>, SandboxError>>()?;
    let drawings = (experiment.draw)(&record)?
        .iter()
        .map(|artefact| drawn(experiment, artefact))
        .collect::<Result<Vec<Drawn>, SandboxError>>()?;
    Ok(Done {
        experiment,
        record,
        findings,
        drawings,
        took: start.elapsed(),
    })
}

fn drawn(experiment: &Experiment, artefact: &Artefact) -> Result<Drawn, SandboxError> {
    let (bytes, ending) = match &artefact.body {
        Body::Figure(figure) => (figure.svg()?.into_bytes(), "svg"),
        Body::Animation(animation) => (animation.gif()?, "gif"),
    };
    let file = match artefact.suffix {
        "" => format!("{}.{ending}", experiment.id),
        suffix => format!("{}-{suffix}.{ending}", experiment.id),
    };
    Ok(Drawn {
        file,
        caption: artefact.caption,
        bytes,
    })
}

/// Runs experiments on all processors; the answers come in the order asked. `watch` is shown each as
/// soon as it is finished: every second processor goes from the first on, the others from the last
/// on, where the long ones stand.
///
/// # Errors
///
/// The first refusal, in the order asked.
pub fn perform_all(
    experiments: &[&'static Experiment],
    watch: &(dyn Fn(&'static Experiment, &Result<Done, SandboxError>) + Sync),
) -> Result<Vec<Done>, SandboxError> {
    let left = Mutex::new(experiments.iter().copied().collect::<VecDeque<_>>());
    let take = |first: bool| {
        let mut left = left.lock().unwrap_or_else(PoisonError::into_inner);
        if first {
            left.pop_front()
        } else {
            left.pop_back()
        }
    };
    let results = Mutex::new(Vec::new());
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for worker in 0..workers.min(experiments.len()) {
            let (take, results) = (&take, &results);
            scope.spawn(move || {
                while let Some(experiment) = take(worker % 2 == 0) {
                    let result = perform(experiment);
                    watch(experiment, &result);
                    if let Ok(mut results) = results.lock() {
                        results.push((experiment.id, result));
                    }
                }
            });
        }
    });
    let mut results = results.into_inner().unwrap_or_else(PoisonError::into_inner);
    results.sort_by_key(|(id, _)| experiments.iter().position(|asked| asked.id == *id));
    results.into_iter().map(|(_, result)| result).collect()
}
