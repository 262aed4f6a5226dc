//! Many fits in a few numbers.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::rows::{Ending, Row};
use score::table::quoted;

/// So much less `IoU` than its start's is a loss.
const LOSS: f64 = 0.02;

/// The fits of one quality in numbers; NaN where there is nothing to take a mean of.
#[derive(Debug)]
pub(super) struct Summary {
    pub(super) quality: String,
    pub(super) number: usize,
    start: f64,
    iou: f64,
    median: f64,
    mean: f64,
    hausdorff: f64,
    f: f64,
    worse: usize,
    unsure: usize,
    refused: usize,
    band: f64,
    seconds: f64,
    same: f64,
}

/// One row for every quality in the order of the fits, and one for all if there are several.
pub(super) fn summaries(rows: &[Row]) -> Vec<Summary> {
    let mut qualities: Vec<&str> = Vec::new();
    for row in rows {
        if !qualities.contains(&row.quality.as_str()) {
            qualities.push(&row.quality);
        }
    }
    let of = |name: &str| {
        rows.iter()
            .filter(|row| row.quality == name)
            .collect::<Vec<_>>()
    };
    let mut all: Vec<Summary> = qualities
        .iter()
        .map(|name| Summary::of(name, &of(name)))
        .collect();
    if all.len() > 1 {
        all.push(Summary::of("all", &rows.iter().collect::<Vec<_>>()));
    }
    all
}

/// The mean of what there is.
pub(super) fn mean(values: impl IntoIterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for value in values {
        sum += value;
        count += 1.0;
    }
    sum / count
}

/// The middle value, or the mean of the two in the middle.
pub(super) fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.into_iter().collect();
    sorted.sort_by(f64::total_cmp);
    let half = sorted.len() / 2;
    match sorted[..] {
        [] => f64::NAN,
        _ if sorted.len() % 2 == 1 => sorted[half],
        _ => 0.5 * (sorted[half - 1] + sorted[half]),
    }
}

impl Summary {
    fn of(quality: &str, rows: &[&Row]) -> Self {
        let agreements = || {
            rows.iter()
                .filter_map(|row| Some(row.found.as_ref()?.1.agreement))
        };
        let count = |is: &dyn Fn(&Row) -> bool| rows.iter().filter(|row| is(row)).count();
        let bands = rows
            .iter()
            .fold([0, 0], |[a, b], row| [a + row.band[0], b + row.band[1]]);
        Self {
            quality: quality.to_owned(),
            number: rows.len(),
            start: mean(rows.iter().map(|row| row.start_iou)),
            iou: mean(rows.iter().map(|row| row.iou())),
            median: median(rows.iter().map(|row| row.iou())),
            mean: mean(agreements().map(|a| a.mean)),
            hausdorff: mean(agreements().map(|a| a.hausdorff)),
            f: mean(rows.iter().map(|row| row.f())),
            worse: count(&|row| row.iou() < row.start_iou - LOSS),
            unsure: count(&|row| matches!(row.ending, Ending::Unsure(_))),
            refused: count(&|row| matches!(row.ending, Ending::Refused(_))),
            band: bands[0] as f64 / bands[1] as f64,
            seconds: mean(rows.iter().map(|row| row.seconds)),
            same: mean(rows.iter().filter_map(|row| row.same)),
        }
    }

    pub(super) fn json(&self) -> Value {
        json!({
            "quality": self.quality,
            "number": self.number,
            "start_iou": self.start,
            "iou": self.iou,
            "median_iou": self.median,
            "mean_distance": self.mean,
            "hausdorff": self.hausdorff,
            "boundary_f": self.f,
            "worse": self.worse,
            "unsure": self.unsure,
            "refused": self.refused,
            "band": self.band,
            "cpu_seconds": self.seconds,
            "same_iou": self.same,
        })
    }
}

/// A number with so many decimals; a dash for none.
pub(super) fn shown(value: f64, decimals: usize) -> String {
    if value.is_finite() {
        format!("{value:.decimals$}")
    } else {
        "-".to_owned()
    }
}

/// The table for people; with a last column if the pictures were changed.
pub(super) fn text(summaries: &[Summary], changed: bool) -> String {
    let wide = summaries
        .iter()
        .map(|s| s.quality.chars().count())
        .max()
        .unwrap_or(0)
        .max(7);
    let mut text = format!(
        "{:wide$} {:>4} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>5} {:>6} {:>7} {:>5} {:>6}",
        "quality",
        "n",
        "start",
        "IoU",
        "median",
        "dist",
        "Hausd",
        "F2",
        "worse",
        "unsure",
        "refused",
        "band",
        "CPU s"
    );
    text += if changed { "   same\n" } else { "\n" };
    for s in summaries {
        let numbers = [
            (s.start, 4),
            (s.iou, 4),
            (s.median, 4),
            (s.mean, 2),
            (s.hausdorff, 2),
            (s.f, 4),
        ];
        // writing to a String cannot fail
        let _ = write!(text, "{:wide$} {:>4}", s.quality, s.number);
        for (value, decimals) in numbers {
            let _ = write!(text, " {:>6}", shown(value, decimals));
        }
        let counts = (s.worse, s.unsure, s.refused);
        let _ = write!(text, " {:>5} {:>6} {:>7}", counts.0, counts.1, counts.2);
        let _ = write!(text, " {:>5} {:>6}", shown(s.band, 3), shown(s.seconds, 3));
        if changed {
            let _ = write!(text, " {:>6}", shown(s.same, 4));
        }
        text.push('\n');
    }
    text
}

/// A row a fit as CSV; empty where there is no number.
pub(super) fn each(rows: &[Row]) -> String {
    let mut text = String::from(
        "stem,quality,start_iou,iou,mean_distance,hausdorff,precision,recall,boundary_f,outcome,why,same_iou,cpu_seconds\n",
    );
    let number = |value: Option<f64>| value.map_or_else(String::new, |v| format!("{v:.6}"));
    for row in rows {
        let agreement = row.found.as_ref().map(|(_, scores)| scores.agreement);
        let (outcome, why) = row.ending.told();
        let values = [
            quoted(&row.stem),
            quoted(&row.quality),
            number(Some(row.start_iou)),
            number(Some(row.iou())),
            number(agreement.map(|a| a.mean)),
            number(agreement.map(|a| a.hausdorff)),
            number(agreement.map(|a| a.precision)),
            number(agreement.map(|a| a.recall)),
            number(Some(row.f())),
            outcome.to_owned(),
            quoted(why),
            number(row.same),
            number(Some(row.seconds)),
        ];
        text += &values.join(",");
        text.push('\n');
    }
    text
}
