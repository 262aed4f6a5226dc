//! Many snakes in one world: they step side by side, meet, divide and go.
//!
//! Contact joins the steps of the single snakes by splitting, as [verlet67] does for any force: half a
//! kick by the contact forces, a step of every snake by itself, half a kick again. The kicks come in pairs, so
//! they keep momentum and angular momentum whatever the scheme, and lose energy only by the contact's own
//! damping and friction.

mod account;
mod contact;
mod course;
mod footing;
mod glue;
mod kick;
mod parts;
mod passage;
mod upkeep;

pub use contact::Contact;
pub use upkeep::{Event, EventKind, Plastic, Upkeep};

use elastic::{SpacingRule, Topology};
use glam::DVec2;
use integrator::{Fault, FaultKind, Limit, Scheme, SchemeError, Start, State, Summary, System};
use outline::OutlineError;

use crate::rest::{Verdict, Watch};
use crate::run::FAR;
use crate::{Ledger, Pace, Rest, Snake, SnakeError};
use account::Books;
use contact::Meetings;
use footing::Footings;
use kick::Half;

/// One snake of a crowd.
#[derive(Debug)]
pub struct Member {
    /// Its number: never given again when it is gone.
    pub id: usize,
    /// The snake.
    pub snake: Snake,
    /// Where it is.
    pub state: State,
    pace: Pace,
    /// Sub-steps that each part of a step is made in, where its nodes have come too close for one.
    cuts: u64,
    /// None where no account is kept.
    ledger: Option<Ledger>,
    /// Mean distance of neighbors when it joined: what upkeep holds to.
    spacing: f64,
    /// The least mass density of a node at any time. M.
    lightest: f64,
    watch: Option<Watch>,
    verdict: Verdict,
}

impl Member {
    /// Whether its curve is closed.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.snake.body().topology == Topology::Closed
    }

    /// Mass of the stretch of curve that node `i` stands for. M L.
    fn mass(&self, i: usize) -> f64 {
        self.snake.mass()[i] * self.snake.body().spacing
    }
}

/// The least mass of a node that may move, whatever schedules and maps say.
fn lightest(snake: &Snake) -> f64 {
    let hardest = snake.at_its_hardest();
    let all = hardest.iter().chain([snake]).flat_map(|snake| snake.mass());
    all.copied().fold(f64::INFINITY, f64::min)
}

/// The longest edge, the closing one counted.
fn longest(x: &[DVec2], closed: bool) -> f64 {
    let n = x.len();
    let edges = if closed { n } else { n - 1 };
    let lengths = (0..edges).map(|i| x[i].distance(x[(i + 1) % n]));
    lengths.fold(0.0, f64::max)
}

/// A crowd that could not go on.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CrowdError {
    /// A step of one snake.
    #[error("snake {member}: {fault}")]
    Fault {
        /// Which snake.
        member: usize,
        /// What happened to it.
        fault: Fault,
    },
    /// A scheme that cannot move one of the snakes.
    #[error("snake {member}: {error}")]
    Scheme {
        /// Which snake.
        member: usize,
        /// Why.
        error: SchemeError,
    },
    /// A number that will not do.
    #[error(transparent)]
    Snake(#[from] SnakeError),
    /// A curve that could not be kept in order.
    #[error("snake {member}: {error}")]
    Outline {
        /// Which snake.
        member: usize,
        /// Why.
        error: OutlineError,
    },
    /// A step too long for the contacts.
    #[error(
        "the contacts allow steps up to {limit}, got {dt}; a smaller step or stiffness would do"
    )]
    AboveLimit {
        /// The step asked for.
        dt: f64,
        /// The largest.
        limit: f64,
    },
}

/// How a crowd moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing {
    /// The scheme of every member.
    pub scheme: Scheme,
    /// The step. T.
    pub dt: f64,
    /// Make every step in as many sub-steps as it takes for each to err by at most so much, contacts between
    /// snakes left out; these are met in equal parts of the step, below a quarter of their own limit. None: steps as
    /// they are. L.
    pub tolerance: Option<f64>,
    /// How a scheme with memory begins.
    pub start: Start,
    /// Whether a step beyond the limit of a snake is made all the same.
    pub force: bool,
}

