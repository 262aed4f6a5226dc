//! Runs of scenes and snakes: the one place that starts and steps them.

use crate::error::{Result, refused};
use crate::real;
use crate::run::{Curve, Frame, Run, gap_of};
use glam::DVec2;
use integrator::{Scheme, State};
use scene::Scene;
use snake::{Energies, Entry, Outcome, Rules, Simulation, Snake, Stepping, Until, Upkeep};
use std::ops::ControlFlow;
use std::path::Path;

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

/// Words of a scene, and what stands in their place: `[(from, to)]`.
pub(crate) type Changes = &'static [(&'static str, &'static str)];

/// A shipped scene, some of its words exchanged for others: `[(from, to)]`.
///
/// # Errors
///
/// No such scene, words it does not have, or a scene refused.
pub fn scene_with(name: &str, changes: &[(&str, &str)]) -> Result<Scene> {
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
pub(crate) fn watched(scene: &Scene, watch: &mut dyn FnMut(&State)) -> Result<scene::Record> {
    Ok(scene.run(&mut |state| {
        watch(state);
        ControlFlow::Continue(())
    })?)
}

/// Runs a scene to its end.
pub(crate) fn to_the_end(scene: &Scene) -> Result<scene::Record> {
    watched(scene, &mut |_| ())
}

/// A scene as it is at its end, and its run.
pub(crate) fn ran(name: &str, changes: &[(&str, &str)]) -> Result<(Scene, scene::Record)> {
    let scene = scene_with(name, changes)?;
    let run = to_the_end(&scene)?;
    Ok((scene, run))
}

/// The nodes at the end of a run.
pub(crate) fn last(run: &scene::Record) -> &[DVec2] {
    run.last().map_or(&[], scene::Frame::nodes)
}

/// Moves a snake that is no scene's, by a scheme with a step, and shows each step.
pub(crate) fn moved(
    snake: &mut Snake,
    state: &mut State,
    (scheme, dt): (Scheme, f64),
    until: &Until,
    watch: &mut dyn FnMut(&State) -> ControlFlow<()>,
) -> Result<Outcome> {
    let stepping = Stepping {
        force: true,
        ..Stepping::of(scheme, dt)
    };
    let mut simulation = Simulation::of(snake.clone(), state.clone(), stepping)?;
    let outcome = simulation.run(until, &mut |simulation| {
        watch(simulation.members()[0].state())
    })?;
    let member = &simulation.members()[0];
    (*snake, *state) = (member.snake().clone(), member.state().clone());
    Ok(outcome)
}

/// Snakes that are stepped together, with an account of their energies.
pub type Group = Simulation;

/// A scene as a group, also where it is a single snake.
///
/// # Errors
///
/// What cannot be stepped together.
pub fn group(scene: &Scene) -> Result<Group> {
    let stepping = Stepping {
        start: scene.plan.start_rule,
        force: scene.plan.force,
        ..Stepping::of(scene.plan.scheme, scene.plan.dt)
    };
    let mut snakes = vec![(scene.snake.clone(), scene.start.clone())];
    let mut rules = Rules {
        energies: true,
        ..Rules::default()
    };
    if let Some(company) = &scene.company {
        snakes.extend(company.others.iter().cloned());
        (rules.contact, rules.upkeep) = (company.contact, company.upkeep);
    }
    let entries = snakes.into_iter();
    let entries = entries.map(|(snake, state)| Entry::new(snake, state));
    Ok(Simulation::new(entries.collect(), stepping, &rules)?)
}

/// A snake that is no scene's as a group, by leapfrog.
pub(crate) fn group_of(snake: Snake, state: State, dt: f64, upkeep: Upkeep) -> Result<Group> {
    let rules = Rules {
        upkeep,
        energies: true,
        ..Rules::default()
    };
    let stepping = Stepping::of(Scheme::Leapfrog, dt);
    Ok(Simulation::new(
        vec![Entry::new(snake, state)],
        stepping,
        &rules,
    )?)
}

/// One step of a group; one that ends with it is refused.
///
/// # Errors
///
/// What cannot be stepped, and a group that blows up or leaves its picture.
pub fn advance(group: &mut Group) -> Result<()> {
    match group.step()? {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(outcome) => Err(refused(outcome)),
    }
}

/// A group as it is now.
pub(crate) fn frame(group: &Group) -> Frame {
    let curves = group.members().iter().map(|member| Curve {
        id: member.id(),
        closed: member.is_closed(),
        nodes: member.state().x.clone(),
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
            advance(group)?;
            out.deepest = out.deepest.max(group.deepest());
        }
        if step.is_multiple_of(every) || step == steps {
            out.run.account.push((group.t(), terms(&group.energies())));
            let off = group.momentum().distance(start);
            out.momentum.1 = out.momentum.1.max(off);
            let speeds = group.members().iter().flat_map(|m| &m.state().v);
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
