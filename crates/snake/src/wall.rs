//! Walls: half planes that a snake may not enter, under one of three laws.
//!
//! The report speaks of a wall at x = 0 and never gives its law (D66); its program clamps the
//! nodes at the upper and lower border of the image and leaves their memory of the position before
//! untouched (D57). That is [`WallLaw::Clamp`]. The other two are laws of physics: a stiff spring,
//! and an impulse with restitution and Coulomb friction.

use glam::{DMat2, DVec2};
use integrator::{Response, Touch};

use crate::SnakeError;
use crate::error::finite_at_least;

/// What happens at a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WallLaw {
    /// The node is put back on the wall and the scheme's memory is left alone: the report's law
    /// (D57). The normal momentum is lost one step late, and a node that *starts* behind the wall
    /// is thrown out.
    Clamp,
    /// A spring and a damper push while the node is behind the wall, and never pull:
    /// `f = max(0, −k d − c ḋ) n` with `d < 0` the signed distance.
    ///
    /// A single node of mass density μ comes back with `exp(−2 ζ arccos ζ / √(1−ζ²))` of its speed,
    /// `ζ = c / (2 √(k μ)) < 1`: it leaves when the wall would begin to pull, which is before the
    /// half period is over. The stiffness adds to the largest eigenvalue in the step limit.
    Penalty {
        /// k. M T⁻².
        stiffness: f64,
        /// c. M T⁻¹.
        damping: f64,
    },
    /// An impulse after the step: the normal velocity turns round, times `restitution`; the
    /// tangential velocity loses at most `friction` times the normal impulse (Coulomb).
    ///
    /// ```text
    /// vₙ⁺ = −ε vₙ,   vₜ⁺ = vₜ · max(0, 1 − f (1 + ε) |vₙ| / |vₜ|),   d⁺ = −ε d
    /// ```
    ///
    /// With ε = 0 this is the inelastic law. Never gives energy to a node, for ε ≤ 1.
    Impact {
        /// ε, from 0 (inelastic) to 1 (elastic).
        restitution: f64,
        /// Coulomb's coefficient f, at least 0.
        friction: f64,
    },
}

/// A straight wall: everything on the far side of a line is forbidden.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wall {
    /// A point of the wall. L.
    point: DVec2,
    /// Unit normal, to the side where the snake may be.
    normal: DVec2,
    /// Its law.
    law: WallLaw,
}

impl Wall {
    /// A wall through `point` with the snake on the side that `normal` points to.
    ///
    /// The normal may have any length above zero.
    ///
    /// # Errors
    ///
    /// Refused: a normal without direction, numbers that are not finite, negative stiffness,
    /// damping or friction, restitution outside 0 … 1.
    pub fn new(point: DVec2, normal: DVec2, law: WallLaw) -> Result<Self, SnakeError> {
        let length = normal.length();
        if !(length.is_finite() && length > 0.0) {
            return Err(SnakeError::NoNormal {
                x: normal.x,
                y: normal.y,
            });
        }
        for value in [point.x, point.y] {
            finite_at_least("a wall's point", f64::MIN, "a place", value)?;
        }
        match law {
            WallLaw::Clamp => {}
            WallLaw::Penalty { stiffness, damping } => {
                finite_at_least(
                    "a wall's stiffness",
                    f64::MIN_POSITIVE,
                    "above 0",
                    stiffness,
                )?;
                finite_at_least("a wall's damping", 0.0, "at least 0", damping)?;
            }
            WallLaw::Impact {
                restitution,
                friction,
            } => {
                finite_at_least("a wall's restitution", 0.0, "from 0 to 1", restitution)?;
                finite_at_least("a wall's friction", 0.0, "at least 0", friction)?;
                if restitution > 1.0 {
                    let (name, bound) = ("a wall's restitution", "from 0 to 1");
                    return Err(SnakeError::BadNumber {
                        name,
                        bound,
                        value: restitution,
                    });
                }
            }
        }
        Ok(Self {
            point,
            normal: normal / length,
            law,
        })
    }

    /// A point of the wall.
    #[must_use]
    pub const fn point(&self) -> DVec2 {
        self.point
    }

    /// The unit normal, to the allowed side.
    #[must_use]
    pub const fn normal(&self) -> DVec2 {
        self.normal
    }

    /// The law.
    #[must_use]
    pub const fn law(&self) -> WallLaw {
        self.law
    }

    /// Whether it acts by a force, not by a touch after the step.
    #[must_use]
    pub const fn is_spring(&self) -> bool {
        matches!(self.law, WallLaw::Penalty { .. })
    }

    /// Signed distance of a point: negative behind the wall.
    #[must_use]
    pub fn distance(&self, x: DVec2) -> f64 {
        (x - self.point).dot(self.normal)
    }

    /// Force of a penalty wall on a node, zero for the other laws. Per unit of arc length.
    #[must_use]
    pub fn force(&self, x: DVec2, v: DVec2) -> DVec2 {
        let WallLaw::Penalty { stiffness, damping } = self.law else {
            return DVec2::ZERO;
        };
        let d = self.distance(x);
        if d >= 0.0 {
            return DVec2::ZERO;
        }
        self.normal * (-stiffness * d - damping * v.dot(self.normal)).max(0.0)
    }

