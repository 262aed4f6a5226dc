//! The account of energies on every scene that is shipped.

use crate::prelude::*;

/// Most steps of a scene that are looked at.
const STEPS: u64 = 3000;

/// The scenes whose accounts are drawn.
const DRAWN: [&str; 3] = ["rigid-ball-penalty", "pile", "road"];

/// Does the sum of all terms stay what it was, on every scene?
pub(crate) const LEDGER: Experiment = Experiment {
    id: "ledger",
    title: "The account of energies on every scene",
    place: "beyond",
    question: "Kinetic, elastic, each force, walls, damping, contacts, changed parameters, growth: does the sum stay what it was, \
               and by how much may it stray on each scene?",
    claims: &[
        claim("on every scene the sum closes to what rounding adds up to, under either scheme and all \
               rules [algebra of the scheme]")
            .judged(|r| {
                let scenes = scenes(r, |_| true)?;
                let mut fine = 0;
                for scene in &scenes {
                    let allowed = r.number(&format!("allowed: {}", scene.name))?;
                    fine += usize::from(scene.gap <= allowed);
                }
                let (all, (name, gap)) = (scenes.len(), worst(&scenes));
                let words = format!("{fine} of {all} scenes, most on {name}: {gap:.0e}");
                Ok(Finding::new(fine == all && fine > 0, words))
            }),
        claim("snakes that meet, rub and adhere, and nodes that enter a spring within a step, are no \
               exception [work of contacts along the way of each step]")
            .judged(|r| {
                let (name, gap) = worst(&scenes(r, |kind| kind > FREE)?);
                Ok(Finding::new(gap < 1e-9, format!("most on {name}: {gap:.0e}")))
            }),
        claim("what a curve gains that grows at its tips is booked [sums before and after lengthening]")
            .when(&[below("road: put in by growth", -0.1), below("gap: road", 1e-9)]),
        claim("what the scheme itself holds back swings by the square of the step under the leapfrog \
               [algebra of the scheme]")
            .when(&[ratio(
                "ringing oval: the scheme's, at its step",
                "ringing oval: the scheme's, at half of it",
                4.0,
                0.5,
            )]),
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
fn scenes(r: &Record, of_kind: fn(f64) -> bool) -> Result<Vec<Found>> {
    let names = r
        .numbers
        .iter()
        .filter_map(|n| n.name.strip_prefix("gap: "));
    let mut out = Vec::new();
    for name in names {
        // a label, not a measurement
        if of_kind(r.told(&format!("kind: {name}"))?) {
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
    run: Run,
    /// What rounding may add up to, as a share of the largest change.
    allowed: f64,
    kind: f64,
}

impl Account {
    fn of(name: &str, step: f64) -> Result<Self> {
        let mut scene = scene_with(name, &[])?;
        let plan = &mut scene.plan;
        plan.dt *= step;
        let steps = steps_in(real_steps(plan.until.steps.min(STEPS)), step);
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
        let run = to_the_end(&scene)?;
        let rows = run.frames.iter();
        let rows = rows.filter_map(|frame| Some((frame.t, frame.energies.as_ref()?.values())));
        let rows: Vec<(f64, Vec<f64>)> = rows.collect();
        // a step's: rounding of all terms, and under the report's scheme that of x / dt in the velocity (D21)
        let cancels = scene.plan.scheme == integrator::Scheme::Report;
        let body = scene.snake.body();
        let mut most = 0.0_f64;
        for ((_, row), frame) in rows.iter().zip(&run.frames) {
            let mut each = 64.0 * row.iter().map(|value| value.abs()).sum::<f64>();
            let velocities = frame.velocities().into_iter().flatten().filter(|_| cancels);
            for (i, (x, v)) in frame.nodes().iter().zip(velocities).enumerate() {
                each +=
                    8.0 * body.spacing * body.mass.at(i) * v.length() * x.length() / scene.plan.dt;
            }
            most = most.max(each);
        }
        let steps = real_steps(run.frames.last().map_or(0, |frame| frame.step)) + 1.0;
        Ok(Self {
            allowed: steps * f64::EPSILON * most / change(&rows),
            run: Run {
                terms: run.terms,
                account: rows,
                ..Run::default()
            },
            kind,
        })
    }
}

fn run() -> Result {
    let mut record = Record::default();
    for (name, _) in scene::SCENES {
        let account = Account::of(name, 1.0)?;
        // digits of rounding are no result
        let gap = gap_of(&account.run.account);
        record.note(format!("gap: {name} [of the largest term]"), gap, 2e-9);
        let allowed = format!("allowed: {name} [of the largest term]");
        record.note(allowed, account.allowed, share(0.01));
        record.note(format!("kind: {name}"), account.kind, EXACT);
        if *name == "road" {
            let put_in = account.run.energy("upkeep")?;
            let put_in = -put_in[put_in.len() - 1].1;
            record.note("road: put in by growth [M px³/s²]", put_in, share(1e-3));
        }
        if DRAWN.contains(name) {
            record.keep_run(*name, account.run);
        }
    }
    for (name, step) in [
        ("ringing oval: the scheme's, at its step [M px³/s²]", 1.0),
        ("ringing oval: the scheme's, at half of it [M px³/s²]", 0.5),
    ] {
        let held_back = Account::of("ringing-oval", step)?.run.energy("scheme")?;
        let swings = most(held_back.iter().map(|(_, held)| held.abs()));
        record.note(name, swings, share(1e-3));
    }
    Ok(record)
}

fn draw(record: &Record) -> Drawn {
    let scenes = scenes(record, |_| true)?;
    let at = |k: usize, value: f64| (value.max(1.2e-16), real(k));
    let all = || scenes.iter().enumerate();
    let rows = Axis::new("", real(scenes.len()), -1.0).with_ticks(0);
    let title = "how far the sum strays, as a share of the largest term";
    let found = dots(all().map(|(k, s)| at(k, s.gap)), 2.2, Color::BLUE);
    let allowed = dots(all().map(|(k, s)| at(k, s.allowed)), 1.6, Color::RED);
    let mut panel = plot(title, Axis::log("share", 1e-16, 1e-2), rows)
        .legend_at(Corner::TopLeft)
        .with(found.named("found"))
        .with(allowed.named("allowed"));
    for (k, found) in all() {
        let reach = [at(k, found.gap), at(k, found.allowed)];
        panel = panel
            .with(line(reach, Color::LIGHT).weighing(0.8))
            .with(Layer::Text {
                at: (3e-7, real(k)),
                words: found.name.clone(),
                color: Color::INK,
                centered: false,
            });
    }
    panel.share = 1.25;
    let gravity = ("gravity", "gravity", Color::GREY);
    let outside = [
        ("outside", "gravity", Color::GREY),
        ("between", "between them", Color::INK),
    ];
    let own = [
        ("kinetic", "kinetic", Color::BLUE),
        ("tension", "tension", Color::SKY),
        ("rigidity", "rigidity", Color::GREEN),
        ("tether", "tether", Color::YELLOW),
    ];
    let lost = [
        ("wall", "walls", Color::PURPLE),
        ("damping", "lost to damping", Color::ORANGE),
        ("contact", "lost in contacts", Color::RED),
    ];
    let ball = [&own[..], &[gravity], &lost].concat();
    let ball = account(
        record,
        DRAWN[0],
        "the rigid ball between penalty walls",
        &ball,
    )?;
    let pile = [&own[..], &outside, &lost].concat();
    let pile = account(record, DRAWN[1], "twenty balls fall into a box", &pile)?;
    let road = [
        own[0],
        own[1],
        ("line", "the line", Color::GREY),
        lost[1],
        ("upkeep", "put in by growth", Color::GREEN),
    ];
    let road = account(
        record,
        DRAWN[2],
        "the road: two ends grow until t = 150 s",
        &road,
    )?;
    Artefact::only(
        "Above left: every shipped scene, its first 3000 steps. Allowed: what rounding adds up to in all steps, that of x/Δt under the report's scheme \
         included. The test of the ledger holds every single step to it. Else: the terms of three scenes stand on each other; that their top is level is the claim.",
        Figure::new("The account of energies", 1100.0)
            .with(560.0, vec![panel, ball])
            .with(300.0, vec![pile, road]),
    )
}
