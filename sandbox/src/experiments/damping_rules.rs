//! Report §3.4.2: the best constant damping, found by search, beside rules by which the program chooses.

use crate::prelude::*;
use elastic::Topology;
use integrator::{Scheme, State, System};
use scene::Scene;
use snake::{Body, Damping, Rest, Settling, Snake, Until, World};
use std::path::Path;

/// What is let go, the range of γ that is searched, and the γ that its scene has.
const CASES: [(&str, f64, f64, f64); 6] = [
    ("soft ball", 0.3, 100.0, 0.2),
    ("hard ball", 0.3, 300.0, 0.2),
    ("very hard ball", 0.3, 300.0, 4.0),
    ("apple", 0.05, 5.0, 2.0),
    ("ellipse", 0.1, 20.0, 10.0),
    ("ellipse of the report", 0.5, 50.0, 10.0),
];

/// The rules, and how they are drawn.
const RULES: [(&str, Damping, Color); 4] = [
    (
        "critical for the slowest mode",
        Damping::Mode(0),
        Color::GREEN,
    ),
    ("critical for the third", Damping::Mode(2), Color::SKY),
    ("critical for each node", Damping::Local, Color::RED),
    (
        "internal for the slowest mode",
        Damping::InternalMode(0),
        Color::PURPLE,
    ),
];

/// Rules of damping against the best constant.
pub(crate) const RULES_OF_DAMPING: Experiment = Experiment {
    id: "sec-3-4-2-rules",
    title: "Damping chosen by the program",
    place: "§3.4.2",
    question: "The report wishes for damping that is chosen, critical where it can be. Six bodies are let go out of shape, three of them free and \
               three in a picture. How long do they take to rest for every constant γ, and where do the rules come in?",
    claims: &[
        claim(
            "critical for the slowest mode that resists is nearly the best constant, without a \
               search, where forces have a potential [report §3.4.2, D23]",
        )
        .judged(|r| {
            let times = over(r, "critical for the slowest mode", "best constant")?;
            let worst = most(times);
            Ok(Finding::new(
                worst < 1.6,
                format!("at most {worst:.2} times the best constant's"),
            ))
        }),
        claim(
            "it saves a search and many times the time of the constants written by hand [scenes]",
        )
        .judged(|r| {
            let times = over(
                r,
                "the scene's own constant",
                "critical for the slowest mode",
            )?;
            let least = least(times);
            Ok(Finding::new(
                least > 2.0,
                format!("at least {least:.0} times sooner at rest"),
            ))
        }),
        claim(
            "the report's wish, damping critical at each node, is the slowest of the rules for a \
               damping of the medium: long waves creep [report §3.4.2]",
        )
        .judged(|r| {
            let first = over(r, "critical for each node", "critical for the slowest mode")?;
            let third = over(r, "critical for each node", "critical for the third")?;
            let least = least(first.into_iter().chain(third));
            let words = format!("at least {least:.1} times the time of the other two");
            Ok(Finding::new(least > 1.0, words))
        }),
        claim(
            "under the report's own rules it is the other way round: little damping never rests \
               there, and each node's own is as good as the best [D39, D52]",
        )
        .when(&[
            less(
                "ellipse of the report: critical for each node",
                1.5,
                "ellipse of the report: best constant",
            ),
            never("ellipse of the report: critical for the slowest mode"),
        ]),
    ],
    run,
    draw,
};

/// One time over another in each case where forces have a potential.
fn over(r: &Record, what: &str, other: &str) -> Result<Vec<f64>> {
    let time = |case: &str, what: &str| r.number(&format!("{case}: {what}"));
    let cases = CASES[..5].iter();
    cases
        .map(|case| Ok(time(case.0, what)? / time(case.0, other)?))
        .collect()
}

/// A ball of chapter 2 let go squeezed, with nothing around it.
fn ball(scene: &str) -> Result<Settling> {
    let material = scene_with(scene, &[])?.snake.body().material.clone();
    let nodes = elastic::ellipse(DVec2::ZERO, DVec2::new(1.5, 1.0), 0.0, 40);
    let body = Body::of(&nodes, Topology::Closed, 1.0)?.with_material(material);
    let squeezed = nodes.iter().map(|p| DVec2::new(0.7 * p.x, 1.2 * p.y));
    Ok(Settling {
        snake: Snake::new(body, World::default())?,
        state: State::at_rest(squeezed.collect()),
        scheme: Scheme::Leapfrog,
        dt: 2e-3,
        until: Until::at_rest(Rest::default(), 60_000),
    })
}

/// A scene from its start, until it rests.
fn settling(scene: Scene, steps: u64) -> Settling {
    Settling {
        scheme: scene.plan.scheme,
        dt: scene.plan.dt,
        until: Until::at_rest(Rest::default(), steps),
        snake: scene.snake,
        state: scene.start,
    }
}

