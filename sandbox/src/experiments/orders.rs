//! Report Eq. 2.6 to 2.9: what the order p of the elastic energy does to a noisy outline.

use super::soft::ended;
use crate::demand::{below, judged};
use crate::draw::{Axis, Color, Corner, Figure, Layer, Line, Panel};
use crate::{Artefact, Claim, Experiment, Finding, Record, SandboxError, Table, Tolerance, real};
use elastic::{Material, Profile, Topology};
use glam::DVec2;
use integrator::{Scheme, Start, State};
use snake::{Body, Freeze, Snake, Until, World};
use std::f64::consts::{PI, TAU};

const ID: &str = "sec-2-4-orders";
const NODES: usize = 120;
const RADIUS: f64 = 30.0;
/// The wave, in turns about the outline, of which every order lets half through.
const CUT: f64 = 9.0;
const SHAPES: [&str; 4] = ["shape-1", "shape-2", "shape-3", "shape-4"];
const FILTERS: [&str; 4] = ["filter-1", "filter-2", "filter-3", "filter-4"];
const COLORS: [Color; 4] = [Color::RED, Color::ORANGE, Color::GREEN, Color::BLUE];

/// Orders one to four.
pub(crate) const ORDERS: Experiment = Experiment {
    id: ID,
    title: "The order of the elastic energy",
    place: "§2.4",
    question: "A noisy outline with lobes pulls at every node with one spring each; the body is a ring of order p = 1, 2, 3 or 4 alone (tension, rigidity, and beyond), \
               stiff enough to let half of wave nine through. What does the order do?",
    claims: &[
        Claim {
            says: "a ring of order p is a filter whose wave j keeps 1/(1 + λⱼ/κ), to the rounding of a run that rests",
            source: "report Eq. 2.6 to 2.10",
            judge: |r| judged(r, &[below("largest distance from the exact filter", 1e-6)]),
        },
        Claim {
            says: "the higher the order, the more of the lobes is kept",
            source: "report Eq. 2.6",
            judge: |r| {
                let kept: Vec<f64> = (1..=4)
                    .map(|p| r.number(&format!("p = {p}: lobes kept")))
                    .collect::<Result<_, _>>()?;
                Ok(Finding::new(
                    kept.windows(2).all(|k| k[1] > k[0]),
                    format!(
                        "{:.0}, {:.0}, {:.1} and {:.1} %",
                        100.0 * kept[0],
                        100.0 * kept[1],
                        100.0 * kept[2],
                        100.0 * kept[3]
                    ),
                ))
            },
        },
        Claim {
            says: "and the less of the finest noise",
            source: "report Eq. 2.6",
            judge: |r| {
                let kept: Vec<f64> = (1..=4)
                    .map(|p| r.number(&format!("p = {p}: fine noise kept")))
                    .collect::<Result<_, _>>()?;
                Ok(Finding::new(
                    kept.windows(2).all(|k| k[1] < k[0]),
                    format!(
                        "{:.1}, {:.2}, {:.3} and {:.4} %",
                        100.0 * kept[0],
                        100.0 * kept[1],
                        100.0 * kept[2],
                        100.0 * kept[3]
                    ),
                ))
            },
        },
        Claim {
            says: "the outline is nearest to the truth at the highest order, and every order has its price: the largest explicit step",
            source: "report Eq. 2.6, §3.4.3",
            judge: |r| {
                let off: Vec<f64> = (1..=4)
                    .map(|p| r.number(&format!("p = {p}: distance from the truth")))
                    .collect::<Result<_, _>>()?;
                let steps: Vec<f64> = (1..=4)
                    .map(|p| r.number(&format!("p = {p}: largest step")))
                    .collect::<Result<_, _>>()?;
                Ok(Finding::new(
                    off.windows(2).all(|k| k[1] < k[0]) && steps.windows(2).all(|k| k[1] < k[0]),
                    format!(
                        "rms {:.2}, {:.2}, {:.2}, {:.2} px; steps {:.3}, {:.3}, {:.3}, {:.4}",
                        off[0], off[1], off[2], off[3], steps[0], steps[1], steps[2], steps[3]
                    ),
                ))
            },
        },
        Claim {
            says: "but not to those who have it in their matrix: at order 4 and fifty times that step the exact scheme is exact, and Newmark's keeps its order",
            source: "closed form of one wave",
            judge: |r| {
                let exact = r.number("p = 4, exact scheme at 50 times the largest step: off by")?;
                let coarse = r.number("p = 4, Newmark at 50 times the largest step: off by")?;
                let fine = r.number("p = 4, Newmark at 25 times the largest step: off by")?;
                let order = (coarse / fine).log2();
                Ok(Finding::new(
                    exact < 1e-11 && (order - 2.0).abs() < 0.1,
                    format!(
                        "of a swing of 1 px, off by {exact:.0e} px; {coarse:.4} px, order {order:.2}"
                    ),
                ))
            },
        },
    ],
    run,
    draw,
};

