//! Second-order systems in time.
//!
//! μ v̈ + γ v̇ = elastic(x) + external(t, x, v): a [`System`] says what its masses, dampings, stiffness
//! and forces are, a [`Scheme`] is chosen by name, and the [`Stepper`] it starts moves a [`State`]
//! one step at a time. Nothing here knows that the nodes belong to a curve or that forces come from
//! an image.
//!
//! An explicit scheme is stable up to a largest step, which [`Scheme::step_limit`] computes; the
//! others take the elastic force at the end of the step, at the cost of one banded solve, and have
//! no such limit. [`Adaptive`] chooses the steps of any scheme by their error, and says why they are as
//! long as they are.
//!
//! ```
//! use integrator::{Scheme, Start, problems};
//!
//! let mut spring = problems::damped_spring(1.0, 0.3, 1.0)?;
//! let scheme: Scheme = "leapfrog".parse()?;
//! scheme.check(&spring.system, 0.01, false)?;
//! let mut stepper = scheme.start(&mut spring.system, &spring.state, 0.01, Start::SecondOrder)?;
//! for _ in 0..100 {
//!     stepper.step(&mut spring.system, &mut spring.state)?;
//! }
//! let exact = (spring.exact)(1.0);
//! assert!((spring.state.x[0] - exact.x[0]).length() < 1e-5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod adaptive;
mod collocation;
mod contact;
mod dormand_prince;
mod each;

mod error;
mod euler;
mod exact;
mod impulse;
mod leapfrog;
mod limits;
mod linear;
mod modes;
mod newmark;
mod oscillator;
pub mod problems;
mod reason;
mod region;
mod relaxation;
mod report;
mod rk4;
mod sbdf2;
mod scheme;
mod solver;
mod stepper;
mod system;
mod tableau;
mod watched;
mod wrapped;

#[cfg(test)]
mod tests;

pub use adaptive::Adaptive;
pub use contact::kinetic_energy;
pub use dormand_prince::DormandPrince;
pub use error::SchemeError;
pub use limits::{critical_damping, report_critical_damping};
pub use reason::{Limit, Reason, Summary};
pub use region::Mode;
pub use relaxation::Relaxation;
pub use report::report_steps;
pub use scheme::Scheme;
pub use stepper::{Start, Stepper};
pub use system::{Fault, FaultKind, Meeting, Response, State, System, Touch};
pub use wrapped::Wrapped;
