//! Drawn pictures whose truth is a formula: errors below a pixel.

use std::fmt::Write as _;

use glam::DVec2;
use scene::fit::Image;
use score::synthetic::{Case, cases, series};
use score::{Agreement, Deviation};
use serde_json::{Value, json};

use super::rows::{Ending, Fits, TOLERANCE, Way, band};
use super::table::{mean, median, shown};
use score::table::quoted;

/// Seeds of the noise.
const SEEDS: u64 = 3;

/// From this boundary F on it is solved.
const SOLVED: f64 = 0.95;

/// A picture and what it is counted with.
#[derive(Debug)]
pub(super) struct Drawn {
    case: Case,
    /// Contrast over noise of the series; None of a case that stands for itself.
    ratio: Option<f64>,
}

/// A fit of a drawn picture.
#[derive(Debug)]
pub(super) struct Fitted {
    name: String,
    seed: u64,
    ratio: Option<f64>,
    start: &'static str,
    /// None if it blew up or was refused.
    errors: Option<(Agreement, Deviation)>,
    /// Nodes whose band holds the truth, and nodes with a band.
    band: [usize; 2],
    ending: Ending,
    seconds: f64,
}

/// All pictures: the series in noise, then the single cases.
pub(super) fn all() -> Vec<Drawn> {
    let series = series(SEEDS).into_iter().map(|(case, ratio)| Drawn {
        case,
        ratio: Some(ratio),
    });
    let single = cases().into_iter().map(|case| Drawn { case, ratio: None });
    series.chain(single).collect()
}

/// The names of the starts.
pub(super) fn names() -> [&'static str; 3] {
    Case::default().starts().map(|start| start.0)
}

/// Fit a drawn picture from every start that is asked for.
pub(super) fn results(drawn: &Drawn, wanted: &[String], way: &Way<'_>) -> Vec<Fitted> {
    let Drawn { case, ratio } = drawn;
    let bytes = case.picture().mapv(super::change::byte);
    let fits = Fits::new(&Image::bytes(bytes.into_shared()), way);
    let truth = case.truth();
    let mut results = Vec::new();
    for (name, start) in case.starts() {
        if way.stop.asked() || !(wanted.is_empty() || wanted.iter().any(|one| one == name)) {
            continue;
        }
        let found = fits.fit(&start);
        let curve = found.contour().map(|fit| &fit.contour.points[..]);
        results.push(Fitted {
            name: case.name.clone(),
            seed: case.seed,
            ratio: *ratio,
            start: name,
            errors: curve.and_then(|curve| errors(curve, &truth)),
            band: found
                .contour()
                .map_or([0, 0], |fit| band(fit, &[&truth[..]])),
            ending: found.ending(),
            seconds: found.seconds,
        });
    }
    results
}

/// How far a closed polygon is from the truth; None if it has no places.
fn errors(curve: &[DVec2], truth: &[DVec2]) -> Option<(Agreement, Deviation)> {
    let agreement = Agreement::of(&[curve], &[truth], TOLERANCE).ok()?;
    Some((agreement, Deviation::of(curve, truth).ok()?))
}

/// Results that are told together.
struct Group<'a> {
    name: String,
    start: &'static str,
    results: Vec<&'a Fitted>,
}

/// The series by contrast over noise, the cases by name; each by start.
fn groups(results: &[Fitted]) -> Vec<Group<'_>> {
    let mut groups: Vec<Group<'_>> = Vec::new();
    for result in results {
        let name = match result.ratio {
            Some(ratio) if ratio.is_finite() => format!("contrast/noise {ratio}"),
            Some(_) => "no noise".to_owned(),
            None => result.name.clone(),
        };
        let known = groups
            .iter_mut()
            .find(|group| group.name == name && group.start == result.start);
        match known {
            Some(group) => group.results.push(result),
            None => groups.push(Group {
                name,
                start: result.start,
                results: vec![result],
            }),
        }
    }
    groups
}

impl Fitted {
    fn solved(&self) -> bool {
        self.errors
            .is_some_and(|(agreement, _)| agreement.f() > SOLVED)
    }
}

