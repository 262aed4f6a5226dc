//! Report §3.4.2: the best constant damping, found by search, beside rules by which the program chooses.

use super::motion::changed_scene;
use crate::draw::{Axis, Color, Corner, Figure, Layer, Line, Panel};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance};
use elastic::{Material, Topology};
use glam::DVec2;
use integrator::{Scheme, State, System};
use scene::Scene;
use snake::{Body, Damping, Rest, Settling, Snake, Until, World};
use std::path::Path;

const ID: &str = "sec-3-4-2-rules";

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
    id: ID,
    title: "Damping chosen by the program",
    place: "§3.4.2",
    question: "The report wishes for damping that is chosen, critical where it can be. Six bodies are let go out of shape, three of them free and \
               three in a picture. How long do they take to rest for every constant γ, and where do the rules come in?",
    claims: &[
        Claim {
            says: "critical for the slowest mode that resists is nearly the best constant, without a search",
            source: "report §3.4.2, D23",
            judge: |r| {
                let mut worst = 0.0_f64;
                for (case, ..) in &CASES[..5] {
                    let best = r.number(&format!("{case}: best constant"))?;
                    let rule = r.number(&format!("{case}: critical for the slowest mode"))?;
                    worst = worst.max(rule / best);
                }
                Ok(Finding::new(
                    worst < 1.6,
                    format!(
                        "at most {worst:.2} times the time of the best constant, where forces have a potential"
                    ),
                ))
            },
        },
        Claim {
            says: "it saves a search and many times the time of the constants written by hand",
            source: "scenes",
            judge: |r| {
                let mut least = f64::INFINITY;
                for (case, ..) in &CASES[..5] {
                    let own = r.number(&format!("{case}: the scene's own constant"))?;
                    let rule = r.number(&format!("{case}: critical for the slowest mode"))?;
                    least = least.min(own / rule);
                }
                Ok(Finding::new(
                    least > 2.0,
                    format!("at least {least:.0} times sooner at rest"),
                ))
            },
        },
        Claim {
            says: "the report's wish, damping critical at each node, is the slowest of the rules for a damping of the medium: long waves creep",
            source: "report §3.4.2",
            judge: |r| {
                let mut least = f64::INFINITY;
                for (case, ..) in &CASES[..5] {
                    let node = r.number(&format!("{case}: critical for each node"))?;
                    for other in ["critical for the slowest mode", "critical for the third"] {
                        least = least.min(node / r.number(&format!("{case}: {other}"))?);
                    }
                }
                Ok(Finding::new(
                    least > 1.0,
                    format!("at least {least:.1} times the time of the other two"),
                ))
            },
        },
        Claim {
            says: "under the report's own rules it is the other way round: little damping never rests there, and each node's own is as good as the best",
            source: "D39, D52",
            judge: |r| {
                let case = CASES[5].0;
                let best = r.number(&format!("{case}: best constant"))?;
                let node = r.number(&format!("{case}: critical for each node"))?;
                let mode = r.number(&format!("{case}: critical for the slowest mode"))?;
                Ok(Finding::new(
                    node < 1.5 * best && mode.is_infinite(),
                    format!(
                        "{:.2} times the best; critical for the slowest mode never rests",
                        node / best
                    ),
                ))
            },
        },
    ],
    run,
    draw,
};

