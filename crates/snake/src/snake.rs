//! A body in a world: the system that the schemes move.

use banded::Operator;
use elastic::Material;
use glam::{DMat2, DVec2};
use integrator::{Fault, Meeting, State, System, Touch};

use crate::account::Account;
use crate::factors::Factors;
use crate::inner::Inner;
use crate::parameters::{operator, pushes, scaled};
use crate::renewal::Renewal;
use crate::turn::TurningRest;
use crate::{Acting, Body, Center, Curve, Parameter, SnakeError, Wall, WallLaw, World};

/// A snake: a [`Body`] in a [`World`], ready to be moved by any scheme of [`integrator`].
#[derive(Debug, Clone)]
pub struct Snake {
    pub(crate) body: Body,
    pub(crate) world: World,
    /// Weights of the nodes in the frame's origin; they sum to 1.
    pub(crate) weights: Vec<f64>,
    pub(crate) held: Vec<bool>,
    pub(crate) any_held: bool,
    /// Nodes that a hand holds, besides those of the ends.
    pub(crate) grasped: Vec<bool>,
    /// Whether `−K e` has a sum, so that the frame's reaction is more than rounding.
    pub(crate) pushes: bool,
    /// The parameters as they are at the time last asked for.
    pub(crate) material: Material,
    pub(crate) mass: Vec<f64>,
    pub(crate) damping: Vec<f64>,
    pub(crate) factors: Factors,
    pub(crate) stiffness: Operator,
    /// The rest shape that turns, if it does.
    pub(crate) turning: Option<TurningRest>,
    /// The densities of internal damping, and a bound of it for step limits; if there is any.
    pub(crate) inner: Option<Inner>,
    /// Damping that is chosen again and again.
    pub(crate) renewal: Option<Renewal>,
    /// When maps are looked at again, and when and where that was done last.
    pub(crate) look: Renewal,
    pub(crate) stood: Option<(f64, Vec<DVec2>)>,
    /// Nodes that slide, each along its line.
    pub(crate) rails: Vec<(usize, outline::Rail)>,
    pub(crate) deformation: Vec<DVec2>,
    pub(crate) account: Option<Account>,
    /// [`System::revision`]: another number after every change of what schemes have their numbers from.
    pub(crate) revision: u64,
    /// How often anyone changed anything from outside, and how often schemes asked for forces, in all and
    /// before that.
    pub(crate) edits: u64,
    pub(crate) asked: u64,
    pub(crate) asked_before: u64,
    /// Until when someone means to change something.
    pub(crate) expected: f64,
    /// Whether what moves it counts its mass: gradient flow does not.
    pub(crate) inertia: bool,
    /// Steps whose rounds did not come to agree.
    pub(crate) unsettled: u64,
    /// The times between which it is meant to run.
    pub(crate) span: (f64, f64),
}

impl Snake {
    /// A snake; its schedules stand at time 0. Its maps stand at the factors that ask for the shortest steps until a
    /// scheme says where the nodes are.
    ///
    /// # Errors
    ///
    /// Refused: whatever [`Body::validate`] and [`World::validate`] refuse.
    pub fn new(body: Body, world: World) -> Result<Self, SnakeError> {
        body.validate()?;
        admit(&world, &body)?;
        let n = body.len();
        let weights = body.weights()?;
        let held = body.topology.held(n);
        let places = (!body.maps.is_empty()).then(|| Box::new(body.maps.hardest(n, true)));
        let factors = Factors {
            common: body.schedules.all_at(0.0),
            places,
        };
        let (material, mass, damping) = scaled(&body, &factors);
        let stiffness = operator(&body, &material, &weights, &held)?;
        let pushes = pushes(&body, &material);
        let turning = TurningRest::new(&body, &weights, &factors);
        let inner = Inner::new(
            &body,
            factors.by_place().times(Parameter::Mass, &body.mass),
            &material,
        )?;
        Ok(Self {
            turning,
            inner,
            renewal: None,
            look: Renewal::every(body.maps.every, f64::NEG_INFINITY),
            stood: None,
            rails: Vec::new(),
            any_held: held.contains(&true),
            pushes,
            grasped: vec![false; n],
            account: None,
            revision: 0,
            edits: 0,
            asked: 0,
            asked_before: 0,
            expected: f64::NEG_INFINITY,
            inertia: true,
            unsettled: 0,
            span: (f64::NEG_INFINITY, f64::INFINITY),
            body,
            world,
            weights,
            held,
            material,
            mass,
            damping,
            factors,
            stiffness,
            deformation: vec![DVec2::ZERO; n],
        })
    }

    /// What it is made of.
    #[must_use]
    pub const fn body(&self) -> &Body {
        &self.body
    }

