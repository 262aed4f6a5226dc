//! How the claims about schemes are judged.

use super::trials::schemes;
use crate::{Finding, Record, SandboxError};

/// Whether one scheme asks for fewer forces than another; one that never got there has lost.
pub(super) fn fewer(
    record: &Record,
    winner: &str,
    loser: &str,
    target: &str,
) -> Result<Finding, SandboxError> {
    let forces = |name: &str| record.number(&format!("{name}: forces to {target}"));
    let (own, other) = (forces(winner)?, forces(loser)?);
    let holds = own < other || own.is_finite() && other.is_nan();
    Ok(Finding::new(
        holds,
        format!("{} forces against {}", words(own), words(other)),
    ))
}

fn words(count: f64) -> String {
    if count.is_finite() {
        format!("{count}")
    } else {
        "too many".to_owned()
    }
}

/// Whether some scheme reaches 1e-3 in at most so small a share of the report's steps at its limit.
pub(super) fn share_of_report(record: &Record, share: f64) -> Result<Finding, SandboxError> {
    let report = record.number("report: steps at its largest stable step")?;
    let mut best = ("none", f64::INFINITY);
    for scheme in schemes().filter(|scheme| scheme.parameter().is_none() || scheme.order() == 2) {
        let steps = record.number(&format!("{}: steps to 1e-3", scheme.name()))?;
        if steps < best.1 {
            best = (scheme.name(), steps);
        }
    }
    let (name, steps) = best;
    let found = format!(
        "{name} in {steps} of {report} steps, 1/{:.0}",
        report / steps
    );
    Ok(Finding::new(steps <= share * report, found))
}
