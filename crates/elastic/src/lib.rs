//! From a deformed curve to the force on itself.
//!
//! A curve is a row of nodes. It has a **rest shape**, and the **deformation** `e` of a node is how far
//! it is from its place in that shape. Three densities along the curve say what a deformation costs:
//!
//! ```text
//! ξ(e) = ½ ∫ ω₀(s) |e|² + ω₁(s) |∂e/∂s|² + ω₂(s) |∂²e/∂s²|²  ds
//! ```
//!
//! ω₀ is the *tether*, ω₁ the *tension*, ω₂ the *rigidity* ([`Material`]), and there may be weights of the derivatives above. What the curve feels is minus
//! the gradient of that energy ([`elastic_force`]), and since the energy is a quadratic form, there is a
//! matrix `K` with `force = −K e` ([`stiffness`]): symmetric and never negative for any ends and any
//! densities, because it is assembled from the differences that exist and never written by hand.
//!
//! ```
//! use elastic::{End, Material, Topology, elastic_force, stiffness};
//! use glam::DVec2;
//!
//! let topology = Topology::Open { head: End::Free, tail: End::Free };
//! let material = Material::uniform(0.0, 1.0, 0.0);
//! let (n, spacing) = (4, 1.0);
//! let e = [DVec2::ZERO, DVec2::X, DVec2::ZERO, DVec2::ZERO];
//!
//! // a node pulled aside is pulled back by both neighbours, and pulls each of them along
//! let mut force = vec![DVec2::ZERO; n];
//! elastic_force(&e, topology, &material, spacing, &mut force);
//! assert_eq!(force, [DVec2::X, -2.0 * DVec2::X, DVec2::X, DVec2::ZERO]);
//!
//! // column 1 of K says the same
//! let k = stiffness(topology, &material, spacing, n)?;
//! assert_eq!([k.entry(0, 1), k.entry(1, 1), k.entry(2, 1), k.entry(3, 1)], [-1.0, 2.0, -1.0, 0.0]);
//! # Ok::<(), elastic::ElasticError>(())
//! ```
//!
//! Besides: where a curve comes from ([`circle`], [`ellipse`], [`segment`], [`spline`], [`resample`]),
//! what can be measured on it ([`length`], [`signed_area`], [`centroid`], [`center`], [`normals`],
//! [`rms`]), and how much it bends ([`curvature`]).
//!
//! **Axes.** x to the right, y down. A closed curve of positive [`signed_area`] runs clockwise on the
//! screen, and its outward normal is then `(t_y, −t_x)` for a tangent `t`.
//!
//! **Doors.** Functions that return `Result` check everything; what they have let through ([`Material::validate`],
//! [`validate_nodes`]) the others trust. Nothing here knows of images or of time.
//!
//! Beyond the report's program: weights of any order ([`Kernel`]), edges of their own lengths ([`Spacings`]), how far a
//! curve has turned and what its motion is made of ([`BestFit`], [`Motion`]), what a node may do ([`Hold`]), and damping
//! from stiffness ([`critical_damping`], [`InternalDamping`]).
//!
//! Not here yet: edges of their own lengths for orders above two.

#![cfg_attr(
    test,
    allow(clippy::float_cmp, reason = "a test that says equal means equal")
)]

mod arc;
mod cubic;
mod curvature;
mod damping;
mod energy;
mod error;
mod fit;
mod force;
mod hold;
mod kernel;
mod kernel_walk;
mod knots;
mod material;
mod measure;
mod motion;
mod profile;
mod shapes;
mod spacing;
mod spacings;
mod spline;
mod stiffness;
mod study;
mod topology;

pub use curvature::{Estimate, curvature, turning_angle};
pub use damping::{InternalDamping, critical_damping, greatest_stiffness, local_stiffness};
pub use energy::{ElasticEnergy, elastic_energy};
pub use error::ElasticError;
pub use fit::BestFit;
pub use force::{body_force, elastic_force};
pub use hold::Hold;
pub use kernel::Kernel;
pub use material::Material;
pub use measure::{centroid, length, normals, rms, signed_area};
pub use motion::Motion;
pub use profile::{Bound, Profile};
pub use shapes::{circle, ellipse, segment};
pub use spacing::{SpacingRule, center, spacing, validate_nodes};
pub use spacings::Spacings;
pub use spline::{Knots, Parameter, resample, resample_over, spline};
pub use stiffness::{stiffness, stiffness_as_printed};
pub use study::{Finding, spacing_study};
pub use topology::{End, Topology};
