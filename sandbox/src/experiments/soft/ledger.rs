//! The account of energies on every scene that is shipped.

use super::course::account;
use crate::draw::{Axis, Color, Corner, Figure, Layer, Line, Panel};
use crate::experiments::motion::{changed_scene, to_the_end};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};

const ID: &str = "ledger";

/// Most steps of a scene that are looked at.
const STEPS: u64 = 3000;

/// The scenes whose accounts are drawn, and the tables they are kept in.
const DRAWN: [(&str, &str); 3] = [
    ("rigid-ball-penalty", "ball"),
    ("pile", "pile"),
    ("road", "road"),
];

/// Does the sum of all terms stay what it was, on every scene?
pub(crate) const LEDGER: Experiment = Experiment {
    id: ID,
    title: "The account of energies on every scene",
    place: "beyond",
    question: "Kinetic, elastic, each force, walls, damping, contacts, changed parameters, growth: does the sum stay what it was, \
               and by how much may it stray on each scene?",
    claims: &[
        Claim {
            says: "on every scene the sum closes to what rounding adds up to, under either scheme and all rules",
            source: "algebra of the scheme",
            judge: |r| {
                let scenes = scenes(r, |_| true)?;
                let mut fine = 0;
                for scene in &scenes {
                    let allowed = r.number(&format!("allowed: {}", scene.name))?;
                    fine += usize::from(scene.gap <= allowed);
                }
                let worst = worst(&scenes);
                Ok(Finding::new(
                    fine == scenes.len() && fine > 0,
                    format!(
                        "{fine} of {} scenes, most on {}: {:.0e}",
                        scenes.len(),
                        worst.0,
                        worst.1
                    ),
                ))
            },
        },
        Claim {
            says: "snakes that meet, rub and adhere, and nodes that enter a spring within a step, are no exception",
            source: "work of contacts along the way of each step",
            judge: |r| {
                let worst = worst(&scenes(r, |kind| kind > FREE)?);
                Ok(Finding::new(
                    worst.1 < 1e-9,
                    format!("most on {}: {:.0e}", worst.0, worst.1),
                ))
            },
        },
        Claim {
            says: "what a curve gains that grows at its tips is booked",
            source: "the sum before and after every lengthening",
            judge: |r| {
                let (gained, gap) = (r.number("road: put in by growth")?, r.number("gap: road")?);
                Ok(Finding::new(
                    gained.abs() > 0.1 && gap < 1e-9,
                    format!("{gained:.0} M px³/s², gap {gap:.0e}"),
                ))
            },
        },
        Claim {
            says: "what the scheme itself holds back swings by the square of the step under the leapfrog",
            source: "algebra of the scheme",
            judge: |r| {
                let (whole, half) = (
                    r.number("ringing oval: the scheme's, at its step")?,
                    r.number("ringing oval: the scheme's, at half of it")?,
                );
                let order = (whole / half).log2();
                Ok(Finding::new(
                    (order - 2.0).abs() < 0.2,
                    format!("order {order:.2}"),
                ))
            },
        },
    ],
    run,
    draw,
};

/// A scene whose forces are smooth in each step; one with springs of walls; one of snakes that meet.
const FREE: f64 = 0.0;
const TOUCHING: f64 = 1.0;
const MEETING: f64 = 2.0;

/// What was found on a scene.
#[derive(Debug, Clone)]
struct Found {
    name: String,
    gap: f64,
    allowed: f64,
}

/// The scenes of some kinds.
fn scenes(r: &Record, of_kind: fn(f64) -> bool) -> Result<Vec<Found>, SandboxError> {
    let names = r
        .numbers
        .iter()
        .filter_map(|n| n.name.strip_prefix("gap: "));
    let mut out = Vec::new();
    for name in names {
        // a label, not a measurement
        let kind = r.told(&format!("kind: {name}"))?;
        if of_kind(kind) {
            out.push(Found {
                name: name.to_owned(),
                gap: r.number(&format!("gap: {name}"))?,
                allowed: r.told(&format!("allowed: {name}"))?,
            });
        }
    }
    Ok(out)
}

