//! What a simulation begins with: snakes, steps, and rules for all of them; and what is refused.

use integrator::{Fault, Scheme, SchemeError, Start, State};
use outline::OutlineError;

use super::{Contact, Upkeep};
use crate::{Snake, SnakeError, Term, Tips};

/// One snake as a simulation begins with it.
#[derive(Debug, Clone)]
pub struct Entry {
    /// The snake.
    pub snake: Snake,
    /// Where it is, and how fast.
    pub state: State,
    /// Inertial forces of a frame that turns by its own equation ([`Turning`](crate::Turning)); None for any other
    /// frame.
    pub terms: Option<Vec<Term>>,
    /// Ends that grow, and after how many steps each time.
    pub tips: Option<(Tips, u64)>,
}

impl Entry {
    /// A snake at a state, without anything special about it.
    #[must_use]
    pub const fn new(snake: Snake, state: State) -> Self {
        Self {
            snake,
            state,
            terms: None,
            tips: None,
        }
    }
}

/// How everything moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stepping {
    /// The scheme of every snake.
    pub scheme: Scheme,
    /// The step. T.
    pub dt: f64,
    /// Make every step in as many sub-steps as it takes for each to err by at most so much, contacts between
    /// snakes left out; these are met in equal parts of the step, below a quarter of their own limit. None: steps as
    /// they are. L.
    pub tolerance: Option<f64>,
    /// Go to rest by the shortest way in place of the scheme ([`Relaxation`](integrator::Relaxation)): steps that
    /// grow as the forces die, none of which moves a node by more than so much; `dt` is the first. For a lone snake.
    /// L.
    pub relax: Option<f64>,
    /// With a tolerance and one snake: every sub-step is a step of its own, and `dt` is the time of the whole run.
    pub each: bool,
    /// How a scheme with memory begins.
    pub start: Start,
    /// Whether a step beyond the limit of a snake is made all the same.
    pub force: bool,
}

impl Stepping {
    /// Equal steps of `dt` by `scheme`, within its limit, begun to second order.
    #[must_use]
    pub const fn of(scheme: Scheme, dt: f64) -> Self {
        Self {
            scheme,
            dt,
            tolerance: None,
            relax: None,
            each: false,
            start: Start::SecondOrder,
            force: false,
        }
    }
}

/// What holds for all snakes of a simulation. By default they pass through each other, their curves stay as they are,
/// and no account of energies is kept.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rules {
    /// What happens where curves meet; None: they pass through each other.
    pub contact: Option<Contact>,
    /// How curves are kept in order.
    pub upkeep: Upkeep,
    /// Whether an account of energies is kept, which takes as long as the steps or longer.
    pub energies: bool,
}

/// A number of the rules.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum RuleKey {
    /// [`Contact::stiffness`].
    Stiffness,
    /// [`Contact::damping`].
    Damping,
    /// [`Contact::friction`].
    Friction,
    /// [`Contact::wall_friction`].
    WallFriction,
    /// [`Contact::stick`].
    Stick,
    /// [`Contact::gap`].
    Gap,
    /// [`Contact::adhesion`].
    Adhesion,
    /// [`Contact::range`].
    Range,
    /// [`Contact::stop`].
    Stop,
    /// [`Upkeep::stretch`].
    Stretch,
    /// [`Upkeep::least_area`].
    LeastArea,
    /// [`Upkeep::merge`].
    Merge,
    /// [`Plastic::yields_at`](super::Plastic).
    YieldsAt,
    /// [`Plastic::rate`](super::Plastic).
    FlowRate,
    /// [`Upkeep::growth`].
    Growth,
}

impl RuleKey {
    /// What it is, in words.
    const fn words(self) -> &'static str {
        match self {
            Self::Stiffness => "the stiffness of contacts",
            Self::Damping => "the damping of contacts",
            Self::Friction => "the friction of contacts",
            Self::WallFriction => "the friction at walls",
            Self::Stick => "the stick of contacts",
            Self::Gap => "the gap of contacts",
            Self::Adhesion => "the adhesion of contacts",
            Self::Range => "the range of adhesion",
            Self::Stop => "the stop of contacts",
            Self::Stretch => "the stretch to re-space at",
            Self::LeastArea => "the least area",
            Self::Merge => "the depth to merge at",
            Self::YieldsAt => "the yield strain",
            Self::FlowRate => "the rate of flow",
            Self::Growth => "the growth",
        }
    }

    /// Refuse a value that is not finite or less than `least`.
    pub(super) fn check(
        self,
        least: f64,
        bound: &'static str,
        value: f64,
    ) -> Result<(), SimulationError> {
        if value.is_finite() && value >= least {
            Ok(())
        } else {
            let key = self;
            Err(SimulationError::Rule { key, bound, value })
        }
    }
}

/// Why a simulation cannot be made, or cannot go on.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// A force that has no value at the start, or after an edit.
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
    /// A number of the rules that is out of its range.
    #[error("{} must be finite and {bound}, got {value}", key.words())]
    Rule {
        /// Which.
        key: RuleKey,
        /// What is needed.
        bound: &'static str,
        /// What was given.
        value: f64,
    },
    /// A value that no snake can have.
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
    #[error("the contacts allow steps up to {limit}, got {dt}; take a smaller step or stiffness")]
    AboveLimit {
        /// The step asked for.
        dt: f64,
        /// The largest.
        limit: f64,
    },
    /// Steps of lengths of their own, which are those of one snake.
    #[error("steps of lengths that a snake chooses are for a lone snake")]
    Unshared,
    /// Ends that grow, under steps that cannot follow.
    #[error(
        "snake {member}: growing ends need an interval of at least 1 step, and steps of one length"
    )]
    Growth {
        /// Which snake.
        member: usize,
    },
    /// A frame with an equation of its own, under steps that are chosen.
    #[error("snake {member}: a frame with an equation of its own needs steps of one length")]
    Frame {
        /// Which snake.
        member: usize,
    },
    /// A snake that is not there.
    #[error("there is no snake {id}")]
    NoSuchSnake {
        /// The number asked for.
        id: usize,
    },
}
