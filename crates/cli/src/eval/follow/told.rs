//! Scores of sequences as tables.

use std::fmt::Write as _;

use score::tracking::{Followed as Means, TrackScores};
use serde_json::{Value, json};

use super::run::{Followed, Score};
use crate::eval::table::{mean, shown};
use score::table::quoted;

/// Columns of one object: name, width, decimals.
const ONE: [(&str, usize, usize); 9] = [
    ("IoU", 6, 4),
    ("last", 6, 4),
    ("worst", 6, 4),
    ("F2", 6, 4),
    ("J&F", 6, 4),
    ("dist", 6, 2),
    ("lost", 5, 3),
    ("wrong", 5, 3),
    ("ms", 6, 1),
];

/// Columns of many objects.
const MANY: [(&str, usize, usize); 7] = [
    ("SEG", 6, 4),
    ("DET", 6, 4),
    ("TRA", 6, 4),
    ("IDF1", 6, 4),
    ("switch", 6, 0),
    ("div F1", 6, 4),
    ("ms", 6, 1),
];

impl Followed {
    fn milliseconds(&self) -> f64 {
        self.seconds.map_or(f64::NAN, |seconds| 1000.0 * seconds)
    }

    /// The numbers of its columns; NaN for none.
    fn numbers(&self) -> Vec<f64> {
        let or = |value: Option<f64>| value.unwrap_or(f64::NAN);
        match &self.score {
            Score::One(m, _) => vec![
                m.iou,
                m.last,
                m.worst,
                m.f,
                or(m.j_and_f()),
                or(m.distance),
                m.lost,
                m.sure_and_lost,
                self.milliseconds(),
            ],
            Score::Many(s) => vec![
                or(s.seg),
                or(s.det),
                or(s.tra),
                or(s.idf1),
                s.switches as f64,
                or(s.division_f1()),
                self.milliseconds(),
            ],
        }
    }

    /// Events told rightly of all there are, and those told where there is none; a dash if nothing is known.
    fn events(&self) -> String {
        match self.events {
            None => "-".to_owned(),
            Some([right, wrong, missed]) => format!("{right}/{}+{wrong}", right + missed),
        }
    }

    const fn frames(&self) -> usize {
        match &self.score {
            Score::One(means, _) => means.frames,
            Score::Many(scores) => scores.frames,
        }
    }

    const fn is_one(&self) -> bool {
        matches!(self.score, Score::One(..))
    }
}

/// The tables for people: of one object, then of many; a row a sequence and start, then the means of each start.
pub(super) fn text(rows: &[Followed]) -> String {
    let mut text = String::new();
    for (one, columns) in [(true, &ONE[..]), (false, &MANY[..])] {
        let own: Vec<&Followed> = rows.iter().filter(|row| row.is_one() == one).collect();
        if own.is_empty() {
            continue;
        }
        if !text.is_empty() {
            text.push('\n');
        }
        table(&mut text, &own, columns);
    }
    for row in rows {
        if let Some(why) = &row.refused {
            // writing to a String cannot fail
            let _ = writeln!(text, "{} from {}: {why}", row.sequence, row.start);
        }
    }
    text
}

