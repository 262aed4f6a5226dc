//! Sequences of one object.

use glam::DVec2;

use super::region::{Form, Region, Wave};
use super::scene::{Body, Scene, Texture};
use super::{Event, Sequence};

/// Level of an object.
pub(super) const BRIGHT: f64 = 200.0;

/// Level of the ground.
pub(super) const DARK: f64 = 60.0;

/// The seeds of the textures of an object and of the ground.
pub(super) const TEXTURES: [u64; 2] = [7001, 7002];

/// A frame of an object of the usual level on the usual ground.
pub(super) fn plain(form: Form, center: DVec2) -> Scene {
    let body = Body::new(1, Region::new(form, center), BRIGHT);
    Scene::of(DARK, vec![body])
}

/// The same with other levels.
fn levels(mut scene: Scene, bright: f64, dark: f64) -> Scene {
    scene.ground = dark;
    scene.bodies.iter_mut().for_each(|body| body.level = bright);
    scene
}

/// The same with texture on object and ground.
pub(super) fn textured(mut scene: Scene, size: f64) -> Scene {
    let [object, ground] = TEXTURES.map(|seed| Some(Texture { size, seed }));
    scene.texture = ground;
    scene
        .bodies
        .iter_mut()
        .for_each(|body| body.texture = object);
    scene
}

/// Something in the frame that is no object, behind those that are.
fn behind(mut scene: Scene, form: Form, center: DVec2, level: f64) -> Scene {
    let region = Region::new(form, center);
    scene.bodies.push(Body::new(0, region, level));
    scene
}

fn wave(count: u32, size: f64, phase: f64) -> Wave {
    Wave { count, size, phase }
}

/// `r = 28 + 6 cos(2a + .15 t) + 4 cos(3a − .2 t) + 2 cos(5a + .1 t)` about `(60 + 1.8 t, 96 + 20 sin(t / 8))`.
fn amoeba(t: f64) -> Scene {
    let waves = vec![
        wave(2, 6.0, 0.15 * t),
        wave(3, 4.0, -0.2 * t),
        wave(5, 2.0, 0.1 * t),
    ];
    let center = DVec2::new(60.0 + 1.8 * t, 96.0 + 20.0 * (t / 8.0).sin());
    plain(Form::Waves { base: 28.0, waves }, center)
}

/// Where the kicked circle is: it falls by 4 pixels a frame; the steps from the frames 20 and 34 are of 26 pixels, 30
/// degrees to the right of upwards, and what they have beyond the fall halves in every frame after.
fn kicked(t: usize) -> DVec2 {
    let fall = DVec2::new(0.0, 4.0);
    let kick = 26.0 * DVec2::new(0.5, -0.75_f64.sqrt()) - fall;
    let (mut at, mut rest) = (DVec2::new(60.0, 30.0), DVec2::ZERO);
    for step in 0..t {
        rest *= 0.5;
        if step == 20 || step == 34 {
            rest = kick;
        }
        at += fall + rest;
    }
    at
}

/// The cases of one object.
pub(super) fn cases() -> Vec<Sequence> {
    let mut all = motions();
    all.extend(shapes());
    all.extend(disturbed());
    all
}

/// What moves.
fn motions() -> Vec<Sequence> {
    let straight = |t: f64| plain(Form::Disc(20.0), DVec2::new(40.0 + 2.8 * t, 96.0));
    vec![
        Sequence::new("move_const", |t| straight(t as f64)),
        Sequence::new("move_fall", |t| {
            let t = t as f64;
            let center = DVec2::new(30.0 + 3.0 * t, 24.0 + 0.09 * t * t);
            plain(Form::Disc(18.0), center)
        }),
        Sequence::new("move_bounce", |t| {
            let u = ((t + 20) % 40) as f64 - 20.0;
            let center = DVec2::new(40.0 + 2.5 * t as f64, 24.0 + 0.36 * u * u);
            plain(Form::Disc(18.0), center)
        })
        .with(&[(20, 1, Event::Kicked)]),
        Sequence::new("kick", |t| {
            let scene = plain(Form::Disc(18.0), kicked(t));
            behind(scene, Form::Disc(13.0), DVec2::new(72.0, 150.0), BRIGHT)
        })
        .with(&[(20, 1, Event::Kicked), (34, 1, Event::Kicked)]),
        Sequence::new("vanish", |t| {
            let mut scene = straight(t as f64);
            scene.bodies[0].hidden = (15..20).contains(&t);
            scene
        })
        .with(&[(15, 1, Event::Vanished), (20, 1, Event::Returned)]),
    ]
}