    /// How often it has been changed from outside. A scheme that it has been stepped by is to be told of it
    /// ([`integrator::Stepper::resume`]); a [`Simulation`](crate::Simulation) does.
    #[must_use]
    pub const fn edits(&self) -> u64 {
        self.edits
    }

    /// How many implicit steps or sub-steps so far have been made by rounds that did not come to agree
    /// ([`System::gave_up`]): each is of a lower order than its scheme.
    #[must_use]
    pub const fn unsettled(&self) -> u64 {
        self.unsettled
    }

    /// Where it lives.
    #[must_use]
    pub const fn world(&self) -> &World {
        &self.world
    }

    /// Origin of the body frame when the nodes are at `x`.
    #[must_use]
    pub fn center(&self, x: &[DVec2]) -> DVec2 {
        if self.body.frame.center == Center::Mean || self.body.mass.is_uniform() {
            elastic::center(x, None)
        } else {
            x.iter().zip(&self.weights).map(|(&p, &w)| p * w).sum()
        }
    }

    /// Deformation `e = x − c − R r` of every node (report Eq. 2.2), along the axes of space; `R` is the
    /// turn of the rest shape, if it turns. Overwrites `e`.
    pub fn deformation_into(&self, x: &[DVec2], e: &mut [DVec2]) {
        let rotation = self.turning.as_ref().map(|turning| turning.rotation(x));
        self.deformation_from(x, rotation, e);
    }

    /// The deformation from the rest shape turned by that much.
    pub(crate) fn deformation_from(&self, x: &[DVec2], rotation: Option<DVec2>, e: &mut [DVec2]) {
        let center = self.center(x);
        for ((e, &x), &r) in e.iter_mut().zip(x).zip(&self.body.rest) {
            let r = rotation.map_or(r, |rotation| rotation.rotate(r));
            *e = x - center - r;
        }
    }

    /// θ: how far the rest shape is turned when the nodes are at `x`, between −π and π; 0 in a frame
    /// that does not turn.
    #[must_use]
    pub fn angle(&self, x: &[DVec2]) -> f64 {
        let rotation = self.turning.as_ref().map(|turning| turning.rotation(x));
        rotation.map_or(0.0, DVec2::to_angle)
    }

    /// The whole elastic force on every node, the turned rest shape counted in. Overwrites `force`.
    ///
    /// [`System::elastic`] is the part of it that is affine in the positions; what turning changes is
    /// among the external forces, so that each scheme asks for it where its order needs it.
    pub fn strain_force(&mut self, x: &[DVec2], force: &mut [DVec2]) {
        self.elastic(x, force);
        self.add_turn(x, force);
        for (f, _) in force.iter_mut().zip(&self.held).filter(|(_, held)| **held) {
            *f = DVec2::ZERO;
        }
    }

    fn add_turn(&self, x: &[DVec2], force: &mut [DVec2]) {
        if let Some(turning) = &self.turning {
            turning.add(x, force);
        }
    }

