//! Snakes in motion: they step side by side, meet, divide, grow and go.
//!
//! A lone snake is a simulation of one. Contact joins the steps of the single snakes by splitting, as [verlet67] does
//! for any force: half a kick by the contact forces, a step of every snake by itself, half a kick again. The kicks come
//! in pairs, so they keep momentum and angular momentum whatever the scheme, and lose energy only by the contact's own
//! damping and friction.

mod account;
mod contact;
mod edit;
mod footing;
mod glue;
mod grow;
mod kick;
mod member;
mod parts;
mod passage;
mod remesh;
mod rules;
mod run;
mod step;

pub use contact::Contact;
pub use edit::Edit;
pub use member::Member;
pub use remesh::{Event, EventKind, Plastic, Upkeep};
pub use rules::{Entry, RuleKey, Rules, SimulationError, Stepping};
pub use run::Run;

use elastic::SpacingRule;
use glam::DVec2;
use integrator::{Limit, Scheme, State, Summary};

use crate::rest::{Verdict, Watch};
use crate::{Ledger, Rest, Snake};
use account::Books;
use contact::Meetings;
use footing::Footings;
use member::{lightest, longest};

/// Snakes in motion, in one world: everything that moves, as one value.
///
/// It is made of snakes and their states, stepped, run until something happens, edited between two steps, and copied:
/// a copy goes on as the original does, to the last bit.
///
/// ```
/// use std::ops::ControlFlow::Continue;
///
/// use glam::DVec2;
/// use integrator::{Scheme, State};
/// use snake::{Acting, Body, Edit, Outcome, Simulation, Snake, Spring, Stepping, Until, World};
///
/// let circle = elastic::circle(DVec2::ZERO, 10.0, 40);
/// let body = Body::of(&circle, elastic::Topology::Closed, 1.0)?.with_damping(1.0);
/// let snake = Snake::new(body, World::default())?;
/// let stepping = Stepping::of(Scheme::Leapfrog, 0.01);
/// let mut simulation = Simulation::of(snake, State::at_rest(circle), stepping)?;
/// simulation.run(&Until::steps(100), &mut |_| Continue(()))?;
///
/// // pull node 0 for two units of time, from a state that can be returned to
/// let before = simulation.clone();
/// let pull = Acting::new(Spring::at_node(0, DVec2::new(14.0, 0.0), 5.0));
/// simulation.edit(0, Edit::Add(pull))?;
/// let outcome = simulation.run(&Until::steps(200), &mut |_| Continue(()))?;
/// assert_eq!(outcome, Outcome::Finished { step: 300 });
/// assert!(simulation.members()[0].state().x[0].x > 11.0);
/// simulation = before;
/// assert!((simulation.members()[0].state().x[0].x - 10.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Simulation {
    members: Vec<Member>,
    stepping: Stepping,
    contact: Option<Contact>,
    upkeep: Upkeep,
    rest: Option<Rest>,
    meetings: Meetings,
    footings: Footings,
    events: Vec<Event>,
    next_id: usize,
    /// Time and steps at the start.
    begin: (f64, u64),
    t: f64,
    step: u64,
    /// The deepest that a node has been in another snake so far.
    deepest: f64,
    /// Parts of a step at the least, by the scene as it began.
    least_parts: u64,
    /// Parts of a step, each begun and ended by the contacts; and what asks for more than one.
    parts: u64,
    cut: Option<Limit>,
    /// Sub-steps of steppers that are gone.
    made: Option<Summary>,
    books: Books,
    /// Whether any member has or had elastic terms above the second order.
    orders: bool,
}

impl Simulation {
    /// A lone snake.
    ///
    /// # Errors
    ///
    /// As [`Simulation::new`].
    pub fn of(snake: Snake, state: State, stepping: Stepping) -> Result<Self, SimulationError> {
        let entries = vec![Entry::new(snake, state)];
        Self::new(entries, stepping, &Rules::default())
    }

