//! Runs of scenes and snakes: the one place that starts and steps them, and what is kept of them.

use crate::error::{Result, refused};
use crate::real;
use crate::record::shortest;
use glam::DVec2;
use integrator::{Scheme, Start, State};
use scene::Scene;
use snake::{Crowd, Energies, Outcome, Snake, Timing, Until, Upkeep};
use std::ops::ControlFlow;
use std::path::Path;

/// One curve at one moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// The snake's number.
    pub id: usize,
    /// Whether it is closed.
    pub closed: bool,
    /// Its nodes.
    pub nodes: Vec<DVec2>,
}

impl Curve {
    /// Its points as they are drawn, a closed one led back to its first.
    pub(crate) fn points(&self) -> Vec<(f64, f64)> {
        let first = self.nodes.first().filter(|_| self.closed);
        let all = self.nodes.iter().chain(first);
        all.map(|&node| pair(node)).collect()
    }
}

/// All curves at one moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// When.
    pub t: f64,
    /// The curves there are.
    pub curves: Vec<Curve>,
}

impl Frame {
    /// A moment of a single closed curve.
    pub(crate) fn closed(t: f64, nodes: Vec<DVec2>) -> Self {
        let (id, closed) = (0, true);
        let curves = vec![Curve { id, closed, nodes }];
        Self { t, curves }
    }
}

/// What is kept of a run: moments, and the account of its energies.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Run {
    /// The moments.
    pub frames: Vec<Frame>,
    /// What the energies are called.
    pub terms: Vec<String>,
    /// For each time of the account the energies, in the order of the terms.
    pub account: Vec<(f64, Vec<f64>)>,
}

impl From<Vec<Frame>> for Run {
    fn from(frames: Vec<Frame>) -> Self {
        Self {
            frames,
            ..Self::default()
        }
    }
}

impl From<&scene::Record> for Run {
    fn from(run: &scene::Record) -> Self {
        let frame = |frame: &scene::Frame| {
            let first = Curve {
                id: frame.first,
                closed: run.closed,
                nodes: frame.nodes.clone(),
            };
            let others = frame.others.iter().map(|curve| Curve {
                id: curve.id,
                closed: curve.closed,
                nodes: curve.nodes.clone(),
            });
            let curves = std::iter::once(first).chain(others).collect();
            Frame { t: frame.t, curves }
        };
        let row = |frame: &scene::Frame| {
            let energies = frame.energies.as_ref()?;
            let mut row = energies.values();
            row.extend([energies.elastic(), energies.mechanical()]);
            Some((frame.t, row))
        };
        let sums = ["elastic", "total"].map(str::to_owned);
        Self {
            frames: run.frames.iter().map(frame).collect(),
            terms: run.terms.iter().cloned().chain(sums).collect(),
            account: run.frames.iter().filter_map(row).collect(),
        }
    }
}

impl Run {
    /// How many moments there are.
    pub(crate) fn len(&self) -> usize {
        self.frames.len()
    }

    /// The time of a moment.
    pub(crate) fn t(&self, frame: usize) -> f64 {
        self.frames[frame].t
    }

    /// The nodes of a moment's first curve.
    pub(crate) fn nodes(&self, frame: usize) -> &[DVec2] {
        &self.frames[frame].curves[0].nodes
    }

    /// The same as pairs.
    pub(crate) fn pairs(&self, frame: usize) -> Vec<(f64, f64)> {
        pairs(self.nodes(frame))
    }

