//! Sequences of what leaves, divides and crosses.

use glam::DVec2;

use super::region::{Form, Region};
use super::scene::{Body, Scene};
use super::single::{BRIGHT, DARK, plain};
use super::{Event, Sequence};
use crate::Measures;

/// What leaves, divides and crosses.
pub(super) fn cases() -> Vec<Sequence> {
    let mut divide = Sequence::new("divide", oval).with(&[
        (20, 1, Event::Divided),
        (20, 2, Event::Born),
        (20, 3, Event::Born),
    ]);
    divide.parents = vec![(2, 1), (3, 1)];
    vec![
        Sequence::new("leave", |t| {
            let t = t as f64;
            let x = 209.5 + 5.0 * (4.0 - (t - 19.5).abs());
            plain(Form::Disc(18.0), DVec2::new(x, 80.0 + 0.8 * t))
        })
        .with(&[(16, 1, Event::Left), (24, 1, Event::Returned)]),
        divide,
        Sequence::new("cross", |t| {
            let along = 4.3 * (t as f64 - 19.5);
            let to = along * DVec2::new(0.75_f64.sqrt(), 0.5);
            let body = |id: u32, to: DVec2| {
                let center = DVec2::splat(96.0) + to;
                Body::new(id, Region::new(Form::Disc(12.0), center), BRIGHT)
            };
            let bodies = vec![body(1, to), body(2, DVec2::new(-to.x, to.y))];
            Scene::of(DARK, bodies)
        }),
    ]
}

/// The distance of two foci of a lemniscate of the area of a circle of radius 28 from its center: its area is twice the
/// square of that.
const LEMNISCATE: f64 = 28.0 * 1.253_314_137_315_500_3;

/// A circle until frame 4; from then on the foci part along an axis at 30 degrees, by 1/16 of [`LEMNISCATE`] a frame to
/// each side, so that at frame 20 the neck closes. The area is kept.
fn oval(t: usize) -> Scene {
    let part = (t as f64 - 4.0).max(0.0) / 16.0;
    let focus = LEMNISCATE * part * DVec2::from_angle(30.0_f64.to_radians());
    let middle = DVec2::splat(96.0);
    let body = |id: u32, form: Form| Body::new(id, Region::new(form, middle), BRIGHT);
    let whole = |product: f64| body(1, Form::Oval { focus, product });
    let lobe = |id: u32, focus: DVec2, product: f64| body(id, Form::Lobe { focus, product });
    let square = focus.length_squared();
    if t == 20 {
        // the two products are equal there but for rounding
        let halves = vec![lobe(2, focus, square), lobe(3, -focus, square)];
        return Scene::of(DARK, halves);
    }
    let area = std::f64::consts::PI * 28.0 * 28.0;
    let of = |product: f64| {
        let (one, share) = if t < 20 {
            (whole(product), area)
        } else {
            (lobe(2, focus, product), 0.5 * area)
        };
        Measures::of(&[one.region.outline()]).map_or(0.0, |m| m.area) - share
    };
    // the area grows with the product
    let (mut low, mut high) = if t < 20 {
        (square, square + 2.0 * 28.0 * 28.0)
    } else {
        (0.0, square)
    };
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if of(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let product = 0.5 * (low + high);
    let bodies = if t < 20 {
        vec![whole(product)]
    } else {
        vec![lobe(2, focus, product), lobe(3, -focus, product)]
    };
    Scene::of(DARK, bodies)
}