/// The ellipse on which the report's program was run for comparison, in the source tree this program was built from.
fn ellipse(rules: &str) -> Result<Settling> {
    let text = format!(
        "title = \"ellipse\"\nrules = \"{rules}\"\n\
         [picture]\nfile = \"images/ellipse_96x80.pgm\"\n[field]\nscale = 0.15\n\
         [snake]\nnodes = 40\ntopology = \"open\"\nstart = {{ points = [[10.86, 45.56], [11.56, 33.45], [18.96, 22.7], \
         [31.66, 15.32], [47.3, 12.7], [62.94, 15.32], [75.64, 22.7], [83.04, 33.45], [83.74, 45.56]] }}\n\
         [material]\ntether = 0.05\ntension = 20.0\nrigidity = 50.0\n\
         [densities]\nmass = 1.0\ndamping = 10.0\n\
         [run]\ndt = 0.05\nsteps = 1\n"
    );
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/scene/tests/oracle");
    let scene = Scene::parse("ellipse", &text, &folder)?;
    Ok(settling(scene, 12_000))
}

fn case(name: &str) -> Result<Settling> {
    match name {
        "apple" => Ok(settling(scene_with("apple", &[])?, 12_000)),
        "ellipse" => ellipse("corrected"),
        "ellipse of the report" => ellipse("report"),
        ball_of => ball(&ball_of.replace(' ', "-")),
    }
}

fn run() -> Result {
    let mut record = Record::default();
    // moments of looking are a fifth of the run apart
    let like = Tolerance::RelativeOrInfinite(0.02);
    for (name, low, high, constant) in CASES {
        let run = case(name)?;
        let time = |rule| -> Result<f64> { Ok(run.under(&[rule])?.time_to_rest()) };
        let (mut gammas, mut times) = (Vec::new(), Vec::new());
        for i in 0..=16 {
            let gamma = low * (high / low).powf(f64::from(i) / 16.0);
            gammas.push(gamma);
            times.push(time(Damping::Constant(gamma))?);
        }
        let best = run.best_constant(low, high, 9)?;
        let mut own = record.under(name);
        own.note("best constant [s]", best.time_to_rest(), like);
        let found = match best.rules.first() {
            Some(Damping::Constant(gamma)) => *gamma,
            _ => f64::NAN,
        };
        own.note("its damping [1/s]", found, share(0.1));
        let by_hand = time(Damping::Constant(constant))?;
        own.note("the scene's own constant [s]", by_hand, like);
        for (rule, damping, _) in RULES {
            own.note(&format!("{rule} [s]"), time(damping)?, like);
            // where it stands among the constants: the mean of what it chose
            let mut snake = run.snake.clone();
            snake.damp(Damping::Constant(0.0), &run.state)?;
            snake.damp(damping, &run.state)?;
            let mean = mean(snake.damping().iter().copied());
            own.note(&format!("{rule}: mean damping [1/s]"), mean, share(1e-6));
        }
        let search = Table::raw(name).exact("gamma [1/s]", gammas);
        record.keep(search.exact("time [s]", times));
    }
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let mut panels = Vec::new();
    for (name, low, high, _) in CASES {
        let number = |what: &str| record.number(&format!("{name}: {what}"));
        let mut points = record.points(name, "gamma", "time")?;
        points.retain(|p| p.1.is_finite());
        let (best, at) = (number("best constant")?, number("its damping")?);
        let times = RULES.map(|(rule, ..)| number(rule));
        let times = times.into_iter().collect::<Result<Vec<f64>>>()?;
        let rested = times.iter().copied().filter(|time| time.is_finite());
        let slowest = most(points.iter().map(|p| p.1).chain(rested).chain([best]));
        // one panel of six has the legend
        let told = name == "hard ball";
        let words = |words: &'static str| if told { words } else { "" };
        let room = if told { 30.0 } else { 2.0 };
        let x = Axis::log("constant γ / (1/s)", 0.6 * low, 1.6 * high);
        let y = Axis::log("time to rest / s", 0.6 * best, room * slowest);
        let mut panel = plot(name, x, y)
            .with(line(points.clone(), Color::INK).weighing(0.8))
            .with(dots(points, 1.2, Color::INK))
            .with(dots([(at, best)], 3.2, Color::ORANGE).named(words("best constant found")));
        for ((rule, damping, color), time) in RULES.into_iter().zip(times) {
            if !time.is_finite() {
                continue;
            }
            panel = if matches!(damping, Damping::InternalMode(_)) {
                let across = line([(0.6 * low, time), (1.6 * high, time)], color);
                panel.with(across.dashed().named(words(rule)))
            } else {
                let mean = number(&format!("{rule}: mean damping"))?;
                let shown = dots([(mean.min(1.5 * high), time)], 3.2, color);
                panel.with(shown.named(words(rule)))
            };
        }
        panels.push(panel);
    }
    let below = panels.split_off(3);
    Artefact::only(
        "Black: a run for every constant γ; gaps never came to rest. Dots: what a rule chose, at its mean γ, and how long that took. Dashed: internal damping, which has \
         no γ. Rest is looked for at moments a fifth of the run apart, hence the saw teeth.",
        Figure::new("§3.4.2  Time to rest by rules of damping", 1000.0)
            .with(270.0, panels)
            .with(270.0, below),
    )
}
