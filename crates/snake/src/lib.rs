//! Snakes: elastic curves with mass in a physical world.
//!
//! Three crates meet here. [`elastic`] says what force a deformed curve exerts on itself, [`field`] what force a
//! picture exerts at a point, [`integrator`] where a system of masses is one step later; here they become one
//! [`Snake`], which moves by
//!
//! ```text
//! μ ẍ + γ ẋ + K e = f                                     (report Eq. 3.4)
//! ```
//!
//! with `e = x − c − r` the deformation from the rest shape `r` about the center of mass `c`, and
//! `f` the sum of everything in its [`World`]. All terms are per unit of arc length at rest.
//!
//! ```
//! use glam::DVec2;
//! use integrator::{Scheme, State};
//! use snake::{Body, Outcome, Simulation, Snake, Stepping, Until, World};
//!
//! let circle = elastic::circle(DVec2::ZERO, 10.0, 40);
//! let body = Body::of(&circle, elastic::Topology::Closed, 1.0)?.with_damping(0.5);
//! let snake = Snake::new(body, World::default().with_gravity(DVec2::new(0.0, 9.8)))?;
//! let stepping = Stepping::of(Scheme::Leapfrog, 0.01);
//! let mut simulation = Simulation::of(snake, State::at_rest(circle), stepping)?;
//! let outcome = simulation.run(&Until::steps(100), &mut |_| std::ops::ControlFlow::Continue(()))?;
//! assert_eq!(outcome, Outcome::Finished { step: 100 });
//! assert!(simulation.members()[0].state().x[0].y > 4.0); // it fell, for one unit of time
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! It does no I/O and knows no file, no format and no drawing. A run ends with an [`Outcome`];
//! blowing up is one of them, not an error.
//!
//! A [`Simulation`] is one snake or many that meet, keeps their outlines valid and even, and is changed between two
//! steps by [`Edit`]s. The body frame turns with the body where [`Turn::Fit`] says so; [`Turning`] is the same as the
//! report's three equations have it (§5.2). [`Damping`] is chosen by rules (§3.4.2), which [`Settling`] compares.
//! [`Pressure`] makes a snake a balloon (§5.4).

mod account;
mod algebra;
mod body;
mod certificate;
mod damping;
mod energy;
mod error;
mod factors;
mod force;
mod hand;
mod inner;
mod ledger;
mod maps;
mod modes;
mod outcome;
mod pace;
mod parameter;
mod parameters;
mod renewal;
mod rest;
mod schedule;
mod settling;
mod simulation;
mod slide;
mod snake;
mod tips;
mod turn;
mod turning;
mod turning_stepper;
mod wall;
mod world;

pub use body::{Body, Center, Frame};
pub use certificate::Certificate;
pub use damping::Damping;
pub use energy::Energies;
pub use error::SnakeError;
pub use force::{
    Acting, Curve, Force, Freeze, Gravity, ImageForce, Path, Pressure, Pull, RegionForce, Repulsor,
    Sampling, SignedEdgeForce, Spring, Turned,
};
pub use ledger::Ledger;
pub use maps::Maps;
pub use modes::ModeOfMotion;
pub use outcome::{Outcome, Until};
pub use pace::Pace;
pub use parameter::Parameter;
pub use rest::Rest;
pub use schedule::{Schedule, Schedules};
pub use settling::{Settling, TimeToRest};
pub use simulation::{
    Contact, Edit, Entry, Event, EventKind, Member, Plastic, RuleKey, Rules, Run, Simulation,
    SimulationError, Stepping, Upkeep,
};
pub use snake::Snake;
pub use tips::Tips;
pub use turn::Turn;
pub use turning::{Term, Turning};
pub use turning_stepper::TurningStepper;
pub use wall::{Wall, WallLaw};
pub use world::World;