    /// Several snakes, each where it is, at the time of the first.
    ///
    /// # Errors
    ///
    /// A scheme that cannot move a snake; rules that cannot be kept, or contacts whose stiffness asks for a
    /// smaller step; a start at which a force has no value, where an account is kept.
    pub fn new(
        entries: Vec<Entry>,
        stepping: Stepping,
        rules: &Rules,
    ) -> Result<Self, SimulationError> {
        let start = entries
            .first()
            .map(|entry| (entry.state.t, entry.state.step));
        let (t, step) = start.unwrap_or_default();
        let mut simulation = Self {
            members: Vec::with_capacity(entries.len()),
            stepping,
            contact: rules.contact,
            upkeep: rules.upkeep,
            rest: None,
            meetings: Meetings::default(),
            footings: Footings::default(),
            events: Vec::new(),
            next_id: 0,
            begin: (t, step),
            t,
            step,
            deepest: 0.0,
            least_parts: 1,
            parts: 1,
            cut: None,
            made: None,
            books: Books::new(rules.energies),
            orders: false,
        };
        simulation.meetings.count(rules.energies);
        rules.upkeep.validate()?;
        simulation.check_alone(entries.len())?;
        if let Some(contact) = &rules.contact {
            contact.validate()?;
            let each = entries.iter().map(|Entry { snake, state, .. }| {
                let closed = snake.body().topology.is_closed();
                (
                    lightest(snake),
                    longest(&state.x, closed) / snake.body().spacing,
                )
            });
            let (least, stretch) = each.fold((f64::INFINITY, 0.0_f64), |(m, l), (mass, long)| {
                (m.min(mass), l.max(long))
            });
            simulation.cut(contact.step_limit(least, stretch))?;
        }
        for entry in entries {
            simulation.admit(entry)?;
        }
        simulation.meet(None)?;
        Ok(simulation)
    }

    /// Refuse steps that a snake chooses for itself, where there is more than one.
    fn check_alone(&self, snakes: usize) -> Result<(), SimulationError> {
        let own = self.stepping.each || self.stepping.relax.is_some();
        if own && (snakes > 1 || self.contact.is_some()) {
            return Err(SimulationError::Unshared);
        }
        Ok(())
    }

    /// Refuse steps beyond the limit of a snake.
    fn check_step(&self, member: usize, snake: &Snake) -> Result<(), SimulationError> {
        let Stepping {
            scheme,
            dt,
            tolerance,
            relax,
            force,
            ..
        } = self.stepping;
        if relax.is_some() {
            return Ok(()); // any step is stable
        }
        // sub-steps stay below the limit by themselves
        let force = force || tolerance.is_some();
        let checked = snake.check_step(scheme, dt, force);
        checked.map_err(|error| SimulationError::Scheme { member, error })
    }

    /// One more snake that has not been checked yet, from now on.
    fn admit(&mut self, entry: Entry) -> Result<(), SimulationError> {
        let member = self.next_id;
        let tolerance = self.stepping.tolerance;
        self.check_step(member, &entry.snake)?;
        if let Some((tips, every)) = &entry.tips {
            tips.validate(&entry.snake)?;
            if *every == 0 || tolerance.is_some() {
                return Err(SimulationError::Growth { member });
            }
        }
        let t = self.t;
        self.join(Entry {
            state: State { t, ..entry.state },
            ..entry
        })
    }

    /// One more snake, from now on.
    fn join(&mut self, entry: Entry) -> Result<(), SimulationError> {
        let Entry {
            mut snake,
            state,
            terms,
            tips,
        } = entry;
        let member = self.next_id;
        snake.settle(&state);
        let Stepping { scheme, start, .. } = self.stepping;
        let begun = self.pace(terms.as_deref(), &mut snake, &state, start);
        let (pace, cuts) = begun.map_err(|error| error.of(member))?;
        let mut ledger = None;
        if self.books.kept {
            let begun = Ledger::begin(&mut snake, &state);
            // steps in a frame of its own equation are not the scheme's of the nodes
            let begun = match &terms {
                Some(_) => begun,
                None => begun.and_then(|ledger| ledger.under(scheme, start, &mut snake)),
            };
            ledger = Some(begun.map_err(|fault| SimulationError::Fault { member, fault })?);
        } else {
            snake.inertia = scheme != Scheme::GradientFlow;
        }
        let topology = snake.body().topology;
        self.orders |= snake.body().material.order() > 2;
        self.members.push(Member {
            id: member,
            lightest: lightest(&snake),
            told: snake.edits,
            spacing: elastic::spacing(&state.x, topology.is_closed(), SpacingRule::Closed),
            snake,
            state,
            pace,
            terms,
            tips,
            cuts,
            ledger,
            watch: None,
            verdict: Verdict::Moving,
        });
        self.next_id += 1;
        if cuts > 1 {
            self.log(member, EventKind::Cut { cuts });
        }
        Ok(())
    }