fn worst(scenes: &[Found]) -> (String, f64) {
    let worst = scenes.iter().max_by(|a, b| a.gap.total_cmp(&b.gap));
    worst.map_or(("none".to_owned(), f64::NAN), |s| (s.name.clone(), s.gap))
}

/// The account of one scene.
struct Account {
    terms: Vec<String>,
    /// For each moment looked at its time and all terms.
    rows: Vec<(f64, Vec<f64>)>,
    /// What rounding may add up to, as a share of the largest change.
    allowed: f64,
    kind: f64,
}

impl Account {
    fn of(name: &str, step: f64) -> Result<Self, SandboxError> {
        let mut scene = changed_scene(ID, name, &[])?;
        let plan = &mut scene.plan;
        plan.dt *= step;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "some thousand"
        )]
        let steps = (real(usize::try_from(plan.until.steps.min(STEPS)).unwrap_or(0)) / step) as u64;
        plan.until.steps = steps;
        plan.until.rest = None;
        plan.recording = scene::Recording {
            every: Some((steps / 200).max(1)),
            velocities: true,
            energies: true,
            ..scene::Recording::default()
        };
        let springs = scene.snake.world().walls.iter().any(snake::Wall::is_spring);
        let kind = match (scene.company.is_some(), springs) {
            (false, false) => FREE,
            (false, true) => TOUCHING,
            (true, _) => MEETING,
        };
        let run = to_the_end(ID, &mut scene)?;
        let cancels = scene.plan.scheme == integrator::Scheme::Report;
        let frames = run.frames.iter();
        let rows: Vec<(f64, Vec<f64>)> = frames
            .filter_map(|frame| Some((frame.t, frame.energies.as_ref()?.values())))
            .collect();
        // a step's: rounding of all terms, and under the report's scheme that of x / dt in the velocity (D21)
        let mut most = 0.0_f64;
        for ((_, row), frame) in rows.iter().zip(&run.frames) {
            let mut each = 64.0 * row.iter().map(|value| value.abs()).sum::<f64>();
            let velocities = frame.velocities().into_iter().flatten();
            for (i, (x, v)) in frame
                .nodes()
                .iter()
                .zip(velocities)
                .enumerate()
                .filter(|_| cancels)
            {
                let body = scene.snake.body();
                each +=
                    8.0 * body.spacing * body.mass.at(i) * v.length() * x.length() / scene.plan.dt;
            }
            most = most.max(each);
        }
        let steps = run.frames.last().map_or(0, |frame| frame.step);
        let steps = real(usize::try_from(steps).unwrap_or(0)) + 1.0;
        let change = strays(&rows).1;
        Ok(Self {
            terms: run.terms,
            rows,
            allowed: steps * f64::EPSILON * most / change,
            kind,
        })
    }

    fn column(&self, name: &str) -> impl Iterator<Item = f64> {
        let column = self.terms.iter().position(|term| term == name);
        let rows = self.rows.iter();
        rows.map(move |(_, row)| column.map_or(0.0, |k| row[k]))
    }
}

