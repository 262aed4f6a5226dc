//! How far a curve has turned: the rotation that brings its rest shape nearest to it.
//!
//! In the plane the polar decomposition has a closed form, one arc tangent. It does not
//! measure stretching: the size of the curve drops out.

use crate::Profile;
use glam::DVec2;

/// The rotation of a rest shape that comes nearest to a curve.
///
/// ```text
/// minimise Σ μ |(x − c) − R(θ) r|²:   θ = atan2( Σ μ r × x, Σ μ r · x )
/// ```
///
/// with the rest shape `r` taken about its own center of mass. It is the rotation in the polar decomposition of
/// Σ μ (x − c) rᵀ wherever that does not mirror. `[muller05]`; the frame of report §5.2, found from shapes instead of
/// from an equation of motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BestFit {
    /// θ between −π and π, positive from +x towards +y. 0 where no angle is better than another.
    pub angle: f64,
    /// How well it fits: 1 for a copy turned and scaled, 0 where no angle is better than another.
    ///
    /// ```text
    /// |Σ μ (r·x, r×x)| / √(Σ μ |r|² Σ μ |x − c|²)
    /// ```
    pub alignment: f64,
    center: DVec2,
    /// Σ μ r·x and Σ μ r×x.
    sums: DVec2,
}

/// Below this part of what the sums could be they are rounding, and there is no angle.
const NOTHING: f64 = 1e-13;

impl BestFit {
    /// The best rotation of `rest` onto `nodes`, weighted by `mass`.
    ///
    /// One place and one mass a node; the sum of masses above 0. Neither curve need be about its center. O(n),
    /// allocates nothing. Where the alignment is below 1e-13 (a shape turned inside out, all nodes in
    /// one place) the angle is 0 and so is its rate.
    #[must_use]
    pub fn new(rest: &[DVec2], nodes: &[DVec2], mass: &Profile) -> Self {
        debug_assert_eq!(rest.len(), nodes.len(), "one place at rest a node");
        let center = center(rest, mass);
        let here = self::center(nodes, mass);
        let (mut sums, mut sizes) = (DVec2::ZERO, DVec2::ZERO);
        for (i, (r, x)) in rest.iter().zip(nodes).enumerate() {
            let (w, r, x) = (mass.at(i), *r - center, *x - here);
            sums += w * DVec2::new(r.dot(x), r.perp_dot(x));
            sizes += w * DVec2::new(r.length_squared(), x.length_squared());
        }
        let could = sizes.x.sqrt() * sizes.y.sqrt();
        let alignment = if could > 0.0 {
            sums.length() / could
        } else {
            0.0
        };
        let fits = alignment > NOTHING;
        Self {
            angle: if fits { sums.y.atan2(sums.x) } else { 0.0 },
            alignment,
            center,
            sums: if fits { sums } else { DVec2::ZERO },
        }
    }

    /// dθ/dt for nodes that move with these `velocities`: the angular velocity of the best fit. T⁻¹.
    ///
    /// ```text
    /// θ̇ = (A Ḃ − B Ȧ) / (A² + B²),   A = Σ μ r·x,   B = Σ μ r×x
    /// ```
    ///
    /// `rest` and `mass` as given to [`new`](Self::new). The velocity of the center drops out. Of a rigid motion
    /// it is the angular velocity; 0 where there is no angle.
    #[must_use]
    pub fn rate(&self, rest: &[DVec2], velocities: &[DVec2], mass: &Profile) -> f64 {
        let mut rates = DVec2::ZERO;
        for (i, (r, v)) in rest.iter().zip(velocities).enumerate() {
            let r = *r - self.center;
            rates += mass.at(i) * DVec2::new(r.dot(*v), r.perp_dot(*v));
        }
        let size = self.sums.length_squared();
        if size > 0.0 {
            self.sums.perp_dot(rates) / size
        } else {
            0.0
        }
    }
}

