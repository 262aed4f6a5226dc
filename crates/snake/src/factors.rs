//! What the parameters of a snake are multiplied by, at a time and place.

use elastic::{Material, Profile};
use glam::DVec2;
use integrator::{Scheme, SchemeError};

use crate::inner::Inner;
use crate::maps::Places;
use crate::parameters::{operator, pushes, scaled};
use crate::schedule;
use crate::turn::TurningRest;
use crate::{Certificate, Parameter, Snake};

/// The factor of every parameter, of all nodes and of each.
#[derive(Debug, Clone)]
pub(crate) struct Factors {
    /// Of all nodes: the schedules'.
    pub(crate) common: schedule::Factors,
    /// Of each node: the maps'.
    pub(crate) places: Option<Box<Places>>,
}

/// A factor of 1 for every parameter.
pub(crate) fn ones() -> schedule::Factors {
    schedule::Factors::of(|_| 1.0)
}

impl Default for Factors {
    fn default() -> Self {
        Self {
            common: ones(),
            places: None,
        }
    }
}

fn equal(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
}

impl Factors {
    /// Whether one of the parameters `which` is multiplied by other factors in `other`.
    fn differ(&self, other: &Self, which: &[Parameter]) -> bool {
        which.iter().any(|&k| {
            let (one, two) = (self.place(k), other.place(k));
            let same = match (one, two) {
                (Some(one), Some(two)) => equal(one, two),
                (None, None) => true,
                _ => false,
            };
            !same || self.common[k].to_bits() != other.common[k].to_bits()
        })
    }

    /// Those of the map of a parameter.
    fn place(&self, parameter: Parameter) -> Option<&Vec<f64>> {
        self.places.as_ref()?[parameter].as_ref()
    }

    /// Whether both are the same to the last bit.
    pub(crate) fn same(&self, other: &Self) -> bool {
        !self.differ(other, &Parameter::ALL)
    }

    /// The same without the schedules.
    pub(crate) fn by_place(&self) -> Self {
        Self {
            common: ones(),
            places: self.places.clone(),
        }
    }

    /// Halfway between two, the factors of a parameter with a map taken as a whole; of the others they are `common`.
    fn between(&self, other: &Self, common: schedule::Factors) -> Self {
        let mut middle = Self {
            common,
            places: None,
        };
        if let (Some(one), Some(two)) = (&self.places, &other.places) {
            let places = Places::of(|k| {
                let (a, b) = (one[k].as_ref()?, two[k].as_ref()?);
                let (s, t) = (self.common[k], other.common[k]);
                let mean = a.iter().zip(b).map(|(a, b)| 0.5 * (s * a + t * b));
                middle.common[k] = 1.0;
                Some(mean.collect())
            });
            middle.places = Some(Box::new(places));
        }
        middle
    }

    /// A profile times the factors of a parameter. What is the same at every node stays one number.
    pub(crate) fn times(&self, parameter: Parameter, profile: &Profile) -> Profile {
        let scaled = profile.scaled(self.common[parameter]);
        let Some(place) = self.place(parameter) else {
            return scaled;
        };
        let one = place.first().filter(|first| {
            scaled.is_uniform() && place.iter().all(|f| f.to_bits() == first.to_bits())
        });
        match one {
            Some(&factor) => scaled.scaled(factor),
            None => {
                let each = place.iter().enumerate();
                Profile::PerNode(each.map(|(i, factor)| scaled.at(i) * factor).collect())
            }
        }
    }
}

impl Factors {
    /// A material times its factors.
    pub(crate) fn material(&self, material: &Material) -> Material {
        Material {
            tether: self.times(Parameter::Tether, &material.tether),
            tension: self.times(Parameter::Tension, &material.tension),
            rigidity: self.times(Parameter::Rigidity, &material.rigidity),
            higher: (material.higher.iter())
                .map(|weight| self.times(Parameter::Higher, weight))
                .collect(),
        }
    }
}

impl Snake {
    /// The factors at time `t` for nodes at `x`.
    pub(crate) fn factors_at(&self, t: f64, x: &[DVec2]) -> Factors {
        let maps = &self.body.maps;
        let places = if maps.is_empty() {
            None
        } else if self.look.is_due(t) {
            Some(Box::new(maps.at(x, self.body.topology)))
        } else {
            self.factors.places.clone()
        };
        Factors {
            common: self.body.schedules.all_at(t),
            places,
        }
    }

    /// The factors halfway between those of two moments.
    pub(crate) fn halfway(&self, t: f64, one: &Factors, two: &Factors) -> Factors {
        one.between(two, self.body.schedules.all_at(t))
    }

    /// Let the parameters be those at time `t` for nodes at `x`; true if any changed.
    pub(crate) fn stand(&mut self, t: f64, x: &[DVec2]) -> bool {
        if self.body.schedules.is_empty() && self.body.maps.is_empty() {
            return false;
        }
        let factors = self.factors_at(t, x);
        if !self.body.maps.is_empty() {
            self.look.meet(t);
            self.stood = Some((t, x.to_vec()));
        }
        if factors.same(&self.factors) {
            return false;
        }
        self.take(factors);
        true
    }

