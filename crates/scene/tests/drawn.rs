//! Pictures that a scene draws from numbers.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

#[test]
fn a_drawn_disc_has_its_area_and_its_noise() {
    let text = |noise: f64, seed: u64| {
        format!(
            "title = \"a\"\n[picture.drawn]\nsize = [64, 64]\nnoise = {noise:?}\nseed = {seed}\n\
             region = {{ circle = {{ center = [31.5, 31.5], radius = 20.25 }} }}\n\
             [snake]\nnodes = 9\ntopology = \"closed\"\n\
             start = {{ circle = {{ center = [32.0, 32.0], radius = 5.0 }} }}\n\
             [material]\ntether = 0.0\ntension = 1.0\nrigidity = 1.0\n\
             [densities]\nmass = 1.0\ndamping = 1.0\n[run]\ndt = 0.1\nsteps = 1\n"
        )
    };
    let picture = |noise, seed| {
        let scene =
            scene::Scene::parse("a", &text(noise, seed), std::path::Path::new(".")).unwrap();
        scene.picture.unwrap().levels().clone()
    };
    let plain = picture(0.0, 0);
    let area: f64 = plain.iter().map(|v| (v - 60.0) / 140.0).sum();
    let exact = std::f64::consts::PI * 20.25 * 20.25;
    // shares are of 64 points, levels whole: about 130 border pixels, each off by 1/140 at random
    assert!((area - exact).abs() < 1.0, "area {area}, should be {exact}");
    let noisy = picture(5.0, 7);
    assert_eq!(noisy, picture(5.0, 7));
    assert_ne!(noisy, picture(5.0, 8));
    let n = noisy.len() as f64;
    let difference = &noisy - &plain;
    let mean = difference.sum() / n;
    let spread = (difference.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / n).sqrt();
    // the mean of 4096 numbers of spread 5 is within four of its own spreads, 5/64, of zero
    assert!(mean.abs() < 4.0 * 5.0 / 64.0, "mean {mean}");
    assert!((spread - 5.0).abs() < 0.25, "spread {spread}");
}
