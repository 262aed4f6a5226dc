//! The account of energies on every scene that is shipped.

use super::course::{account, gap};
use crate::draw::{Axis, Color, Corner, Figure, Layer, Line, Panel};
use crate::experiments::motion::{changed_scene, to_the_end};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};

const ID: &str = "ledger";

/// Most steps of a scene that are looked at.
const STEPS: u64 = 3000;

/// The scene whose account is drawn.
const DRAWN: &str = "rigid-ball-penalty";

/// Does the sum of all terms stay what it was, on every scene?
pub(crate) const LEDGER: Experiment = Experiment {
    id: ID,
    title: "The account of energies on every scene",
    place: "beyond",
    question: "Kinetic, elastic, each force, walls, damping, contacts, changed parameters: does the sum stay what it was, \
               and by how much may it stray on each scene?",
    claims: &[
        Claim {
            says: "where nothing meets a spring or another snake the sum closes to rounding, under either scheme and all rules",
            source: "algebra of the scheme",
            judge: |r| {
                let scenes: Vec<_> = scenes(r)?.into_iter().filter(|s| s.kind == FREE).collect();
                let fine = scenes.iter().filter(|s| s.gap <= s.allowed).count();
                let worst = worst(&scenes, FREE);
                Ok(Finding::new(
                    fine == scenes.len(),
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
            says: "where springs of walls set in within a step it strays by less than a ten thousandth",
            source: "Simpson's rule over a kink",
            judge: |r| {
                let worst = worst(&scenes(r)?, TOUCHING);
                Ok(Finding::new(
                    worst.1 < 1e-4,
                    format!("most on {}: {:.0e}", worst.0, worst.1),
                ))
            },
        },
        Claim {
            says: "where snakes meet, whose kicks are a scheme of their own, by less than two thousandths",
            source: "measured; not derived in the sum",
            judge: |r| {
                let worst = worst(&scenes(r)?, MEETING);
                Ok(Finding::new(
                    worst.1 < 0.002,
                    format!("most on {}: {:.3} %", worst.0, 100.0 * worst.1),
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
    kind: f64,
}

fn scenes(r: &Record) -> Result<Vec<Found>, SandboxError> {
    let names = r
        .numbers
        .iter()
        .filter_map(|n| n.name.strip_prefix("gap: "));
    names
        .map(|name| {
            Ok(Found {
                name: name.to_owned(),
                gap: r.number(&format!("gap: {name}"))?,
                allowed: r.number(&format!("allowed: {name}"))?,
                kind: r.number(&format!("kind: {name}"))?,
            })
        })
        .collect()
}

fn worst(scenes: &[Found], kind: f64) -> (String, f64) {
    let of = scenes.iter().filter(|s| s.kind.to_bits() == kind.to_bits());
    let worst = of.max_by(|a, b| a.gap.total_cmp(&b.gap));
    worst.map_or(("none".to_owned(), f64::NAN), |s| (s.name.clone(), s.gap))
}

/// The account of one scene: names of its terms, and a row for each moment with the time in front.
type Account = (Vec<String>, Vec<(f64, Vec<f64>)>);

fn books(name: &str, step: f64) -> Result<(Account, f64, f64), SandboxError> {
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
        energies: true,
        ..scene::Recording::default()
    };
    let report = plan.scheme == integrator::Scheme::Report;
    let springs = scene.snake.world().walls.iter().any(snake::Wall::is_spring);
    let (allowed, kind) = match (scene.company.is_some(), springs) {
        // places as large as the picture, in steps of a thousandth: rounding of x / dt (D21)
        (false, false) if report => (1e-8, FREE),
        (false, false) => (1e-9, FREE),
        (false, true) => (1e-4, TOUCHING),
        (true, _) => (2e-3, MEETING),
    };
    let run = to_the_end(ID, &mut scene)?;
    let rows = run
        .frames
        .iter()
        .filter_map(|frame| Some((frame.t, frame.energies.as_ref()?.values())))
        .collect();
    Ok(((run.terms, rows), allowed, kind))
}

/// The largest change of the sum, as a share of the largest change of a term.
fn strays(rows: &[(f64, Vec<f64>)]) -> f64 {
    let mut padded: Vec<[f64; 16]> = Vec::new();
    for (_, row) in rows {
        let mut all = [0.0; 16];
        all.iter_mut().zip(row).for_each(|(a, v)| *a = *v);
        padded.push(all);
    }
    gap(&padded)
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    for (name, _) in scene::SCENES {
        let ((terms, rows), allowed, kind) = books(name, 1.0)?;
        let gap = strays(&rows);
        // a gap is a small difference of large numbers, and after contacts it is sensitive
        let loose = Tolerance::Absolute((0.5 * gap).max(2e-9));
        record.note(format!("gap: {name}"), gap, "of the largest term", loose);
        record.note(
            format!("allowed: {name}"),
            allowed,
            "of the largest term",
            Tolerance::Relative(1e-3),
        );
        record.note(format!("kind: {name}"), kind, "", Tolerance::EXACT);
        if *name == DRAWN {
            let mut table = Table::raw("account").with(
                "t",
                "s",
                Tolerance::EXACT,
                rows.iter().map(|row| row.0).collect(),
            );
            for (k, term) in terms.iter().enumerate() {
                let values = rows.iter().map(|row| row.1[k]).collect();
                table = table.with(term, "", Tolerance::EXACT, values);
            }
            record.keep(table);
        }
    }
    for (name, step) in [
        ("ringing oval: the scheme's, at its step", 1.0),
        ("ringing oval: the scheme's, at half of it", 0.5),
    ] {
        let ((terms, rows), ..) = books("ringing-oval", step)?;
        let column = terms.iter().position(|term| term == "scheme").unwrap_or(0);
        let swings = rows
            .iter()
            .map(|row| row.1[column].abs())
            .fold(0.0, f64::max);
        record.note(name, swings, "M px³/s²", Tolerance::Relative(1e-3));
    }
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let scenes = scenes(record)?;
    let rows = real(scenes.len());
    let mut panel = Panel::new(
        "how far the sum strays, as a share of the largest term",
        Axis::log("share", 1e-16, 1e6),
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
                at: (1.6, real(k)),
                words: found.name.clone(),
                color: Color::INK,
                centered: false,
            });
    }
    panel.share = 1.25;
    let kept = account(
        record,
        "account",
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
    let figure = Figure::new("The account of energies", 1100.0).with(460.0, vec![panel, kept]);
    Ok(vec![Artefact::figure(
        "Left: every shipped scene, its first 3000 steps. Allowed: rounding, of x/Δt under the report's scheme; 1e-4 where springs of walls set in within a step; 2e-3 where snakes meet. The test of the ledger holds every single step to a derived bound. Right: the terms \
         of one scene stand on each other; that their top is level is the claim.",
        figure,
    )])
}