    /// Let these be the factors.
    pub(crate) fn take(&mut self, factors: Factors) {
        let (material, mass, damping) = scaled(&self.body, &factors);
        let elastic = factors.differ(&self.factors, &Parameter::ELASTIC);
        let heavier = factors.differ(&self.factors, &[Parameter::Mass]);
        (self.mass, self.damping) = (mass, damping);
        if elastic {
            // the same profiles passed with other factors at the door, so this cannot be refused
            if let Ok(stiffness) = operator(&self.body, &material, &self.weights, &self.held) {
                self.stiffness = stiffness;
            }
            self.pushes = pushes(&self.body, &material);
            self.turning = TurningRest::new(&self.body, &self.weights, &factors);
            self.material = material;
        }
        if (elastic || heavier) && self.inner.is_some() {
            let mass = factors.by_place().times(Parameter::Mass, &self.body.mass);
            self.inner = Inner::new(&self.body, mass, &self.material).unwrap_or_default();
        }
        self.factors = factors;
    }

    /// The same for an account, which asks for them by time alone where there are no maps.
    pub(crate) fn bring(&mut self, t: f64, x: &[DVec2]) {
        if !self.body.maps.is_empty() && self.stand(t, x) {
            self.revision += 1;
        }
    }

    /// Takes over where `other` stands in its schedules, and what it found in maps that are looked up at intervals.
    pub(crate) fn keep_up_with(&mut self, other: &Self) {
        if self.body.maps.is_empty() && !self.body.schedules.is_empty() {
            self.take(other.factors.clone());
        }
        if self.body.maps.every > 0.0 && other.body.maps.every > 0.0 {
            self.look = other.look;
            self.take(other.factors.clone());
        }
    }

    /// The times between which it is meant to run: step limits hold for what schedules say in between. Without a word,
    /// for all that they say.
    pub const fn run_between(&mut self, from: f64, to: f64) {
        self.span = (from, to);
    }

    /// Whether `scheme` can make steps of `dt` at all times of the run ([`Snake::run_between`]) and
    /// for whatever factors maps have:
    /// refused, unless `force`d, is what the elastic force, the damping and the walls alone make
    /// unstable. The limit that
    /// is told then is [`Certificate::limit`], which counts the slopes of all forces as well.
    ///
    /// # Errors
    ///
    /// As [`Scheme::check`].
    pub fn check_step(&self, scheme: Scheme, dt: f64, force: bool) -> Result<(), SchemeError> {
        let hardest = self.at_its_hardest();
        let mut all = hardest.iter().chain(hardest.is_empty().then_some(self));
        let checked = all.try_for_each(|snake| scheme.check(snake, dt, force));
        checked.map_err(|error| match error {
            SchemeError::AboveLimit {
                scheme: name,
                dt,
                limit,
            } => {
                let anywhere = Certificate::limit(self, scheme);
                let limit = anywhere.map_or(limit, |anywhere| limit.min(anywhere.dt));
                SchemeError::AboveLimit {
                    scheme: name,
                    dt,
                    limit,
                }
            }
            other => other,
        })
    }

    /// The snake with the parameters that ask for the shortest steps, of all that schedules say during the run
    /// ([`Snake::run_between`]) and maps say anywhere: one for each combination that may be the hardest. Empty where no
    /// parameter changes.
    #[must_use]
    pub fn at_its_hardest(&self) -> Vec<Self> {
        let (maps, schedules) = (&self.body.maps, &self.body.schedules);
        if maps.is_empty() && schedules.is_empty() {
            return Vec::new();
        }
        let mut times = schedules.hardest(self.span);
        if times.is_empty() {
            times.push(self.factors.common);
        }
        let places: Vec<_> = if maps.is_empty() {
            vec![None]
        } else {
            let hardest = |damped| Some(Box::new(maps.hardest(self.body.len(), damped)));
            vec![hardest(true), hardest(false)]
        };
        let each = times.iter().flat_map(|&common| {
            places.iter().map(move |places| Factors {
                common,
                places: places.clone(),
            })
        });
        each.map(|factors| {
            let mut snake = self.clone();
            snake.take(factors);
            snake
        })
        .collect()
    }

    /// How the rest shape is turned at `x` under these factors, if it turns.
    pub(crate) fn rotation_under(&self, factors: &Factors, x: &[DVec2]) -> Option<DVec2> {
        let turning = self.turning.as_ref()?;
        if factors.places.is_none() {
            return Some(turning.rotation_at(x, factors.common));
        }
        if factors.same(&self.factors) {
            return Some(turning.rotation(x));
        }
        let turning = TurningRest::new(&self.body, &self.weights, factors);
        turning.map(|turning| turning.rotation(x))
    }
}