/// Snakes that share a world and know of each other.
#[derive(Debug)]
pub struct Crowd {
    members: Vec<Member>,
    timing: Timing,
    contact: Option<Contact>,
    upkeep: Upkeep,
    rest: Option<Rest>,
    meetings: Meetings,
    footings: Footings,
    events: Vec<Event>,
    next_id: usize,
    begin: f64,
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

impl Crowd {
    /// A crowd of snakes, each where it is, at the time of the first; it keeps an account of energies.
    ///
    /// # Errors
    ///
    /// A scheme that cannot move a snake; a contact law that will not do, or whose stiffness asks for a
    /// smaller step; a start at which a force has no value, which the account asks for.
    pub fn new(
        snakes: Vec<(Snake, State)>,
        timing: Timing,
        contact: Option<Contact>,
        upkeep: Upkeep,
    ) -> Result<Self, CrowdError> {
        Self::begin(snakes, timing, contact, upkeep, true)
    }

    /// The same without an account of energies, which takes as long as the steps or longer: what would be booked is 0.
    ///
    /// # Errors
    ///
    /// As [`Crowd::new`] but for the account.
    pub fn unbooked(
        snakes: Vec<(Snake, State)>,
        timing: Timing,
        contact: Option<Contact>,
        upkeep: Upkeep,
    ) -> Result<Self, CrowdError> {
        Self::begin(snakes, timing, contact, upkeep, false)
    }

    fn begin(
        snakes: Vec<(Snake, State)>,
        timing: Timing,
        contact: Option<Contact>,
        upkeep: Upkeep,
        kept: bool,
    ) -> Result<Self, CrowdError> {
        let t = snakes.first().map_or(0.0, |(_, state)| state.t);
        let mut crowd = Self {
            members: Vec::new(),
            timing,
            contact,
            upkeep,
            rest: None,
            meetings: Meetings::default(),
            footings: Footings::default(),
            events: Vec::new(),
            next_id: 0,
            begin: t,
            t,
            step: 0,
            deepest: 0.0,
            least_parts: 1,
            parts: 1,
            cut: None,
            made: None,
            books: Books::new(kept),
            orders: false,
        };
        crowd.meetings.count(kept);
        upkeep.validate()?;
        if let Some(contact) = &crowd.contact {
            contact.validate()?;
            let each = snakes.iter().map(|(snake, state)| {
                let closed = snake.body().topology.is_closed();
                (
                    lightest(snake),
                    longest(&state.x, closed) / snake.body().spacing,
                )
            });
            let (least, stretch) = each.fold((f64::INFINITY, 0.0_f64), |(m, l), (mass, long)| {
                (m.min(mass), l.max(long))
            });
            crowd.cut(contact.step_limit(least, stretch))?;
        }
        for (member, (snake, state)) in snakes.into_iter().enumerate() {
            // sub-steps stay below the limit by themselves
            let force = timing.force || timing.tolerance.is_some();
            snake
                .check_step(timing.scheme, timing.dt, force)
                .map_err(|error| CrowdError::Scheme { member, error })?;
            crowd.join(snake, State { t, ..state })?;
        }
        crowd.meet(None)?;
        Ok(crowd)
    }

