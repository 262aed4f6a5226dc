//! What a moving curve does as a whole: mass, momenta, inertia, and its kinetic energy in three parts.
//!
//! In the plane a turn is one number, and ω × q is ω times q turned by a quarter, which glam calls `perp` (D76). The
//! moment of inertia is one number too, not the tensor of the report (D74).

use crate::Profile;
use glam::DVec2;

/// The motion of a curve as a whole, and what is left of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Total mass, h Σ μ. M L.
    pub mass: f64,
    /// Center of mass.
    pub center: DVec2,
    /// Velocity of the center. L T⁻¹.
    pub velocity: DVec2,
    /// Moment of inertia about the center, h Σ μ |q|². M L³.
    pub inertia: f64,
    /// Angular momentum about the center, h Σ μ q × q̇; positive from +x towards +y. M L³ T⁻¹.
    pub angular_momentum: f64,
    /// Kinetic energy of the center, ½ m |ċ|². M L³ T⁻².
    pub translation: f64,
    /// Kinetic energy of the turn, ½ I ω². M L³ T⁻².
    pub rotation: f64,
    /// Kinetic energy of what is left, ½ h Σ μ |q̇ − ω × q|². M L³ T⁻².
    pub deformation: f64,
}

impl Motion {
    /// The motion of `nodes` that have these `velocities`.
    ///
    /// ```text
    /// c = Σ μ x / Σ μ,   q = x − c,   I = h Σ μ |q|²,   L = h Σ μ q × q̇,   ω = L / I
    /// T = ½ m |ċ|² + ½ I ω² + ½ h Σ μ |q̇ − ω × q|²
    /// ```
    ///
    /// The three parts add up to ½ h Σ μ |ẋ|² for any motion, because this ω leaves a rest without angular
    /// momentum. One value a node in all slices; `mass` above 0. Each node counts for a whole `spacing`, as in
    /// every law here. O(n), allocates nothing. All sums are about the center, so that a small curve far from
    /// the origin loses no digits. No nodes: everything is 0.
    ///
    /// Report §5.2: (5.1) divided by the mass (D9), and the energy (5.3) with its inertia as one number (D74).
    #[must_use]
    pub fn of(nodes: &[DVec2], velocities: &[DVec2], mass: &Profile, spacing: f64) -> Self {
        debug_assert_eq!(nodes.len(), velocities.len(), "one velocity a node");
        let weights = || (0..nodes.len()).map(|i| mass.at(i));
        let sum: f64 = weights().sum();
        // about the first node, for the digits
        let mean = |vectors: &[DVec2]| {
            let origin = vectors.first().copied().unwrap_or_default();
            let moment: DVec2 = weights().zip(vectors).map(|(w, &v)| w * (v - origin)).sum();
            if sum > 0.0 {
                origin + moment / sum
            } else {
                origin
            }
        };
        let (center, velocity) = (mean(nodes), mean(velocities));
        let seen = || {
            weights()
                .zip(nodes.iter().zip(velocities))
                .map(|(w, (&x, &v))| (w, x - center, v - velocity))
        };
        let (mut inertia, mut momentum) = (0.0, 0.0);
        for (w, q, v) in seen() {
            inertia += w * q.length_squared();
            momentum += w * q.perp_dot(v);
        }
        let omega = ratio(momentum, inertia);
        let left: f64 = seen()
            .map(|(w, q, v)| w * (v - omega * q.perp()).length_squared())
            .sum();
        Self {
            mass: spacing * sum,
            center,
            velocity,
            inertia: spacing * inertia,
            angular_momentum: spacing * momentum,
            translation: 0.5 * spacing * sum * velocity.length_squared(),
            rotation: 0.5 * spacing * momentum * omega,
            deformation: 0.5 * spacing * left,
        }
    }

    /// ω = L / I: the turn that carries all the angular momentum. T⁻¹; 0 without inertia.
    ///
    /// Of a rigid motion it is the angular velocity. Of others it differs from the rate of the
    /// [best fit](crate::BestFit), which asks for the shape and not for the momentum.
    #[must_use]
    pub fn angular_velocity(&self) -> f64 {
        ratio(self.angular_momentum, self.inertia)
    }

    /// The three parts of the kinetic energy together.
    #[must_use]
    pub fn kinetic(&self) -> f64 {
        self.translation + self.rotation + self.deformation
    }

    /// The velocity a node at `place` would have if the curve were rigid: ċ + ω × q.
    #[must_use]
    pub fn rigid(&self, place: DVec2) -> DVec2 {
        self.velocity + self.angular_velocity() * (place - self.center).perp()
    }
}

