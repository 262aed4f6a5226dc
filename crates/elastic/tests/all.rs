//! All tests of elastic forces in one program, which is linked once.

mod body_force;
mod continuum;
mod corners;
mod curvature;
mod damping;
mod ends;
mod errata;
mod errata_curves;
mod kernel;
mod laws;
mod oracle;
mod resample;
mod spacings;
mod spline;