/// Center of mass, about the first node for the digits.
fn center(nodes: &[DVec2], mass: &Profile) -> DVec2 {
    let origin = nodes.first().copied().unwrap_or_default();
    let (mut moment, mut sum) = (DVec2::ZERO, 0.0);
    for (i, x) in nodes.iter().enumerate() {
        moment += mass.at(i) * (*x - origin);
        sum += mass.at(i);
    }
    if sum > 0.0 {
        origin + moment / sum
    } else {
        origin
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Motion, circle, ellipse};
    use glam::DMat2;
    use std::f64::consts::PI;

    /// A lopsided closed curve and masses that are not all one.
    fn shape() -> (Vec<DVec2>, Profile) {
        let nodes: Vec<_> = ellipse(DVec2::new(4.0, 7.0), DVec2::new(5.0, 2.0), 0.4, 23)
            .iter()
            .enumerate()
            .map(|(i, v)| *v + DVec2::new(0.0, (i as f64 * 0.3).sin()))
            .collect();
        let mass: Vec<f64> = (0..23).map(|i| 1.0 + 0.5 * f64::from(i).sin()).collect();
        (nodes, mass.into())
    }

    /// The shape, stretched and sheared, turned by `angle` and moved.
    fn deformed(rest: &[DVec2], angle: f64) -> Vec<DVec2> {
        let map = DMat2::from_angle(angle) * DMat2::from_cols_array(&[1.3, 0.2, 0.4, 0.8]);
        rest.iter()
            .map(|r| map * *r + 0.02 * r.y * r.y * DVec2::X + DVec2::new(-3.0, 50.0))
            .collect()
    }

    #[test]
    fn a_turned_and_scaled_copy_gives_its_angle_back_and_fits_wholly() {
        let (rest, mass) = shape();
        for angle in [-3.0, -1e-9, 0.0, 0.5, 2.0] {
            let turn = DVec2::from_angle(angle);
            let copy: Vec<_> = rest
                .iter()
                .map(|r| 2.5 * turn.rotate(*r) + DVec2::splat(1e3))
                .collect();
            let fit = BestFit::new(&rest, &copy, &mass);
            // places at 1e3, sizes of 5
            assert!((fit.angle - angle).abs() < 1e-12, "{angle}: {}", fit.angle);
            assert!((fit.alignment - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn no_other_angle_brings_the_rest_shape_nearer() {
        let (rest, mass) = shape();
        let nodes = deformed(&rest, 1.1);
        let fit = BestFit::new(&rest, &nodes, &mass);
        let (from, to) = (center(&rest, &mass), center(&nodes, &mass));
        let miss = |angle: f64| {
            let turn = DVec2::from_angle(angle);
            let far = |(i, (r, x)): (usize, (&DVec2, &DVec2))| {
                mass.at(i) * ((*x - to) - turn.rotate(*r - from)).length_squared()
            };
            rest.iter().zip(&nodes).enumerate().map(far).sum::<f64>()
        };
        let best = miss(fit.angle);
        for k in 1..360 {
            let angle = fit.angle + f64::from(k) * PI / 180.0;
            assert!(miss(angle) > best, "{k} degrees off");
        }
        assert!((miss(fit.angle + 1e-4) - miss(fit.angle - 1e-4)).abs() < 1e-12 * best);
    }

    #[test]
    fn it_is_the_rotation_of_the_polar_decomposition() {
        let (rest, mass) = shape();
        let nodes = deformed(&rest, -2.0);
        let (from, to) = (center(&rest, &mass), center(&nodes, &mass));
        let mut polar = DMat2::ZERO;
        for (i, (r, x)) in rest.iter().zip(&nodes).enumerate() {
            let (r, x) = (*r - from, *x - to);
            polar += mass.at(i) * DMat2::from_cols(r.x * x, r.y * x);
        }
        // Newton's iteration, quadratic: R ← (R + R⁻ᵀ)/2
        for _ in 0..40 {
            polar = 0.5 * (polar + polar.inverse().transpose());
        }
        let fit = BestFit::new(&rest, &nodes, &mass);
        assert!((DVec2::from_angle(fit.angle) - polar.x_axis).length() < 1e-13);
    }

    #[test]
    fn its_rate_is_the_derivative_of_its_angle_and_of_a_rigid_motion_the_spin() {
        let (rest, mass) = shape();
        let nodes = deformed(&rest, 0.3);
        let v: Vec<_> = (0..23)
            .map(|i| DVec2::new(f64::from(i).sin(), f64::from(3 * i).cos()))
            .collect();
        let after = |dt: f64| {
            let moved: Vec<_> = nodes.iter().zip(&v).map(|(x, v)| *x + dt * *v).collect();
            BestFit::new(&rest, &moved, &mass).angle
        };
        let rate = BestFit::new(&rest, &nodes, &mass).rate(&rest, &v, &mass);
        let difference = (after(1e-5) - after(-1e-5)) / 2e-5;
        // the difference's own error: dt² and rounding over dt
        assert!((rate - difference).abs() < 1e-9, "{rate} for {difference}");
        let fit = BestFit::new(&rest, &nodes, &mass);
        let spin: Vec<_> = nodes.iter().map(|x| DVec2::X - 0.8 * x.perp()).collect();
        assert!((fit.rate(&rest, &spin, &mass) + 0.8).abs() < 1e-13);
        let motion = Motion::of(&nodes, &spin, &mass, 1.0);
        assert!((motion.angular_velocity() + 0.8).abs() < 1e-13);
    }

    #[test]
    fn where_no_angle_is_better_than_another_it_is_zero_and_so_is_its_rate() {
        let round = circle(DVec2::ZERO, 2.0, 16);
        // walked the other way round, a circle lies as well at any angle
        let mirrored: Vec<_> = round.iter().map(|v| DVec2::new(v.x, -v.y)).collect();
        for nodes in [mirrored, vec![DVec2::ONE; 16]] {
            let fit = BestFit::new(&round, &nodes, &1.0.into());
            assert!(fit.alignment < 1e-15 && fit.angle == 0.0, "{fit:?}");
            assert_eq!(fit.rate(&round, &round, &1.0.into()), 0.0);
        }
        assert_eq!(BestFit::new(&[], &[], &1.0.into()).angle, 0.0);
    }
}
