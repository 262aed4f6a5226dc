//! Into how many parts a step is cut: by the contacts, and by nodes that have come closer to each other.

use glam::DVec2;
use integrator::{Limit, Relaxation, SchemeError, Start, State, Summary};

use super::run::around;
use super::{Contact, Simulation, SimulationError, Stepping, longest};
use crate::{Pace, Snake, SnakeError, Term, Turning, TurningStepper};

/// Share of the contacts' limit that chosen steps have: they err by the square of it.
const RESOLVED: f64 = 0.25;

/// Share of the gap and the stop that nodes may come closer by in a part of a step: so each is seen on its way in.
const SEEN: f64 = 0.5;

/// Share of its limit that a cut step has at most.
const BELOW: f64 = 0.9;

/// Sub-steps of a step at most: a curve that needs more is taken for a mistake in the scene.
const MOST: f64 = 1000.0;

/// Why a snake cannot be stepped.
#[derive(Debug)]
pub(super) enum Unready {
    Scheme(SchemeError),
    Snake(SnakeError),
    Frame,
}

impl From<SchemeError> for Unready {
    fn from(error: SchemeError) -> Self {
        Self::Scheme(error)
    }
}

impl From<SnakeError> for Unready {
    fn from(error: SnakeError) -> Self {
        Self::Snake(error)
    }
}

impl Unready {
    /// The error of a simulation that it is, of that snake.
    pub(super) fn of(self, member: usize) -> SimulationError {
        match self {
            Self::Scheme(error) => SimulationError::Scheme { member, error },
            Self::Snake(error) => error.into(),
            Self::Frame => SimulationError::Frame { member },
        }
    }
}

