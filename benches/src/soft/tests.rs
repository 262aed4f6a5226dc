use super::model::turning;
use super::world::{Method, World};
use sandbox::prelude::*;

#[test]
fn the_slopes_of_a_hinge_are_those_of_its_angle() {
    let at = [
        DVec2::new(0.0, 0.1),
        DVec2::new(1.0, -0.3),
        DVec2::new(1.7, 0.9),
    ];
    let (_, slopes) = turning(at[0], at[1], at[2]);
    for k in 0..3 {
        for axis in [DVec2::X, DVec2::Y] {
            let moved = |by: f64| {
                let mut at = at;
                at[k] += by * axis;
                turning(at[0], at[1], at[2]).0
            };
            // a third derivative of some tens times 1e-10
            let slope = (moved(1e-5) - moved(-1e-5)) / 2e-5;
            assert!((slopes[k].dot(axis) - slope).abs() < 1e-8);
        }
    }
}

#[test]
fn the_other_methods_hang_a_rope_as_long_as_it_is() {
    let scene = scene_with("rope", &[]).unwrap();
    // 4.1 px of stretch, as the snake has it, and 40 springs of 0.0025 px at rest
    for (method, share, off) in [(Method::Springs, 1.0, 1e-3), (Method::Positions, 0.5, 0.02)] {
        let mut world = World::new(&scene, method, share).unwrap();
        world.go(120.0).unwrap();
        let rope = world.curve(0);
        let length = rope[0].y - rope[40].y;
        assert!((length - 4.2).abs() < off, "{method:?}: {length}");
    }
}
