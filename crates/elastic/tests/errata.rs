//! Where the report is wrong about the elastic matrix and what belongs to it, pinned with numbers. D.. are the errata's.
//!
//! D8 and D9 also stand with the code in `src/spacing.rs`; D3 against the report's own numbers is in
//! `oracle.rs`; D61 and later, on drawn curves, are in `errata_curves.rs`.
#![allow(
    clippy::unwrap_used,
    clippy::float_cmp,
    reason = "a test may stop, and one that says equal means equal"
)]

use elastic::{
    End, Material, SpacingRule, Topology, center, circle, elastic_force, ellipse, spacing,
    stiffness, stiffness_as_printed,
};
use glam::DVec2;

const FREE: Topology = Topology::open(End::Free);
const ANCHORED: Topology = Topology::open(End::Anchored);

fn forces(e: &[DVec2], topology: Topology, material: &Material, h: f64) -> Vec<DVec2> {
    let mut force = vec![DVec2::ZERO; e.len()];
    elastic_force(e, topology, material, h, &mut force);
    force
}

/// A bend that is no symmetry of anything.
fn bent(n: usize) -> Vec<DVec2> {
    (0..n)
        .map(|i| {
            let s = i as f64 / n as f64;
            DVec2::new((3.0 * s).exp(), (7.0 * s).sin())
        })
        .collect()
}

/// Row sums of K: the force on each node when all are shifted by −1.
fn row_sums(topology: Topology, material: &Material, h: f64, n: usize) -> Vec<f64> {
    let k = stiffness(topology, material, h, n).unwrap();
    let mut sums = vec![0.0; n];
    k.multiply_scalars_into(&vec![1.0; n], &mut sums);
    sums
}

#[test]
fn d1_the_matrix_as_printed_grows_some_deformations_and_the_right_one_none() {
    // errata: w = (0.1, 10, 10), n = 30 has least eigenvalue −2.25; the symbol's least is w0 − w1²/4w2
    let printed = stiffness_as_printed(0.1, 10.0, 10.0, 30).unwrap();
    let least = printed.dense().eigen().unwrap().values[0];
    assert!(
        (least + 2.25).abs() < 0.005,
        "two digits are given: {least}"
    );
    assert!(
        least > 0.1 - 100.0 / 40.0,
        "no cut matrix goes below the symbol"
    );
    let right = stiffness(ANCHORED, &Material::uniform(0.1, 10.0, 10.0), 1.0, 30).unwrap();
    assert!(right.dense().eigen().unwrap().values[0] > 0.1);
    // not for every set: below w1² = 4 w0 w2 the printed matrix is merely wrong
    let mild = stiffness_as_printed(1.0, 1.0, 1.0, 30).unwrap();
    assert!(mild.dense().eigen().unwrap().values[0] > 0.0);
}

#[test]
fn d1_the_printed_row_has_the_tension_with_the_wrong_sign_twice() {
    let printed = stiffness_as_printed(1.0, 5.0, 0.0, 6).unwrap();
    let right = stiffness(ANCHORED, &Material::uniform(1.0, 5.0, 0.0), 1.0, 6).unwrap();
    assert_eq!(
        (printed.entry(2, 2), printed.entry(2, 3)),
        (1.0 - 10.0, 5.0)
    );
    assert_eq!((right.entry(2, 2), right.entry(2, 3)), (1.0 + 10.0, -5.0));
}

#[test]
fn d2_tension_goes_with_the_square_of_the_spacing_and_rigidity_with_its_fourth_power() {
    let row = |w0: f64, w1: f64, w2: f64, h: f64| {
        let k = stiffness(Topology::Closed, &Material::uniform(w0, w1, w2), h, 8).unwrap();
        [k.entry(3, 3), k.entry(3, 4), k.entry(3, 5)]
    };
    assert_eq!(row(7.0, 0.0, 0.0, 2.0), [7.0, 0.0, 0.0]);
    assert_eq!(row(0.0, 4.0, 0.0, 2.0), [2.0, -1.0, 0.0]);
    assert_eq!(row(0.0, 0.0, 16.0, 2.0), [6.0, -4.0, 1.0]);
}

