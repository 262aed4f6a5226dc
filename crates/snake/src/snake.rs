//! A body in a world: the system that the schemes move.

use banded::{Operator, Pentadiagonal};
use elastic::{End, Material, Topology};
use field::Interpolation;
use glam::{DMat2, DVec2};
use integrator::{Fault, State, System, Touch};

use crate::{Body, Center, Energies, External, Sampling, SnakeError, Wall, World};

/// A snake: a [`Body`] in a [`World`], ready to be moved by any scheme of [`integrator`].
#[derive(Debug, Clone)]
pub struct Snake {
    body: Body,
    world: World,
    /// Weights of the nodes in the frame's origin; they sum to 1.
    weights: Vec<f64>,
    held: Vec<bool>,
    any_held: bool,
    /// Whether `−K e` has a sum, so that the frame's reaction is more than rounding.
    pushes: bool,
    /// The parameters as they are at the time last asked for.
    material: Material,
    mass: Vec<f64>,
    damping: Vec<f64>,
    factors: [f64; 5],
    stiffness: Operator,
    deformation: Vec<DVec2>,
    scratch: Vec<DVec2>,
}

impl Snake {
    /// A snake; its schedules stand at time 0.
    ///
    /// # Errors
    ///
    /// Refused: whatever [`Body::validate`] and [`World::validate`] refuse.
    pub fn new(body: Body, world: World) -> Result<Self, SnakeError> {
        body.validate()?;
        world.validate(body.len())?;
        let n = body.len();
        let weights = body.weights()?;
        let held = body.topology.held(n);
        let factors = body.schedules.at(0.0);
        let (material, mass, damping) = scaled(&body, factors);
        let stiffness = operator(&body, &material, &weights, &held)?;
        let pushes = pushes(&body, &material);
        let (deformation, scratch) = (vec![DVec2::ZERO; n], vec![DVec2::ZERO; n]);
        Ok(Self {
            any_held: held.contains(&true),
            pushes,
            scratch,
            body,
            world,
            weights,
            held,
            material,
            mass,
            damping,
            factors,
            stiffness,
            deformation,
        })
    }

