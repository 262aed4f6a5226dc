//! Systems around others: all as the one inside has it, but for what they change.

use banded::Operator;
use glam::{DMat2, DVec2};

use crate::{Fault, Meeting, State, System, Touch};

/// A [`System`] around another: what it does not say itself, the one inside answers.
///
/// For systems that count, watch, or change one thing. Every method but the first two is that of [`System`] of the same
/// name, handed on. Whoever changes the external force says too whether it is constant and what its slope is: the one
/// inside knows of its own only.
///
/// ```
/// use glam::DVec2;
/// use integrator::{Fault, System, Wrapped, problems};
///
/// /// Counts how often the external force is asked for.
/// struct Counted(problems::Springs, u64);
///
/// impl Wrapped for Counted {
///     fn inner(&self) -> &dyn System {
///         &self.0
///     }
///     fn inner_mut(&mut self) -> &mut dyn System {
///         &mut self.0
///     }
///     fn external(&mut self, t: f64, x: &[DVec2], v: &[DVec2], force: &mut [DVec2]) -> Result<(), Fault> {
///         self.1 += 1;
///         self.0.external(t, x, v, force)
///     }
/// }
/// ```
pub trait Wrapped {
    /// The system inside.
    fn inner(&self) -> &dyn System;

    /// The same, to be asked for what changes it.
    fn inner_mut(&mut self) -> &mut dyn System;

    /// See [`System::mass`].
    fn mass(&self) -> &[f64] {
        self.inner().mass()
    }

    /// See [`System::damping`].
    fn damping(&self) -> &[f64] {
        self.inner().damping()
    }

    /// See [`System::held`].
    fn held(&self) -> &[bool] {
        self.inner().held()
    }

    /// See [`System::stiffness`].
    fn stiffness(&self) -> &Operator {
        self.inner().stiffness()
    }

    /// See [`System::advance`].
    fn advance(&mut self, t: f64, x: &[DVec2]) {
        self.inner_mut().advance(t, x);
    }

    /// See [`System::revision`].
    fn revision(&self) -> u64 {
        self.inner().revision()
    }

    /// See [`System::depends_on_place`].
    fn depends_on_place(&self) -> bool {
        self.inner().depends_on_place()
    }

    /// See [`System::elastic`].
    fn elastic(&mut self, x: &[DVec2], force: &mut [DVec2]) {
        self.inner_mut().elastic(x, force);
    }

    /// See [`System::external`].
    ///
    /// # Errors
    ///
    /// As there.
    fn external(
        &mut self,
        t: f64,
        x: &[DVec2],
        v: &[DVec2],
        force: &mut [DVec2],
    ) -> Result<(), Fault> {
        self.inner_mut().external(t, x, v, force)
    }

    /// See [`System::external_is_constant`].
    fn external_is_constant(&self) -> bool {
        self.inner().external_is_constant()
    }

    /// See [`System::external_depends_on_velocity`].
    fn external_depends_on_velocity(&self) -> bool {
        self.inner().external_depends_on_velocity()
    }

    /// See [`System::contacts`].
    fn contacts(
        &mut self,
        dt: f64,
        before: &[DVec2],
        x: &[DVec2],
        v: &[DVec2],
        touches: &mut Vec<Touch>,
    ) {
        self.inner_mut().contacts(dt, before, x, v, touches);
    }

    /// See [`System::met`].
    fn met(&mut self, meeting: &Meeting<'_>) {
        self.inner_mut().met(meeting);
    }

    /// See [`System::passed`].
    fn passed(&mut self, state: &State) {
        self.inner_mut().passed(state);
    }

    /// See [`System::gave_up`].
    fn gave_up(&mut self) {
        self.inner_mut().gave_up();
    }

    /// See [`System::frame_work`].
    fn frame_work(&mut self, work: f64) {
        self.inner_mut().frame_work(work);
    }

    /// See [`System::contact_stiffness`].
    fn contact_stiffness(&self) -> (f64, f64) {
        self.inner().contact_stiffness()
    }

    /// See [`System::internal_damping`].
    fn internal_damping(&self) -> f64 {
        self.inner().internal_damping()
    }

    /// See [`System::external_slope`].
    fn external_slope(&mut self, t: f64, x: &[DVec2], slope: &mut [DMat2]) -> bool {
        self.inner_mut().external_slope(t, x, slope)
    }
}

impl<T: Wrapped> System for T {
    fn len(&self) -> usize {
        self.inner().len()
    }

    fn mass(&self) -> &[f64] {
        Wrapped::mass(self)
    }

    fn damping(&self) -> &[f64] {
        Wrapped::damping(self)
    }

    fn held(&self) -> &[bool] {
        Wrapped::held(self)
    }

    fn stiffness(&self) -> &Operator {
        Wrapped::stiffness(self)
    }

    fn advance(&mut self, t: f64, x: &[DVec2]) {
        Wrapped::advance(self, t, x);
    }

    fn revision(&self) -> u64 {
        Wrapped::revision(self)
    }

    fn external_depends_on_velocity(&self) -> bool {
        Wrapped::external_depends_on_velocity(self)
    }

    fn depends_on_place(&self) -> bool {
        Wrapped::depends_on_place(self)
    }

    fn elastic(&mut self, x: &[DVec2], force: &mut [DVec2]) {
        Wrapped::elastic(self, x, force);
    }

    fn external(
        &mut self,
        t: f64,
        x: &[DVec2],
        v: &[DVec2],
        force: &mut [DVec2],
    ) -> Result<(), Fault> {
        Wrapped::external(self, t, x, v, force)
    }

    fn external_is_constant(&self) -> bool {
        Wrapped::external_is_constant(self)
    }

    fn contacts(
        &mut self,
        dt: f64,
        before: &[DVec2],
        x: &[DVec2],
        v: &[DVec2],
        touches: &mut Vec<Touch>,
    ) {
        Wrapped::contacts(self, dt, before, x, v, touches);
    }

    fn met(&mut self, meeting: &Meeting<'_>) {
        Wrapped::met(self, meeting);
    }

    fn passed(&mut self, state: &State) {
        Wrapped::passed(self, state);
    }

    fn gave_up(&mut self) {
        Wrapped::gave_up(self);
    }

    fn frame_work(&mut self, work: f64) {
        Wrapped::frame_work(self, work);
    }

    fn contact_stiffness(&self) -> (f64, f64) {
        Wrapped::contact_stiffness(self)
    }

    fn internal_damping(&self) -> f64 {
        Wrapped::internal_damping(self)
    }

    fn external_slope(&mut self, t: f64, x: &[DVec2], slope: &mut [DMat2]) -> bool {
        Wrapped::external_slope(self, t, x, slope)
    }
}