#[test]
fn d3_anchored_ends_are_tied_where_free_ones_are_not() {
    let (w0, w1, w2, h): (f64, f64, f64, f64) = (0.5, 3.0, 2.0, 1.25);
    let material = Material::uniform(w0, w1, w2);
    let end = w0 + w1 / h.powi(2) + 3.0 * w2 / h.powi(4);
    let second = w0 - w2 / h.powi(4);
    let want = [end, second, w0, w0, w0, second, end];
    for (sum, wanted) in row_sums(ANCHORED, &material, h, 7).iter().zip(want) {
        // six entries of at most 10
        assert!((sum - wanted).abs() < 1e-14, "{sum} for {wanted}");
    }
    for sum in row_sums(FREE, &material, h, 7) {
        assert!((sum - w0).abs() < 1e-14, "{sum}");
    }
}

#[test]
fn d4_the_reports_ends_let_a_bent_curve_push_itself_along() {
    let material = Material::uniform(0.0, 10.0, 10.0);
    let shape = bent(30);
    let middle = center(&shape, None);
    let e: Vec<_> = shape.iter().map(|&v| v - middle).collect();
    let sum = |topology| {
        forces(&e, topology, &material, 1.3)
            .iter()
            .sum::<DVec2>()
            .length()
    };
    assert!(sum(ANCHORED) > 10.0, "{}", sum(ANCHORED));
    for topology in [FREE, Topology::Closed, Topology::open(End::Pinned)] {
        // the largest single force is some hundreds
        assert!(sum(topology) < 1e-12, "{}", sum(topology));
    }
}

#[test]
fn d5_taking_the_mean_off_changes_nothing_unless_the_ends_are_anchored() {
    // e = P v − r has no mean, so the force of the energy in v is −P K e; the program forgets P
    let material = Material::uniform(0.7, 10.0, 10.0);
    let shape = bent(30);
    let middle = center(&shape, None);
    let e: Vec<_> = shape.iter().map(|&v| v - middle).collect();
    for (topology, differs) in [(FREE, false), (Topology::Closed, false), (ANCHORED, true)] {
        let force = forces(&e, topology, &material, 1.3);
        let mean = center(&force, None).length();
        assert_eq!(mean > 1e-12, differs, "{topology:?}: {mean}");
    }
}

#[test]
fn d6_a_row_times_k_is_k_times_a_column_because_k_is_symmetric() {
    let mut material = Material::uniform(0.7, 10.0, 10.0);
    material.rigidity = (0..9).map(f64::from).collect::<Vec<_>>().into();
    for topology in [FREE, Topology::Closed, ANCHORED] {
        let k = stiffness(topology, &material, 1.3, 9).unwrap().dense();
        // the force on node i of a push at node j, by the force's own formula, which asks no matrix
        let push = |j: usize| -> Vec<f64> {
            let mut e = vec![DVec2::ZERO; 9];
            e[j].y = 1.0;
            let force = forces(&e, topology, &material, 1.3);
            force.iter().map(|f| -f.y).collect()
        };
        let columns: Vec<Vec<f64>> = (0..9).map(push).collect();
        let most = columns
            .iter()
            .flatten()
            .fold(0.0_f64, |a, b| a.max(b.abs()));
        for (i, column) in columns.iter().enumerate() {
            for (j, other) in columns.iter().enumerate() {
                assert!((column[j] - other[i]).abs() < 1e-14 * most, "{topology:?}");
                assert!((column[j] - k[(j, i)]).abs() < 1e-14 * most, "{topology:?}");
            }
        }
    }
}

#[test]
fn d7_the_spacing_is_a_length_so_a_curve_twice_as_large_is_softer() {
    // with s in 0…1 a curve would not know its size
    let n = 40;
    let stiffest = |radius: f64| {
        let nodes = circle(DVec2::ZERO, radius, n);
        let h = spacing(&nodes, true, SpacingRule::Closed);
        stiffness(Topology::Closed, &Material::uniform(0.0, 0.0, 1.0), h, n)
            .unwrap()
            .entry(0, 0)
    };
    let ratio = stiffest(10.0) / stiffest(20.0);
    assert!(
        (ratio - 16.0).abs() < 1e-12,
        "rounding of h to the fourth: {ratio}"
    );
}

#[test]
fn d8_a_closed_curve_has_one_edge_more_than_the_program_counts() {
    let nodes = ellipse(DVec2::new(5.0, 8.0), DVec2::new(1.5, 1.0), 0.0, 40);
    let all = spacing(&nodes, true, SpacingRule::Closed);
    // the h of the oracle's balls, which run on a closed curve
    assert!((all - 0.198_114_170_224_792_47).abs() < 1e-15, "{all:.17}");
    let without_the_last = spacing(&nodes, true, SpacingRule::OpenMean);
    assert!(
        (without_the_last - all).abs() > 1e-3 * all,
        "{without_the_last}"
    );
}

