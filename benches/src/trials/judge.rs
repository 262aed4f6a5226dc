//! How the claims about schemes are judged.

use super::problems::schemes;
use sandbox::prelude::*;

/// Whether one scheme asks for fewer forces than every other.
pub(super) fn fewest_of_all(record: &Record, winner: &str, target: &str) -> Result<Finding> {
    let forces = |name: &str| record.number(&format!("{name}: forces to {target}"));
    let own = forces(winner)?;
    let mut next = ("none", f64::INFINITY);
    for scheme in schemes().filter(|scheme| scheme.name() != winner) {
        let other = forces(scheme.name())?;
        if other < next.1 {
            next = (scheme.name(), other);
        }
    }
    let found = format!(
        "{} forces; the next is {} with {}",
        words(own),
        next.0,
        words(next.1)
    );
    Ok(Finding::new(own < next.1, found))
}

fn words(count: f64) -> String {
    if count.is_finite() {
        format!("{count}")
    } else {
        "too many".to_owned()
    }
}

/// Whether some scheme reaches 1e-3 in at most so small a share of the report's steps at its limit.
pub(super) fn share_of_report(record: &Record, share: f64) -> Result<Finding> {
    let report = record.number("report: steps at its largest stable step")?;
    let mut best = ("none", f64::INFINITY);
    for scheme in schemes().filter(|scheme| scheme.parameter().is_none() || scheme.order() == 2) {
        let steps = record.number(&format!("{}: steps to 1e-3", scheme.name()))?;
        if steps < best.1 {
            best = (scheme.name(), steps);
        }
    }
    let (name, steps) = best;
    if steps.is_infinite() {
        return Ok(Finding::new(false, "no scheme gets there"));
    }
    let found = format!(
        "{name} in {steps} of {report} steps, 1/{:.0}",
        report / steps
    );
    Ok(Finding::new(steps <= share * report, found))
}
