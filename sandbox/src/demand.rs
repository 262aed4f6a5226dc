//! What a claim demands of the numbers it names.
//!
//! From a demand follow both the verdict and the words about what was measured. A name stands for
//! one number; for all whose names fit, where it has a star: `"*: largest step"`; or for a column,
//! `"area @ balls"` in the table of that name. Of many, each must meet the demand.

use crate::table::shortest;
use crate::{Finding, Record, SandboxError};

type Name = &'static str;

/// A demand on numbers.
#[derive(Debug, Clone, Copy)]
pub enum Demand {
    /// Less than a bound.
    Below(Name, f64),
    /// At most a bound.
    AtMost(Name, f64),
    /// More than a bound.
    Above(Name, f64),
    /// At least a bound.
    AtLeast(Name, f64),
    /// Nearer to a value than so much.
    Near(Name, f64, f64),
    /// Less than so many times another.
    Less(Name, f64, Name),
    /// More than so many times another.
    More(Name, f64, Name),
    /// As another, to less than this share of it.
    Like(Name, Name, f64),
    /// As another, to less than this amount.
    Close(Name, Name, f64),
    /// Over another, nearer to a value than so much.
    Ratio(Name, Name, f64, f64),
    /// Each more than the one before.
    Rising(Name),
    /// Each less than the one before.
    Falling(Name),
    /// Infinite.
    Never(Name),
}