/// A ball of chapter 2 let go squeezed, with nothing around it.
fn ball(scene: &str) -> Result<Settling, SandboxError> {
    let scene = changed_scene(ID, scene, &[])?;
    let material: Material = scene.snake.body().material.clone();
    let nodes = elastic::ellipse(DVec2::ZERO, DVec2::new(1.5, 1.0), 0.0, 40);
    let body = Body::of(&nodes, Topology::Closed, 1.0)
        .map_err(SandboxError::refused(ID))?
        .with_material(material);
    let squeezed = nodes.iter().map(|p| DVec2::new(0.7 * p.x, 1.2 * p.y));
    Ok(Settling {
        snake: Snake::new(body, World::default()).map_err(SandboxError::refused(ID))?,
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
fn ellipse(rules: &str) -> Result<Settling, SandboxError> {
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
    let scene = Scene::parse("ellipse", &text, &folder).map_err(SandboxError::refused(ID))?;
    Ok(settling(scene, 12_000))
}

fn case(name: &str) -> Result<Settling, SandboxError> {
    match name {
        "apple" => Ok(settling(changed_scene(ID, "apple", &[])?, 12_000)),
        "ellipse" => ellipse("corrected"),
        "ellipse of the report" => ellipse("report"),
        ball_of => ball(&ball_of.replace(' ', "-")),
    }
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    // moments of looking are a fifth of the run apart
    let like = Tolerance::RelativeOrInfinite(0.02);
    for (name, low, high, own) in CASES {
        let run = case(name)?;
        let under = |rules: &[Damping]| run.under(rules).map_err(SandboxError::refused(ID));
        let (mut gammas, mut times) = (Vec::new(), Vec::new());
        for i in 0..=16 {
            let gamma = low * (high / low).powf(f64::from(i) / 16.0);
            gammas.push(gamma);
            times.push(under(&[Damping::Constant(gamma)])?.time_to_rest());
        }
        let best = run
            .best_constant(low, high, 9)
            .map_err(SandboxError::refused(ID))?;
        record.note(
            format!("{name}: best constant"),
            best.time_to_rest(),
            "s",
            like,
        );
        let found = match best.rules.first() {
            Some(Damping::Constant(gamma)) => *gamma,
            _ => f64::NAN,
        };
        record.note(
            format!("{name}: its damping"),
            found,
            "1/s",
            Tolerance::Relative(0.1),
        );
        let own = under(&[Damping::Constant(own)])?;
        record.note(
            format!("{name}: the scene's own constant"),
            own.time_to_rest(),
            "s",
            like,
        );
        for (rule, damping, _) in RULES {
            let row = under(&[damping])?;
            record.note(format!("{name}: {rule}"), row.time_to_rest(), "s", like);
            // where it stands among the constants: the mean of what it chose
            let mut snake = run.snake.clone();
            snake
                .damp(Damping::Constant(0.0), &run.state)
                .map_err(SandboxError::refused(ID))?;
            snake
                .damp(damping, &run.state)
                .map_err(SandboxError::refused(ID))?;
            let mean = snake.damping().iter().sum::<f64>() / crate::real(snake.damping().len());
            record.note(
                format!("{name}: {rule}: mean damping"),
                mean,
                "1/s",
                Tolerance::Relative(1e-6),
            );
        }
        record.keep(
            Table::raw(table(name))
                .with("gamma", "1/s", Tolerance::EXACT, gammas)
                .with("time", "s", Tolerance::EXACT, times),
        );
    }
    Ok(record)
}

/// The table of a case.
fn table(name: &str) -> &'static str {
    match name {
        "soft ball" => "search-soft",
        "hard ball" => "search-hard",
        "very hard ball" => "search-very-hard",
        "apple" => "search-apple",
        "ellipse" => "search-ellipse",
        _ => "search-report",
    }
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let mut panels = Vec::new();
    for (name, low, high, _) in CASES {
        let points = record.points(table(name), "gamma", "time")?;
        let finite: Vec<(f64, f64)> = points.iter().copied().filter(|p| p.1.is_finite()).collect();
        let best = record.number(&format!("{name}: best constant"))?;
        let at = record.number(&format!("{name}: its damping"))?;
        let mut most = finite.iter().map(|p| p.1).fold(best, f64::max);
        for (rule, ..) in RULES {
            let time = record.number(&format!("{name}: {rule}"))?;
            if time.is_finite() {
                most = most.max(time);
            }
        }
        let mut panel = Panel::new(
            name,
            Axis::log("constant γ / (1/s)", 0.6 * low, 1.6 * high),
            Axis::log(
                "time to rest / s",
                0.6 * best,
                if name == CASES[1].0 {
                    30.0 * most
                } else {
                    2.0 * most
                },
            ),
        )
        .legend_at(Corner::TopRight)
        .with(Line::new(finite.clone(), Color::INK).weighing(0.8))
        .with(Layer::Dots {
            points: finite,
            radius: 1.2,
            color: Color::INK,
            label: String::new(),
        })
        .with(Layer::Dots {
            points: vec![(at, best)],
            radius: 3.2,
            color: Color::ORANGE,
            label: if name == CASES[1].0 {
                "best constant found".to_owned()
            } else {
                String::new()
            },
        });
        for (rule, damping, color) in RULES {
            let time = record.number(&format!("{name}: {rule}"))?;
            if !time.is_finite() {
                continue;
            }
            let label = if name == CASES[1].0 {
                rule.to_owned()
            } else {
                String::new()
            };
            if matches!(damping, Damping::InternalMode(_)) {
                let across = Line::new(vec![(0.6 * low, time), (1.6 * high, time)], color);
                panel = panel.with(across.dashed().named(label));
            } else {
                let mean = record.number(&format!("{name}: {rule}: mean damping"))?;
                let shown = mean.min(1.5 * high);
                panel = panel.with(Layer::Dots {
                    points: vec![(shown, time)],
                    radius: 3.2,
                    color,
                    label,
                });
            }
        }
        panels.push(panel);
    }
    let below = panels.split_off(3);
    Ok(vec![Artefact::figure(
        "Black: a run for every constant γ; gaps never came to rest. Dots: what a rule chose, at its mean γ, and how long that took. Dashed: internal damping, which has \
         no γ. Rest is looked for at moments a fifth of the run apart, hence the saw teeth.",
        Figure::new("§3.4.2  Time to rest by rules of damping", 1000.0)
            .with(270.0, panels)
            .with(270.0, below),
    )])
}