/// The outline as it is, or with noise.
fn outline(noise: f64) -> Vec<DVec2> {
    (0..NODES)
        .map(|i| {
            let angle = TAU * real(i) / real(NODES);
            // as wild as noise, and the same everywhere: a sine of squares
            let wild = (real(i * i) * 1.7 + 0.3).sin() + (real(i * i) * 2.9 + 1.1).sin();
            (RADIUS * (1.0 + 0.18 * (5.0 * angle).cos()) + noise * wild) * DVec2::from_angle(angle)
        })
        .collect()
}

/// How far from the closed form a ring of order 4 alone is after a time in which its wave five swings a quarter, in px.
fn off(scheme: Scheme, times: f64) -> Result<f64, SandboxError> {
    let ring = elastic::circle(DVec2::ZERO, RADIUS, NODES);
    let body = Body::of(&ring, Topology::Closed, 1.0).map_err(SandboxError::refused(ID))?;
    let h = body.spacing;
    let steep = |j: f64| (2.0 * (PI * j / real(NODES)).sin() / h).powi(8);
    let weight = 1.0 / steep(CUT);
    let orders = vec![Profile::Uniform(0.0), Profile::Uniform(weight)];
    let body = body.with_material(Material::uniform(0.0, 0.0, 0.0).with_higher(orders));
    let mut snake = Snake::new(body, World::default()).map_err(SandboxError::refused(ID))?;
    let limit = Scheme::Leapfrog.step_limit(&snake).unwrap_or(1.0);
    let dt = times * limit;
    let bent = |size: f64| -> Vec<DVec2> {
        let wave = |i: usize| size * (TAU * real(5 * i) / real(NODES)).cos();
        (0..NODES).map(|i| ring[i] + wave(i) * DVec2::X).collect()
    };
    let mut state = State::at_rest(bent(1.0));
    let mut stepper = scheme
        .start(&mut snake, &state, dt, Start::SecondOrder)
        .map_err(SandboxError::refused(ID))?;
    // as many steps of fifty limits as a quarter of a swing has, to the nearest
    let omega = (weight * steep(5.0)).sqrt();
    let whole = (0.25 * TAU / omega / (50.0 * limit)).round().max(1.0);
    while state.t < 50.0 * limit * whole - 0.5 * dt {
        stepper
            .step(&mut snake, &mut state)
            .map_err(SandboxError::refused(ID))?;
    }
    let exact = bent((omega * state.t).cos());
    let far = exact.iter().zip(&state.x).map(|(a, b)| a.distance(*b));
    Ok(far.fold(0.0, f64::max))
}

/// Wave `j` of a closed curve, as the complex numbers of its plane.
fn wave(x: &[DVec2], j: usize) -> DVec2 {
    let terms = x
        .iter()
        .enumerate()
        .map(|(i, p)| DVec2::from_angle(-TAU * real(i * j % NODES) / real(NODES)).rotate(*p));
    terms.sum::<DVec2>() / real(NODES)
}