/// Constructors by the names of claims.
macro_rules! constructors {
    ($($(#[$doc:meta])* $name:ident = $variant:ident($($part:ident: $type:ty),*);)*) => {
        $($(#[$doc])* #[must_use]
        pub const fn $name($($part: $type),*) -> Demand {
            Demand::$variant($($part),*)
        })*
    };
}

constructors! {
    /// Less than a bound.
    below = Below(name: Name, bound: f64);
    /// At most a bound.
    at_most = AtMost(name: Name, bound: f64);
    /// More than a bound.
    above = Above(name: Name, bound: f64);
    /// At least a bound.
    at_least = AtLeast(name: Name, bound: f64);
    /// Nearer to a value than so much.
    near = Near(name: Name, value: f64, within: f64);
    /// Less than so many times another.
    less = Less(name: Name, times: f64, other: Name);
    /// More than so many times another.
    more = More(name: Name, times: f64, other: Name);
    /// As another, to less than this share of it.
    like = Like(name: Name, other: Name, share: f64);
    /// As another, to less than this amount.
    close = Close(name: Name, other: Name, within: f64);
    /// Over another, nearer to a value than so much.
    ratio = Ratio(name: Name, other: Name, value: f64, within: f64);
    /// Each more than the one before.
    rising = Rising(name: Name);
    /// Each less than the one before.
    falling = Falling(name: Name);
    /// Infinite.
    never = Never(name: Name);
}

/// Whether a record meets all demands, with each number beside what was asked of it.
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
    let each = |name, asked, met: &dyn Fn(f64) -> bool| {
        let values = values(record, name)?;
        let met = values.iter().all(|&value| met(value));
        Ok((met, said(record, name, &values, asked)))
    };
    let pairs = |name, other: Name, asked: String, met: &dyn Fn(f64, f64) -> bool| {
        let (values, others) = (values(record, name)?, values(record, other)?);
        // one for each, or one for all
        let fits = others.len() == values.len() || others.len() == 1;
        let against = others.iter().cycle().zip(&values);
        let met = fits && { against }.all(|(&other, &value)| met(value, other));
        let asked = format!("{asked}{}, {other}", list(&others));
        Ok((met, said(record, name, &values, asked)))
    };
    let chain = |name, asked: &str, met: &dyn Fn(f64, f64) -> bool| {
        let values = values(record, name)?;
        let met = values.len() > 1 && values.windows(2).all(|pair| met(pair[0], pair[1]));
        Ok((met, said(record, name, &values, asked.to_owned())))
    };
    let of = |times: f64| match times {
        1.0 => String::new(),
        times => format!("{} of ", shortest(times)),
    };
    let short = shortest;
    match demand {
        Demand::Below(name, bound) => each(name, format!("below {}", short(bound)), &|v| v < bound),
        Demand::AtMost(name, bound) => {
            each(name, format!("at most {}", short(bound)), &|v| v <= bound)
        }
        Demand::Above(name, bound) => each(name, format!("above {}", short(bound)), &|v| v > bound),
        Demand::AtLeast(name, bound) => {
            each(name, format!("at least {}", short(bound)), &|v| v >= bound)
        }
        Demand::Near(name, wanted, within) => {
            let asked = format!("{} within {}", short(wanted), short(within));
            each(name, asked, &|v| (v - wanted).abs() < within)
        }
        Demand::Never(name) => each(name, "infinite".to_owned(), &f64::is_infinite),
        Demand::Less(name, times, other) => {
            let asked = format!("below {}", of(times));
            pairs(name, other, asked, &|v, other| v < times * other)
        }
        Demand::More(name, times, other) => {
            let asked = format!("above {}", of(times));
            pairs(name, other, asked, &|v, other| v > times * other)
        }
        Demand::Like(name, other, share) => {
            let asked = format!("within {} of ", short(share));
            let met = |v: f64, other: f64| (v / other - 1.0).abs() < share;
            pairs(name, other, asked, &met)
        }
        Demand::Close(name, other, within) => {
            let asked = format!("within {} from ", short(within));
            let met = |v: f64, other: f64| (v - other).abs() < within;
            pairs(name, other, asked, &met)
        }
        Demand::Ratio(name, other, wanted, within) => {
            let asked = format!("{} within {} times ", short(wanted), short(within));
            let met = |v: f64, other: f64| (v / other - wanted).abs() < within;
            pairs(name, other, asked, &met)
        }
        Demand::Rising(name) => chain(name, "rising", &|a, b| b > a),
        Demand::Falling(name) => chain(name, "falling", &|a, b| b < a),
    }
}

/// All that a name stands for.
fn values(record: &Record, name: &str) -> Result<Vec<f64>, SandboxError> {
    if let Some((column, table)) = name.split_once(" @ ") {
        return Ok(record.column(table, column)?.to_vec());
    }
    let Some((before, after)) = name.split_once('*') else {
        return Ok(vec![record.number(name)?]);
    };
    let known = record.numbers.iter().map(|number| number.name.as_str());
    let fits = |known: &&str| {
        known.len() >= before.len() + after.len()
            && known.starts_with(before)
            && known.ends_with(after)
    };
    let found: Result<Vec<f64>, _> = known.filter(fits).map(|one| record.number(one)).collect();
    match found {
        Ok(found) if found.is_empty() => Err(SandboxError::NotRecorded {
            kind: "number",
            name: name.to_owned(),
        }),
        found => found,
    }
}

/// What was measured, and what was asked of it.
fn said(record: &Record, name: &str, values: &[f64], asked: String) -> String {
    format!("{name}: {}{} ({asked})", list(values), unit(record, name))
}

/// A few values one by one, of many the least and the largest.
fn list(values: &[f64]) -> String {
    if values.len() > 8 {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        return format!("{} to {}", rounded(least), rounded(most));
    }
    let values: Vec<String> = values.iter().map(|&value| rounded(value)).collect();
    values.join(", ")
}

/// The unit of what a name stands for, behind a space.
fn unit(record: &Record, name: &str) -> String {
    let unit = if let Some((column, table)) = name.split_once(" @ ") {
        let tables = record.tables.iter().filter(|kept| kept.name == table);
        let mut columns = tables.flat_map(|table| &table.columns);
        columns
            .find(|kept| kept.name == column)
            .map(|kept| &kept.unit)
    } else {
        let (before, after) = name.split_once('*').unwrap_or((name, ""));
        let mut numbers = record.numbers.iter();
        let fits = |known: &str| known.starts_with(before) && known.ends_with(after);
        let number = numbers.find(|number| fits(&number.name));
        number.map(|number| &number.unit)
    };
    match unit.map_or("", String::as_str) {
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
        Ok(short) if short.is_infinite() => "never".to_owned(),
        _ => digits,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Table;

    fn record() -> Record {
        let mut record = Record::default();
        record.note("way [px]", 1.23456, 0.0);
        record.note("gap", 1.5e-12, 0.0);
        record.note("p = 1: kept [px]", 2.0, 0.0);
        record.note("p = 2: kept [px]", 3.0, 0.0);
        record.note("p = 1: lost", 4.0, 0.0);
        record.note("p = 2: lost", 6.0, 0.0);
        record.note("end", f64::INFINITY, 0.0);
        record.keep(Table::new("t").exact("area [px²]", [3.0, 2.0, 1.0]));
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
            (at_least("way", 1.23456), true),
            (at_least("way", 1.3), false),
            (near("way", 1.2, 0.1), true),
            (near("way", 1.2, 0.01), false),
            (less("gap", 1.0, "way"), true),
            (less("way", 0.5, "gap"), false),
            (more("way", 2.0, "gap"), true),
            (more("gap", 2.0, "way"), false),
            (like("p = 1: kept", "p = 1: lost", 0.6), true),
            (like("p = 1: kept", "p = 1: lost", 0.4), false),
            (close("p = 1: kept", "p = 1: lost", 2.1), true),
            (close("p = 1: kept", "p = 1: lost", 1.9), false),
            (ratio("p = 1: kept", "p = 1: lost", 0.4, 0.2), true),
            (ratio("p = 1: kept", "p = 1: lost", 0.4, 0.05), false),
            (never("end"), true),
            (never("way"), false),
        ] {
            assert_eq!(found(&[demand]).0, holds, "{demand:?}");
        }
        assert!(!found(&[below("way", 1.3), below("gap", 0.0)]).0);
        assert!(judged(&record(), &[below("none", 1.0)]).is_err());
    }

    #[test]
    fn a_demand_on_many_holds_for_each_of_them() {
        for (demand, holds) in [
            (below("p = *: kept", 3.1), true),
            (below("p = *: kept", 2.5), false),
            (rising("p = *: kept"), true),
            (falling("p = *: kept"), false),
            (falling("area @ t"), true),
            (rising("area @ t"), false),
            (rising("way"), false),
            (ratio("p = *: kept", "p = *: lost", 0.5, 1e-9), true),
            (less("p = *: kept", 1.0, "p = 1: kept"), false),
            (less("p = *: kept", 2.0, "p = 1: kept"), true),
            (less("area @ t", 9.0, "p = *: kept"), false),
        ] {
            assert_eq!(found(&[demand]).0, holds, "{demand:?}");
        }
        assert!(judged(&record(), &[below("q = *", 1.0)]).is_err());
        assert!(judged(&record(), &[below("none @ t", 1.0)]).is_err());
    }

    #[test]
    fn the_words_are_the_number_its_unit_and_what_was_asked() {
        for (demands, words) in [
            (
                &[below("way", 1.3), less("gap", 0.5, "way")][..],
                "way: 1.23 px (below 1.3); gap: 1.50e-12 (below 0.5 of 1.23, way)",
            ),
            (&[near("way", 1.0, 0.5)], "way: 1.23 px (1 within 0.5)"),
            (&[never("end")], "end: never (infinite)"),
            (
                &[below("p = *: kept", 4.0), falling("area @ t")],
                "p = *: kept: 2, 3 px (below 4); area @ t: 3, 2, 1 px² (falling)",
            ),
        ] {
            assert_eq!(found(demands).1, words);
        }
    }
}
