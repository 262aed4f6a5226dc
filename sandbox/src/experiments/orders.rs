//! Report Eq. 2.6 to 2.9: what the order p of the elastic energy does to a noisy outline.

use crate::prelude::*;
use elastic::{Material, Profile, Topology};
use integrator::{Scheme, Start, State};
use snake::{Body, Freeze, Snake, Until, World};
use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;

const NODES: usize = 120;
const RADIUS: f64 = 30.0;
/// The wave, in turns about the outline, of which every order lets half through.
const CUT: f64 = 9.0;
const SHAPES: [&str; 4] = ["shape-1", "shape-2", "shape-3", "shape-4"];
const FILTERS: [&str; 4] = ["filter-1", "filter-2", "filter-3", "filter-4"];
const COLORS: [Color; 4] = [Color::RED, Color::ORANGE, Color::GREEN, Color::BLUE];

/// Orders one to four.
pub(crate) const ORDERS: Experiment = Experiment {
    id: "sec-2-4-orders",
    title: "The order of the elastic energy",
    place: "§2.4",
    question: "A noisy outline with lobes pulls at every node with one spring each; the body is a ring of order p = 1, 2, 3 or 4 alone (tension, rigidity, and beyond), \
               stiff enough to let half of wave nine through. What does the order do?",
    claims: &[
        claim("a ring of order p is a filter: wave j keeps 1/(1 + λⱼ/κ) [report Eq. 2.6 to 2.10]")
            .when(&[below("largest distance from the exact filter", 1e-6)]),
        claim("the higher the order, the more of the lobes is kept [report Eq. 2.6]")
            .when(&[rising("p = *: lobes kept")]),
        claim("and the less of the finest noise [report Eq. 2.6]")
            .when(&[falling("p = *: fine noise kept")]),
        claim("the highest order is nearest to the truth [report Eq. 2.6]")
            .when(&[falling("p = *: distance from the truth")]),
        claim("and every order has its price: the largest explicit step [report §3.4.3]")
            .when(&[falling("p = *: largest step")]),
        claim(
            "with the order in its matrix, the exact scheme is exact at fifty such steps, and \
               Newmark's is of second order [closed form of one wave]",
        )
        .when(&[
            below(
                "p = 4, exact scheme at 50 times the largest step: off by",
                1e-11,
            ),
            ratio(
                "p = 4, Newmark at 50 times the largest step: off by",
                "p = 4, Newmark at 25 times the largest step: off by",
                4.0,
                0.26,
            ),
        ]),
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
fn off(scheme: Scheme, times: f64) -> Result<f64> {
    let ring = elastic::circle(DVec2::ZERO, RADIUS, NODES);
    let (body, weight) = of_order(4, &ring)?;
    let steep = steepness(&body, 5.0).powi(4);
    let mut snake = Snake::new(body, World::default())?;
    let limit = Scheme::Leapfrog.step_limit(&snake).unwrap_or(1.0);
    let dt = times * limit;
    let bent = |size: f64| -> Vec<DVec2> {
        let wave = |i: usize| size * (TAU * real(5 * i) / real(NODES)).cos();
        (0..NODES).map(|i| ring[i] + wave(i) * DVec2::X).collect()
    };
    let mut state = State::at_rest(bent(1.0));
    let mut stepper = scheme.start(&mut snake, &state, dt, Start::SecondOrder)?;
    // as many steps of fifty limits as a quarter of a swing has, to the nearest
    let omega = (weight * steep).sqrt();
    let whole = (0.25 * TAU / omega / (50.0 * limit)).round().max(1.0);
    while state.t < 50.0 * limit * whole - 0.5 * dt {
        stepper.step(&mut snake, &mut state)?;
    }
    let exact = bent((omega * state.t).cos());
    Ok(most(
        exact.iter().zip(&state.x).map(|(a, b)| a.distance(*b)),
    ))
}

/// What one difference along the curve makes of wave `j`, squared.
fn steepness(body: &Body, j: f64) -> f64 {
    (2.0 * (PI * j / real(NODES)).sin() / body.spacing).powi(2)
}

/// A ring of one order alone, and its weight: half of the wave [`CUT`] goes through.
fn of_order(p: usize, ring: &[DVec2]) -> Result<(Body, f64)> {
    let body = Body::of(ring, Topology::Closed, 1.0)?;
    let weight = 1.0 / steepness(&body, CUT).powi(i32::try_from(p).unwrap_or(1));
    let material = match p {
        1 => Material::uniform(0.0, weight, 0.0),
        2 => Material::uniform(0.0, 0.0, weight),
        _ => {
            let mut weights = vec![Profile::Uniform(0.0); p - 3];
            weights.push(Profile::Uniform(weight));
            Material::uniform(0.0, 0.0, 0.0).with_higher(weights)
        }
    };
    Ok((body.with_material(material), weight))
}

/// Wave `j` of a closed curve, as the complex numbers of its plane.
fn wave(x: &[DVec2], j: usize) -> DVec2 {
    let turn = |i: usize| DVec2::from_angle(-TAU * real(i * j % NODES) / real(NODES));
    let terms = x.iter().enumerate().map(|(i, p)| turn(i).rotate(*p));
    terms.sum::<DVec2>() / real(NODES)
}

fn run() -> Result {
    let mut record = Record::default();
    let (truth, noisy) = (outline(0.0), outline(1.3));
    let ring = elastic::circle(DVec2::ZERO, RADIUS, NODES);
    let lines = |x: &[DVec2]| -> Vec<DVec2> { x.iter().zip(&ring).map(|(&x, &r)| x - r).collect() };
    let (close, mut worst) = (share(1e-4), 0.0_f64);
    for (p, (shape, filter)) in (1..).zip(SHAPES.into_iter().zip(FILTERS)) {
        let (body, weight) = of_order(p, &ring)?;
        let body = body.with_damping(2.0);
        let power = i32::try_from(p).unwrap_or(1);
        let steep: Vec<f64> = (0..=NODES / 2).map(|j| steepness(&body, real(j))).collect();
        let world = World::default().with(Freeze::new(&noisy, 0..NODES, 1.0)?);
        let mut snake = Snake::new(body, world)?;
        let limit = Scheme::Leapfrog.step_limit(&snake).unwrap_or(1.0);
        record.note(format!("p = {p}: largest step [s]"), limit, share(1e-6));
        let mut state = State::at_rest(noisy.clone());
        // springs of stiffness 1 are not in that limit
        let dt = (0.5 * limit).min(0.05);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "some thousand"
        )]
        let until = Until::steps((30.0 / dt) as u64);
        let watch = &mut |_: &State| ControlFlow::Continue(());
        moved(
            &mut snake,
            &mut state,
            (Scheme::Leapfrog, dt),
            &until,
            watch,
        )?;
        let (before, after) = (lines(&noisy), lines(&state.x));
        let (mut kept, mut exact) = (Vec::new(), Vec::new());
        for j in 2..=NODES / 2 {
            let (was, is) = (wave(&before, j), wave(&after, j));
            let share = is.dot(was) / was.length_squared();
            let right = 1.0 / (1.0 + weight * steep[j].powi(power));
            worst = worst.max((share - right).abs());
            kept.push(share.abs());
            exact.push(right);
        }
        let squares = state
            .x
            .iter()
            .zip(&truth)
            .map(|(a, b)| a.distance_squared(*b));
        let rms = (squares.sum::<f64>() / real(NODES)).sqrt();
        // the lobes are the waves 6 and -4
        record.note(format!("p = {p}: lobes kept"), kept[6 - 2], close);
        record.note(
            format!("p = {p}: fine noise kept"),
            kept[kept.len() - 1],
            close,
        );
        record.note(format!("p = {p}: distance from the truth [px]"), rms, close);
        record.keep(
            Table::raw(filter)
                .exact("wave", (2..=NODES / 2).map(real))
                .exact("kept", kept)
                .exact("exact", exact),
        );
        record.keep_points(shape, &state.x);
    }
    record.keep_points("noisy", &noisy);
    record.keep_points("truth", &truth);
    for (name, scheme, times, close) in [
        (
            "exact scheme",
            Scheme::Exact,
            50.0,
            Tolerance::Absolute(1e-11),
        ),
        ("Newmark", Scheme::Newmark, 50.0, share(1e-6)),
        ("Newmark", Scheme::Newmark, 25.0, share(1e-6)),
    ] {
        let name = format!("p = 4, {name} at {times} times the largest step: off by [px]");
        record.note(name, off(scheme, times)?, close);
    }
    record.note("largest distance from the exact filter", worst, 1e-6);
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let mut panels = Vec::new();
    let mut filter = plot(
        "what is left of each wave; lines: 1/(1 + λ/κ), dots: runs",
        ("wave about the outline", 0.0, 40.0),
        ("share kept", 0.0, 1.1),
    );
    let names = ["p = 1, tension", "p = 2, rigidity", "p = 3", "p = 4"];
    for (i, name) in names.into_iter().enumerate() {
        let (color, whole) = (COLORS[i], ("", -41.0, 41.0));
        let truth = line(record.xy("truth")?, Color::INK)
            .closed()
            .dashed()
            .weighing(0.6);
        let panel = plot(name, whole, whole).equal().bare().with(truth);
        let panel = panel.with(dots(record.xy("noisy")?, 1.0, Color::GREY));
        panels.push(panel.with(line(record.xy(SHAPES[i])?, color).closed()));
        let kept = record
            .points(FILTERS[i], "wave", "kept")?
            .into_iter()
            .take(39);
        let exact = record.points(FILTERS[i], "wave", "exact")?;
        filter = filter
            .with(line(exact, color).named(name))
            .with(dots(kept, 1.6, color));
    }
    Artefact::only(
        "Dots: the outline that is seen; dashed: what it is. The order is the steepness of the filter: low ones flatten the lobes and keep noise, high ones do neither.",
        Figure::new("§2.4  Rings of order one to four", 1000.0)
            .with(250.0, panels)
            .with(280.0, vec![filter]),
    )
}
