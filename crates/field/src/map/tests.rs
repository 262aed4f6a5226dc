use super::*;
use proptest::prelude::*;

const SMOOTHING: Smoothing = Smoothing::Gaussian(1.5);

fn ramp() -> Grid {
    Grid::from_shape_fn((5, 9), |(y, x)| 2.0 + 0.5 * x as f64 + 0.25 * y as f64)
}

fn step() -> Grid {
    Grid::from_shape_fn((20, 40), |(_, x)| if x >= 20 { 180.0 } else { 40.0 })
}

#[test]
fn a_ramp_is_itself_between_pixels_and_level_beyond_the_border() {
    let map = Map::new(&ramp()).unwrap();
    for (x, y) in [(0.0, 0.0), (3.25, 1.5), (8.0, 4.0), (7.9, 0.3)] {
        let truth = 2.0 + 0.5 * x + 0.25 * y;
        // a few roundings of numbers below 8
        assert!((map.at(DVec2::new(x, y)) - truth).abs() < 1e-14);
    }
    assert_eq!(map.at(DVec2::new(-7.0, 2.0)).to_bits(), 2.5_f64.to_bits());
    assert_eq!(map.at(DVec2::new(99.0, 99.0)).to_bits(), 7.0_f64.to_bits());
    assert!(map.at(DVec2::new(f64::NAN, 1.0)).is_nan());
    assert_eq!((map.least(), map.largest()), (2.0, 7.0));
    assert_eq!(map.size(), (9, 5));
}

proptest! {
    #[test]
    fn nothing_lies_outside_the_pixels_and_a_constant_is_one_to_the_last_bit(
        values in proptest::collection::vec(-1e3..1e3_f64, 12),
        (x, y) in (-2.0..6.0_f64, -2.0..5.0_f64),
        level in -1e3..1e3_f64,
    ) {
        let map = Map::new(&Grid::from_shape_vec((3, 4), values).unwrap()).unwrap();
        let at = map.at(DVec2::new(x, y));
        prop_assert!(at >= map.least() && at <= map.largest());
        let flat = Map::new(&Grid::from_elem((3, 4), level)).unwrap();
        prop_assert_eq!(flat.at(DVec2::new(x, y)).to_bits(), level.to_bits());
    }
}

#[test]
fn shares_become_factors_between_two_ends() {
    let shares = ndarray::array![[0.0, 0.2, 0.35, 0.5, 1.0]];
    let map = Map::of_shares(&shares, [0.2, 0.5], [1.0, 0.1]).unwrap();
    let at = |x: f64| map.at(DVec2::new(x, 0.0));
    let found = [at(0.0), at(1.0), at(3.0), at(4.0)].map(f64::to_bits);
    assert_eq!(found, [1.0, 1.0, 0.1, 0.1].map(f64::to_bits));
    assert!((at(2.0) - 0.55).abs() < 1e-15);
    assert!(Map::of_shares(&shares, [0.5, 0.5], [1.0, 0.1]).is_err());
    assert!(Map::of_shares(&shares, [0.0, 1.0], [f64::NAN, 0.1]).is_err());
}

#[test]
fn shares_run_from_0_to_1_and_mean_what_they_say() {
    let grey = grey_share(&step()).unwrap();
    assert_eq!((grey[[3, 3]], grey[[3, 30]]), (0.0, 1.0));
    let edge = edge_share(&step(), SMOOTHING).unwrap();
    assert!(edge[[10, 19]] > 0.9 && edge[[10, 5]] < 1e-12);
    let contrast = contrast_share(&step(), SMOOTHING).unwrap();
    assert!(contrast[[10, 19]] > 0.9 && contrast[[10, 5]] < 1e-6);
    let distance = distance_share(&step(), SMOOTHING, 0.5, 10.0).unwrap();
    let edge_at = (0..40).find(|&x| distance[[10, x]] <= 0.0).unwrap();
    assert!(edge_at == 19 || edge_at == 20);
    assert!((distance[[10, edge_at - 4]] - 0.4).abs() < 1e-15);
    assert!((distance[[10, 2]] - 1.0).abs() < 1e-15);
    for share in [grey, edge, contrast, distance] {
        assert!(share.iter().all(|s| (0.0..=1.0).contains(s)));
    }
}

#[test]
fn noise_has_contrast_and_little_edge_where_it_is_smoothed_away() {
    let mut seed = 7_u64;
    let noisy = Grid::from_shape_fn((40, 40), |(_, x)| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        let noise = (seed >> 40) as f64 / f64::from(1 << 24) - 0.5;
        100.0 + if x < 20 { 40.0 * noise } else { 0.0 }
    });
    let contrast = contrast_share(&noisy, Smoothing::Gaussian(3.0)).unwrap();
    assert!(contrast[[20, 8]] > 0.6 && contrast[[20, 35]] < 0.01);
}

#[test]
fn shares_do_not_move_with_the_scale_of_the_grey() {
    // a factor of 2 is exact, 1/255 and 257 are not: a contrast of 0 is the root of what rounding leaves
    for (factor, tolerance) in [(2.0, 0.0), (1.0 / 255.0, 1e-7), (257.0, 1e-7)] {
        let scaled = step().mapv(|v| v * factor);
        let pairs = [
            (grey_share(&step()), grey_share(&scaled)),
            (
                edge_share(&step(), SMOOTHING),
                edge_share(&scaled, SMOOTHING),
            ),
            (
                contrast_share(&step(), SMOOTHING),
                contrast_share(&scaled, SMOOTHING),
            ),
            (
                distance_share(&step(), SMOOTHING, 0.5, 10.0),
                distance_share(&scaled, SMOOTHING, 0.5, 10.0),
            ),
        ];
        for (one, other) in pairs {
            for (a, b) in one.unwrap().iter().zip(&other.unwrap()) {
                assert!((a - b).abs() <= tolerance, "{factor}: {a} {b}");
            }
        }
    }
}

#[test]
fn a_constant_picture_is_nowhere_bright_an_edge_or_near_one() {
    let flat = Grid::from_elem((7, 8), 0.1);
    assert!(grey_share(&flat).unwrap().iter().all(|&s| s <= 0.0));
    assert!(
        edge_share(&flat, SMOOTHING)
            .unwrap()
            .iter()
            .all(|&s| s <= 0.0)
    );
    assert!(
        contrast_share(&flat, SMOOTHING)
            .unwrap()
            .iter()
            .all(|&s| s <= 0.0)
    );
    let distance = distance_share(&flat, SMOOTHING, 0.5, 4.0).unwrap();
    assert!(distance.iter().all(|&s| s >= 1.0));
}

#[test]
fn bad_input_is_refused() {
    assert!(Map::new(&Grid::zeros((0, 3))).is_err());
    assert!(Map::new(&Grid::from_elem((2, 2), f64::NAN)).is_err());
    assert!(grey_share(&Grid::from_elem((2, 2), f64::INFINITY)).is_err());
    assert!(edge_share(&step(), Smoothing::Gaussian(0.0)).is_err());
    assert!(contrast_share(&step(), Smoothing::Gaussian(-1.0)).is_err());
    assert!(distance_share(&step(), SMOOTHING, 0.0, 4.0).is_err());
    assert!(distance_share(&step(), SMOOTHING, 0.5, f64::NAN).is_err());
}