#[test]
fn d9_the_center_of_mass_of_unequal_masses_is_not_the_mean() {
    let nodes = bent(12);
    let mass: Vec<f64> = (1..=12).map(f64::from).collect();
    let weighted = center(&nodes, Some(&mass));
    assert!((weighted - center(&nodes, None)).length() > 0.5);
    let moment: DVec2 = nodes
        .iter()
        .zip(&mass)
        .map(|(&v, &m)| m * (v - weighted))
        .sum();
    assert!(
        moment.length() < 1e-12,
        "no moment about the center of mass: {moment}"
    );
}

#[test]
fn d10_a_tether_alone_moves_each_node_by_itself() {
    let mut e = vec![DVec2::ZERO; 6];
    e[2] = DVec2::new(3.0, -1.0);
    let force = forces(&e, FREE, &Material::uniform(2.0, 0.0, 0.0), 1.0);
    for (i, f) in force.iter().enumerate() {
        assert_eq!(*f, -2.0 * e[i], "node {i}");
    }
}

#[test]
fn d13_beyond_an_anchored_end_the_equation_meets_nodes_at_rest() {
    // Eq. 3.2 to the letter on a row with e[-1], e[-2] and e[n], e[n+1] put to zero
    let (w0, w1, w2, h) = (0.3, 5.0, 2.0, 0.8);
    let e = bent(9);
    let mut row = vec![DVec2::ZERO; 2];
    row.extend(&e);
    row.extend([DVec2::ZERO; 2]);
    let forward = |f: &[DVec2], i: usize| (f[i + 1] - f[i]) / h;
    let second = |i: usize| (row[i + 1] - 2.0 * row[i] + row[i - 1]) / (h * h);
    let force = forces(&e, ANCHORED, &Material::uniform(w0, w1, w2), h);
    for (i, f) in force.iter().enumerate() {
        let k = i + 2;
        let stretch = w1 * (forward(&row, k) - forward(&row, k - 1)) / h;
        let inner = |k: usize| {
            if k == 0 || k + 1 == row.len() {
                DVec2::ZERO
            } else {
                second(k)
            }
        };
        let bend = w2 * (inner(k + 1) - 2.0 * inner(k) + inner(k - 1)) / (h * h);
        let want = -(w0 * row[k] - stretch + bend);
        // the largest term is some thousands
        assert!((*f - want).length() < 1e-11, "node {i}: {f} for {want}");
    }
}

#[test]
fn d14_a_node_has_four_neighbours_and_feels_its_deformation_not_its_position() {
    let n = 12;
    let material = Material::uniform(0.5, 3.0, 2.0);
    let k = stiffness(Topology::Closed, &material, 1.0, n).unwrap();
    for i in 0..n {
        assert_eq!(
            (0..n).filter(|&j| k.entry(i, j) != 0.0).count(),
            5,
            "row {i}"
        );
    }
    // a circle at rest feels nothing; its positions taken for a deformation would pull it together
    let rest = circle(DVec2::ZERO, 4.0, n);
    assert!(
        forces(&vec![DVec2::ZERO; n], Topology::Closed, &material, 1.0)
            .iter()
            .all(|f| *f == DVec2::ZERO)
    );
    for (f, v) in forces(&rest, Topology::Closed, &material, 1.0)
        .iter()
        .zip(&rest)
    {
        assert!(f.dot(*v) < 0.0);
    }
}

#[test]
fn d15_on_a_closed_curve_the_open_matrix_ties_the_seam_and_the_circulant_does_not() {
    let material = Material::uniform(0.0, 5.0, 0.3);
    let (n, h) = (40, 0.2);
    let shift = vec![DVec2::X; n];
    let closed = forces(&shift, Topology::Closed, &material, h);
    assert!(closed.iter().all(|f| *f == DVec2::ZERO));
    let open = forces(&shift, ANCHORED, &material, h);
    for (i, f) in open.iter().enumerate() {
        let at_seam = i < 2 || i + 2 >= n;
        assert_eq!(f.length() > 1.0, at_seam, "node {i}: {f}");
    }
    let circulant = stiffness(Topology::Closed, &material, h, n)
        .unwrap()
        .circulant();
    assert!(circulant.is_some());
    assert!(
        stiffness(ANCHORED, &material, h, n)
            .unwrap()
            .circulant()
            .is_none()
    );
}
