//! Scenes of more than one snake, or of one whose curve is looked after.

use std::ops::ControlFlow;

use integrator::{SchemeError, State};
use io::record::Curve;
use snake::{
    Contact, Crowd, CrowdError, Energies, Event, EventKind, Outcome, Snake, Timing, Upkeep,
};

use crate::record::{Frame, Record};
use crate::scene::{Scene, unsettled};
use crate::{Evidence, SceneError};

/// Whom a scene's snake shares its world with, and how curves are kept in order.
#[derive(Debug, Clone)]
pub struct Company {
    /// The further snakes, each where it starts.
    pub others: Vec<(Snake, State)>,
    /// What happens where curves meet; None: they pass through each other.
    pub contact: Option<Contact>,
    /// How curves are kept in order.
    pub upkeep: Upkeep,
}

impl Scene {
    /// Run the whole crowd from the start; the observer is shown the first snake that is there.
    pub(crate) fn run_company(
        &mut self,
        company: &Company,
        observer: &mut dyn FnMut(&State) -> ControlFlow<()>,
    ) -> Result<Record, SceneError> {
        let plan = self.plan.clone();
        let timing = Timing {
            scheme: plan.scheme,
            dt: plan.dt,
            tolerance: plan.tolerance,
            start: plan.start_rule,
            force: plan.force,
        };
        let mut snakes = vec![(self.snake.clone(), self.start.clone())];
        snakes.extend(company.others.iter().cloned());
        let snakes_at_start: Vec<_> = snakes.iter().map(|(_, state)| state.x.clone()).collect();
        let (from, to) = self.span();
        for (snake, _) in &mut snakes {
            snake.run_between(from, to);
        }
        let keep = plan.recording.sorted();
        let begin = if keep.energies {
            Crowd::new
        } else {
            Crowd::unbooked
        };
        let crowd = begin(snakes, timing, company.contact, company.upkeep);
        let mut crowd = crowd.map_err(|error| refused(&error))?;
        let mut record = Record::of(self);
        record.terms = Energies::names_with(crowd.orders(), Crowd::FORCES.into_iter());
        let frames = &mut record.frames;
        frames.push(frame(&mut crowd, keep.velocities, keep.energies));
        let outcome = crowd.run(&plan.until, &mut |crowd| {
            if keep.keeps(crowd.steps()) {
                frames.push(frame(crowd, keep.velocities, keep.energies));
            }
            match crowd.members().first() {
                Some(first) => observer(&first.state),
                None => ControlFlow::Continue(()),
            }
        });
        let outcome = outcome.map_err(|error| refused(&error))?;
        let step = crowd.steps();
        let last = frames.last().is_some_and(|frame| frame.step == step);
        if !last && !matches!(outcome, Outcome::Diverged { .. }) {
            frames.push(frame(&mut crowd, keep.velocities, keep.energies));
        }
        if self.picture.is_some() && matches!(outcome, Outcome::Settled { .. }) {
            for member in crowd.members() {
                // curves that were born on the way began where they are
                let start = snakes_at_start.get(member.id).unwrap_or(&member.state.x);
                let mut snake = member.snake.clone();
                let found = Evidence::of(&mut snake, start, &member.state, self.resolves);
                record.evidence.push(found);
            }
        }
        record.events = crowd.events().iter().map(said).collect();
        record.pace = crowd.summary().map(|summary| summary.to_string());
        let snakes = crowd.members().iter().map(|member| &member.snake);
        let said = snakes.filter_map(|snake| unsettled(snake, plan.scheme));
        record.remarks.extend(said.take(1));
        record.outcome = outcome;
        Ok(record)
    }
}

/// The moment that a crowd is at.
fn frame(crowd: &mut Crowd, velocities: bool, energies: bool) -> Frame {
    let energies = energies.then(|| crowd.energies());
    let curves = crowd.members().iter().map(|member| Curve {
        id: member.id,
        closed: member.is_closed(),
        nodes: member.state.x.clone(),
        velocities: velocities.then(|| member.state.v.clone()),
    });
    Frame {
        step: crowd.steps(),
        t: crowd.t(),
        curves: curves.collect(),
        energies,
    }
}

/// What happened to a curve, in words.
fn said(event: &Event) -> String {
    let Event { t, member, .. } = event;
    let what = match event.kind {
        EventKind::Cut { cuts: 1 } => "makes its steps in one part again".to_owned(),
        EventKind::Cut { cuts } => format!("makes its steps in {cuts} parts"),
        EventKind::Respaced { from, to } => format!("has {to} nodes instead of {from}"),
        EventKind::LoopRemoved { area } => format!("lost a loop of area {area:.2}"),
        EventKind::Split { pieces } => format!("fell into {pieces} pieces"),
        EventKind::Merged { with } => format!("took snake {with} in"),
        EventKind::Vanished => "vanished".to_owned(),
        _ => "changed".to_owned(),
    };
    format!("t = {t:.4}: snake {member} {what}")
}

/// An error of the crowd, under the key it belongs to.
fn refused(error: &CrowdError) -> SceneError {
    match error {
        CrowdError::Scheme {
            error: SchemeError::AboveLimit { .. } | SchemeError::BadStep { .. },
            ..
        } => SceneError::Step(error.to_string()),
        CrowdError::Scheme { .. } => SceneError::key("run.scheme", error),
        CrowdError::AboveLimit { .. } => SceneError::key("contact.stiffness", error),
        CrowdError::Fault { .. } => SceneError::key("snake.start", error),
        CrowdError::Outline { .. } => SceneError::key("upkeep", error),
        CrowdError::Snake(snake::SnakeError::BadNumber { name, .. }) => {
            let key = match *name {
                "the stiffness of contacts" => "contact.stiffness",
                "the damping of contacts" => "contact.damping",
                "the friction of contacts" => "contact.friction",
                "the friction at walls" => "contact.wall-friction",
                "the adhesion of contacts" => "contact.adhesion",
                "the range of adhesion" => "contact.range",
                "the stick of contacts" => "contact.stick",
                "the gap of contacts" => "contact.gap",
                "the stop of contacts" => "contact.stop",
                "the stretch to re-space at" => "upkeep.stretch",
                "the least area" => "upkeep.least-area",
                "the depth to merge at" => "upkeep.merge",
                "the yield strain" => "upkeep.plastic.yields-at",
                "the rate of flow" => "upkeep.plastic.rate",
                "the growth" => "upkeep.growth",
                _ => "upkeep",
            };
            SceneError::key(key, error)
        }
        _ => SceneError::key("upkeep", error),
    }
}
