//! The energies of a snake at one moment, and what its ledger asks of it.

use glam::DVec2;
use integrator::{Meeting, State};

use crate::factors::Factors;
use crate::{Curve, Energies, Parameter, Snake};

/// What a ledger needs to know of the moments between two states.
#[derive(Debug, Clone, Default)]
pub(crate) struct Account {
    /// Contacts since last asked.
    contact: Option<Touched>,
    /// Sub-steps that ended since last asked.
    trail: Vec<Passed>,
    /// Work of a frame of its own equation since last asked.
    frame: f64,
}

/// A sub-step that ended.
#[derive(Debug, Clone)]
pub(crate) struct Passed {
    pub(crate) state: State,
    /// What was touched since the one before.
    pub(crate) touched: Option<Touched>,
    /// Whether it stands for more than one.
    pub(crate) coarse: bool,
}

/// Numbers that the trail of sub-steps may hold: a step of more than that is booked by every second
/// of them, every fourth, …
const TRAIL: usize = 1 << 20;

/// What contacts have done within one step or sub-step.
#[derive(Debug, Clone, Default)]
pub(crate) struct Touched {
    /// Just before the last of them, velocities as the scheme had them.
    pub(crate) before: (Vec<DVec2>, Vec<DVec2>),
    /// Velocities just after it, as the scheme goes on with them.
    pub(crate) after: Vec<DVec2>,
    /// What obstacles added to the velocities after the second half of the step; empty where it has none.
    pub(crate) support: Vec<DVec2>,
    /// What they have taken, as far as places and velocities say at the moment of each.
    pub(crate) lost: f64,
}

/// Every second of these sub-steps, each with the contacts of both.
fn thinned(trail: Vec<Passed>) -> Vec<Passed> {
    let mut kept = Vec::with_capacity(trail.len());
    let mut each = trail.into_iter();
    while let Some(first) = each.next() {
        let Some(mut second) = each.next() else {
            kept.push(first);
            break;
        };
        second.coarse = true;
        second.touched = match (first.touched, second.touched) {
            (Some(one), Some(two)) => Some(Touched {
                lost: one.lost + two.lost,
                ..two
            }),
            (one, two) => one.or(two),
        };
        kept.push(second);
    }
    kept
}

impl Snake {
    /// The potential of every force of the world, in its order; None for one that has none, and for
    /// all where the mass, on which they may depend, changes with time or place.
    pub(crate) fn potentials(&self, curve: &Curve<'_>) -> Vec<Option<f64>> {
        let constant = self.body.schedules.mass.is_none() && self.body.maps.mass.is_none();
        self.world
            .forces
            .iter()
            .map(|acting| acting.energy(curve).filter(|_| constant))
            .collect()
    }

    /// Energies at `state`. What needs a [`crate::Ledger`] is left 0: the work of forces without a
    /// potential, and all that was lost or put in.
    pub fn energies(&mut self, state: &State) -> Energies {
        let potentials = self.potentials(&self.curve(state.t, &state.x, &state.v));
        let forces = potentials
            .into_iter()
            .map(|energy| energy.unwrap_or(0.0))
            .collect();
        Energies {
            forces,
            ..self.own_energies(state.t, &state.x, &state.v)
        }
    }

    /// Kinetic and elastic energy, and that of penalty walls; parameters are those of time `t`, whatever
    /// time a scheme last asked for.
    fn own_energies(&mut self, t: f64, x: &[DVec2], v: &[DVec2]) -> Energies {
        let factors = self.factors_at(t, x);
        let mut energies = self.energies_under(&factors, x, v);
        for &x in x {
            for wall in &self.world.walls {
                energies.wall += self.body.spacing * wall.energy(x);
            }
        }
        energies
    }

    /// Kinetic and elastic energy under these factors.
    fn energies_under(&mut self, factors: &Factors, x: &[DVec2], v: &[DVec2]) -> Energies {
        let h = self.body.spacing;
        let rotation = self.rotation_under(factors, x);
        let mut e = std::mem::take(&mut self.deformation);
        self.deformation_from(x, rotation, &mut e);
        let (body, common) = (&self.body, &factors.common);
        let by_place = factors.by_place();
        let material = by_place.material(&body.material);
        let elastic = elastic::elastic_energy(&e, body.topology, &material, h);
        let mut energies = Energies {
            tether: common[Parameter::Tether] * elastic.tether,
            tension: common[Parameter::Tension] * elastic.tension,
            rigidity: common[Parameter::Rigidity] * elastic.rigidity,
            higher: (body.material.order() > 2)
                .then_some(common[Parameter::Higher] * elastic.higher),
            ..Energies::default()
        };
        let mass = by_place.times(Parameter::Mass, &body.mass);
        for (i, &v) in v.iter().enumerate().filter(|_| self.inertia) {
            energies.kinetic +=
                0.5 * h * (common[Parameter::Mass] * mass.at(i)) * v.length_squared();
        }
        self.deformation = e;
        energies
    }

    /// Keep account of what contacts take and parameters put in, from now on.
    pub(crate) fn keep_account(&mut self) {
        self.account = Some(Account::default());
    }

    /// What contacts have done since last asked; None where there were none.
    pub(crate) fn take_touched(&mut self) -> Option<Touched> {
        let account = self.account.as_mut();
        account.and_then(|account| account.contact.take())
    }

    /// What a frame of its own equation has put in since last asked.
    pub(crate) fn take_frame_work(&mut self) -> f64 {
        let account = self.account.as_mut();
        account.map_or(0.0, |account| std::mem::take(&mut account.frame))
    }

    /// A frame of its own equation has put that in.
    pub(crate) fn note_frame_work(&mut self, work: f64) {
        if let Some(account) = &mut self.account {
            account.frame += work;
        }
    }

