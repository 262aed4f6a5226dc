//! How much a curve bends at a node: the estimates of report §5.3, each by name.
//!
//! All four look at a node and its two neighbours, `u₁ = v[i] − v[i−1]` and `u₂ = v[i+1] − v[i]`, and all
//! are signed: positive where the curve turns from +x towards +y, so everywhere on a circle of positive
//! area. They differ in what an uneven spacing does to them, and in what they cost.
//!
//! | estimate | even circle | uneven circle | square roots | arc tangents |
//! | --- | --- | --- | --- | --- |
//! | [`Estimate::Turn`] | order 2 | order 2 | 2 | 1 |
//! | [`Estimate::Direction`] | exact | order 2 or better | 2 | 0 |
//! | [`Estimate::Formula`] | order 2 | order 2 | 3 | 0 |
//! | [`Estimate::Difference`] | exact | does not converge | 1 | 0 |
//!
//! None of them is smoothed: on noisy nodes each is as noisy as second differences are.

use crate::{SpacingRule, spacing};
use glam::DVec2;

/// A way to estimate curvature from a node and its two neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Estimate {
    /// The turning angle over the mean of the two edges: the definition, `K = dθ/ds`.
    ///
    /// ```text
    /// K = Δθ / Δs,   Δθ = atan2(u₁ × u₂, u₁ · u₂),   Δs = (|u₁| + |u₂|) / 2
    /// ```
    ///
    /// Second order on a circle however uneven the nodes; first order on other uneven curves. The
    /// report's arc cosine has a minus where the dot product has a plus (D71), its middle expression for
    /// Δs too (D72), and it forgets the sign of the angle (D73). `[williams92]`, report §5.3.
    Turn,
    /// The difference of the two unit edges over their mean length.
    ///
    /// ```text
    /// |K| = | u₂/|u₂| − u₁/|u₁| | / Δs = 2 sin(Δθ/2) / Δs
    /// ```
    ///
    /// No arc tangent. On a circle the error is `1/cos((a − b)/4) − 1` for arcs of the angles a and b: none on
    /// even nodes, second order at worst. Never above 2/Δs, so that a sharp corner counts for less than by
    /// [`Turn`](Self::Turn). `[williams92]`, report §5.3 and Fig. 5.1 (D79).
    Direction,
    /// The formula for any parameter, with derivatives that know the two spacings.
    ///
    /// ```text
    /// K = (x' y'' − x'' y') / (x'² + y'²)^(3/2)
    /// v' = (d₁ u₂/d₂ + d₂ u₁/d₁) / (d₁ + d₂),   v'' = (u₂/d₂ − u₁/d₁) / ((d₁ + d₂)/2),   d = |u|
    /// ```
    ///
    /// First differences are divided by their own spacing and second differences by the mean of the two:
    /// not one factor, as the text has it (D77). Second order on a circle. Report Eq. 5.5, signed.
    Formula,
    /// The plain second difference with one spacing for the whole curve: what chapter 3 computes.
    ///
    /// ```text
    /// |K| = | v[i+1] − 2 v[i] + v[i−1] | / h²
    /// ```
    ///
    /// Cheap, exact for evenly spaced nodes on a circle, and wrong for uneven ones however many there
    /// are: `s` is then no arc length. Report §5.3.
    Difference,
}

impl Estimate {
    /// All of them, in the order of the report.
    pub const ALL: [Self; 4] = [Self::Difference, Self::Formula, Self::Turn, Self::Direction];

    /// One word for tables and flags.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Turn => "turn",
            Self::Direction => "direction",
            Self::Formula => "formula",
            Self::Difference => "difference",
        }
    }

    /// Signed curvature at `here`, between its two neighbours. L⁻¹.
    ///
    /// `h` is the mean spacing of the whole curve, used by [`Difference`](Self::Difference) only. Where
    /// `here` coincides with a neighbour there is no direction, and the answer is 0.
    #[must_use]
    pub fn at(self, before: DVec2, here: DVec2, after: DVec2, h: f64) -> f64 {
        let (u1, u2) = (here - before, after - here);
        let (d1, d2) = (u1.length(), u2.length());
        if d1 == 0.0 || d2 == 0.0 {
            return 0.0;
        }
        let mean = 0.5 * (d1 + d2);
        match self {
            Self::Turn => turning_angle(u1, u2) / mean,
            Self::Direction => {
                let (t1, t2) = (u1 / d1, u2 / d2);
                (t2 - t1).length().copysign(t1.perp_dot(t2)) / mean
            }
            Self::Formula => {
                let (t1, t2) = (u1 / d1, u2 / d2);
                let first = (d1 * t2 + d2 * t1) / (d1 + d2);
                let second = (t2 - t1) / mean;
                let speed = first.length();
                if speed == 0.0 {
                    0.0
                } else {
                    first.perp_dot(second) / (speed * speed * speed)
                }
            }
            Self::Difference => (u2 - u1).length().copysign(u1.perp_dot(u2)) / (h * h),
        }
    }
}

/// Signed angle from `u` to `w`, between −π and π, positive from +x towards +y.
///
/// ```text
/// Δθ = atan2(u × w, u · w)
/// ```
///
/// Any lengths; 0 if one of them is zero. Accurate for small angles, where the report's arc cosine
/// loses half its digits.
///
/// ```
/// use elastic::turning_angle;
/// use glam::DVec2;
///
/// assert_eq!(turning_angle(DVec2::X, 5.0 * DVec2::Y), std::f64::consts::FRAC_PI_2);
/// assert_eq!(turning_angle(DVec2::Y, DVec2::X), -std::f64::consts::FRAC_PI_2);
/// ```
#[must_use]
pub fn turning_angle(u: DVec2, w: DVec2) -> f64 {
    u.perp_dot(w).atan2(u.dot(w))
}

/// Signed curvature at every node of a curve, by one of the [`Estimate`]s. L⁻¹.
///
/// One value a node. The two ends of an open curve have no bend, and get 0. O(n).
#[must_use]
pub fn curvature(nodes: &[DVec2], closed: bool, estimate: Estimate) -> Vec<f64> {
    let n = nodes.len();
    let h = spacing(nodes, closed, SpacingRule::Closed);
    (0..n)
        .map(|i| {
            if !closed && (i == 0 || i + 1 == n) {
                return 0.0;
            }
            estimate.at(nodes[(i + n - 1) % n], nodes[i], nodes[(i + 1) % n], h)
        })
        .collect()
}
