//! How a run ended, and whether what it found is an outline: words and exit codes.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::{Folder, disc, scene};

fn circle(center: [f64; 2], radius: f64, count: u32) -> String {
    let points = (0..count).map(|i| {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(count);
        let (sin, cos) = angle.sin_cos();
        format!(
            "{},{}\n",
            center[0] + radius * cos,
            center[1] + radius * sin
        )
    });
    format!("x,y\n{}", points.collect::<String>())
}

/// Code and words of a fit of a disc of radius 16 at (50, 50), of contrast 140.
fn fit(start: &str, flags: &[&str]) -> (Option<i32>, String) {
    let folder = Folder::new();
    folder.write("a.pgm", disc(101, [50.0, 50.0], 16.0));
    folder.write("c.csv", start);
    let answer = folder.snake(
        &[
            &[
                "fit", "a.pgm", "--from", "c.csv", "--method", "motion", "--out", "f.csv",
            ],
            flags,
        ]
        .concat(),
    );
    (answer.code, answer.err)
}

fn says(answer: &(Option<i32>, String), code: i32, part: &str) {
    assert!(
        answer.0 == Some(code) && answer.1.contains(part),
        "{part}: {answer:?}"
    );
}

#[test]
fn an_outline_on_its_edge_is_a_success_with_its_measures() {
    let found = fit(&circle([51.0, 49.0], 19.0, 12), &[]);
    says(&found, 0, "100 % held by the picture, area ");
}

#[test]
fn a_curve_that_nothing_holds_is_no_outline() {
    for (start, flags) in [
        (circle([50.0, 50.0], 45.0, 20), &[][..]),
        (
            circle([50.0, 50.0], 20.0, 20),
            &["--polarity", "dark-to-bright"],
        ),
        (circle([50.0, 50.0], 4.0, 20), &["--sigma", "1"]),
    ] {
        says(&fit(&start, flags), 1, "no boundary here");
    }
}

#[test]
fn a_curve_that_loses_its_area_or_turns_over_is_no_outline() {
    // half a disc at the border of the picture: the straight side has no edge
    let folder = Folder::new();
    folder.write("half.pgm", disc(81, [0.0, 40.0], 20.0));
    let mut text = String::from("x,y\n0,20\n");
    for i in 1..20 {
        let angle = std::f64::consts::PI * (f64::from(i) / 20.0 - 0.5);
        text += &format!("{},{}\n", 20.0 * angle.cos(), 40.0 + 20.0 * angle.sin());
    }
    text += "0,60\n";
    folder.write("c.csv", text);
    let answer = folder.snake(&[
        "fit", "half.pgm", "--from", "c.csv", "--method", "motion", "--out", "f.csv",
    ]);
    says(&(answer.code, answer.err), 1, "collapsed");
    let turned = fit(&circle([50.0, 50.0], 24.0, 20), &["--balloon", "-3"]);
    assert_eq!(turned.0, Some(1), "{turned:?}");
}

#[test]
fn a_bar_thinner_than_the_smoothing_is_told() {
    let folder = Folder::new();
    let mut bytes = b"P5 160 60 255\n".to_vec();
    for y in 0..60 {
        for x in 0..160 {
            let inside = (30..=130).contains(&x) && (29..=31).contains(&y);
            bytes.push(if inside { 200 } else { 40 });
        }
    }
    folder.write("bar.pgm", bytes);
    folder.write("c.csv", "x,y\n29,27\n131,27\n131,33\n29,33\n");
    let answer = folder.snake(&[
        "fit", "bar.pgm", "--from", "c.csv", "--method", "motion", "--out", "f.csv",
    ]);
    says(&(answer.code, answer.err), 0, "the smoothing resolves 7.9");
}

#[test]
fn another_step_takes_the_same_time_and_keeps_the_same_moments() {
    let folder = Folder::new();
    folder.write("s.toml", scene(&[("steps = 5", "steps = 50")]));
    let times = |dt: &[&str]| {
        let args = [&["run", "s.toml", "--record", "r.csv", "--every", "10"], dt].concat();
        let answer = folder.snake(&args);
        assert_eq!(answer.code, Some(0), "{answer:?}");
        answer.err
    };
    let usual = times(&[]);
    assert!(
        usual.contains("finished after 50 steps, t = 0.500000"),
        "{usual}"
    );
    let fine = times(&["--dt", "0.005"]);
    assert!(
        fine.contains("finished after 100 steps, t = 0.500000"),
        "{fine}"
    );
    let coarse = times(&["--dt", "0.05"]);
    assert!(
        coarse.contains("finished after 10 steps, t = 0.500000"),
        "{coarse}"
    );
    let counted = times(&["--dt", "0.05", "--steps", "3"]);
    assert!(
        counted.contains("finished after 3 steps, t = 0.150000"),
        "{counted}"
    );
}
