//! How a scene is run: as one simulation, whatever it holds.

use std::ops::ControlFlow;

use integrator::{Scheme, SchemeError, State};
use snake::{
    Edit, Energies, Entry, Event, EventKind, Member, Outcome, RuleKey, Rules, Simulation,
    SimulationError, Snake, Stepping, Until,
};

use io::record::Curve;

use crate::record::{Frame, Record};
use crate::scene::{Recording, Scene, refused_step};
use crate::{Evidence, SceneError};

impl Scene {
    /// Everything that moves, at its start: what [`Scene::run`] runs. Forces and holds of hands come and go in a run
    /// only.
    ///
    /// # Errors
    ///
    /// Whatever [`Scene::check`] refuses; a start at which a force has no value, where energies are kept.
    pub fn simulation(&self) -> Result<Simulation, SceneError> {
        self.check()?;
        self.begin(self.all().map(|(snake, _)| snake.clone()).collect())
    }

    /// Every snake of it, each where it starts.
    fn all(&self) -> impl Iterator<Item = (&Snake, &State)> {
        let others = self.company.iter().flat_map(|company| &company.others);
        let others = others.map(|(snake, start)| (snake, start));
        std::iter::once((&self.snake, &self.start)).chain(others)
    }

    /// The same with these snakes in place of its own.
    fn begin(&self, snakes: Vec<Snake>) -> Result<Simulation, SceneError> {
        let plan = &self.plan;
        let stepping = Stepping {
            scheme: plan.scheme,
            dt: plan.dt,
            tolerance: plan.tolerance,
            relax: None,
            each: plan.each,
            start: plan.start_rule,
            force: plan.force,
        };
        let starts = self.all().map(|(_, start)| start);
        let entry = |(snake, start): (Snake, &State)| Entry {
            terms: self.terms.clone(),
            ..Entry::new(snake, start.clone())
        };
        let mut entries: Vec<Entry> = snakes.into_iter().zip(starts).map(entry).collect();
        if let Some(first) = entries.first_mut() {
            first.tips.clone_from(&self.tips);
        }
        let mut rules = Rules {
            energies: plan.recording.energies,
            ..Rules::default()
        };
        if let Some(company) = &self.company {
            (rules.contact, rules.upkeep) = (company.contact, company.upkeep);
        }
        let (from, to) = self.span();
        for Entry { snake, .. } in &mut entries {
            snake.run_between(from, to);
        }
        Simulation::new(entries, stepping, &rules).map_err(|error| refused(&error))
    }

    /// Run it from the start, showing the first snake that is there to `observer` after every step.
    ///
    /// # Errors
    ///
    /// Whatever [`Scene::check`] refuses; a start at which a force cannot be evaluated.
    pub fn run(
        &self,
        observer: &mut dyn FnMut(&State) -> ControlFlow<()>,
    ) -> Result<Record, SceneError> {
        self.check()?;
        let plan = &self.plan;
        let (mut hand, slack) = (self.hand.clone(), 1e-9 * plan.dt);
        let mut snakes: Vec<Snake> = self.all().map(|(snake, _)| snake.clone()).collect();
        let mut said = Vec::new();
        let t = self.start.t;
        for (index, edit, what) in hand.act(t, slack, |k| self.all().nth(k).map(|(_, at)| at))? {
            let done = edit_snake(&mut snakes[index], edit);
            done.map_err(|error| SceneError::key("hand", error))?;
            said.push((t, what));
        }
        for (index, snake) in snakes.iter_mut().enumerate() {
            if hand.acts_on(index) {
                snake.expect_changes_until(hand.end());
            }
        }
        let mut simulation = self.begin(snakes)?;
        let keep = &plan.recording.sorted();
        let room = plan.room(self.start.len());
        let until = Until {
            steps: room,
            ..plan.until
        };
        let mut record = Record::of(self);
        if self.company.is_some() {
            let names = Simulation::FORCES.into_iter();
            record.terms = Energies::names_with(simulation.orders(), names);
        }
        let alone = self.company.is_none();
        record.frames.push(frame(&mut simulation, keep, alone)?);
        let (begin, mut refusal) = (simulation.steps(), None);
        let frames = &mut record.frames;
        let outcome = simulation.run(&until, &mut |simulation| {
            let mut watch = || -> Result<ControlFlow<()>, SceneError> {
                if keep.keeps(simulation.steps()) {
                    frames.push(frame(simulation, keep, alone)?);
                }
                let Some(first) = simulation.members().first() else {
                    return Ok(ControlFlow::Continue(()));
                };
                let shown = observer(first.state());
                // what is done after the last step is of no run
                if hand.is_empty() || simulation.steps() - begin >= until.steps {
                    return Ok(shown);
                }
                let (t, members) = (simulation.t(), simulation.members());
                let of = |id| {
                    members
                        .iter()
                        .find(|member| member.id() == id)
                        .map(Member::state)
                };
                for (id, edit, what) in hand.act(t, slack, of)? {
                    let done = simulation.edit(id, edit);
                    done.map_err(|error| SceneError::key("hand", error))?;
                    said.push((t, what));
                }
                Ok(shown)
            };
            watch().unwrap_or_else(|error| {
                refusal = Some(error);
                ControlFlow::Break(())
            })
        });
        if let Some(error) = refusal {
            return Err(error);
        }
        let outcome = outcome.map_err(|error| refused(&error))?;
        let last = record.frames.last().map(|frame| frame.step);
        if last != Some(simulation.steps()) && !matches!(outcome, Outcome::Diverged { .. }) {
            record.frames.push(frame(&mut simulation, keep, alone)?);
        }
        if self.picture.is_some() && matches!(outcome, Outcome::Settled { .. }) {
            record.evidence = self.evidence(&simulation);
        }
        said.extend(
            simulation
                .events()
                .iter()
                .map(|event| (event.t, words(event))),
        );
        said.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        record.events = said.into_iter().map(|(_, what)| what).collect();
        record.remarks.extend(unsettled(&simulation, plan.scheme));
        record.pace = simulation.summary().map(|summary| summary.to_string());
        record.outcome = outcome;
        let short = until.time.is_some_and(|end| simulation.t() < end);
        if short && room < plan.until.steps && matches!(outcome, Outcome::Finished { .. }) {
            let message = format!(
                "has kept {room} steps, which is all there is room for, by t = {:.6}; keep fewer moments",
                simulation.t()
            );
            return Err(SceneError::key("record.every", message));
        }
        Ok(record)
    }