    /// The moment nearest in time.
    pub(crate) fn nearest(&self, t: f64) -> usize {
        let distance = |i: &usize| (self.t(*i) - t).abs();
        let nearest = (0..self.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.unwrap_or(0)
    }

    /// The moments nearest to `0, every, 2 every …` up to the last.
    pub(crate) fn each(&self, every: f64) -> Vec<usize> {
        let end = self.frames.last().map_or(0.0, |frame| frame.t);
        let times = (0..100_000).map(|i| real(i) * every);
        let times = times.take_while(|t| *t <= end + 1e-9);
        let mut out: Vec<usize> = times.map(|t| self.nearest(t)).collect();
        out.dedup();
        out
    }

    /// An energy over time.
    pub(crate) fn energy(&self, term: &str) -> Result<Vec<(f64, f64)>> {
        let column = self.terms.iter().position(|known| known == term);
        let column = column.ok_or_else(|| refused(format!("the account has no {term}")))?;
        let rows = self.account.iter();
        Ok(rows.map(|(t, row)| (*t, row[column])).collect())
    }

    /// The moments as CSV, a node a line; behind them the account, if there is one.
    pub(crate) fn csv(&self) -> String {
        let mut out = String::from("t,curve,x,y\n");
        for frame in &self.frames {
            for curve in &frame.curves {
                for node in &curve.nodes {
                    let [t, x, y] = [frame.t, node.x, node.y].map(shortest);
                    out.push_str(&format!("{t},{},{x},{y}\n", curve.id));
                }
            }
        }
        if !self.account.is_empty() {
            out.push_str(&format!("\nt,{}\n", self.terms.join(",")));
        }
        for (t, row) in &self.account {
            let cells = std::iter::once(t).chain(row);
            let cells: Vec<String> = cells.map(|&value| shortest(value)).collect();
            out.push_str(&format!("{}\n", cells.join(",")));
        }
        out
    }
}

/// A point as the drawing kit takes it.
pub(crate) fn pair(p: DVec2) -> (f64, f64) {
    (p.x, p.y)
}

/// Points as the drawing kit takes them.
pub(crate) fn pairs(points: &[DVec2]) -> Vec<(f64, f64)> {
    points.iter().map(|&p| pair(p)).collect()
}

/// How many steps make up a time.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "some thousand"
)]
pub(crate) fn steps_in(time: f64, dt: f64) -> u64 {
    (time / dt).round() as u64
}

/// A number of steps as a number.
pub(crate) fn real_steps(steps: u64) -> f64 {
    usize::try_from(steps).map_or(f64::INFINITY, real)
}

/// A shipped scene, some of its words exchanged for others: `[(from, to)]`.
pub(crate) fn scene_with(name: &str, changes: &[(&str, &str)]) -> Result<Scene> {
    let Some((_, text)) = scene::SCENES.iter().find(|(known, _)| *known == name) else {
        return Ok(Scene::named(name)?); // refused with the nearest name
    };
    let mut text = (*text).to_owned();
    for (from, to) in changes {
        if !text.contains(from) {
            return Err(refused(format!("{name} does not say {from}")));
        }
        text = text.replace(from, to);
    }
    Ok(Scene::parse(name, &text, Path::new("."))?)
}

/// Runs a scene to its end, and shows each step.
pub(crate) fn watched(scene: &mut Scene, watch: &mut dyn FnMut(&State)) -> Result<scene::Record> {
    Ok(scene.run(&mut |state| {
        watch(state);
        ControlFlow::Continue(())
    })?)
}

/// Runs a scene to its end.
pub(crate) fn to_the_end(scene: &mut Scene) -> Result<scene::Record> {
    watched(scene, &mut |_| ())
}

/// A scene as it is at its end, and its run.
pub(crate) fn ran(name: &str, changes: &[(&str, &str)]) -> Result<(Scene, scene::Record)> {
    let mut scene = scene_with(name, changes)?;
    let run = to_the_end(&mut scene)?;
    Ok((scene, run))
}

/// The nodes at the end of a run.
pub(crate) fn last(run: &scene::Record) -> &[DVec2] {
    run.last().map_or(&[], |frame| &frame.nodes)
}

/// Moves a snake that is no scene's, by a scheme with a step, and shows each step.
pub(crate) fn moved(
    snake: &mut Snake,
    state: &mut State,
    (scheme, dt): (Scheme, f64),
    until: &Until,
    watch: &mut dyn FnMut(&State) -> ControlFlow<()>,
) -> Result<Outcome> {
    let mut stepper = scheme.start(snake, state, dt, Start::SecondOrder)?;
    let watch = &mut |_: &mut Snake, state: &State| watch(state);
    Ok(snake::run(snake, &mut *stepper, state, until, watch))
}

/// Snakes that are stepped together.
pub(crate) type Group = Crowd;

/// A scene as a group, also where it is a single snake.
pub(crate) fn group(scene: &Scene) -> Result<Group> {
    let timing = Timing {
        scheme: scene.plan.scheme,
        dt: scene.plan.dt,
        tolerance: None,
        start: scene.plan.start_rule,
        force: scene.plan.force,
    };
    let mut snakes = vec![(scene.snake.clone(), scene.start.clone())];
    let (mut contact, mut upkeep) = (None, Upkeep::default());
    if let Some(company) = &scene.company {
        snakes.extend(company.others.iter().cloned());
        (contact, upkeep) = (company.contact, company.upkeep);
    }
    Ok(Crowd::new(snakes, timing, contact, upkeep)?)
}