/// What changes its form or its levels.
fn shapes() -> Vec<Sequence> {
    let middle = DVec2::splat(96.0);
    let turned = |degrees: f64| {
        let (half, angle) = (DVec2::new(50.0, 20.0), degrees.to_radians());
        plain(Form::Ellipse { half, angle }, middle)
    };
    let mut noisy = Sequence::new("noise_cnr2", |t| levels(amoeba(t as f64), 104.0, 96.0));
    noisy.noise = 4.0;
    vec![
        Sequence::new("turn", |t| turned(4.0 * t as f64)),
        Sequence::new("turn_fast", |t| textured(turned(12.0 * t as f64), 15.0)),
        Sequence::new("breathe", |t| {
            let waves = vec![wave(2, 12.0 * (0.2 * t as f64).sin(), 0.0)];
            plain(Form::Waves { base: 45.0, waves }, middle)
        }),
        Sequence::new("grow", |t| plain(Form::Disc(12.0 + t as f64), middle)),
        Sequence::new("amoeba_tex", |t| {
            let mut scene = textured(levels(amoeba(t as f64), 130.0, 110.0), 14.0);
            scene.texture = None;
            scene
        }),
        Sequence::new("amoeba_camo", |t| {
            textured(levels(amoeba(t as f64), 130.0, 110.0), 14.0)
        }),
        noisy,
        Sequence::new("fade", |t| {
            let t = t as f64;
            levels(amoeba(t), DARK + 140.0 * 0.93_f64.powf(t), DARK)
        }),
    ]
}

/// What is hidden, passed, touched or shaken.
fn disturbed() -> Vec<Sequence> {
    let upright = |half: f64| Form::Box(DVec2::new(half, 400.0));
    let level = |half: f64| Form::Box(DVec2::new(400.0, half));
    vec![
        Sequence::new("occluded", |t| {
            let mut scene = plain(Form::Disc(18.0), DVec2::new(32.0 + 3.2 * t as f64, 96.0));
            let bar = Region::new(upright(17.0), DVec2::splat(96.0));
            scene.bodies.insert(0, Body::new(0, bar, 130.0));
            scene
        }),
        Sequence::new("distractor", |t| {
            let along = 2.6 * t as f64;
            let scene = plain(Form::Disc(16.0), DVec2::new(40.0 + along, 78.0));
            let center = DVec2::new(152.0 - along, 113.0);
            behind(scene, Form::Disc(16.0), center, BRIGHT)
        }),
        Sequence::new("tongue", |t| {
            let scene = plain(Form::Disc(22.0), DVec2::new(36.0 + 3.0 * t as f64, 96.0));
            behind(scene, level(7.0), DVec2::new(96.0, 125.0), 190.0)
        }),
        Sequence::new("camera", |t| {
            let time = t as f64;
            let golden = 2.399_963_229_728_653 * (t / 4) as f64;
            let shift = if t % 4 >= 2 {
                15.0 * DVec2::from_angle(golden)
            } else {
                DVec2::ZERO
            };
            let (half, angle) = (DVec2::new(28.0, 20.0), (2.0 * time).to_radians());
            let center = DVec2::new(66.0 + 1.5 * time, 96.0) + shift;
            let scene = plain(Form::Ellipse { half, angle }, center);
            let mut scene = textured(levels(scene, 160.0, 100.0), 15.0);
            scene.shift = shift;
            scene
        }),
    ]
}