    /// Whether any member has or had elastic terms above the second order, which have a column of their own in
    /// [`Energies::names_with`](crate::Energies::names_with).
    #[must_use]
    pub const fn orders(&self) -> bool {
        self.orders
    }

    /// The snakes that are there.
    #[must_use]
    pub fn members(&self) -> &[Member] {
        &self.members
    }

    /// How everything moves.
    #[must_use]
    pub const fn stepping(&self) -> &Stepping {
        &self.stepping
    }

    /// What happens where curves meet; None: they pass through each other.
    #[must_use]
    pub const fn contact(&self) -> Option<&Contact> {
        self.contact.as_ref()
    }

    /// What has happened to curves so far.
    #[must_use]
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// The time. T.
    #[must_use]
    pub const fn t(&self) -> f64 {
        self.t
    }

    /// Steps made, with those that the first snake had made before.
    #[must_use]
    pub const fn steps(&self) -> u64 {
        self.step
    }

    /// Watch for rest from now on. Where curves rub on each other without sticking, what friction holds cannot be
    /// told from what is out of balance, and rest is a matter of motion alone.
    pub fn watch(&mut self, rest: Rest) {
        let rubs = self
            .contact
            .is_some_and(|contact| contact.friction > 0.0 && contact.stick <= 0.0);
        let balance = if rubs { f64::INFINITY } else { rest.balance };
        self.rest = Some(Rest { balance, ..rest });
        for member in &mut self.members {
            let (snake, state) = (&mut member.snake, &member.state);
            member.watch = self.rest.map(|rest| Watch::new(rest, snake, state));
            member.verdict = Verdict::Moving;
        }
    }

    /// Whether every snake is at rest. One that goes to and fro, is lost, has collapsed or turned over is not.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        self.members
            .iter()
            .all(|member| member.verdict == Verdict::Rest)
    }

    /// Look at every snake, if asked to.
    fn look(&mut self) {
        let Some(rest) = self.rest else { return };
        let mut due = false;
        for member in &mut self.members {
            if member.grows() {
                continue;
            }
            let (snake, state) = (&mut member.snake, &member.state);
            let watch = member
                .watch
                .get_or_insert_with(|| Watch::new(rest, snake, state));
            due |= watch.look(snake, state);
        }
        if !due {
            return;
        }
        let mut pushes: &mut [Vec<DVec2>] = &mut [];
        if let Some(contact) = &self.contact {
            pushes = self.meetings.forces(contact, &self.members);
            self.footings.add_forces(contact, &self.members, pushes);
        }
        for (k, member) in self.members.iter_mut().enumerate() {
            let (snake, state) = (&mut member.snake, &member.state);
            let push = pushes.get(k).map_or(&[][..], Vec::as_slice);
            // what it found holds until another window ends with something else
            let judged = member.watch.as_mut();
            if let Some(verdict) = judged.and_then(|watch| watch.judge(snake, state, push)) {
                member.verdict = verdict;
            }
        }
    }

    /// Momentum of all members, `Σ h Σ μ v`. M L² T⁻¹.
    #[must_use]
    pub fn momentum(&self) -> DVec2 {
        let each = |member: &Member| -> DVec2 {
            let nodes = member.state.v.iter().enumerate();
            nodes.map(|(i, v)| member.mass(i) * *v).sum()
        };
        self.members.iter().map(each).sum()
    }

    /// Angular momentum of all members about the origin, `Σ h Σ μ x × v`. M L³ T⁻¹.
    #[must_use]
    pub fn angular_momentum(&self) -> f64 {
        let each = |member: &Member| -> f64 {
            let pairs = member.state.x.iter().zip(&member.state.v).enumerate();
            pairs
                .map(|(i, (x, v))| member.mass(i) * x.perp_dot(*v))
                .sum()
        };
        self.members.iter().map(each).sum()
    }

    /// How deep a node has been in another snake at the end of a step, at most so far. L.
    #[must_use]
    pub const fn deepest_so_far(&self) -> f64 {
        self.deepest
    }

    /// How deep the deepest node is in another snake, and 0 where none is. L.
    #[must_use]
    pub fn deepest(&self) -> f64 {
        let gap = self.contact.as_ref().map_or(0.0, |contact| contact.gap);
        (self.meetings.deepest() - gap).max(0.0)
    }
}