/// A quotient that is 0 where there is nothing to divide by.
fn ratio(above: f64, below: f64) -> f64 {
    if below > 0.0 { above / below } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::circle;
    use std::f64::consts::TAU;

    /// Values between −1 and 1 without a pattern.
    fn scattered(i: usize) -> f64 {
        (i as f64 * 12.9898).sin()
    }

    #[test]
    fn a_rigid_ring_has_the_inertia_of_the_book_and_no_energy_of_deformation() {
        // m R², for nodes on the circle itself
        let (n, radius, mass, omega) = (40, 3.0, 0.7, -1.3);
        let h = TAU * radius / n as f64;
        let place = DVec2::new(1e6, -2e6);
        let nodes = circle(place, radius, n);
        let drift = DVec2::new(5.0, 2.0);
        let v: Vec<_> = nodes
            .iter()
            .map(|x| drift + omega * (*x - place).perp())
            .collect();
        let motion = Motion::of(&nodes, &v, &mass.into(), h);
        let m = mass * TAU * radius;
        // nodes at 1e6 are rounded at 1e-10
        let near = |a: f64, b: f64| (a - b).abs() < 1e-9 * b.abs();
        assert!(near(motion.mass, m));
        assert!(near(motion.inertia, m * radius * radius));
        assert!(near(motion.angular_velocity(), omega));
        assert!(near(motion.translation, 0.5 * m * 29.0));
        assert!(near(
            motion.rotation,
            0.5 * m * radius * radius * omega * omega
        ));
        assert!(motion.deformation < 1e-16 * motion.rotation);
        assert!((motion.rigid(nodes[3]) - v[3]).length() < 1e-9);
    }

    #[test]
    fn the_three_parts_of_the_kinetic_energy_add_up_for_any_motion() {
        for n in [1, 2, 7, 60] {
            let node =
                |k: usize| (0..n).map(move |i| DVec2::new(scattered(k + i), scattered(k + 5 * i)));
            let (nodes, v): (Vec<_>, Vec<_>) = (node(3).collect(), node(90).collect());
            let mass: Vec<f64> = (0..n).map(|i| 1.5 + scattered(i)).collect();
            let whole: f64 = 0.5
                * 0.3
                * mass
                    .iter()
                    .zip(&v)
                    .map(|(m, v)| m * v.length_squared())
                    .sum::<f64>();
            let motion = Motion::of(&nodes, &v, &mass.into(), 0.3);
            assert!(
                (motion.kinetic() - whole).abs() < 1e-14 * whole * n as f64,
                "{n}"
            );
            assert!(motion.deformation >= 0.0);
        }
    }

    #[test]
    fn d74_the_inertia_in_the_plane_is_the_trace_of_the_reports_tensor() {
        // I_ij = Σ μ (δ_ij q² − q_i q_j): its two diagonal elements add up to the one number
        let nodes = [
            DVec2::new(0.0, 0.0),
            DVec2::new(4.0, 0.0),
            DVec2::new(2.0, 3.0),
        ];
        let motion = Motion::of(&nodes, &[DVec2::ZERO; 3], &2.0.into(), 1.0);
        let q: Vec<_> = nodes.iter().map(|x| *x - DVec2::new(2.0, 1.0)).collect();
        let (xx, yy) = q.iter().fold((0.0, 0.0), |(xx, yy), q| {
            (xx + 2.0 * q.y * q.y, yy + 2.0 * q.x * q.x)
        });
        assert_eq!(motion.inertia, xx + yy);
    }

    #[test]
    fn d75_the_motion_of_the_center_is_all_the_momentum_there_is() {
        // T(v + δ) − T(v) = m ċ·δ + ½ m δ²: ∂T/∂ċ is m ċ, and nothing of the deformation is in it
        let nodes: Vec<_> = (0..9)
            .map(|i| DVec2::new(scattered(i), scattered(2 * i)))
            .collect();
        let v: Vec<_> = (0..9)
            .map(|i| DVec2::new(scattered(7 * i), scattered(3 * i)))
            .collect();
        let mass = Profile::from((1..10).map(f64::from).collect::<Vec<_>>());
        let before = Motion::of(&nodes, &v, &mass, 1.0);
        let push = DVec2::new(0.5, -2.0);
        let pushed: Vec<_> = v.iter().map(|v| *v + push).collect();
        let gained = Motion::of(&nodes, &pushed, &mass, 1.0).kinetic() - before.kinetic();
        let want = before.mass * (before.velocity.dot(push) + 0.5 * push.length_squared());
        assert!(
            (gained - want).abs() < 1e-13 * want.abs(),
            "{gained} for {want}"
        );
    }

    #[test]
    fn d76_omega_cross_q_is_q_turned_by_a_quarter_and_its_derivative_says_so() {
        let (q, omega, dt) = (DVec2::new(3.0, -1.0), 0.8, 1e-6);
        let turned = |t: f64| DVec2::from_angle(omega * t).rotate(q);
        let rate = (turned(dt) - turned(-dt)) / (2.0 * dt);
        // rounding of 1e-16·3 over 2e-6
        assert!((rate - omega * q.perp()).length() < 1e-9);
        assert_eq!(q.perp(), DVec2::new(1.0, 3.0));
    }

    #[test]
    fn without_extent_nothing_turns() {
        let v = [DVec2::X, DVec2::NEG_X];
        let motion = Motion::of(&[DVec2::ONE; 2], &v, &1.0.into(), 1.0);
        assert_eq!(
            (motion.inertia, motion.angular_velocity(), motion.rotation),
            (0.0, 0.0, 0.0)
        );
        assert_eq!(motion.deformation, 1.0);
        assert_eq!(Motion::of(&[], &[], &1.0.into(), 1.0).kinetic(), 0.0);
    }
}