    /// Sub-steps since last asked.
    pub(crate) fn take_trail(&mut self) -> Vec<Passed> {
        let account = self.account.as_mut();
        account.map_or_else(Vec::new, |account| std::mem::take(&mut account.trail))
    }

    /// A sub-step ended here.
    pub(crate) fn note_passed(&mut self, state: &State) {
        if let Some(account) = &mut self.account {
            let touched = account.contact.take();
            if account.trail.len() >= (TRAIL / state.len().max(1)).clamp(16, 1024) {
                account.trail = thinned(std::mem::take(&mut account.trail));
            }
            account.trail.push(Passed {
                state: state.clone(),
                touched,
                coarse: false,
            });
        }
    }

    /// Energy that schedules and maps have put in between two moments: what the change of the parameters alone
    /// does to the energy, the mean over the way by Simpson's rule: start, middle, end. Of the kinetic energy it is that of
    /// the velocities `carried`, where a scheme has one set of them for the whole step.
    pub(crate) fn put_in(
        &mut self,
        (before, after): (&Factors, &Factors),
        way: [(&[DVec2], &[DVec2]); 3],
        carried: Option<&[DVec2]>,
    ) -> f64 {
        if self.body.schedules.is_empty() && self.body.maps.is_empty() {
            return 0.0;
        }
        let mut put_in = 0.0;
        for ((x, v), weight) in way.into_iter().zip([1.0, 4.0, 1.0]) {
            let v = carried.unwrap_or(v);
            let change = self.energies_under(after, x, v).mechanical()
                - self.energies_under(before, x, v).mechanical();
            put_in += weight / 6.0 * change;
        }
        put_in
    }

    /// What damping, internal damping and the dampers of penalty walls take at `state`, per unit of time and length of
    /// curve a node.
    pub(crate) fn loss(&self, state: &State) -> f64 {
        let mut loss = self.inner_loss(state);
        let factors = self.factors_at(state.t, &state.x);
        let damping = factors.times(Parameter::Damping, &self.body.damping);
        for (i, (&x, &v)) in state.x.iter().zip(&state.v).enumerate() {
            loss += damping.at(i) * v.length_squared();
            for wall in self.world.walls.iter().filter(|wall| wall.is_spring()) {
                loss -= (wall.force(x, v) - wall.force(x, DVec2::ZERO)).dot(v);
            }
        }
        loss
    }

    /// Kinetic, elastic and potential energy.
    pub(crate) fn mechanical(&mut self, t: f64, x: &[DVec2], v: &[DVec2]) -> f64 {
        let potentials = self.potentials(&self.curve(t, x, v));
        self.own_energies(t, x, v).mechanical() + potentials.into_iter().flatten().sum::<f64>()
    }

    /// What forces without a potential do while contacts move the nodes from `before` to `x`.
    fn unbooked(&mut self, t: f64, before: &[DVec2], x: &[DVec2]) -> f64 {
        let still = vec![DVec2::ZERO; x.len()];
        let mut force = still.clone();
        let potentials = self.potentials(&self.curve(t, x, &still));
        let (forces, curve) = self.forces(t, x, &still);
        for (acting, potential) in forces.iter_mut().zip(potentials) {
            if potential.is_none() && acting.add(&curve, &mut force).is_err() {
                return 0.0; // the run ends at this very place
            }
        }
        let moved = x.iter().zip(before).zip(&force);
        self.body.spacing * moved.map(|((x, from), f)| f.dot(*x - *from)).sum::<f64>()
    }

    /// What the contacts of a step have taken, now that they have left the nodes where they are.
    pub(crate) fn book_contact(&mut self, meeting: &Meeting<'_>) {
        let Some(mut account) = self.account.take() else {
            return;
        };
        let (t, (x, v), (put, turned)) = (meeting.t, meeting.before, meeting.after);
        let taken = self.mechanical(t, x, v) - self.mechanical(t, put, turned);
        let lost = taken + self.unbooked(t, x, put);
        let earlier = account.contact.take().map_or(0.0, |contact| contact.lost);
        account.contact = Some(Touched {
            before: (x.to_vec(), v.to_vec()),
            after: turned.to_vec(),
            support: meeting.support.to_vec(),
            lost: earlier + lost,
        });
        self.account = Some(account);
    }
}

#[cfg(test)]
mod tests {
    use elastic::Topology;

    use super::*;
    use crate::{Body, World};

    #[test]
    fn a_step_of_any_number_of_sub_steps_keeps_a_bounded_trail_with_all_that_was_touched() {
        let x = elastic::circle(DVec2::ZERO, 5.0, 10);
        let body =
            Body::of(&x, Topology::Closed, 1.0).unwrap_or_else(|error| unreachable!("{error}"));
        let snake = Snake::new(body, World::default());
        let mut snake = snake.unwrap_or_else(|error| unreachable!("{error}"));
        snake.keep_account();
        let mut state = State::at_rest(x);
        for k in 0..100_000_u32 {
            state.t = f64::from(k);
            if let Some(account) = snake.account.as_mut() {
                account.contact = (k % 3 == 0).then(|| Touched {
                    lost: 1.0,
                    ..Touched::default()
                });
            }
            snake.note_passed(&state);
        }
        let trail = snake.take_trail();
        assert!(trail.len() <= 1024, "{}", trail.len());
        let lost = trail.iter().filter_map(|passed| passed.touched.as_ref());
        let lost: f64 = lost.map(|touched| touched.lost).sum();
        assert!((lost - 33_334.0).abs() < 1e-9, "{lost}");
        assert!(trail.windows(2).all(|w| w[0].state.t < w[1].state.t));
        assert!((state.t - trail[trail.len() - 1].state.t).abs() < 1e-9);
    }
}