fn run() -> Result<Record, SandboxError> {
    let mut record = Record::default();
    let (truth, noisy) = (outline(0.0), outline(1.3));
    let ring = elastic::circle(DVec2::ZERO, RADIUS, NODES);
    let mut worst = 0.0_f64;
    for p in 1..=4_usize {
        let body = Body::of(&ring, Topology::Closed, 1.0)
            .map_err(SandboxError::refused(ID))?
            .with_damping(2.0);
        let h = body.spacing;
        let steep = |j: f64| (2.0 * (PI * j / real(NODES)).sin() / h).powi(2);
        let power = i32::try_from(p).unwrap_or(1);
        let weight = 1.0 / steep(CUT).powi(power);
        let springs = Freeze::new(&noisy, 0..NODES, 1.0).map_err(SandboxError::refused(ID))?;
        let world = World::default().with(springs);
        let body = match p {
            1 => body.with_material(Material::uniform(0.0, weight, 0.0)),
            2 => body.with_material(Material::uniform(0.0, 0.0, weight)),
            _ => {
                let mut weights = vec![Profile::Uniform(0.0); p - 3];
                weights.push(Profile::Uniform(weight));
                body.with_material(Material::uniform(0.0, 0.0, 0.0).with_higher(weights))
            }
        };
        let snake = Snake::new(body, world).map_err(SandboxError::refused(ID))?;
        let limit = Scheme::Leapfrog.step_limit(&snake).unwrap_or(1.0);
        record.note(
            format!("p = {p}: largest step"),
            limit,
            "s",
            Tolerance::Relative(1e-6),
        );
        // springs of stiffness 1 are not in that limit
        let dt = (0.5 * limit).min(0.05);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "some thousand"
        )]
        let until = Until::steps((30.0 / dt) as u64);
        let state = ended(ID, snake, State::at_rest(noisy.clone()), dt, &until)?;
        let lines = |x: &[DVec2]| {
            x.iter()
                .zip(&ring)
                .map(|(&x, &r)| x - r)
                .collect::<Vec<_>>()
        };
        let (before, after) = (lines(&noisy), lines(&state.x));
        let (mut waves, mut kept, mut exact) = (Vec::new(), Vec::new(), Vec::new());
        for j in 2..=NODES / 2 {
            let (was, is) = (wave(&before, j), wave(&after, j));
            let share = is.dot(was) / was.length_squared();
            let right = 1.0 / (1.0 + weight * steep(real(j)).powi(power));
            worst = worst.max((share - right).abs());
            waves.push(real(j));
            kept.push(share.abs());
            exact.push(right);
        }
        let rms = state
            .x
            .iter()
            .zip(&truth)
            .map(|(a, b)| a.distance_squared(*b))
            .sum::<f64>()
            / real(NODES);
        let close = Tolerance::Relative(1e-4);
        // the lobes are the waves 6 and -4
        record.note(format!("p = {p}: lobes kept"), kept[6 - 2], "", close);
        record.note(
            format!("p = {p}: fine noise kept"),
            kept[kept.len() - 1],
            "",
            close,
        );
        record.note(
            format!("p = {p}: distance from the truth"),
            rms.sqrt(),
            "px",
            close,
        );
        record.keep(
            Table::raw(FILTERS[p - 1])
                .with("wave", "", Tolerance::EXACT, waves)
                .with("kept", "", Tolerance::EXACT, kept)
                .with("exact", "", Tolerance::EXACT, exact),
        );
        let table = |name, x: &[DVec2]| {
            Table::raw(name)
                .with("x", "", Tolerance::EXACT, x.iter().map(|p| p.x).collect())
                .with("y", "", Tolerance::EXACT, x.iter().map(|p| p.y).collect())
        };
        record.keep(table(SHAPES[p - 1], &state.x));
        if p == 1 {
            record.keep(table("noisy", &noisy));
            record.keep(table("truth", &truth));
        }
    }
    for (name, scheme, times, close) in [
        (
            "exact scheme",
            Scheme::Exact,
            50.0,
            Tolerance::Absolute(1e-11),
        ),
        ("Newmark", Scheme::Newmark, 50.0, Tolerance::Relative(1e-6)),
        ("Newmark", Scheme::Newmark, 25.0, Tolerance::Relative(1e-6)),
    ] {
        record.note(
            format!("p = 4, {name} at {times} times the largest step: off by"),
            off(scheme, times)?,
            "px",
            close,
        );
    }
    record.note(
        "largest distance from the exact filter",
        worst,
        "",
        Tolerance::Absolute(1e-6),
    );
    Ok(record)
}

fn draw(record: &Record) -> Result<Vec<Artefact>, SandboxError> {
    let mut panels = Vec::new();
    let names = ["p = 1, tension", "p = 2, rigidity", "p = 3", "p = 4"];
    for ((name, table), color) in names.into_iter().zip(SHAPES).zip(COLORS) {
        let mut panel = Panel::new(name, Axis::new("", -41.0, 41.0), Axis::new("", -41.0, 41.0))
            .equal()
            .bare();
        panel = panel
            .with(
                Line::new(record.points("truth", "x", "y")?, Color::INK)
                    .closed()
                    .dashed()
                    .weighing(0.6),
            )
            .with(Layer::Dots {
                points: record.points("noisy", "x", "y")?,
                radius: 1.0,
                color: Color::GREY,
                label: String::new(),
            })
            .with(Line::new(record.points(table, "x", "y")?, color).closed());
        panels.push(panel);
    }
    let mut filter = Panel::new(
        "what is left of each wave; lines: 1/(1 + λ/κ), dots: runs",
        Axis::new("wave about the outline", 0.0, 40.0),
        Axis::new("share kept", 0.0, 1.1),
    )
    .legend_at(Corner::TopRight);
    for ((name, table), color) in names.into_iter().zip(FILTERS).zip(COLORS) {
        let kept = record.points(table, "wave", "kept")?;
        filter = filter
            .with(Line::new(record.points(table, "wave", "exact")?, color).named(name))
            .with(Layer::Dots {
                points: kept.into_iter().take(39).collect(),
                radius: 1.6,
                color,
                label: String::new(),
            });
    }
    Ok(vec![Artefact::figure(
        "Dots: the outline that is seen; dashed: what it is. The order is the steepness of the filter: low ones flatten the lobes and keep noise, high ones do neither.",
        Figure::new("§2.4  Rings of order one to four", 1000.0)
            .with(250.0, panels)
            .with(280.0, vec![filter]),
    )])
}