impl Group<'_> {
    /// Median of the mean distance; of those that are solved the mean of the RMS and of the mean of the signed
    /// distance; CPU seconds.
    fn numbers(&self) -> [f64; 5] {
        let errors = || self.results.iter().filter_map(|one| one.errors);
        let solved = || {
            self.results
                .iter()
                .filter(|one| one.solved())
                .filter_map(|one| one.errors)
        };
        [
            median(errors().map(|one| one.0.mean)),
            mean(solved().map(|one| one.1.rms)),
            mean(solved().map(|one| one.1.mean)),
            mean(self.results.iter().map(|one| one.seconds)),
            self.band(),
        ]
    }

    /// The share of the nodes whose 95 % band holds the truth, of those that are solved.
    fn band(&self) -> f64 {
        let solved = self.results.iter().filter(|one| one.solved());
        let counts = solved.fold([0, 0], |[a, b], one| [a + one.band[0], b + one.band[1]]);
        counts[0] as f64 / counts[1] as f64
    }

    /// Solved, unsure, refused.
    fn counts(&self) -> [usize; 3] {
        let count =
            |is: &dyn Fn(&Fitted) -> bool| self.results.iter().filter(|one| is(one)).count();
        [
            count(&|one| one.solved()),
            count(&|one| matches!(one.ending, Ending::Unsure(_))),
            count(&|one| matches!(one.ending, Ending::Refused(_))),
        ]
    }
}

/// The table for people.
pub(super) fn text(results: &[Fitted]) -> String {
    let groups = groups(results);
    let mut text = format!(
        "{:18} {:8} {:>3} {:>6} {:>8} {:>7} {:>8} {:>5} {:>6} {:>7} {:>6}\n",
        "picture",
        "start",
        "n",
        "solved",
        "distance",
        "rms",
        "mean",
        "band",
        "unsure",
        "refused",
        "CPU s"
    );
    for group in &groups {
        let ([solved, unsure, refused], numbers) = (group.counts(), group.numbers());
        let [distance, rms, bias, band] =
            [numbers[0], numbers[1], numbers[2], numbers[4]].map(|v| shown(v, 3));
        // writing to a String cannot fail
        let _ = writeln!(
            text,
            "{:18} {:8} {:>3} {solved:>6} {distance:>8} {rms:>7} {bias:>8} {band:>5} {unsure:>6} {refused:>7} {:>6.4}",
            group.name,
            group.start,
            group.results.len(),
            numbers[3]
        );
    }
    let solved = results.iter().filter(|one| one.solved()).count();
    let _ = writeln!(text, "solved: {solved} of {}", results.len());
    text
}

/// The table as JSON.
pub(super) fn json(results: &[Fitted]) -> Vec<Value> {
    let told = |group: &Group<'_>| {
        let ([solved, unsure, refused], numbers) = (group.counts(), group.numbers());
        json!({
            "picture": group.name,
            "start": group.start,
            "number": group.results.len(),
            "solved": solved,
            "median_distance": numbers[0],
            "rms": numbers[1],
            "mean_signed": numbers[2],
            "band": numbers[4],
            "unsure": unsure,
            "refused": refused,
            "cpu_seconds": numbers[3],
        })
    };
    groups(results).iter().map(told).collect()
}

/// A row a fit as CSV; empty where there is no number.
pub(super) fn each(results: &[Fitted]) -> String {
    let mut text = String::from(
        "picture,seed,contrast_to_noise,start,mean_distance,hausdorff,boundary_f,rms,mean_signed,outcome,why,cpu_seconds\n",
    );
    let number = |value: Option<f64>| value.map_or_else(String::new, |v| format!("{v:.6}"));
    for one in results {
        let (outcome, why) = one.ending.told();
        let of = |what: &dyn Fn(&Agreement, &Deviation) -> f64| {
            number(one.errors.as_ref().map(|(a, d)| what(a, d)))
        };
        let values = [
            quoted(&one.name),
            one.seed.to_string(),
            one.ratio
                .map_or_else(String::new, |ratio| ratio.to_string()),
            one.start.to_owned(),
            of(&|a, _| a.mean),
            of(&|a, _| a.hausdorff),
            of(&|a, _| a.f()),
            of(&|_, d| d.rms),
            of(&|_, d| d.mean),
            outcome.to_owned(),
            quoted(why),
            number(Some(one.seconds)),
        ];
        text += &values.join(",");
        text.push('\n');
    }
    text
}