/// A snake that is no scene's as a group, by leapfrog.
pub(crate) fn group_of(snake: Snake, state: State, dt: f64, upkeep: Upkeep) -> Result<Group> {
    let timing = Timing {
        scheme: Scheme::Leapfrog,
        dt,
        tolerance: None,
        start: Start::SecondOrder,
        force: false,
    };
    Ok(Crowd::new(vec![(snake, state)], timing, None, upkeep)?)
}

/// A group as it is now.
pub(crate) fn frame(group: &Group) -> Frame {
    let curves = group.members().iter().map(|member| Curve {
        id: member.id,
        closed: member.is_closed(),
        nodes: member.state.x.clone(),
    });
    Frame {
        t: group.t(),
        curves: curves.collect(),
    }
}

/// The terms of a group's account.
const TERMS: [&str; 10] = [
    "kinetic",
    "elastic",
    "outside",
    "between",
    "wall",
    "damping",
    "contact",
    "parameters",
    "upkeep",
    "scheme",
];

fn terms(energies: &Energies) -> Vec<f64> {
    vec![
        energies.kinetic,
        energies.elastic(),
        energies.forces[0],
        energies.forces[1],
        energies.wall,
        energies.damping,
        energies.contact,
        energies.parameters + energies.hand,
        energies.upkeep,
        energies.frame + energies.scheme,
    ]
}

/// What watching a group gave.
#[derive(Debug)]
pub(crate) struct Watched {
    /// Moments and account.
    pub run: Run,
    /// The deepest that any node was in another snake.
    pub deepest: f64,
    /// The greatest speed of a node.
    pub fastest: f64,
    /// Momentum at the start, and the largest distance from it.
    pub momentum: (DVec2, f64),
}

/// Moves a group by so many steps; the account is read every `every` steps, pictures are taken at
/// the steps of `pictures`.
pub(crate) fn watch(
    group: &mut Group,
    steps: u64,
    every: u64,
    pictures: &[u64],
) -> Result<Watched> {
    let start = group.momentum();
    let mut out = Watched {
        run: Run {
            terms: TERMS.map(str::to_owned).to_vec(),
            ..Run::default()
        },
        deepest: 0.0,
        fastest: 0.0,
        momentum: (start, 0.0),
    };
    for step in 0..=steps {
        if step > 0 {
            group.step()?;
            out.deepest = out.deepest.max(group.deepest());
        }
        if step.is_multiple_of(every) || step == steps {
            out.run.account.push((group.t(), terms(&group.energies())));
            let off = group.momentum().distance(start);
            out.momentum.1 = out.momentum.1.max(off);
            let speeds = group.members().iter().flat_map(|m| &m.state.v);
            out.fastest = speeds.fold(out.fastest, |most, v| most.max(v.length()));
        }
        if pictures.contains(&step) {
            out.run.frames.push(frame(group));
        }
    }
    Ok(out)
}

impl Watched {
    /// Notes what every group is judged by.
    pub(crate) fn note(&self, record: &mut crate::Record, name: &str, loose: f64) {
        let share = crate::tolerance::share;
        // digits of rounding are no result
        let gap = format!("{name}: gap of the account [of the largest term]");
        record.note(gap, gap_of(&self.run.account), 1e-9);
        let deep = format!("{name}: deepest overlap [px]");
        record.note(deep, self.deepest, share(0.1));
        let fast = format!("{name}: greatest speed [px/s]");
        record.note(fast, self.fastest, share(loose));
    }
}

/// The largest change of the sum of an account.
pub(crate) fn stray(rows: &[(f64, Vec<f64>)]) -> f64 {
    let total = |row: &(f64, Vec<f64>)| row.1.iter().sum::<f64>();
    let first = rows.first().map_or(0.0, total);
    rows.iter()
        .fold(0.0, |off, row| off.max((total(row) - first).abs()))
}

/// The largest change of a term of an account.
pub(crate) fn change(rows: &[(f64, Vec<f64>)]) -> f64 {
    let first = rows.first().into_iter().flat_map(|row| &row.1);
    let changes = rows.iter().flat_map(|row| row.1.iter().zip(first.clone()));
    changes.fold(f64::MIN_POSITIVE, |most, (now, then)| {
        most.max((now - then).abs())
    })
}

/// How far the sum of an account strays, as a share of the largest change of one of its terms.
pub(crate) fn gap_of(rows: &[(f64, Vec<f64>)]) -> f64 {
    stray(rows) / change(rows)
}
