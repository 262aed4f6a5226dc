//! Every lane against its own solve, byte for byte.

use glam::DVec2;
use proptest::prelude::*;

use super::{springs, vectors};
use crate::{BandedError, Factor, LaneFactor, LanePoint, Pentadiagonal};

fn check<const W: usize>(matrices: &[Pentadiagonal], b: &[Vec<DVec2>]) {
    let n = matrices[0].len();
    let mut together = vec![LanePoint::<W>::default(); n];
    for (lane, b) in b.iter().enumerate().take(W) {
        (0..n).for_each(|i| together[i].set_lane(lane, b[i]));
    }
    let mut shared = together.clone();
    LaneFactor::<W>::new(matrices).unwrap().solve(&mut together);
    Factor::new(&matrices[0]).unwrap().solve_lanes(&mut shared);
    for lane in 0..W.min(b.len()) {
        let own = &matrices[lane.min(matrices.len() - 1)];
        for (a, lanes) in [(own, &together), (&matrices[0], &shared)] {
            let mut alone = b[lane].clone();
            Factor::new(a).unwrap().solve(&mut alone);
            for i in 0..n {
                let found = lanes[i].lane(lane);
                assert_eq!(
                    found.to_array().map(f64::to_bits),
                    alone[i].to_array().map(f64::to_bits)
                );
            }
        }
    }
}

proptest! {
    #[test]
    fn every_lane_gives_the_bytes_of_its_own_solve(
        (n, cyclic) in (5..40_usize, any::<bool>()),
        weights in proptest::collection::vec(proptest::collection::vec(0.01..10.0_f64, 9), 4),
        b in proptest::collection::vec(vectors(40), 4),
    ) {
        let b: Vec<Vec<DVec2>> = b.iter().map(|b| b[..n].to_vec()).collect();
        // stiffer from lane to lane, so that their spikes fade at different places
        let floor = |k: i32| 10.0_f64.powi(4 - 3 * k);
        let matrices: Vec<Pentadiagonal> =
            (0..).zip(&weights).map(|(k, weights)| springs(n, cyclic, weights, floor(k))).collect();
        check::<4>(&matrices, &b);
        check::<2>(&matrices[2..], &b);
        check::<4>(&matrices[..3], &b);
        check::<1>(&matrices[..1], &b);
    }
}

#[test]
fn the_lane_that_has_a_problem_is_named() {
    let good = springs(8, true, &[1.0], 1.0);
    let mut bad = good.clone();
    bad.add(5, 5, f64::INFINITY);
    let refused = LaneFactor::<4>::new(&[good.clone(), bad]).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "lane 1: row 5 holds a number that is not finite"
    );
    let other = springs(9, true, &[1.0], 1.0);
    let refused = LaneFactor::<4>::new(&[good.clone(), good.clone(), other]).unwrap_err();
    assert!(matches!(refused, BandedError::Lane { lane: 2, .. }));
    let open = springs(8, false, &[1.0], 1.0);
    let refused = LaneFactor::<4>::new(&[good.clone(), open]).unwrap_err();
    assert!(matches!(refused, BandedError::Lane { lane: 1, .. }));
    let many = vec![good; 3];
    assert!(matches!(
        LaneFactor::<2>::new(&many),
        Err(BandedError::Length { got: 3, .. })
    ));
    assert!(matches!(
        LaneFactor::<2>::new(&[]),
        Err(BandedError::Length { got: 0, .. })
    ));
}
