//! The force field of a picture.

use std::any::Any;
use std::sync::Arc;

use field::{ForceField, Interpolation};
use glam::{DMat2, DVec2};
use integrator::{Fault, FaultKind};
use lanes::{Finite, flat, flat_mut, wide};

use super::{Curve, Force, Pull, nowhere, push_back};

/// How the force of a picture is read between its pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sampling {
    /// Bilinear in the four pixels around; the position is clamped to the picture.
    Bilinear,
    /// By cubics through sixteen pixels, clamped likewise: its slope is continuous, and it goes up to a
    /// quarter beyond the forces of its pixels.
    Bicubic,
    /// The report's rule: along one axis only, from the rounded pixel, and a fault off the picture
    /// (D51, D54).
    OneAxis,
}

/// Points read at a time: their forces are added while they are in the first cache.
const BLOCK: usize = 512;

wide! {
    /// Adds `sampled` to `force`; true if all of it is finite.
    fn join(sampled: &[f64], force: &mut [f64]) -> bool {
        let sampled = &sampled[..force.len()];
        let mut finite = Finite::default();
        for k in 0..force.len() {
            force[k] += sampled[k];
            finite.see(sampled[k]);
        }
        finite.all()
    }
}

/// The force field of a picture, felt by the nodes.
///
/// It has no energy of its own: between pixel centers a sampled field is no gradient, and the
/// report's is none anywhere (D39).
#[derive(Debug, Clone)]
pub struct ImageForce {
    field: Arc<ForceField>,
    sampling: Sampling,
    scratch: Vec<DVec2>,
}

impl ImageForce {
    /// The force of `field`; shared, since it is large and never changes.
    #[must_use]
    pub const fn new(field: Arc<ForceField>, sampling: Sampling) -> Self {
        let scratch = Vec::new();
        Self {
            field,
            sampling,
            scratch,
        }
    }

    /// The field.
    #[must_use]
    pub const fn field(&self) -> &Arc<ForceField> {
        &self.field
    }

    /// How it is read.
    #[must_use]
    pub const fn sampling(&self) -> Sampling {
        self.sampling
    }

    /// The rule of its slopes: the report's rule has none and is bounded by the bilinear one's.
    const fn rule(&self) -> Interpolation {
        match self.sampling {
            Sampling::Bicubic => Interpolation::Bicubic,
            Sampling::Bilinear | Sampling::OneAxis => Interpolation::Bilinear,
        }
    }
}

impl Force for ImageForce {
    fn name(&self) -> &'static str {
        "image"
    }

    /// Faults: [`FaultKind::OutsideField`] under the report's rule off the picture,
    /// [`FaultKind::NotFinite`] for a node that is no place.
    fn add(&mut self, curve: &Curve<'_>, force: &mut [DVec2]) -> Result<(), Fault> {
        let x = curve.x;
        match self.sampling {
            Sampling::Bilinear | Sampling::Bicubic => {
                let (rule, sampled) = (self.rule(), &mut self.scratch);
                sampled.resize(BLOCK, DVec2::ZERO);
                let mut finite = true;
                for (x, force) in x.chunks(BLOCK).zip(force.chunks_mut(BLOCK)) {
                    let sampled = &mut sampled[..x.len()];
                    self.field.sample_into(x, rule, sampled);
                    finite &= join(flat(sampled), flat_mut(force));
                }
                // a position that is not finite shows as a force that is not
                if !finite && let Some(fault) = nowhere(x) {
                    return Err(fault);
                }
            }
            Sampling::OneAxis => {
                for (node, (f, &at)) in force.iter_mut().zip(x).enumerate() {
                    let fault = |_| Fault {
                        node,
                        at,
                        kind: FaultKind::OutsideField,
                    };
                    *f += self.field.at_report(at).map_err(fault)?;
                }
            }
        }
        Ok(())
    }

    fn add_slope(&mut self, curve: &Curve<'_>, slope: &mut [DMat2]) -> bool {
        if self.sampling == Sampling::OneAxis {
            return false; // the report's rule jumps between pixels and has no slope there
        }
        let rule = self.rule();
        for (slope, &p) in slope.iter_mut().zip(curve.x) {
            *slope += self.field.sample_with_slope(p, rule).1;
        }
        true
    }

    /// Anywhere under bicubic sampling: a bound, up to about twice what is reached.
    fn pull(&self, _spacing: f64, curve: Option<&Curve<'_>>) -> Pull {
        let stiffness = match curve {
            Some(curve) => curve
                .x
                .iter()
                .map(|&p| push_back(self.field.sample_with_slope(p, self.rule()).1))
                .fold(0.0, f64::max),
            None if self.sampling == Sampling::Bicubic => steepest_cubic(&self.field),
            None => steepest_in(&self.field),
        };
        Pull {
            stiffness,
            damping: 0.0,
        }
    }

    fn depends_on_velocity(&self) -> bool {
        false
    }

    fn boxed(&self) -> Box<dyn Force> {
        Box::new(self.clone())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

/// The steepest push back anywhere between the pixel centers.
///
/// In a cell the slope along x is linear in y and the other way round, and the steepest push back is
/// a convex function of both: it is largest in a corner.
fn steepest_in(field: &ForceField) -> f64 {
    let at = |column: usize, row: usize| field.pixel(column, row).unwrap_or(DVec2::ZERO);
    let mut steepest = 0.0_f64;
    for row in 1..field.height() {
        for column in 1..field.width() {
            let [a, b] = [at(column - 1, row - 1), at(column, row - 1)];
            let [c, d] = [at(column - 1, row), at(column, row)];
            for x in [b - a, d - c] {
                for y in [c - a, d - b] {
                    steepest = steepest.max(push_back(DMat2::from_cols(x, y)));
                }
            }
        }
    }
    steepest
}

/// The same under bicubic sampling, or more.
///
/// A slope between pixels is a sum of differences of neighbors along the axis whose weights are 1.5 at most in size
/// (at the middle of a cell), over rows whose weights are 1.25 at most.
fn steepest_cubic(field: &ForceField) -> f64 {
    let at = |column: usize, row: usize| field.pixel(column, row).unwrap_or(DVec2::ZERO);
    let (mut across, mut down) = (0.0_f64, 0.0_f64);
    for row in 0..field.height() {
        for column in 0..field.width() {
            if column > 0 {
                across = across.max((at(column, row) - at(column - 1, row)).length_squared());
            }
            if row > 0 {
                down = down.max((at(column, row) - at(column, row - 1)).length_squared());
            }
        }
    }
    1.5 * 1.25 * (across + down).sqrt()
}
