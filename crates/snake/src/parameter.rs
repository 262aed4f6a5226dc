//! The parameters of a body, by name.

use std::fmt;
use std::ops::{Index, IndexMut};
use std::str::FromStr;

use elastic::Profile;

use crate::{Body, SnakeError};

/// A parameter of a body that may differ along the curve, change with time or with place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parameter {
    /// ω₀. M T⁻².
    Tether,
    /// ω₁. M L² T⁻².
    Tension,
    /// ω₂. M L⁴ T⁻².
    Rigidity,
    /// All weights of orders above 2, as a factor of those that the body has.
    Higher,
    /// μ. M.
    Mass,
    /// γ. M T⁻¹.
    Damping,
    /// β: internal damping. T.
    Internal,
}

impl Parameter {
    /// All of them, in the order of their declaration.
    pub const ALL: [Self; 7] = [
        Self::Tether,
        Self::Tension,
        Self::Rigidity,
        Self::Higher,
        Self::Mass,
        Self::Damping,
        Self::Internal,
    ];

    /// Those of the elastic force.
    pub(crate) const ELASTIC: [Self; 4] =
        [Self::Tether, Self::Tension, Self::Rigidity, Self::Higher];

    /// Its name in texts.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Tether => "tether",
            Self::Tension => "tension",
            Self::Rigidity => "rigidity",
            Self::Higher => "higher",
            Self::Mass => "mass",
            Self::Damping => "damping",
            Self::Internal => "internal",
        }
    }
}

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Parameter {
    type Err = SnakeError;

    fn from_str(text: &str) -> Result<Self, SnakeError> {
        let found = Self::ALL.iter().find(|each| each.name() == text);
        found.copied().ok_or_else(|| SnakeError::UnknownName {
            what: "parameter",
            name: text.to_owned(),
            known: "tether, tension, rigidity, higher, mass, damping, internal",
        })
    }
}

/// One value for each parameter.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct PerParameter<T>([T; 7]);

impl<T> PerParameter<T> {
    /// The value of each by a function.
    pub(crate) fn of(value: impl FnMut(Parameter) -> T) -> Self {
        Self(Parameter::ALL.map(value))
    }
}

impl<T> Index<Parameter> for PerParameter<T> {
    type Output = T;

    fn index(&self, parameter: Parameter) -> &T {
        &self.0[parameter as usize]
    }
}

impl<T> IndexMut<Parameter> for PerParameter<T> {
    fn index_mut(&mut self, parameter: Parameter) -> &mut T {
        &mut self.0[parameter as usize]
    }
}

impl Body {
    /// Give a parameter this profile along the curve. The weights of higher orders are all multiplied by it, which
    /// must then be uniform; so must internal damping.
    ///
    /// # Errors
    ///
    /// A value that the parameter cannot have; then nothing has changed.
    pub fn set(&mut self, parameter: Parameter, profile: Profile) -> Result<(), SnakeError> {
        let mut body = self.clone();
        let uniform = |profile: &Profile| match profile {
            Profile::Uniform(value) => Ok(*value),
            Profile::PerNode(values) => Err(SnakeError::OtherLength {
                needed: 1,
                got: values.len(),
            }),
        };
        match parameter {
            Parameter::Tether => body.material.tether = profile,
            Parameter::Tension => body.material.tension = profile,
            Parameter::Rigidity => body.material.rigidity = profile,
            Parameter::Higher => {
                let factor = uniform(&profile)?;
                for weight in &mut body.material.higher {
                    *weight = weight.scaled(factor);
                }
            }
            Parameter::Mass => body.mass = profile,
            Parameter::Damping => body.damping = profile,
            Parameter::Internal => body.internal = uniform(&profile)?,
        }
        body.validate()?;
        *self = body;
        Ok(())
    }
}
