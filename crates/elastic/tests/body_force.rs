//! The force of a body where it is, against the force of the deformation written down.

use elastic::{End, Material, Profile, Topology, body_force, elastic_force};
use glam::DVec2;

const ENDS: [End; 4] = [End::Free, End::Pinned, End::Anchored, End::Clamped];

fn topologies() -> impl Iterator<Item = Topology> {
    let open = ENDS.into_iter().flat_map(|head| {
        ENDS.into_iter()
            .map(move |tail| Topology::Open { head, tail })
    });
    std::iter::once(Topology::Closed).chain(open)
}

fn wave(n: usize, turn: f64) -> Vec<DVec2> {
    (0..n)
        .map(|i| DVec2::from_angle(turn * i as f64) * (40.0 + (0.3 * i as f64).sin()))
        .collect()
}

/// Every length from the shortest up past two blocks, so that each remainder of the wide loops is met.
#[test]
fn the_force_of_a_body_has_the_digits_of_the_force_of_its_deformation() {
    let center = DVec2::new(101.3, -57.9);
    for topology in topologies() {
        for n in (topology.least_nodes()..40).chain(120..150).chain(250..280) {
            let (x, rest) = (wave(n, 0.7), wave(n, 0.71));
            let uniform = Material::uniform(0.1, 2.0, 3.0);
            let uneven = Material {
                rigidity: Profile::from((0..n).map(|i| 1.0 + i as f64).collect::<Vec<_>>()),
                ..uniform.clone()
            };
            for material in [uniform, uneven] {
                let e: Vec<DVec2> = x.iter().zip(&rest).map(|(x, r)| x - center - r).collect();
                let mut slow = vec![DVec2::ZERO; n];
                elastic_force(&e, topology, &material, 1.3, &mut slow);
                let (mut scratch, mut quick) = (vec![DVec2::NAN; n], vec![DVec2::NAN; n]);
                let curve = (topology, &material, 1.3);
                body_force([&x, &rest], center, curve, &mut scratch, &mut quick);
                assert_eq!(quick, slow, "{topology:?}, {n} nodes");
            }
        }
    }
}
