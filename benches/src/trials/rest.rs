//! The oracle's ellipse to rest: how few steps are enough?

use super::effort::to_real;
use integrator::{Scheme, Start};
use sandbox::prelude::*;
use scene::Scene;
use std::path::Path;

/// Within this of the place of rest, for good. px.
const NEAR: f64 = 0.01;
/// The run the oracle made.
const DT: f64 = 0.01;
const UNTIL: f64 = 60.0;

pub(crate) const REST: Experiment = Experiment {
    id: "rest",
    title: "The oracle's ellipse to rest",
    place: "Appendix A",
    question: "The report's program leads 40 nodes to an ellipse in 6001 steps of 0.01 s. After how many steps is it within \
               0.01 px of where it ends, and how few would do?",
    claims: &[
        claim(
            "some scheme comes to rest there with at most a tenth of the report's steps [theory]",
        )
        .when(&[less(
            "fewest steps to rest",
            0.1,
            "report at 0.01 s: steps to rest",
        )]),
        claim("and with a fifth of its steps at the best step it has itself [theory]").when(&[
            less("fewest steps to rest", 0.2, "report: fewest steps to rest"),
        ]),
    ],
    run: || run(1),
    draw,
};

/// The same claims on every third of the steps tried.
pub(crate) const REST_SHORT: Experiment = Experiment {
    run: || run(3),
    ..REST
};

/// The situation of the oracle's run, and where its program ended.
fn oracle() -> Result<(Scene, Vec<DVec2>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/scene/tests/oracle");
    let table = |file: &str| -> Result<Vec<Vec<f64>>> {
        let path = folder.join("snake/ellipse_damped").join(file);
        let text = std::fs::read_to_string(&path)
            .map_err(|reason| refused(format!("{}: {reason}", path.display())))?;
        let number = |word: &str| word.trim().parse().unwrap_or(f64::NAN);
        Ok(text
            .lines()
            .skip(1)
            .map(|line| line.split(',').map(number).collect())
            .collect())
    };
    // the program counts pixels from 1
    let clicks: Vec<String> = table("points.csv")?
        .iter()
        .map(|p| format!("[{}, {}]", p[0] - 1.0, p[1] - 1.0))
        .collect();
    let text = format!(
        "title = \"ellipse\"\nrules = \"report\"\n[picture]\nfile = \"images/ellipse_96x80.pgm\"\n\
         [field]\nscale = 0.15\n[snake]\nnodes = 40\ntopology = \"open\"\nstart = {{ points = [{}] }}\n\
         [material]\ntether = 0.05\ntension = 20.0\nrigidity = 50.0\n\
         [densities]\nmass = 1.0\ndamping = 10.0\n[run]\ndt = {DT}\ntime = {UNTIL:?}\n",
        clicks.join(", ")
    );
    let scene = Scene::parse("ellipse", &text, &folder)?;
    let positions = table("positions.csv")?;
    let last = positions.iter().map(|row| row[0]).fold(0.0, f64::max);
    let end = positions.iter().filter(|row| row[0] >= last);
    Ok((
        scene,
        end.map(|row| DVec2::new(row[2] - 1.0, row[3] - 1.0))
            .collect(),
    ))
}

/// The step after which every node stays within [`NEAR`] of `end`; None where it never does.
fn steps_to_rest(scene: &mut Scene, end: &[DVec2], scheme: Scheme, dt: f64) -> Option<u64> {
    let mut state = scene.start.clone();
    let mut stepper = scheme
        .start(&mut scene.snake, &state, dt, Start::FirstOrder)
        .ok()?;
    let mut arrived = None;
    while state.t < UNTIL.max(40.0 * dt) {
        stepper.step(&mut scene.snake, &mut state).ok()?;
        let mut apart = state.x.iter().zip(end).map(|(x, y)| x.distance(*y));
        if apart.all(|d| d <= NEAR) {
            arrived = arrived.or(Some(state.step));
        } else {
            arrived = None;
        }
    }
    arrived
}

fn schemes() -> impl Iterator<Item = Scheme> {
    Scheme::ALL
        .iter()
        .copied()
        .filter(|scheme| !matches!(scheme, Scheme::DormandPrince { .. }))
}

/// Tries steps from 0.01 s on, five of `every` to an octave.
fn run(every: usize) -> Result {
    let (mut scene, end) = oracle()?;
    let mut record = Record::default();
    let loose = Tolerance::RelativeOrInfinite(1.0);
    let mut count =
        |scheme, dt| steps_to_rest(&mut scene, &end, scheme, dt).map_or(f64::NAN, to_real);
    let or_never = |steps: f64| if steps.is_nan() { f64::INFINITY } else { steps };
    let plain = or_never(count(Scheme::Report, DT));
    record.note("report at 0.01 s: steps to rest", plain, loose);
    let tried = (0..=60)
        .step_by(every)
        .map(|i| 0.01 * 2.0_f64.powf(real(i) / 5.0));
    let tried: Vec<f64> = tried.collect();
    let mut table = Table::raw("steps").exact("dt [s]", tried.clone());
    let mut fewest = f64::INFINITY;
    for scheme in schemes() {
        let steps: Vec<f64> = tried.iter().map(|&dt| count(scheme, dt)).collect();
        let rested = steps
            .iter()
            .zip(&tried)
            .filter(|(steps, _)| steps.is_finite());
        let best = rested.min_by(|a, b| a.0.total_cmp(b.0));
        let (best, with) = best.map_or((f64::NAN, f64::NAN), |(steps, dt)| (*steps, *dt));
        let name = scheme.name();
        record.note(
            format!("{name}: fewest steps to rest"),
            or_never(best),
            loose,
        );
        record.note(format!("{name}: step of these [s]"), with, loose);
        if scheme != Scheme::Report && best.is_finite() {
            fewest = fewest.min(best);
        }
        table = table.exact(name, steps);
    }
    record.note("fewest steps to rest", fewest, loose);
    record.keep(table);
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let (dt, steps) = (
        Axis::log("Δt / s", 0.01, 10.0),
        Axis::log("steps", 10.0, 1e4),
    );
    let mut panel = plot("steps until within 0.01 px for good", dt, steps);
    let mut names = plot("", ("", 0.0, 1.0), ("", 0.0, 1.0)).bare();
    names.share = 0.35;
    for scheme in schemes() {
        let points = record.points("steps", "dt", scheme.name())?;
        let color = super::chart::color(scheme);
        let seen: Vec<(f64, f64)> = points.iter().copied().filter(|p| p.1.is_finite()).collect();
        panel = panel
            .with(line(points, color).weighing(0.8))
            .with(dots(seen, 1.2, color));
        names = names.with(line([], color).weighing(1.6).named(scheme.name()));
    }
    let names = names.legend_at(Corner::TopLeft);
    Artefact::only(
        "Where a line ends the scheme blows up, circles, or rests elsewhere. A picture pushes back, so every scheme that takes \
         its force from the start of a step has a largest step; a step that looks at the picture's slope goes on.",
        Figure::new("The oracle's ellipse to rest", 860.0).with(430.0, vec![panel, names]),
    )
}
