//! Corners and breaks, report §3.4.1: where a density is zero, the curve does not feel what it would resist.
#![allow(
    clippy::unwrap_used,
    clippy::float_cmp,
    reason = "a test may stop, and one that says equal means equal"
)]

use elastic::{ElasticEnergy, End, Material, Topology, elastic_energy, elastic_force};
use glam::DVec2;

const N: usize = 12;
const H: f64 = 0.5;

fn topologies() -> [Topology; 3] {
    [
        Topology::open(End::Free),
        Topology::open(End::Pinned),
        Topology::Open {
            head: End::Free,
            tail: End::Pinned,
        },
    ]
}

fn energy(e: &[DVec2], topology: Topology, material: &Material) -> ElasticEnergy {
    elastic_energy(e, topology, material, H)
}

fn forces(e: &[DVec2], topology: Topology, material: &Material) -> Vec<DVec2> {
    let mut force = vec![DVec2::NAN; e.len()];
    elastic_force(e, topology, material, H, &mut force);
    force
}

/// Straight and at rest up to `node`, from there on turned aside.
fn kink(node: usize) -> Vec<DVec2> {
    let slope = DVec2::new(0.25, -0.5);
    (0..N)
        .map(|i| i.saturating_sub(node) as f64 * slope)
        .collect()
}

/// At rest up to `node`; after it, moved away and turned.
fn jump(node: usize) -> Vec<DVec2> {
    let (step, slope) = (DVec2::new(-4.0, 2.0), DVec2::new(0.25, -0.5));
    (0..N)
        .map(|i| {
            if i > node {
                step + (i - node) as f64 * slope
            } else {
                DVec2::ZERO
            }
        })
        .collect()
}

/// At rest up to `node`; after it, moved away as a whole.
fn gap(node: usize) -> Vec<DVec2> {
    (0..N)
        .map(|i| {
            if i > node {
                DVec2::new(-4.0, 2.0)
            } else {
                DVec2::ZERO
            }
        })
        .collect()
}

#[test]
fn a_kink_at_a_corner_costs_no_bending_and_one_beside_it_does() {
    for topology in topologies() {
        let material = Material::uniform(0.0, 0.0, 3.0).with_corner(5, N).unwrap();
        assert_eq!(
            energy(&kink(5), topology, &material).total(),
            0.0,
            "{topology:?}"
        );
        assert!(
            forces(&kink(5), topology, &material)
                .iter()
                .all(|f| *f == DVec2::ZERO)
        );
        for beside in [3, 4, 6, 7] {
            let cost = energy(&kink(beside), topology, &material).rigidity;
            // ½ h ω₂ |slope|²/h⁴
            assert_eq!(cost, 0.5 * 3.0 * 0.3125 / H.powi(3), "kink at {beside}");
            assert!(forces(&kink(beside), topology, &material)[beside].length() > 1.0);
        }
    }
}

#[test]
fn at_a_corner_the_curve_still_resists_being_torn() {
    let material = Material::uniform(0.0, 2.0, 3.0).with_corner(5, N).unwrap();
    for topology in topologies() {
        let cost = energy(&gap(5), topology, &material);
        assert!(cost.tension > 0.0 && cost.rigidity > 0.0, "{cost:?}");
    }
}

#[test]
fn a_jump_at_a_break_costs_nothing_and_one_beside_it_does() {
    let whole = Material::uniform(0.0, 2.0, 3.0);
    for topology in topologies() {
        let broken = whole.with_break(5, N).unwrap();
        let cost = energy(&gap(5), topology, &broken);
        assert_eq!(cost.total(), 0.0, "{topology:?}");
        assert!(
            forces(&gap(5), topology, &broken)
                .iter()
                .all(|f| *f == DVec2::ZERO)
        );
        for beside in [3, 4, 6, 7] {
            let cost = energy(&gap(beside), topology, &broken);
            assert_eq!(cost.tension, 0.5 * 2.0 * 20.0 / H, "jump after {beside}");
            assert!(cost.rigidity > 0.0);
        }
    }
}

#[test]
fn the_two_sides_of_a_break_may_also_turn_against_each_other() {
    let broken = Material::uniform(0.0, 0.0, 3.0).with_break(5, N).unwrap();
    for topology in topologies() {
        assert_eq!(
            energy(&jump(5), topology, &broken).total(),
            0.0,
            "{topology:?}"
        );
        assert!(
            forces(&jump(5), topology, &broken)
                .iter()
                .all(|f| *f == DVec2::ZERO)
        );
        assert!(energy(&jump(4), topology, &broken).total() > 0.0);
    }
}

#[test]
fn one_node_without_tension_and_rigidity_is_not_yet_a_break() {
    // the text's ω₁(s₀) = ω₂(s₀) = 0 at one node: the bend of its neighbour still reaches across
    let mut material = Material::uniform(0.0, 2.0, 3.0).with_corner(5, N).unwrap();
    material.tension = material.tension.with(5, N, 0.0);
    let cost = energy(&gap(5), Topology::open(End::Free), &material);
    assert_eq!(cost.tension, 0.0);
    assert!(cost.rigidity > 0.0);
}

#[test]
fn a_ring_broken_once_is_an_open_curve() {
    let whole = Material::uniform(0.25, 2.0, 3.0);
    let broken = whole.with_break(N - 1, N).unwrap();
    let e: Vec<_> = (0..N)
        .map(|i| DVec2::from_angle(1.7 * i as f64) * (1.0 + i as f64))
        .collect();
    let ring = forces(&e, Topology::Closed, &broken);
    let open = forces(&e, Topology::open(End::Free), &whole);
    for (a, b) in ring.iter().zip(&open) {
        // forces of some thousands; the two loops add the same terms in another order
        assert!((*a - *b).length() < 1e-11, "{a} for {b}");
    }
    let (one, two) = (
        energy(&e, Topology::Closed, &broken).total(),
        energy(&e, Topology::open(End::Free), &whole).total(),
    );
    assert!((one - two).abs() < 1e-13 * two, "{one} for {two}");
}

#[test]
fn a_corner_at_the_seam_of_a_ring_is_a_corner_like_any_other() {
    let material = Material::uniform(0.0, 0.0, 3.0);
    let bump = |node: usize| -> Vec<DVec2> {
        (0..N)
            .map(|i| if i == node { DVec2::Y } else { DVec2::ZERO })
            .collect()
    };
    for node in [0, 1, 5, N - 1] {
        let corner = material.with_corner(node, N).unwrap();
        let cost = energy(&bump(node), Topology::Closed, &corner).rigidity;
        // of its three bends, 1 + 4 + 1, the middle one is gone
        assert_eq!(cost, 0.5 * 3.0 * 2.0 / H.powi(3), "corner at {node}");
    }
}
