//! Pictures and contours that will not do: one line, code 2, nothing written.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::{Folder, disc, float_tiff, png_head, scene};

/// A contour inside the disc's picture.
const CIRCLE: &str = "10,30\n30,10\n50,30\n30,50\n";

/// Give a picture to every command that reads one.
fn picture(name: &str, bytes: &[u8], says: &[&str]) {
    let folder = Folder::new();
    folder.write(name, bytes);
    folder.write("c.csv", CIRCLE);
    let naming = [&[name], says].concat();
    folder.refused(&["field", name, "--out", "out"], &naming);
    folder.refused(&["fit", name, "--from", "c.csv", "--out", "o.csv"], &naming);
    let text = scene(&[("[snake]", &format!("[picture]\nfile = \"{name}\"\n[snake]"))]);
    folder.write("s.toml", text);
    folder.refused(&["run", "s.toml", "--record", "r.csv"], &naming);
}

#[test]
fn an_empty_picture_is_refused() {
    picture("a.png", b"", &["is empty", "PNG"]);
}

#[test]
fn a_truncated_picture_is_refused() {
    let whole = disc(64, [31.5, 31.5], 12.0);
    for part in [3, 10, 14, 1000, whole.len() - 1] {
        picture("a.pgm", &whole[..part], &["cannot be decoded", "needed"]);
    }
    let png = png_head(64, 64);
    for part in [8, 20, png.len()] {
        picture("a.png", &png[..part], &["cannot be decoded", "needed"]);
    }
    picture(
        "a.jpg",
        b"\xff\xd8\xff\xe0\x00\x10JFIF\x00",
        &["cannot be decoded"],
    );
    let tiff = float_tiff(4, 4, &[0.5; 16]);
    for part in [8, 60, tiff.len() - 5] {
        picture("a.tiff", &tiff[..part], &["cannot be decoded"]);
    }
}

#[test]
fn a_text_named_png_and_a_picture_of_another_format_are_refused() {
    picture(
        "a.png",
        b"title = \"no picture\"\n",
        &["not a picture", "PNG, JPEG, TIFF, PGM"],
    );
    picture(
        "a.png",
        b"GIF89a\x01\x00\x01\x00\x00\x00\x00;",
        &["format gif", "PNG, JPEG, TIFF, PGM"],
    );
    picture("a.png", &[0xE5; 4096], &["not a picture"]);
}

#[test]
fn a_picture_of_one_pixel_or_one_row_is_one_without_a_force() {
    for (width, height) in [(1, 1), (1, 40), (40, 1), (2, 40), (3, 3)] {
        let folder = Folder::new();
        let mut bytes = format!("P5 {width} {height} 255\n").into_bytes();
        bytes.extend(vec![7; width * height]);
        folder.write("a.pgm", &bytes);
        let answer = folder.snake(&["field", "a.pgm", "--out", "out", "--all"]);
        assert_eq!(answer.code, Some(0), "{width}×{height}: {answer:?}");
        let corner = format!("0,0\n{0},0\n{0},{1}\n0,{1}\n", width - 1, height - 1);
        folder.write("c.csv", corner);
        let fit = [
            "fit", "a.pgm", "--from", "c.csv", "--method", "motion", "--out", "o.csv",
        ];
        let answer = folder.snake(&fit);
        // there may be no room for a curve: refused, or run against the border; both are said
        assert!(
            answer.code.is_some_and(|code| code < 3),
            "{width}×{height}: {answer:?}"
        );
        assert!(!answer.err.contains("panicked"), "{answer:?}");
        let noted = answer
            .err
            .contains("note: the picture is the same everywhere");
        assert!(noted || answer.code == Some(2), "{answer:?}");
    }
    picture("a.pgm", b"P5 0 9 255\n", &["at least one pixel"]);
}

#[test]
fn a_picture_that_claims_to_be_huge_is_refused_without_its_memory() {
    picture(
        "a.png",
        &png_head(60_000, 60_000),
        &["60000×60000", "at most"],
    );
    picture(
        "a.pgm",
        b"P5 60000 60000 255\n",
        &["60000×60000", "at most"],
    );
    picture("a.pgm", b"P5 4000000000 4000000000 65535\n", &["at most"]);
    picture(
        "a.tiff",
        &float_tiff(60_000, 60_000, &[0.5; 9]),
        &["60000×60000", "at most"],
    );
}

#[test]
fn a_picture_with_a_number_that_is_none_is_refused_by_its_pixel() {
    let mut pixels = [0.5; 16];
    pixels[6] = f32::NAN;
    picture(
        "a.tiff",
        &float_tiff(4, 4, &pixels),
        &["pixel (2, 1) is NaN"],
    );
    pixels[6] = f32::INFINITY;
    picture(
        "a.tiff",
        &float_tiff(4, 4, &pixels),
        &["pixel (2, 1) is inf"],
    );
}

#[test]
fn a_missing_picture_or_a_folder_is_refused() {
    let folder = Folder::new();
    folder.write("c.csv", CIRCLE);
    std::fs::create_dir(folder.path("d")).unwrap();
    for (name, says) in [("no.png", "No such file"), ("d", "directory")] {
        folder.refused(&["field", name, "--out", "out"], &[name, says]);
    }
    folder.refused(
        &["fit", "no.png", "--from", "c.csv"],
        &["no.png", "No such file"],
    );
    folder.refused(&["fit", "d", "--from", "c.csv"], &["--out-dir", "folder"]);
    let empty = ["fit", "d", "--from", "c.csv", "--out-dir", "o"];
    folder.refused(&empty, &["d holds no picture"]);
    let text = scene(&[("[snake]", "[picture]\nfile = \"no.png\"\n[snake]")]);
    folder.write("s.toml", text);
    folder.refused(&["run", "s.toml"], &["s.toml", "no.png", "No such file"]);
}