    /// What speaks for the curves that have come to rest.
    fn evidence(&self, simulation: &Simulation) -> Vec<Evidence> {
        let starts: Vec<_> = self.all().map(|(_, start)| &start.x).collect();
        let of = |member: &Member| {
            let end = member.state();
            // curves that were born on the way began where they are
            let start = starts.get(member.id()).copied().unwrap_or(&end.x);
            Evidence::of(&mut member.snake().clone(), start, end, self.resolves)
        };
        simulation.members().iter().map(of).collect()
    }
}

/// An edit of a snake before its simulation begins.
fn edit_snake(snake: &mut Snake, edit: Edit) -> Result<(), snake::SnakeError> {
    match edit {
        Edit::Hold(nodes) => snake.hold(nodes),
        Edit::Release(nodes) => snake.release(nodes),
        Edit::Add(acting) => snake.add_force(acting),
        Edit::Replace(acting) => {
            let name = acting.name().to_owned();
            snake.replace_force(&name, acting).map(|_| ())
        }
        // hands do nothing else
        _ => Ok(()),
    }
}

/// The moment that a simulation is at.
fn frame(simulation: &mut Simulation, keep: &Recording, alone: bool) -> Result<Frame, SceneError> {
    let energies = match simulation.members().first().map(Member::id) {
        _ if !keep.energies => None,
        // force by force, by their names
        Some(id) if alone => {
            let own = simulation.energies_of(id);
            Some(own.map_err(|error| refused(&error))?)
        }
        _ => Some(simulation.energies()),
    };
    let velocities = keep.velocities;
    let curves = simulation.members().iter().map(|member| Curve {
        id: member.id(),
        closed: member.is_closed(),
        nodes: member.state().x.clone(),
        velocities: velocities.then(|| member.state().v.clone()),
    });
    Ok(Frame {
        step: simulation.steps(),
        t: simulation.t(),
        curves: curves.collect(),
        energies,
    })
}

/// What happened to a curve, in words.
fn words(event: &Event) -> String {
    let Event { t, member, .. } = event;
    let what = match event.kind {
        EventKind::Cut { cuts: 1 } => "makes its steps in one part again".to_owned(),
        EventKind::Cut { cuts } => format!("makes its steps in {cuts} parts"),
        EventKind::Respaced { from, to } => format!("has {to} nodes instead of {from}"),
        EventKind::LoopRemoved { area } => format!("lost a loop of area {area:.2}"),
        EventKind::Split { pieces } => format!("fell into {pieces} pieces"),
        EventKind::Merged { with } => format!("took snake {with} in"),
        EventKind::Vanished => "vanished".to_owned(),
        EventKind::Grown { head, nodes } => {
            let end = if head { "head" } else { "tail" };
            format!("no longer grows at its {end}, {nodes} nodes")
        }
        _ => "changed".to_owned(),
    };
    format!("t = {t:.4}: snake {member} {what}")
}

/// What to say of implicit steps whose rounds did not come to agree.
fn unsettled(simulation: &Simulation, scheme: Scheme) -> Option<String> {
    let counts = simulation.members().iter().map(|m| m.snake().unsettled());
    let count: u64 = counts.sum();
    (count > 0).then(|| {
        format!(
            "the rounds of {count} steps of {} did not come to agree, so these are of lower order (those of backward-euler \
             are steps of imex); a smaller step mends it",
            scheme.name()
        )
    })
}

/// An error of the simulation, under the key it belongs to.
fn refused(error: &SimulationError) -> SceneError {
    let key = match error {
        SimulationError::Scheme { error: inner, .. } => {
            return match inner {
                SchemeError::AboveLimit { .. } | SchemeError::BadStep { .. } => {
                    SceneError::Step(error.to_string())
                }
                _ => refused_step(inner),
            };
        }
        SimulationError::AboveLimit { .. } => "contact.stiffness",
        SimulationError::Fault { .. } => "snake.start",
        SimulationError::Rule { key, .. } => match key {
            RuleKey::Stiffness => "contact.stiffness",
            RuleKey::Damping => "contact.damping",
            RuleKey::Friction => "contact.friction",
            RuleKey::WallFriction => "contact.wall-friction",
            RuleKey::Stick => "contact.stick",
            RuleKey::Gap => "contact.gap",
            RuleKey::Adhesion => "contact.adhesion",
            RuleKey::Range => "contact.range",
            RuleKey::Stop => "contact.stop",
            RuleKey::Stretch => "upkeep.stretch",
            RuleKey::LeastArea => "upkeep.least-area",
            RuleKey::Merge => "upkeep.merge",
            RuleKey::YieldsAt => "upkeep.plastic.yields-at",
            RuleKey::FlowRate => "upkeep.plastic.rate",
            RuleKey::Growth => "upkeep.growth",
            _ => "upkeep",
        },
        SimulationError::Unshared => "run.output",
        SimulationError::Growth { .. } => "tips",
        SimulationError::Frame { .. } => "run.dt",
        _ => "upkeep",
    };
    SceneError::key(key, error)
}
