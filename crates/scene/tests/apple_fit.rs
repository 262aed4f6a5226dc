//! The default fit on the shipped apple: where it rests, in how many steps.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use std::ops::ControlFlow;
use std::sync::Arc;

use elastic::{Material, Topology};
use glam::DVec2;
use integrator::{Scheme, State};
use scene::fit::force::Computing;
use scene::fit::{Contour, Image, Options, Prepared};
use snake::{
    Body, Certificate, Outcome, Rest, Sampling, Simulation, Snake, Stepping, Until, Wall, WallLaw,
    World,
};

/// Steps of the explicit run until a motion of a millionth of its size in a sixth of its time
/// counts as rest.
const EXPLICIT_STEPS: u64 = 73_455;

/// Where the curve rests when it is moved by leapfrog with half of its largest step.
fn explicit_rest(prepared: &Prepared, start: &[DVec2]) -> State {
    let options = prepared.options();
    let material = Material::uniform(options.tether, options.tension, options.rigidity);
    let body = Body::of(start, Topology::Closed, 1.0).unwrap();
    let body = body.with_material(material).with_damping(options.damping);
    let field = prepared.field().unwrap().clone();
    let mut world = World::default().with_image(field, Sampling::Bilinear);
    let (width, height) = prepared.image().size();
    let last = DVec2::new(width as f64 - 1.0, height as f64 - 1.0);
    let law = WallLaw::Impact {
        restitution: 0.0,
        friction: 0.0,
    };
    for (point, normal) in [
        (DVec2::ZERO, DVec2::X),
        (DVec2::ZERO, DVec2::Y),
        (last, DVec2::NEG_X),
        (last, DVec2::NEG_Y),
    ] {
        world = world.with_wall(Wall::new(point, normal, law).unwrap());
    }
    let snake = Snake::new(body, world).unwrap();
    let dt = 0.5 * Certificate::limit(&snake, Scheme::Leapfrog).unwrap().dt;
    let stepping = Stepping::of(Scheme::Leapfrog, dt);
    let mut simulation = Simulation::of(snake, State::at_rest(start.to_vec()), stepping).unwrap();
    let strict = Rest {
        balance: 1e-7,
        travel: 1e-6,
        shape: false,
    };
    let until = Until::at_rest(strict, 200_000);
    let outcome = simulation.run(&until, &mut |_| ControlFlow::Continue(()));
    let outcome = outcome.unwrap();
    assert_eq!(
        outcome,
        Outcome::Settled {
            step: EXPLICIT_STEPS
        }
    );
    simulation.members()[0].state().clone()
}

#[test]
fn the_default_fit_of_the_apple_rests_where_small_steps_rest_in_hundreds_of_its_own() {
    let picture = Arc::new(scene::picture("apple").unwrap());
    let image = Image::of(picture.clone());
    let start = scene::contour("apple-whole-without-the-stem").unwrap();
    let start = Contour::closed(start.first().to_vec());
    let made = |computing| {
        let options = Options {
            computing,
            ..Options::motion()
        };
        Prepared::of(&image, &options).unwrap()
    };
    let whole = made(Computing::Whole);
    let short = whole.fit(&start).unwrap();
    assert!(short.is_outline() && short.steps < 1000, "{short:?}");
    let slow = explicit_rest(&whole, whole.session(&start).unwrap().start());
    let both = short.contour.points.iter().zip(&slow.x);
    let off = both.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(off < 0.01, "{off}");
    // as users have it, computed where the curve goes
    let lazy = made(Computing::Auto).fit(&start).unwrap();
    let both = short.contour.points.iter().zip(&lazy.contour.points);
    let off = both.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(lazy.is_outline() && off < 0.01, "{off}");
}