    /// One more snake, from now on.
    fn join(&mut self, mut snake: Snake, state: State) -> Result<(), CrowdError> {
        let member = self.next_id;
        snake.settle(&state);
        let (pace, cuts) = self
            .pace(&mut snake, &state, self.timing.start)
            .map_err(|error| CrowdError::Scheme { member, error })?;
        let ledger = if self.books.kept {
            let begun = Ledger::begin(&mut snake, &state)
                .and_then(|ledger| ledger.under(self.timing.scheme, self.timing.start, &mut snake));
            Some(begun.map_err(|fault| CrowdError::Fault { member, fault })?)
        } else {
            None
        };
        let topology = snake.body().topology;
        let spacing = elastic::spacing(&state.x, topology.is_closed(), SpacingRule::Closed);
        let orders = self.orders || snake.body().material.order() > 2;
        self.members.push(Member {
            id: member,
            lightest: lightest(&snake),
            snake,
            state,
            pace,
            cuts,
            ledger,
            spacing,
            watch: None,
            verdict: Verdict::Moving,
        });
        self.next_id += 1;
        if cuts > 1 {
            self.log(member, EventKind::Cut { cuts });
        }
        self.orders = orders;
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

    /// The same, to be changed between two steps: worlds and bodies, not places.
    pub fn members_mut(&mut self) -> &mut [Member] {
        &mut self.members
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

    /// Steps made.
    #[must_use]
    pub const fn steps(&self) -> u64 {
        self.step
    }

    /// Move everything one step on.
    ///
    /// # Errors
    ///
    /// The first snake that could not make its step, or whose curve could not be kept in order.
    pub fn step(&mut self) -> Result<(), CrowdError> {
        if self.books.kept {
            for member in &mut self.members {
                member.catch_up()?;
            }
        }
        self.divide()?;
        for part in 1..=self.parts {
            self.go(part)?;
        }
        self.step += 1;
        if self.upkeep.is_due(self.step) {
            self.keep_up()?;
        }
        self.look();
        Ok(())
    }

    /// Move everything on by one part of the step.
    fn go(&mut self, part: u64) -> Result<(), CrowdError> {
        let half = 0.5 * self.part();
        self.kick(half, Half::First)?;
        // counted, not added up, unless the report's clock is asked for (D20)
        let share = self.step as f64 + part as f64 / self.parts as f64;
        let t = self.begin + share * self.timing.dt;
        let counted = self.timing.scheme != Scheme::Report;
        for member in &mut self.members {
            let id = member.id;
            let fault = |fault| CrowdError::Fault { member: id, fault };
            for cut in 1..=member.cuts {
                let stepper = member.pace.stepper();
                stepper
                    .step(&mut member.snake, &mut member.state)
                    .map_err(fault)?;
                if counted && cut == member.cuts {
                    member.state.t = t;
                }
                let somewhere = |x: &DVec2| x.is_finite() && x.abs().max_element() < FAR;
                if let Some(node) = member.state.x.iter().position(|x| !somewhere(x)) {
                    // the step is made, and led nowhere
                    self.step += 1;
                    return Err(fault(Fault {
                        node,
                        at: member.state.x[node],
                        kind: FaultKind::NotFinite,
                    }));
                }
                if let Some(ledger) = &mut member.ledger {
                    let booked = ledger.book(&mut member.snake, &member.state);
                    booked.map_err(fault)?;
                }
            }
        }
        self.t = self.members.first().map_or(self.t, |member| member.state.t);
        self.meet(Some(self.part()))?;
        self.deepest = self.deepest.max(self.deepest());
        self.kick(half, Half::Second)
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
        let mut pushes: &mut [Vec<DVec2>] = &mut [];
        if let Some(contact) = &self.contact {
            pushes = self.meetings.forces(contact, &self.members);
            self.footings.add_forces(contact, &self.members, pushes);
        }
        for (k, member) in self.members.iter_mut().enumerate() {
            let (snake, state) = (&mut member.snake, &member.state);
            let watch = member
                .watch
                .get_or_insert_with(|| Watch::new(rest, snake, state));
            let push = pushes.get(k).map_or(&[][..], Vec::as_slice);
            // what it found holds until another window ends with something else
            if let Some(verdict) = watch.look(snake, state, push) {
                member.verdict = verdict;
            }
        }
    }

    /// Find who touches whom, so long after the last time.
    fn meet(&mut self, since: Option<f64>) -> Result<(), CrowdError> {
        if let Some(contact) = &self.contact {
            let mut tally = self.meetings.find(contact, &self.members, since)?;
            tally += self.footings.find(contact, &self.members, since.is_none());
            self.books.passed(tally);
        }
        Ok(())
    }

    /// Let the contacts push for that long.
    fn kick(&mut self, time: f64, half: Half) -> Result<(), CrowdError> {
        let Some(contact) = &self.contact else {
            return Ok(());
        };
        let mut tally = self.meetings.kick(contact, &mut self.members, time, half);
        tally += self.footings.kick(contact, &mut self.members, time, half);
        self.books.kicked(tally);
        for (k, member) in self.members.iter_mut().enumerate() {
            if self.meetings.kicked(k) || self.footings.kicked(k) {
                member.resume()?;
            }
        }
        Ok(())
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