/// The largest change of the sum, and that of a term.
fn strays(rows: &[(f64, Vec<f64>)]) -> (f64, f64) {
    let Some((_, first)) = rows.first() else {
        return (0.0, f64::MIN_POSITIVE);
    };
    let total: f64 = first.iter().sum();
    let (mut off, mut most) = (0.0_f64, f64::MIN_POSITIVE);
    for (_, row) in rows {
        off = off.max((row.iter().sum::<f64>() - total).abs());
        for (now, then) in row.iter().zip(first) {
            most = most.max((now - then).abs());
        }
    }
    (off, most)
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    for (name, _) in scene::SCENES {
        let account = Account::of(name, 1.0)?;
        let (off, most) = strays(&account.rows);
        // digits of rounding are no result
        let share = "of the largest term";
        record.note(
            format!("gap: {name}"),
            off / most,
            share,
            Tolerance::Absolute(2e-9),
        );
        record.note(
            format!("allowed: {name}"),
            account.allowed,
            share,
            Tolerance::Relative(0.01),
        );
        record.note(format!("kind: {name}"), account.kind, "", Tolerance::EXACT);
        if *name == "road" {
            let put_in = -account.column("upkeep").last().unwrap_or(0.0);
            let like = Tolerance::Relative(1e-3);
            record.note("road: put in by growth", put_in, "M px³/s²", like);
        }
        if let Some((_, table)) = DRAWN.iter().find(|(drawn, _)| drawn == name) {
            let times = account.rows.iter().map(|row| row.0).collect();
            let mut table = Table::raw(table).with("t", "s", Tolerance::EXACT, times);
            for term in &account.terms {
                let values = account.column(term).collect();
                table = table.with(term, "", Tolerance::EXACT, values);
            }
            record.keep(table);
        }
    }
    for (name, step) in [
        ("ringing oval: the scheme's, at its step", 1.0),
        ("ringing oval: the scheme's, at half of it", 0.5),
    ] {
        let account = Account::of("ringing-oval", step)?;
        let swings = account
            .column("scheme")
            .fold(0.0_f64, |most, s| most.max(s.abs()));
        record.note(name, swings, "M px³/s²", Tolerance::Relative(1e-3));
    }
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let scenes = scenes(record, |_| true)?;
    let rows = real(scenes.len());
    let mut panel = Panel::new(
        "how far the sum strays, as a share of the largest term",
        Axis::log("share", 1e-16, 1e-2),
        Axis::new("", rows, -1.0).with_ticks(0),
    )
    .legend_at(Corner::TopLeft);
    let at = |k: usize, value: f64| (value.max(1.2e-16), real(k));
    let found = scenes.iter().enumerate();
    panel = panel
        .with(Layer::Dots {
            points: found.clone().map(|(k, s)| at(k, s.gap)).collect(),
            radius: 2.2,
            color: Color::BLUE,
            label: "found".to_owned(),
        })
        .with(Layer::Dots {
            points: found.clone().map(|(k, s)| at(k, s.allowed)).collect(),
            radius: 1.6,
            color: Color::RED,
            label: "allowed".to_owned(),
        });
    for (k, found) in found {
        panel = panel
            .with(
                Line::new(vec![at(k, found.gap), at(k, found.allowed)], Color::LIGHT).weighing(0.8),
            )
            .with(Layer::Text {
                at: (3e-7, real(k)),
                words: found.name.clone(),
                color: Color::INK,
                centered: false,
            });
    }
    panel.share = 1.25;
    let ball = account(
        record,
        "ball",
        "the rigid ball between penalty walls",
        &[
            ("kinetic", "kinetic", Color::BLUE),
            ("tension", "tension", Color::SKY),
            ("rigidity", "rigidity", Color::GREEN),
            ("tether", "tether", Color::YELLOW),
            ("gravity", "gravity", Color::GREY),
            ("wall", "walls", Color::PURPLE),
            ("damping", "lost to damping", Color::ORANGE),
            ("contact", "lost in contacts", Color::RED),
        ],
    )?;
    let pile = account(
        record,
        "pile",
        "twenty balls fall into a box",
        &[
            ("kinetic", "kinetic", Color::BLUE),
            ("tension", "tension", Color::SKY),
            ("rigidity", "rigidity", Color::GREEN),
            ("tether", "tether", Color::YELLOW),
            ("outside", "gravity", Color::GREY),
            ("between", "between them", Color::INK),
            ("wall", "walls", Color::PURPLE),
            ("damping", "lost to damping", Color::ORANGE),
            ("contact", "lost in contacts", Color::RED),
        ],
    )?;
    let road = account(
        record,
        "road",
        "the road: two ends grow until t = 150 s",
        &[
            ("kinetic", "kinetic", Color::BLUE),
            ("tension", "tension", Color::SKY),
            ("line", "the line", Color::GREY),
            ("damping", "lost to damping", Color::ORANGE),
            ("upkeep", "put in by growth", Color::GREEN),
        ],
    )?;
    let figure = Figure::new("The account of energies", 1100.0)
        .with(560.0, vec![panel, ball])
        .with(300.0, vec![pile, road]);
    Ok(vec![Artefact::figure(
        "Above left: every shipped scene, its first 3000 steps. Allowed: what rounding adds up to in all steps, that of x/Δt under the report's scheme \
         included. The test of the ledger holds every single step to it. Else: the terms of three scenes stand on each other; that their top is level is the claim.",
        figure,
    )])
}