    /// The curve as its forces meet it.
    pub(crate) fn curve<'a>(&'a self, t: f64, x: &'a [DVec2], v: &'a [DVec2]) -> Curve<'a> {
        Curve {
            t,
            x,
            v,
            mass: &self.mass,
            closed: self.body.topology.is_closed(),
            spacing: self.body.spacing,
        }
    }

    /// The forces of the world, and the curve they meet.
    pub(crate) fn forces<'a>(
        &'a mut self,
        t: f64,
        x: &'a [DVec2],
        v: &'a [DVec2],
    ) -> (&'a mut [Acting], Curve<'a>) {
        let curve = Curve {
            t,
            x,
            v,
            mass: &self.mass,
            closed: self.body.topology.is_closed(),
            spacing: self.body.spacing,
        };
        (&mut self.world.forces, curve)
    }

    /// Add the force number `index` of the world, weights included, to `force`.
    ///
    /// # Errors
    ///
    /// The fault of the first node at which it has no value.
    pub fn force_of(
        &mut self,
        index: usize,
        state: &State,
        force: &mut [DVec2],
    ) -> Result<(), Fault> {
        let (forces, curve) = self.forces(state.t, &state.x, &state.v);
        forces
            .get_mut(index)
            .map_or(Ok(()), |acting| acting.add(&curve, force))
    }

    /// Settle what depends on the curve that a run begins with: which way is out for a pressure,
    /// and the sign of an automatic
    /// one. What is settled stays. A [`Simulation`](crate::Simulation) asks for it; where a snake is stepped without
    /// one, the first force that acts does.
    pub fn settle(&mut self, state: &State) {
        if state.len() == self.len() {
            let (forces, curve) = self.forces(state.t, &state.x, &state.v);
            forces.iter_mut().for_each(|acting| acting.settle(&curve));
        }
    }

    /// Put another body in place of this one; its schemes are told at their next step.
    ///
    /// # Errors
    ///
    /// As [`Snake::new`]; then nothing has changed. A body of another number of nodes is
    /// refused: that is a new snake.
    pub fn set_body(&mut self, body: Body) -> Result<(), SnakeError> {
        if body.len() != self.body.len() {
            return Err(SnakeError::OtherLength {
                needed: self.body.len(),
                got: body.len(),
            });
        }
        let mut new = Self::new(body, self.world.clone())?;
        new.grasped.clone_from(&self.grasped);
        new.hold_again()?;
        // nothing is refused from here on
        new.rails.clone_from(&self.rails);
        new.stay(self);
        new.account = self.account.take();
        if let Some((t, x)) = &self.stood {
            new.stand(*t, x);
        }
        new.note();
        *self = new;
        Ok(())
    }

    /// Keep what belongs to the run and not to the body: what `old` was told of it.
    pub(crate) const fn stay(&mut self, old: &Self) {
        (self.edits, self.asked) = (old.edits, old.asked);
        self.revision = old.revision + 1;
        (self.renewal, self.expected, self.span) = (old.renewal, old.expected, old.span);
        (self.inertia, self.unsettled) = (old.inertia, old.unsettled);
    }

    /// Put another rest shape in place of this one: a body that gives way, or grows.
    ///
    /// # Errors
    ///
    /// Refused: another number of nodes, or nodes that no body can have; then nothing has changed.
    pub fn set_rest(&mut self, rest: Vec<DVec2>) -> Result<(), SnakeError> {
        if rest.len() != self.body.len() {
            return Err(SnakeError::OtherLength {
                needed: self.body.len(),
                got: rest.len(),
            });
        }
        elastic::validate_nodes(&rest, self.body.topology)?;
        self.body.rest = rest;
        self.body.recenter()?;
        self.turning = TurningRest::new(&self.body, &self.weights, &self.factors);
        self.note_quietly();
        Ok(())
    }

    /// Put another world in place of this one.
    ///
    /// # Errors
    ///
    /// Refused: whatever [`Snake::new`] refuses of a world; then nothing has changed.
    pub fn set_world(&mut self, world: World) -> Result<(), SnakeError> {
        admit(&world, &self.body)?;
        self.world = world;
        self.note();
        Ok(())
    }

    /// Largest of the net forces `net` at `state` once walls have answered, held nodes left out.
    ///
    /// A node that bounces hovers above its wall by what its force moves it in a step or two of
    /// that length; or it is as near
    /// as counts for nothing.
    pub(crate) fn largest_push(&self, state: &State, net: &[DVec2], (near, dt): (f64, f64)) -> f64 {
        let mut largest = 0.0_f64;
        for (i, force) in net.iter().enumerate().filter(|(i, _)| !self.held[*i]) {
            let sprung: DVec2 = self
                .world
                .walls
                .iter()
                .map(|wall| wall.force(state.x[i], DVec2::ZERO))
                .sum();
            let force = *force + sprung;
            let fall = if self.inertia && self.mass[i] > 0.0 {
                2.0 * dt * dt * force.length() / self.mass[i]
            } else {
                0.0
            };
            let pushed = self.pushed(state.x[i], force, near.max(fall));
            largest = largest.max(self.along_rail(i, state.x[i], pushed).length());
        }
        largest
    }

    /// What is left of a force once the walls that are so near have answered it.
    fn pushed(&self, x: DVec2, mut force: DVec2, near: f64) -> DVec2 {
        for wall in &self.world.walls {
            let into = force.dot(wall.normal());
            if wall.distance(x) <= near && into < 0.0 {
                force -= wall.normal() * into;
                if let WallLaw::Impact { friction, .. } = wall.law() {
                    // what slides by less than friction holds does not slide
                    let along = force.length();
                    let held = (friction * -into).min(along);
                    force -= force.normalize_or_zero() * held;
                }
            }
        }
        force
    }
}

/// A world that this body can be in.
pub(crate) fn admit(world: &World, body: &Body) -> Result<(), SnakeError> {
    world.validate(body.len())?;
    match world.needs_closed() {
        Some(acting) if !body.topology.is_closed() => Err(SnakeError::NeedsClosed {
            name: acting.name().to_owned(),
        }),
        _ => Ok(()),
    }
}

impl System for Snake {
    fn len(&self) -> usize {
        self.body.len()
    }

    fn mass(&self) -> &[f64] {
        &self.mass
    }