impl Simulation {
    /// Let the step have as many parts as the contacts ask for now: masses and lengths change with
    /// upkeep, and nodes that
    /// come fast must be seen on the way.
    pub(super) fn divide(&mut self) -> Result<(), SimulationError> {
        let Some(contact) = self.contact else {
            return Ok(());
        };
        let dt = self.stepping.dt;
        let mut wanted = self.least_parts as f64;
        if self.stepping.tolerance.is_none() && dt >= self.contact_limit(&contact) {
            wanted = wanted.max((dt / (BELOW * self.contact_limit(&contact))).ceil());
        }
        let way = SEEN * (contact.gap + contact.stop);
        wanted = wanted
            .max((dt * self.approach(&contact) / way).ceil())
            .min(MOST);
        // not back and forth for every small change
        if wanted <= self.parts as f64 && 3.0 * wanted > self.parts as f64 {
            return Ok(());
        }
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "from 1 to MOST, or what it was"
        )]
        let parts = (wanted as u64).max(self.least_parts);
        if parts == self.parts {
            return Ok(());
        }
        self.parts = parts;
        for k in 0..self.members.len() {
            self.remember(k);
            let mut snake = self.members[k].snake.clone();
            let pace = self.pace_of(k, &mut snake, &self.members[k].state);
            let member = &mut self.members[k];
            let (pace, cuts) = pace.map_err(|error| error.of(member.id))?;
            (member.pace, member.cuts) = (pace, cuts);
            member.resume()?;
        }
        Ok(())
    }

    /// The largest step of the contacts for the masses and lengths there are, at any time.
    pub(super) fn contact_limit(&self, contact: &Contact) -> f64 {
        let least = self.members.iter().map(|member| member.lightest);
        let edges = self.members.iter().map(|member| {
            longest(&member.state.x, member.is_closed()) / member.snake.body().spacing
        });
        let stretch = if contact.adheres() {
            edges.fold(0.0, f64::max)
        } else {
            1.0
        };
        contact.step_limit(least.fold(f64::INFINITY, f64::min), stretch)
    }

    /// How fast nodes of curves come towards each other that may meet within the next step. L T⁻¹.
    fn approach(&self, contact: &Contact) -> f64 {
        let reach = contact.gap + contact.stop;
        let moving: Vec<_> = (self.members.iter())
            .map(|m| (around(&m.state.x), around(&m.state.v)))
            .collect();
        let against = |a: (DVec2, DVec2), b: (DVec2, DVec2)| {
            let apart = (a.1 - b.0).abs().max((b.1 - a.0).abs());
            apart.length()
        };
        let mut fastest = 0.0_f64;
        if contact.own {
            let own = moving.iter().map(|(_, v)| against(*v, *v));
            fastest = own.fold(0.0, f64::max);
        }
        let all = moving.iter().map(|(_, v)| *v);
        let all = all.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let dt = self.stepping.dt;
        // nothing can come that far: mostly so
        let most = all.map_or(0.0, |all| against(all, all));
        if dt * most <= SEEN * reach {
            return 0.0;
        }
        let mut order: Vec<usize> = (0..moving.len()).collect();
        order.sort_by(|&a, &b| moving[a].0.0.x.total_cmp(&moving[b].0.0.x));
        for (k, &a) in order.iter().enumerate() {
            let (box_a, speed_a) = moving[a];
            for &b in &order[k + 1..] {
                let (box_b, speed_b) = moving[b];
                if box_b.0.x > box_a.1.x + reach + dt * most {
                    break;
                }
                let speed = against(speed_a, speed_b);
                let near = DVec2::splat(reach + dt * speed);
                let meet = (box_a.0 - near).cmple(box_b.1) & (box_b.0 - near).cmple(box_a.1);
                if meet.all() {
                    fastest = fastest.max(speed);
                }
            }
        }
        fastest
    }

    /// Cut the step into parts below the limit of the contacts, or refuse it where it may not be cut.
    pub(super) fn cut(&mut self, limit: f64) -> Result<(), SimulationError> {
        let dt = self.stepping.dt;
        let most = match self.stepping.tolerance {
            Some(_) => RESOLVED * limit,
            None => limit,
        };
        if dt <= most {
            return Ok(());
        }
        let parts = (dt / (RESOLVED * limit)).ceil();
        // more would take longer than anybody waits for one step
        if self.stepping.tolerance.is_none() || !(limit > 0.0 && parts < 1e9) {
            return Err(SimulationError::AboveLimit { dt, limit });
        }
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 1 and 1e9"
        )]
        let parts = parts as u64;
        (self.parts, self.least_parts) = (parts, parts);
        self.cut = Some(Limit {
            dt: most,
            of: "the contacts between snakes, with a margin to resolve them",
        });
        Ok(())
    }

    /// The length of a part of a step. T.
    pub(super) const fn part(&self) -> f64 {
        self.stepping.dt / self.parts as f64
    }

    /// What moves a snake, and in how many sub-steps it makes each part of a step.
    ///
    /// Nodes that upkeep has put closer together allow shorter steps only: what the scene began with was
    /// checked, what became of it is cut.
    pub(super) fn pace(
        &self,
        terms: Option<&[Term]>,
        snake: &mut Snake,
        state: &State,
        start: Start,
    ) -> Result<(Pace, u64), Unready> {
        let Stepping {
            scheme,
            dt,
            tolerance,
            relax,
            each,
            ..
        } = self.stepping;
        if let (Some(reach), None) = (relax, terms) {
            let relaxation = Relaxation::new(snake, state, dt, reach)?;
            return Ok((Pace::Fixed(Box::new(relaxation)), 1));
        }
        let Some(tolerance) = tolerance else {
            let cuts = self.cuts(snake)?;
            let dt = dt / cuts as f64;
            let pace = match terms {
                None => Pace::fixed(scheme, snake, state, dt, start)?,
                Some(terms) => {
                    let turning = Turning::new(snake)?;
                    let missing = Term::ALL.iter().filter(|term| !terms.contains(term));
                    let turning = missing.fold(turning, |turning, &term| turning.without(term));
                    let stepper = TurningStepper::new(turning, scheme, state, dt, start)?;
                    Pace::Fixed(Box::new(stepper))
                }
            };
            return Ok((pace, cuts));
        };
        if terms.is_some() {
            return Err(Unready::Frame);
        }
        let pace = Pace::chosen(scheme, snake, state, self.part(), tolerance)?;
        let pace = match self.cut {
            Some(limit) => pace.cut_by(limit),
            None if each => pace.each(),
            None => pace,
        };
        Ok((pace, 1))
    }

    /// The same for what has become of member `k`.
    pub(super) fn pace_of(
        &self,
        k: usize,
        snake: &mut Snake,
        state: &State,
    ) -> Result<(Pace, u64), Unready> {
        let terms = self.members[k].terms.as_deref();
        self.pace(terms, snake, state, Start::SecondOrder)
    }

    /// How many sub-steps keep a step of this snake below its limit, with a margin where it takes more than one.
    fn cuts(&self, snake: &Snake) -> Result<u64, SchemeError> {
        let Stepping {
            scheme, dt, force, ..
        } = self.stepping;
        let hardest = snake.at_its_hardest();
        let all = hardest.iter().chain(hardest.is_empty().then_some(snake));
        let limit = all.filter_map(|snake| scheme.step_limit(snake));
        let limit = limit.min_by(f64::total_cmp);
        let Some(limit) = limit.filter(|limit| dt > *limit && !force) else {
            return Ok(1);
        };
        let cuts = (dt / (BELOW * limit)).ceil();
        if cuts > MOST {
            snake.check_step(scheme, dt, false)?;
        }
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "from 1 to MOST"
        )]
        let cuts = cuts.min(MOST) as u64;
        Ok(cuts)
    }

    /// Keep what is known of the sub-steps of a stepper that goes.
    pub(super) fn remember(&mut self, k: usize) {
        if let Some(gone) = self.members[k].pace.summary().filter(|s| s.made > 0) {
            let made = self.made.map_or(*gone, |made| made.with(gone));
            self.made = Some(made);
        }
    }

    /// What became of the sub-steps of all members, where they are chosen.
    #[must_use]
    pub fn summary(&self) -> Option<Summary> {
        let members = self.members.iter().filter_map(|m| m.pace.summary());
        let mut all = self.made.iter().chain(members);
        let first = *all.next()?;
        Some(all.fold(first, |sum, more| sum.with(more)))
    }
}
