//! `snake eval` on pictures that are changed, of many objects and drawn; the sheets of the worst.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test: a broken set-up should stop it"
)]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::float_cmp,
    reason = "a test: small whole numbers"
)]

use crate::common::Folder;
use crate::common::discs::{columns, set, start_iou, words};
use io::Picture;

#[test]
fn a_picture_that_is_changed_is_found_again_and_compared() {
    let folder = set();
    for flags in [
        &["--invert"][..],
        &["--turn", "90"],
        &["--turn", "270", "--double"],
        &["--darken", "0.5"],
    ] {
        let answer = folder.snake(&[&["eval", "set", "--quality", "near"], flags].concat());
        assert_eq!(answer.code, Some(0), "{answer:?}");
        assert!(
            answer.out.lines().next().unwrap().ends_with("same"),
            "{answer:?}"
        );
        let row = &words(&answer.out)[0];
        let mean = (0..3).map(|k| start_iou(k, 1.0)).sum::<f64>() / 3.0;
        assert_eq!(
            row[2],
            format!("{mean:.4}"),
            "the start's score is that of the picture as it is"
        );
        let (iou, same): (f64, f64) = (row[3].parse().unwrap(), row[13].parse().unwrap());
        assert!(iou > 0.95 && same > 0.95, "{flags:?}: {answer:?}");
    }
}

#[test]
fn the_worst_are_drawn_on_a_sheet_or_into_a_folder() {
    let folder = set();
    let answer = folder.snake(&["eval", "set", "--worst", "2", "--sheet", "sheet.png"]);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    let lines: Vec<&str> = answer.err.lines().collect();
    assert!(
        lines.len() == 2 && lines[1].starts_with("row 1, column 2: d"),
        "{answer:?}"
    );
    let sheet = Picture::load(&folder.path("sheet.png")).unwrap();
    let (width, height) = sheet.size();
    assert!(
        width > 700 && height > 350 && width < 800 && height < 400,
        "two tiles: {width} {height}"
    );
    // truth, start and result are there in their colors
    let has = |color: [u8; 3]| sheet.display().pixels().any(|pixel| pixel.0 == color);
    assert!(has([0, 190, 0]) && has([86, 180, 233]) && has([230, 97, 1]));
    let answer = folder.snake(&["eval", "set", "--worst", "2", "--sheet", "tiles"]);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    let files = folder.listing();
    let files = files
        .iter()
        .filter(|(path, _)| path.parent().unwrap().ends_with("tiles"));
    assert_eq!(files.count(), 2);
}

#[test]
fn many_objects_are_scored_by_their_labels() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("set")).unwrap();
    let (side, discs) = (120_usize, [([35.0, 40.0], 17.0), ([82.0, 75.0], 20.0)]);
    let far = |at: usize, [x, y]: [f64; 2]| ((at % side) as f64 - x).hypot((at / side) as f64 - y);
    let label = |at: usize| {
        discs
            .iter()
            .position(|(center, radius)| far(at, *center) <= *radius)
    };
    let level = |at: usize| {
        let share = discs
            .iter()
            .map(|(center, radius)| (radius - far(at, *center) + 0.5).clamp(0.0, 1.0));
        (60.0 + 140.0 * share.fold(0.0, f64::max)).round() as u8
    };
    let mut picture = format!("P5 {side} {side} 255\n").into_bytes();
    let mut labels = format!("P5 {side} {side} 65535\n").into_bytes();
    for at in 0..side * side {
        picture.push(level(at));
        labels.extend(label(at).map_or(0, |k| 300 * (k as u16 + 1)).to_be_bytes());
    }
    folder.write("set/a.pgm", &picture);
    folder.write("set/a_labels.pgm", labels);
    folder.write("set/b.pgm", picture);
    folder.write(
        "set/manifest.csv",
        "file,mask,labels\na.pgm,a_mask.pgm,a_labels.pgm\nb.pgm,b_mask.pgm,\n",
    );
    // the seeds' circles are of about half the radius
    let inits = "stem,cx,cy,inner_r\na,35,40,10.2\na,82,75,12.1\n";
    folder.write("set/inits.csv", inits);
    let answer = folder.snake(&["eval", "set", "--each", "each.csv"]);
    assert_eq!(
        (answer.code, answer.err.as_str()),
        (Some(0), ""),
        "{answer:?}"
    );
    let rows = words(&answer.out);
    assert_eq!(rows[0][..3], ["a", "2", "2"], "{answer:?}");
    assert_eq!(rows[0][3..8], ["1.0000"; 5], "{answer:?}");
    assert_eq!(
        rows[1][..8],
        [&["all"], &rows[0][1..8]].concat()[..],
        "of one picture, the mean is its own"
    );
    let each = std::fs::read_to_string(folder.path("each.csv")).unwrap();
    assert!(
        each.lines()
            .nth(1)
            .unwrap()
            .starts_with("a,2,2,1.000000,1.000000,"),
        "{each}"
    );
    // a picture without labels is left out; one seed alone finds one of two
    folder.write(
        "set/inits.csv",
        "stem,cx,cy,inner_r\nb,35,40,9\na,35,40,10.2\na,35,40,-1\n",
    );
    let answer = folder.snake(&["eval", "set"]);
    assert_eq!(answer.code, Some(1), "{answer:?}");
    assert!(
        answer
            .err
            .contains("line 4: inner_r must be above 0, got -1"),
        "{answer:?}"
    );
    assert!(answer.err.contains("b.pgm: has no labels"), "{answer:?}");
    assert_eq!(
        words(&answer.out)[0][..4],
        ["a", "2", "1", "0.5000"],
        "{answer:?}"
    );
    folder.refused(
        &["eval", "set", "--sheet", "s.png"],
        &["--sheet", "many objects"],
    );
    let answer = folder.snake(&["eval", "set", "--seeds", "auto", "--sheet", "drawn"]);
    assert_eq!(
        words(&answer.out)[0][..4],
        ["a", "2", "2", "1.0000"],
        "{answer:?}"
    );
    assert!(folder.path("drawn/a.png").exists());
}

#[test]
fn drawn_pictures_are_scored_below_a_pixel() {
    let folder = Folder::new();
    let answer = folder.snake(&[
        "eval",
        "synthetic",
        "--quality",
        "near",
        "--each",
        "each.csv",
        "--jobs",
        "2",
    ]);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    let each = std::fs::read_to_string(folder.path("each.csv")).unwrap();
    let rows = columns(
        &each,
        &[
            "picture",
            "start",
            "mean_distance",
            "rms",
            "mean_signed",
            "boundary_f",
        ],
    );
    assert_eq!(rows.len(), 4 * 3 * 3 + 16);
    let disk = rows.iter().rfind(|row| row[0] == "disk").unwrap();
    let number = |k: usize| disk[k].parse::<f64>().unwrap();
    // bounds of geometry: the mean's size ≤ the mean size ≤ the root of the mean square
    assert!(
        number(4).abs() <= number(2) + 0.01 && number(2) <= number(3) + 0.01,
        "{disk:?}"
    );
    assert!(number(3) < 0.5 && number(5) == 1.0, "{disk:?}");
    let solved = rows
        .iter()
        .filter(|row| row[5].parse::<f64>().unwrap() > 0.95)
        .count();
    let last = format!("solved: {solved} of {}", rows.len());
    assert_eq!(answer.out.lines().last(), Some(last.as_str()));
}