    fn damping(&self) -> &[f64] {
        &self.damping
    }

    fn held(&self) -> &[bool] {
        &self.held
    }

    fn stiffness(&self) -> &Operator {
        &self.stiffness
    }

    fn advance(&mut self, t: f64, x: &[DVec2]) {
        let stands = self.stand(t, x);
        if self.renew(t, x) | stands {
            self.revision += 1;
        }
    }

    fn revision(&self) -> u64 {
        self.revision
    }

    fn depends_on_place(&self) -> bool {
        !self.body.maps.is_empty() || self.renewal.is_some()
    }

    fn elastic(&mut self, x: &[DVec2], force: &mut [DVec2]) {
        let center = self.center(x);
        let curve = (self.body.topology, &self.material, self.body.spacing);
        let e = &mut self.deformation;
        elastic::body_force([x, &self.body.rest], center, curve, e, force);
        if self.pushes {
            let total: DVec2 = force.iter().copied().sum();
            for (f, &w) in force.iter_mut().zip(&self.weights) {
                *f -= total * w;
            }
        }
        if self.any_held {
            for (f, &held) in force.iter_mut().zip(&self.held) {
                if held {
                    *f = DVec2::ZERO;
                }
            }
        }
    }

    fn external(
        &mut self,
        t: f64,
        x: &[DVec2],
        v: &[DVec2],
        force: &mut [DVec2],
    ) -> Result<(), Fault> {
        self.asked += 1;
        // the buffer may hold the elastic force already
        let held: Vec<DVec2> = self.rails.iter().map(|(node, _)| force[*node]).collect();
        let (forces, curve) = self.forces(t, x, v);
        for acting in forces {
            acting.add(&curve, force)?;
        }
        for wall in self.world.walls.iter().filter(|wall| wall.is_spring()) {
            for ((f, &p), &v) in force.iter_mut().zip(x).zip(v) {
                *f += wall.force(p, v);
            }
        }
        self.add_turn(x, force);
        self.add_inner(x, v, force);
        self.push_of_rails(x, &held, force);
        Ok(())
    }

    fn external_is_constant(&self) -> bool {
        let still = self.turning.is_none() && self.inner.is_none() && self.rails.is_empty();
        still
            && self.world.forces.iter().all(Acting::is_constant)
            && !self.world.walls.iter().any(Wall::is_spring)
    }

    fn external_depends_on_velocity(&self) -> bool {
        let damps =
            |wall: &Wall| matches!(wall.law(), WallLaw::Penalty { damping, .. } if damping > 0.0);
        self.inner.is_some()
            || self.world.forces.iter().any(Acting::depends_on_velocity)
            || self.world.walls.iter().any(damps)
    }

    fn contacts(
        &mut self,
        _dt: f64,
        _before: &[DVec2],
        x: &[DVec2],
        v: &[DVec2],
        touches: &mut Vec<Touch>,
    ) {
        if self.world.walls.iter().all(Wall::is_spring) && self.rails.is_empty() {
            return;
        }
        self.back_on_rails(x, v, touches);
        for (node, (&x, &v)) in x.iter().zip(v).enumerate() {
            if self.slides(node) {
                continue;
            }
            let mut place = x;
            for wall in &self.world.walls {
                if let Some(touch) = wall.touch(node, place, v) {
                    place = touch.position;
                    touches.push(touch);
                }
            }
        }
    }

    fn met(&mut self, meeting: &Meeting<'_>) {
        self.book_contact(meeting);
    }

    fn passed(&mut self, state: &State) {
        self.note_passed(state);
    }

    fn gave_up(&mut self) {
        self.unsettled += 1;
    }

    fn frame_work(&mut self, work: f64) {
        self.note_frame_work(work);
    }

    fn contact_stiffness(&self) -> (f64, f64) {
        let (stiffness, damping) = self.world.contact_stiffness();
        let forces = self.world.forces.iter();
        let elastic: f64 = forces.map(|acting| acting.force().stiffness()).sum();
        (stiffness + elastic, damping)
    }

    fn internal_damping(&self) -> f64 {
        self.inner.as_ref().map_or(0.0, Inner::time)
    }

    fn external_slope(&mut self, t: f64, x: &[DVec2], slope: &mut [DMat2]) -> bool {
        slope.fill(DMat2::ZERO);
        let (forces, curve) = self.forces(t, x, &[]);
        let mut known = false;
        let mut any = false;
        for acting in forces {
            any |= !acting.is_constant();
            known |= acting.add_slope(&curve, slope);
        }
        for wall in &self.world.walls {
            for (slope, &p) in slope.iter_mut().zip(x) {
                *slope += wall.slope(p);
            }
        }
        known || !any
    }
}