    /// Slope of [`Wall::force`] with the position, damping left out: `−k n nᵀ` behind a penalty wall.
    #[must_use]
    pub fn slope(&self, x: DVec2) -> DMat2 {
        match self.law {
            WallLaw::Penalty { stiffness, .. } if self.distance(x) < 0.0 => {
                let scaled = self.normal * -stiffness;
                DMat2::from_cols(scaled * self.normal.x, scaled * self.normal.y)
            }
            _ => DMat2::ZERO,
        }
    }

    /// Energy a penalty wall holds per unit of arc length at `x`: `½ k d²` behind it.
    #[must_use]
    pub fn energy(&self, x: DVec2) -> f64 {
        match self.law {
            WallLaw::Penalty { stiffness, .. } => {
                let d = self.distance(x).min(0.0);
                0.5 * stiffness * d * d
            }
            WallLaw::Clamp | WallLaw::Impact { .. } => 0.0,
        }
    }

    /// What the wall does to a node at `x` with velocity `v` after a step, if it touches it.
    #[must_use]
    pub fn touch(&self, node: usize, x: DVec2, v: DVec2) -> Option<Touch> {
        let d = self.distance(x);
        let (position, response) = match self.law {
            WallLaw::Penalty { .. } => return None,
            WallLaw::Clamp => {
                if d > 0.0 {
                    return None;
                }
                (x - self.normal * d, Response::Clamp)
            }
            WallLaw::Impact {
                restitution,
                friction,
            } => {
                if d >= 0.0 {
                    return None;
                }
                let surface = x - self.normal * d;
                let response = Response::Impact {
                    restitution,
                    friction,
                };
                if v.dot(self.normal) < 0.0 {
                    (surface - self.normal * (restitution * d), response)
                } else {
                    (surface, response)
                }
            }
        };
        Some(Touch {
            node,
            position,
            normal: self.normal,
            response,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wall(law: WallLaw) -> Wall {
        Wall::new(DVec2::ZERO, DVec2::new(2.0, 0.0), law).unwrap()
    }

    #[test]
    fn the_clamp_puts_the_node_on_the_wall() {
        let touch = wall(WallLaw::Clamp)
            .touch(3, DVec2::new(-0.5, 7.0), DVec2::NEG_X)
            .unwrap();
        assert_eq!(
            touch,
            Touch {
                node: 3,
                position: DVec2::new(0.0, 7.0),
                normal: DVec2::X,
                response: Response::Clamp,
            }
        );
        assert_eq!(
            wall(WallLaw::Clamp).touch(3, DVec2::new(0.5, 7.0), DVec2::NEG_X),
            None
        );
    }

    #[test]
    fn an_impact_mirrors_the_depth_by_its_restitution_and_a_node_that_leaves_is_put_on_the_wall() {
        let law = WallLaw::Impact {
            restitution: 0.5,
            friction: 0.1,
        };
        let at = DVec2::new(-0.2, 1.0);
        let touch = wall(law).touch(0, at, DVec2::new(-4.0, 3.0)).unwrap();
        assert!((touch.position.x - 0.1).abs() < 1e-15);
        let touch = wall(law).touch(0, at, DVec2::new(4.0, 3.0)).unwrap();
        assert_eq!(touch.position, DVec2::new(0.0, 1.0));
    }

    #[test]
    fn a_penalty_wall_never_pulls_and_its_force_is_minus_the_slope_of_its_energy() {
        let law = WallLaw::Penalty {
            stiffness: 100.0,
            damping: 10.0,
        };
        let (x, step) = (DVec2::new(-0.3, 0.0), DVec2::new(1e-6, 0.0));
        let slope = (wall(law).energy(x + step) - wall(law).energy(x - step)) / 2e-6;
        assert!((wall(law).force(x, DVec2::ZERO).x + slope).abs() < 1e-6);
        assert_eq!(wall(law).force(x, DVec2::new(100.0, 0.0)), DVec2::ZERO);
        assert_eq!(wall(law).force(-x, DVec2::ZERO), DVec2::ZERO);
    }

    #[test]
    fn bad_walls_are_refused_by_name() {
        let law = WallLaw::Impact {
            restitution: 1.5,
            friction: 0.0,
        };
        let error = Wall::new(DVec2::ZERO, DVec2::X, law).unwrap_err();
        assert_eq!(
            error.to_string(),
            "a wall's restitution must be finite and from 0 to 1, got 1.5"
        );
        assert!(Wall::new(DVec2::ZERO, DVec2::ZERO, WallLaw::Clamp).is_err());
        assert!(Wall::new(DVec2::NAN, DVec2::X, WallLaw::Clamp).is_err());
        let stiff = WallLaw::Penalty {
            stiffness: -1.0,
            damping: 0.0,
        };
        assert!(Wall::new(DVec2::ZERO, DVec2::X, stiff).is_err());
    }
}
