//! The neck of an outline: its shortest chord between two parts that are large enough.

use glam::DVec2;

/// The two nodes of a neck, its length over the square root of the area.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Neck {
    pub ends: [usize; 2],
    pub narrow: f64,
}

/// The shortest chord that cuts off at least that share of the area on either side; None if there is none. O(nodes²).
pub(crate) fn neck(curve: &[DVec2], least: f64) -> Option<Neck> {
    let n = curve.len();
    let mut sums = Vec::with_capacity(n + 1);
    let mut sum = 0.0;
    for i in 0..n {
        sums.push(sum);
        sum += 0.5 * curve[i].perp_dot(curve[(i + 1) % n]);
    }
    let area = sum;
    let mut best: Option<(f64, [usize; 2])> = None;
    for i in 0..n {
        for j in i + 2..n {
            let far = curve[i].distance_squared(curve[j]);
            if best.is_some_and(|best| far >= best.0) {
                continue;
            }
            let part = (sums[j] - sums[i] + 0.5 * curve[j].perp_dot(curve[i])) / area;
            if part >= least && part <= 1.0 - least {
                best = Some((far, [i, j]));
            }
        }
    }
    let (far, ends) = best?;
    let narrow = (far / area.abs()).sqrt();
    Some(Neck { ends, narrow })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_has_no_neck_and_a_bone_has_one() {
        let circle: Vec<DVec2> = (0..120)
            .map(|i| 30.0 * DVec2::from_angle(std::f64::consts::TAU * f64::from(i) / 120.0))
            .collect();
        // the shortest chord that cuts off a fifth: 2 sin(a) with (a - sin a cos a) / π = 0.2, a = 1.0567
        let found = neck(&circle, 0.2).map(|neck| neck.narrow);
        let chord = 2.0 * 1.0567_f64.sin() / std::f64::consts::PI.sqrt();
        assert!(
            found.is_some_and(|narrow| (narrow - chord).abs() < 0.03),
            "{found:?}"
        );
        // r = 30 (0.55 + 0.45 cos 2a): a waist of 6 at 90 degrees
        let bone: Vec<DVec2> = (0..120)
            .map(|i| {
                let angle = std::f64::consts::TAU * f64::from(i) / 120.0;
                30.0 * (0.55 + 0.45 * (2.0 * angle).cos()) * DVec2::from_angle(angle)
            })
            .collect();
        let area = elastic::signed_area(&bone);
        let found = neck(&bone, 0.2);
        assert!(
            found.is_some_and(
                |neck| neck.ends == [30, 90] && (neck.narrow - 6.0 / area.sqrt()).abs() < 1e-9
            ),
            "{found:?}"
        );
    }
}