    /// What it is made of.
    #[must_use]
    pub const fn body(&self) -> &Body {
        &self.body
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

    /// Deformation `e = x − c − r` of every node (report Eq. 2.2). Overwrites `e`.
    pub fn deformation_into(&self, x: &[DVec2], e: &mut [DVec2]) {
        let center = self.center(x);
        for ((e, &x), &r) in e.iter_mut().zip(x).zip(&self.body.rest) {
            *e = x - center - r;
        }
    }

    /// Force of the pictures alone, weights included. Overwrites `force`.
    ///
    /// # Errors
    ///
    /// The fault of the first node at which a field cannot be read.
    pub fn image_force(&mut self, x: &[DVec2], force: &mut [DVec2]) -> Result<(), Fault> {
        force.fill(DVec2::ZERO);
        for external in &self.world.externals {
            if let External::Image(image) = external {
                image.add(x, &mut self.scratch, force)?;
            }
        }
        Ok(())
    }

    /// Energies at `state`; `image` is left 0, since it needs a [`crate::Ledger`].
    pub fn energies(&mut self, state: &State) -> Energies {
        let h = self.body.spacing;
        let mut e = std::mem::take(&mut self.deformation);
        self.deformation_into(&state.x, &mut e);
        let elastic = elastic::elastic_energy(&e, self.body.topology, &self.material, h);
        self.deformation = e;
        let mut energies = Energies {
            tether: elastic.tether,
            tension: elastic.tension,
            rigidity: elastic.rigidity,
            ..Energies::default()
        };
        for (i, (&x, &v)) in state.x.iter().zip(&state.v).enumerate() {
            energies.kinetic += 0.5 * h * self.mass[i] * v.length_squared();
            for external in &self.world.externals {
                if let External::Gravity(g) = external {
                    energies.gravity -= h * self.mass[i] * g.dot(x);
                }
            }
            for wall in &self.world.walls {
                energies.wall += h * wall.energy(x);
            }
        }
        energies
    }

    /// Net force that no motion explains: elastic plus external at rest, per unit of arc length,
    /// largest over the nodes. Zero at equilibrium.
    ///
    /// # Errors
    ///
    /// The fault of the first node at which a force cannot be evaluated.
    pub fn residual(&mut self, state: &State, scratch: &mut [DVec2]) -> Result<f64, Fault> {
        self.elastic(&state.x, scratch);
        let mut still = std::mem::take(&mut self.deformation);
        still.fill(DVec2::ZERO);
        let outcome = self.external(state.t, &state.x, &still, scratch);
        self.deformation = still;
        outcome?;
        let mut largest = 0.0_f64;
        for (i, f) in scratch.iter().enumerate() {
            if !self.held[i] {
                largest = largest.max(self.pushed(state.x[i], *f).length());
            }
        }
        Ok(largest)
    }

    /// What is left of a force once the walls the node touches have answered it.
    fn pushed(&self, x: DVec2, mut force: DVec2) -> DVec2 {
        for wall in &self.world.walls {
            let into = force.dot(wall.normal());
            if wall.distance(x) <= 1e-9 && into < 0.0 {
                force -= wall.normal() * into;
            }
        }
        force
    }
}

/// The parameters of `body` times the five factors.
fn scaled(body: &Body, [tether, tension, rigidity, mass, damping]: [f64; 5]) -> Parameters {
    let n = body.len();
    let material = Material {
        tether: body.material.tether.scaled(tether),
        tension: body.material.tension.scaled(tension),
        rigidity: body.material.rigidity.scaled(rigidity),
    };
    (
        material,
        body.mass.scaled(mass).to_vec(n),
        body.damping.scaled(damping).to_vec(n),
    )
}

/// Whether the reaction of the frame has anything to take out of `−K e`.
///
/// The sum of `−K e` is `−Σ kⱼ eⱼ` with `k = K 1`. Closed or with natural ends, k is the tether
/// alone; where that and the mass are the same everywhere, the sum is that of e, which is zero
/// about the mean.
fn pushes(body: &Body, material: &Material) -> bool {
    let natural = match body.topology {
        Topology::Closed => true,
        Topology::Open { head, tail } => head != End::Anchored && tail != End::Anchored,
    };
    let even = body.frame.center == Center::Mean || body.mass.is_uniform();
    body.frame.reaction && !(natural && even && material.tether.is_uniform())
}

type Parameters = (Material, Vec<f64>, Vec<f64>);

/// The operator `Pᵀ K P`, held nodes taken out: K, and a correction of rank two for the frame.
///
/// ```text
/// P = I − 1 wᵀ,   Pᵀ K P = K − w kᵀ − k wᵀ + s w wᵀ,   k = K 1,   s = 1ᵀ K 1
/// ```
///
/// Without reaction (the report's frame) the force is `−K P x`, which is not symmetric; what is
/// returned then is its symmetric part up to rank two, `K − ½ (w kᵀ + k wᵀ)`. The implicit schemes
/// need the exact one and refuse such a frame where the difference matters.
fn operator(
    body: &Body,
    material: &Material,
    weights: &[f64],
    held: &[bool],
) -> Result<Operator, SnakeError> {
    let n = body.len();
    let band: Pentadiagonal = elastic::stiffness(body.topology, material, body.spacing, n)?;
    let mut row_sums = vec![0.0; n];
    band.multiply_scalars_into(&vec![1.0; n], &mut row_sums);
    let scale = band.diagonal().iter().fold(0.0_f64, |a, d| a.max(d.abs()));
    let drift = row_sums.iter().fold(0.0_f64, |a, k| a.max(k.abs()));
    let mut masked = band;
    masked.hold(held);
    if drift <= 1e-13 * scale {
        return Ok(Operator::from(masked));
    }
    let total: f64 = row_sums.iter().sum();
    let free = |values: &[f64]| -> Vec<f64> {
        values
            .iter()
            .zip(held)
            .map(|(&v, &h)| if h { 0.0 } else { v })
            .collect()
    };
    let middle = if body.frame.reaction {
        vec![total, -1.0, -1.0, 0.0]
    } else {
        vec![0.0, -0.5, -0.5, 0.0]
    };
    let columns = vec![free(weights), free(&row_sums)];
    Operator::new(masked, columns, middle).map_err(|error| SnakeError::Elastic(error.into()))
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

    fn advance(&mut self, t: f64) -> bool {
        if self.body.schedules.is_empty() {
            return false;
        }
        let factors = self.body.schedules.at(t);
        let same = factors
            .iter()
            .zip(&self.factors)
            .all(|(a, b)| a.to_bits() == b.to_bits());
        if same {
            return false;
        }
        let (material, mass, damping) = scaled(&self.body, factors);
        // the same profiles passed with other factors at the door, so this cannot be refused
        if let Ok(stiffness) = operator(&self.body, &material, &self.weights, &self.held) {
            self.stiffness = stiffness;
        }
        self.pushes = pushes(&self.body, &material);
        (self.material, self.mass, self.damping, self.factors) = (material, mass, damping, factors);
        true
    }

    fn elastic(&mut self, x: &[DVec2], force: &mut [DVec2]) {
        let mut e = std::mem::take(&mut self.deformation);
        self.deformation_into(x, &mut e);
        elastic::elastic_force(
            &e,
            self.body.topology,
            &self.material,
            self.body.spacing,
            force,
        );
        self.deformation = e;
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
        _t: f64,
        x: &[DVec2],
        v: &[DVec2],
        force: &mut [DVec2],
    ) -> Result<(), Fault> {
        for external in &self.world.externals {
            match external {
                External::Gravity(g) => {
                    for (f, &mass) in force.iter_mut().zip(&self.mass) {
                        *f += *g * mass;
                    }
                }
                External::Image(image) => image.add(x, &mut self.scratch, force)?,
            }
        }
        for wall in self.world.walls.iter().filter(|wall| wall.is_spring()) {
            for ((f, &p), &v) in force.iter_mut().zip(x).zip(v) {
                *f += wall.force(p, v);
            }
        }
        Ok(())
    }

    fn contacts(
        &mut self,
        _dt: f64,
        _before: &[DVec2],
        x: &[DVec2],
        v: &[DVec2],
        touches: &mut Vec<Touch>,
    ) {
        if self.world.walls.iter().all(Wall::is_spring) {
            return;
        }
        for (node, (&x, &v)) in x.iter().zip(v).enumerate() {
            let (mut place, mut velocity) = (x, v);
            for wall in &self.world.walls {
                if let Some(touch) = wall.touch(node, place, velocity) {
                    place = touch.position;
                    velocity = touch.velocity.unwrap_or(velocity);
                    touches.push(touch);
                }
            }
        }
    }

    fn contact_stiffness(&self) -> (f64, f64) {
        self.world.contact_stiffness()
    }

    fn external_slope(&mut self, _t: f64, x: &[DVec2], slope: &mut [DMat2]) -> bool {
        if self
            .world
            .image()
            .is_some_and(|image| image.sampling == Sampling::OneAxis)
        {
            return false; // the report's rule jumps between pixels and has no slope there
        }
        slope.fill(DMat2::ZERO);
        for external in &self.world.externals {
            if let External::Image(image) = external {
                for (i, (slope, &p)) in slope.iter_mut().zip(x).enumerate() {
                    *slope += image.field.sample_with_slope(p, Interpolation::Bilinear).1
                        * image.weight.at(i);
                }
            }
        }
        for wall in &self.world.walls {
            for (slope, &p) in slope.iter_mut().zip(x) {
                *slope += wall.slope(p);
            }
        }
        true
    }
}