/// Fit a contour of this text into a sound picture.
fn contour(bytes: impl AsRef<[u8]>, more: &[&str], says: &[&str]) {
    let folder = Folder::new();
    folder.write("a.pgm", disc(61, [30.0, 30.0], 12.0));
    folder.write("c.csv", bytes.as_ref());
    let args = [
        "fit",
        "a.pgm",
        "--from",
        "c.csv",
        "--method",
        "motion",
        "--out",
        "o.csv",
        "--overlay",
        "o.png",
    ];
    folder.refused(&[&args, more].concat(), says);
    let args = ["fit", "a.pgm", "--from", "-", "--method", "motion"];
    folder.refused_reading(&[&args, more].concat(), bytes, &says[1..]);
}

#[test]
fn a_contour_that_is_none_is_refused_by_its_line() {
    for (text, says) in [
        ("", ["c.csv", "no points"]),
        ("x,y\n", ["c.csv", "no points"]),
        ("x,y\n1,2\n3,apple\n", ["c.csv", "line 3"]),
        ("1,2\n3,NaN\n", ["c.csv", "line 2"]),
        ("1,2\ninf,4\n", ["c.csv", "line 2"]),
        ("1,2\n3,1e300\n", ["c.csv", "line 2"]),
        ("1,2\n3\n", ["c.csv", "line 2"]),
        ("# contour 7\n1,2\n", ["c.csv", "line 1"]),
        ("title = \"no contour\"\n", ["c.csv", "line 1"]),
    ] {
        contour(text, &[], &says);
    }
    contour([0x80, 0xFF, 0x00, 0x13], &[], &["c.csv", "not text"]);
}

#[test]
fn too_few_points_or_nodes_are_refused() {
    contour("10,30\n", &[], &["--from", "at least 3 points", "got 1"]);
    contour("10,30\n30,10\n", &[], &["--from", "at least 3 points"]);
    contour(
        "10,30\n30,10\n10,30\n",
        &[],
        &["--from", "at least 3 points"],
    );
    contour("10,30\n", &["--open"], &["--from", "at least 2 points"]);
    contour(
        CIRCLE,
        &["--nodes", "4"],
        &["--nodes", "at least 5 nodes, got 4"],
    );
    contour(CIRCLE, &["--nodes", "0"], &["--nodes", "at least 5 nodes"]);
    contour(
        CIRCLE,
        &["--nodes", "2", "--open"],
        &["--nodes", "at least 3 nodes"],
    );
    contour(
        CIRCLE,
        &["--nodes", "100000000000"],
        &["--nodes", "at most 1048576"],
    );
}

#[test]
fn coincident_points_are_refused_and_a_double_click_is_not() {
    contour(
        "10,30\n10,30\n10,30\n10,30\n",
        &[],
        &["--from", "(10, 30)", "move one"],
    );
    let folder = Folder::new();
    folder.write("a.pgm", disc(61, [30.0, 30.0], 12.0));
    folder.write("c.csv", "15,30\n15,30\n30,15\n45,30\n30,45\n30,45\n");
    let answer = folder.snake(&["fit", "a.pgm", "--from", "c.csv", "--steps", "5"]);
    assert_eq!(answer.code, Some(1), "{answer:?}");
    assert!(!answer.out.contains("NaN"), "{answer:?}");
}

#[test]
fn a_contour_outside_the_picture_is_refused_by_its_point() {
    contour(
        "10,30\n30,10\n99,30\n",
        &[],
        &[
            "--from",
            "point 2 at (99.00, 30.00)",
            "61×61",
            "x from 0 to 60",
        ],
    );
}

#[test]
fn numbers_of_a_fit_that_make_no_sense_are_refused_by_their_flag() {
    for flag in [
        "--tether",
        "--tension",
        "--rigidity",
        "--damping",
        "--sigma",
        "--strength",
        "--dt",
    ] {
        for value in ["nan", "inf", "-1"] {
            contour(
                CIRCLE,
                &[flag, value],
                &[flag, "above 0"].map(|s| {
                    if s == "above 0"
                        && matches!(flag, "--tether" | "--tension" | "--rigidity" | "--damping")
                    {
                        "at least 0"
                    } else {
                        s
                    }
                }),
            );
        }
    }
    contour(CIRCLE, &["--sigma", "0"], &["--sigma", "above 0"]);
    contour(CIRCLE, &["--sigma", "1e4000"], &["--sigma"]);
    contour(CIRCLE, &["--sigma", "9999999"], &["--sigma", "at most"]);
    contour(CIRCLE, &["--dt", "100"], &["--dt", "largest stable step"]);
    contour(
        CIRCLE,
        &["--steps", "99999999999999"],
        &["--steps", "at most 1000000000"],
    );
}

#[test]
fn numbers_of_a_field_that_make_no_sense_are_refused_by_their_flag() {
    let folder = Folder::new();
    folder.write("a.pgm", disc(61, [30.0, 30.0], 12.0));
    for (flag, value, says) in [
        ("--sigma", "nan", "above 0"),
        ("--sigma", "-3", "above 0"),
        ("--sigma", "1e9", "at most"),
        ("--passes", "4000000000", "at most"),
    ] {
        folder.refused(
            &["field", "a.pgm", "--out", "out", flag, value],
            &[flag, says],
        );
    }
}
