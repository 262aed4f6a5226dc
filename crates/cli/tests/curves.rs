//! Contours as other programs write them, and several of them in one file.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common;

use crate::common::{Folder, disc, scene};

const POINTS: [(f64, f64); 4] = [(15.0, 30.0), (30.0, 14.0), (46.0, 30.0), (30.0, 45.0)];

fn table(heading: &str, line: impl Fn(usize, f64, f64) -> String) -> String {
    let lines = (0..).zip(POINTS).map(|(i, (x, y))| line(i, x, y) + "\n");
    format!("{heading}\n{}", lines.collect::<String>())
}

fn fit(text: &str) -> common::Answer {
    let folder = Folder::new();
    folder.write("a.pgm", disc(61, [30.0, 30.0], 12.0));
    folder.write("c.csv", text);
    folder.snake(&["fit", "a.pgm", "--from", "c.csv"])
}

#[test]
fn a_contour_is_the_same_in_the_columns_of_any_program() {
    let usual = fit(&table("x,y", |_, x, y| format!("{x},{y}")));
    assert_eq!(usual.code, Some(0), "{usual:?}");
    for text in [
        table("y,x", |_, x, y| format!("{y},{x}")),
        table(" \tX\tY", |i, x, y| format!("{i}\t{x}\t{y}")),
        table("row,col", |_, x, y| format!("{y},{x}")),
        table("index,axis-0,axis-1", |i, x, y| format!("{i}.0,{y},{x}")),
        table("index,axis-0,axis-1,axis-2", |i, x, y| {
            format!("{i}.0,5,{y},{x}")
        }),
        table("FRAME,POSITION_X,POSITION_Y", |_, x, y| {
            format!("0,{x},{y}")
        }),
        table("\"x (px)\";\"y (px)\"", |_, x, y| {
            format!("\"{x}\";\"{y}\"")
        }),
        table("# contour drawn by hand\r\nx,y\r", |_, x, y| {
            format!("{x},{y}\r")
        }),
    ] {
        let answer = fit(&text);
        assert_eq!(answer, usual, "{text}");
    }
}

#[test]
fn columns_that_cannot_be_told_are_refused_and_not_shown() {
    for (text, says) in [
        (
            table("x y", |i, x, y| format!("{i} {x} {y}")),
            "line 2: more entries than the 2",
        ),
        (
            table("x,y", |_, x, y| format!("{x},00,{y},00")),
            "line 2: more entries",
        ),
        (
            table("x [um],y [um]", |_, x, y| format!("{x},{y}")),
            "line 1: column 1 is in another unit",
        ),
        (
            table("a,b", |_, x, y| format!("{x},{y}")),
            "line 1: the heading must name",
        ),
        (
            table("0,15,30", |i, x, y| format!("{i},{x},{y}")),
            "more than two entries",
        ),
        ("secret:of:a:file\nmore\n".to_owned(), "line 1"),
        (
            format!("1,2\n{}", ",".repeat(1 << 22)),
            "line 2: more than two entries",
        ),
    ] {
        let answer = fit(&text);
        assert_eq!(answer.code, Some(2), "{answer:?}");
        assert!(answer.err.contains(says), "{says}: {answer:?}");
        assert!(
            answer.err.len() < 200 && !answer.err.contains("secret"),
            "{answer:?}"
        );
    }
    let folder = Folder::new();
    folder.write("a.pgm", disc(61, [30.0, 30.0], 12.0));
    let wide: Vec<u8> = "x,y\n1,2\n"
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    for (bytes, says) in [
        ([&[0xFF, 0xFE][..], &wide].concat(), "UTF-16"),
        (b"# gr\xfc\xdfe\nx,y\n1,2\n".to_vec(), "not UTF-8"),
    ] {
        folder.write("c.csv", bytes);
        folder.refused(&["fit", "a.pgm", "--from", "c.csv"], &["c.csv", says]);
    }
}

/// A scene of two circles, one of them to the right.
fn two() -> String {
    scene(&[]) + "\n[[also]]\nat = [[130.0, 30.0]]\n"
}

#[test]
fn every_curve_of_a_run_is_written_and_read_back() {
    let folder = Folder::new();
    folder.write("two.toml", two());
    let answer = folder.snake(&["run", "two.toml", "--out", "-", "--record", "r.csv"]);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    let curves = scene_curves(&answer.out);
    assert_eq!(curves.len(), 2);
    for (curve, middle) in curves.iter().zip([30.0, 130.0]) {
        assert_eq!(curve.len(), 20);
        let x = curve.iter().map(|p| p.0).sum::<f64>() / 20.0;
        assert!((x - middle).abs() < 0.1, "{x}");
    }
    // a file of several outlines starts several: the second has no edge, which is told
    folder.write("a.pgm", disc(200, [30.0, 30.0], 12.0));
    folder.write("found.csv", &answer.out);
    let fit = ["fit", "a.pgm", "--from", "found.csv"];
    let both = folder.snake(&fit);
    assert_eq!(both.code, Some(1), "{both:?}");
    assert!(
        both.err.contains("outline 1 of 2") && both.out.starts_with("# outline 2: unsure"),
        "{both:?}"
    );
    assert_eq!(io::shapes::parse(&both.out).unwrap().len(), 2);
    for joined in [
        "x,y\n1,2\n3,4\n5,1\n\n11,2\n13,4\n15,1\n",
        "x,y,id\n1,2,a\n3,4,a\n11,2,b\n13,4,b\n",
    ] {
        folder.write("found.csv", joined);
        // small ones without an edge, and ones of too few points
        let answer = folder.snake(&fit);
        assert!(
            answer.code != Some(0) && answer.err.contains("outline"),
            "{answer:?}"
        );
    }
}

/// The points of each curve by the column `curve`.
fn scene_curves(text: &str) -> Vec<Vec<(f64, f64)>> {
    let mut curves: Vec<Vec<(f64, f64)>> = Vec::new();
    assert!(
        text.starts_with("# contour 1, closed\nx,y,curve\n"),
        "{text}"
    );
    for line in text.lines().skip(2) {
        let entries: Vec<f64> = line
            .split(',')
            .map(|entry| entry.parse().unwrap())
            .collect();
        let curve = entries[2] as usize;
        curves.resize(curves.len().max(curve), Vec::new());
        curves[curve - 1].push((entries[0], entries[1]));
    }
    curves
}

#[test]
fn a_contour_of_a_scene_that_comes_through_a_pipe_is_read_once() {
    let folder = Folder::new();
    folder.write("c.csv", table("x,y", |_, x, y| format!("{x},{y}")));
    let with = |file: &str| {
        let start = format!("start = {{ file = \"{file}\" }}");
        scene(&[(common::CIRCLE, &start)]) + "\n[[also]]\nvelocity = [0.0, 1.0]\n"
    };
    folder.write("file.toml", with("c.csv"));
    folder.write("pipe.toml", with("/dev/stdin"));
    let usual = folder.snake(&["run", "file.toml", "--out", "-"]);
    assert_eq!(usual.code, Some(0), "{usual:?}");
    let text = std::fs::read(folder.path("c.csv")).unwrap();
    let piped = folder.snake_reading(&["run", "pipe.toml", "--out", "-"], text);
    assert_eq!(piped.out, usual.out, "{piped:?}");
}
