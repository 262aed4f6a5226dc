//! What a claim demands of the numbers it names.
//!
//! Most claims are bounds on single numbers: they are written as demands, from which both the
//! verdict and the words about what was measured follow. The rest judge in code of their own.

use crate::record::shortest;
use crate::{Finding, Record, SandboxError};

/// A demand on one number.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Demand {
    /// Less than a bound.
    Below(&'static str, f64),
    /// At most a bound.
    AtMost(&'static str, f64),
    /// More than a bound.
    Above(&'static str, f64),
    /// Nearer to a value than so much.
    Near(&'static str, f64, f64),
    /// Less than so many times another number.
    Less(&'static str, f64, &'static str),
}

pub(crate) const fn below(name: &'static str, bound: f64) -> Demand {
    Demand::Below(name, bound)
}

pub(crate) const fn at_most(name: &'static str, bound: f64) -> Demand {
    Demand::AtMost(name, bound)
}

pub(crate) const fn above(name: &'static str, bound: f64) -> Demand {
    Demand::Above(name, bound)
}

pub(crate) const fn near(name: &'static str, value: f64, within: f64) -> Demand {
    Demand::Near(name, value, within)
}

/// `name` less than `times` the number called `other`.
pub(crate) const fn less(name: &'static str, times: f64, other: &'static str) -> Demand {
    Demand::Less(name, times, other)
}

/// Whether a record meets all demands, with each number beside its bound.
pub(crate) fn judged(record: &Record, demands: &[Demand]) -> Result<Finding, SandboxError> {
    let (mut holds, mut words) = (true, Vec::new());
    for demand in demands {
        let (met, said) = one(record, *demand)?;
        holds &= met;
        words.push(said);
    }
    Ok(Finding::new(holds, words.join("; ")))
}

fn one(record: &Record, demand: Demand) -> Result<(bool, String), SandboxError> {
    let (Demand::Below(name, _)
    | Demand::AtMost(name, _)
    | Demand::Above(name, _)
    | Demand::Near(name, ..)
    | Demand::Less(name, ..)) = demand;
    let value = record.number(name)?;
    let unit = unit(record, name);
    let (met, asked) = match demand {
        Demand::Below(_, bound) => (value < bound, format!("below {}", shortest(bound))),
        Demand::AtMost(_, bound) => (value <= bound, format!("at most {}", shortest(bound))),
        Demand::Above(_, bound) => (value > bound, format!("above {}", shortest(bound))),
        Demand::Near(_, wanted, within) => (
            (value - wanted).abs() < within,
            format!("{} within {}", shortest(wanted), shortest(within)),
        ),
        Demand::Less(_, times, other) => {
            let against = record.number(other)?;
            let share = match times {
                1.0 => String::new(),
                times => format!("{} of ", shortest(times)),
            };
            (
                value < times * against,
                format!("below {share}{}, {other}", rounded(against)),
            )
        }
    };
    Ok((met, format!("{name}: {}{unit} ({asked})", rounded(value))))
}

/// A number's unit behind a space.
fn unit(record: &Record, name: &str) -> String {
    let number = record.numbers.iter().find(|number| number.name == name);
    match number.map_or("", |number| number.unit) {
        "" => String::new(),
        unit => format!(" {unit}"),
    }
}

/// Three digits.
fn rounded(value: f64) -> String {
    let size = value.abs();
    let digits = format!("{value:.2e}");
    match digits.parse::<f64>() {
        // an exponent is for what is very large or very small
        Ok(short) if size == 0.0 || (1e-3..1e6).contains(&size) => format!("{short}"),
        _ => digits,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Tolerance;

    fn record() -> Record {
        let mut record = Record::default();
        record.note("way", 1.23456, "px", Tolerance::EXACT);
        record.note("gap", 1.5e-12, "", Tolerance::EXACT);
        record
    }

    fn found(demands: &[Demand]) -> (bool, String) {
        let finding = judged(&record(), demands).unwrap();
        (finding.holds, finding.measured)
    }

    #[test]
    fn each_demand_holds_on_its_side_of_the_bound_only() {
        for (demand, holds) in [
            (below("way", 1.3), true),
            (below("way", 1.2), false),
            (at_most("way", 1.23456), true),
            (at_most("way", 1.23), false),
            (above("way", 1.2), true),
            (above("way", 1.23456), false),
            (near("way", 1.2, 0.1), true),
            (near("way", 1.2, 0.01), false),
            (less("gap", 1.0, "way"), true),
            (less("way", 0.5, "gap"), false),
        ] {
            assert_eq!(found(&[demand]).0, holds, "{demand:?}");
        }
        assert!(!found(&[below("way", 1.3), below("gap", 0.0)]).0);
        assert!(judged(&record(), &[below("none", 1.0)]).is_err());
    }

    #[test]
    fn the_words_are_the_number_its_unit_and_what_was_asked() {
        assert_eq!(
            found(&[below("way", 1.3), less("gap", 0.5, "way")]).1,
            "way: 1.23 px (below 1.3); gap: 1.50e-12 (below 0.5 of 1.23, way)"
        );
        assert_eq!(
            found(&[near("way", 1.0, 0.5)]).1,
            "way: 1.23 px (1 within 0.5)"
        );
    }
}
