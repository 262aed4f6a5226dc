//! Pixels of every form: depths, colors, masks.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: levels from 0 to 255"
)]

use crate::common::{apart, disc, whole};
use fit::{Contour, Image, Options, fit};
use glam::DVec2;
use ndarray::Array2;

const CENTER: DVec2 = DVec2::new(48.3, 44.8);

#[test]
fn depths_of_one_picture_give_one_outline_lazily_and_whole() {
    let levels = disc(CENTER, 22.0).mapv(f64::round);
    let start = Contour::circle(CENTER, 26.0);
    let expected = fit(&Image::grey(levels.clone()), &start, &whole()).unwrap();
    let bytes = levels.mapv(|v| v as u8).into_shared();
    let words = levels.mapv(|v| 257 * v as u16).into_shared();
    let floats = levels.mapv(|v| v as f32 / 255.0).into_shared();
    let color = Image::color([levels.clone(), levels.clone(), levels.clone()]).unwrap();
    for image in [
        Image::bytes(bytes),
        Image::words(words),
        Image::floats(floats),
        color,
        Image::grey(levels),
    ] {
        for options in [whole(), Options::motion()] {
            let found = fit(&image, &start, &options).unwrap();
            // a lazy field is within 1e-6 of gain times level: 1e-4 of the pull, which turns within
            // 3 pixels
            let off = apart(&found.contour, &expected.contour);
            assert!(off < 1e-3, "{off}");
            assert!(found.is_outline());
        }
    }
}

#[test]
fn what_a_mask_leaves_out_has_no_influence() {
    let levels = disc(CENTER, 22.0);
    let start = Contour::circle(CENTER, 26.0);
    // far from the disc, as far as the Gaussian goes
    let far = |x: usize, y: usize| DVec2::new(x as f64, y as f64).distance(CENTER) < 36.0;
    let valid = Array2::from_shape_fn((91, 97), |(y, x)| far(x, y));
    let mut wild = levels.clone();
    for ((y, x), level) in wild.indexed_iter_mut() {
        if !far(x, y) {
            *level = if (x + y) % 7 == 0 { 9000.0 } else { f64::NAN };
        }
    }
    let options = Options {
        sigma: 1.0,
        ..whole()
    };
    let masked = |levels| Image::grey(levels).with_mask(valid.clone()).unwrap();
    let tame = fit(&masked(levels), &start, &options).unwrap();
    let wild = fit(&masked(wild), &start, &options).unwrap();
    assert_eq!(tame, wild);
    assert!(tame.is_outline());
    assert!(
        Image::grey(disc(CENTER, 22.0))
            .with_mask(Array2::from_elem((3, 3), true))
            .is_err()
    );
    let grids = [(4, 4), (4, 5), (4, 4)].map(field::Grid::zeros);
    assert!(Image::color(grids).is_err());
}