fn table(text: &mut String, rows: &[&Followed], columns: &[(&str, usize, usize)]) {
    let names = rows.iter().map(|row| row.sequence.chars().count());
    let wide = names.max().unwrap_or(0).max(8);
    let _ = write!(text, "{:wide$} {:6} {:>4}", "sequence", "start", "n");
    for (name, width, _) in columns {
        let _ = write!(text, " {name:>width$}");
    }
    text.push_str("  events\n");
    let mut line = |name: &str, start: &str, count: usize, numbers: &[f64], events: &str| {
        let _ = write!(text, "{name:wide$} {start:6} {count:>4}");
        for (number, (_, width, decimals)) in numbers.iter().zip(columns) {
            let _ = write!(text, " {:>width$}", shown(*number, *decimals));
        }
        if !events.is_empty() {
            let _ = write!(text, " {events:>7}");
        }
        text.push('\n');
    };
    let mut starts: Vec<&str> = Vec::new();
    for row in rows {
        let events = row.events();
        line(
            &row.sequence,
            &row.start,
            row.frames(),
            &row.numbers(),
            &events,
        );
        if !starts.contains(&row.start.as_str()) {
            starts.push(&row.start);
        }
    }
    for start in starts {
        let own: Vec<Vec<f64>> = rows
            .iter()
            .filter(|row| row.start == start)
            .map(|row| row.numbers())
            .collect();
        let column = |k: usize| mean(own.iter().map(|row| row[k]).filter(|v| v.is_finite()));
        let means: Vec<f64> = (0..columns.len()).map(column).collect();
        line("all", start, own.len(), &means, "");
    }
}

/// The rows as JSON.
pub(super) fn json(rows: &[Followed]) -> Vec<Value> {
    let told = |row: &Followed| {
        let mut value = match &row.score {
            Score::One(means, _) => of_one(means),
            Score::Many(scores) => of_many(scores),
        };
        value["sequence"] = json!(row.sequence);
        value["start"] = json!(row.start);
        value["frames"] = json!(row.frames());
        value["events"] = json!(row.events.map(|[right, wrong, missed]| {
            json!({ "right": right, "wrong": wrong, "missed": missed })
        }));
        value["refused"] = json!(row.refused);
        value["cpu_ms"] = json!(row.milliseconds());
        value
    };
    rows.iter().map(told).collect()
}

fn of_one(m: &Means) -> Value {
    json!({
        "iou": m.iou,
        "last_iou": m.last,
        "worst_iou": m.worst,
        "boundary_f": m.f,
        "davis_j": m.j,
        "davis_f": m.davis,
        "davis_j_and_f": m.j_and_f(),
        "mean_distance": m.distance,
        "lost": m.lost,
        "sure_and_lost": m.sure_and_lost,
    })
}

fn of_many(s: &TrackScores) -> Value {
    let e = &s.errors;
    json!({
        "seg": s.seg,
        "det": s.det,
        "tra": s.tra,
        "idf1": s.idf1,
        "switches": s.switches,
        "division_f1": s.division_f1(),
        "divisions": { "right": s.divisions[0], "wrong": s.divisions[1], "missed": s.divisions[2] },
        "graph": {
            "nodes": e.nodes, "edges": e.edges, "split": e.split, "missed": e.missed, "extra": e.extra,
            "deleted": e.deleted, "added": e.added, "changed": e.changed, "aogm": e.aogm(),
        },
    })
}

/// A row a frame as CSV, of sequences with one object; of one with many, a row with its scores.
pub(super) fn each(rows: &[Followed]) -> String {
    let mut text = String::from(
        "sequence,start,frame,iou,boundary_f,davis_f,mean_distance,sure,seg,det,tra,idf1,switches,division_f1\n",
    );
    let number = |value: Option<f64>| value.map_or_else(String::new, |v| format!("{v:.6}"));
    for row in rows {
        let head = format!("{},{}", quoted(&row.sequence), quoted(&row.start));
        match &row.score {
            Score::One(_, frames) => {
                for (t, frame) in frames.iter().enumerate() {
                    let distance = number(frame.distance);
                    let _ = writeln!(
                        text,
                        "{head},{t},{:.6},{:.6},{:.6},{distance},{},,,,,,",
                        frame.iou,
                        frame.f,
                        frame.davis,
                        u8::from(frame.sure)
                    );
                }
            }
            Score::Many(s) => {
                let values = [s.seg, s.det, s.tra, s.idf1].map(number).join(",");
                let divisions = number(s.division_f1());
                let _ = writeln!(text, "{head},,,,,,,{values},{},{divisions}", s.switches);
            }
        }
    }
    text
}
