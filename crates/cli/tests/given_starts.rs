//! Where `snake fit` starts: files for another picture, of several, of parts; starts out of all measure; what is said.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common;

use crate::common::Folder;

/// Two bright discs, about (30, 30) and (90, 40), as PGM.
fn pair() -> Vec<u8> {
    grey(128, 72, |x, y| {
        let inside = |a: f64, b: f64| (15.5 - (x - a).hypot(y - b)).clamp(0.0, 1.0);
        60.0 + 120.0 * (inside(30.0, 30.0) + inside(90.0, 40.0))
    })
}

fn grey(width: u32, height: u32, level: impl Fn(f64, f64) -> f64) -> Vec<u8> {
    let mut text = format!("P5\n{width} {height}\n255\n").into_bytes();
    for y in 0..height {
        let row = (0..width).map(|x| common::fits::byte(level(f64::from(x), f64::from(y))));
        text.extend(row);
    }
    text
}

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("p.pgm", pair());
    folder
}

fn square(x: f64, y: f64, half: f64) -> String {
    let corners = [
        (-1.0, -1.0),
        (1.0, -1.0),
        (1.0, 1.0),
        (-1.0, 1.0),
        (-1.0, -1.0),
    ];
    let corners = corners.map(|(a, b)| format!("[{},{}]", x + half * a, y + half * b));
    format!("[{}]", corners.join(","))
}

/// Means of the outlines of a table.
fn centers(text: &str) -> Vec<(f64, f64)> {
    let shapes = io::shapes::parse(text).unwrap();
    let mean = |shape: &io::shapes::Shape| {
        let points = shape.first();
        let sum = points
            .iter()
            .fold((0.0, 0.0), |sum, p| (sum.0 + p.x, sum.1 + p.y));
        (sum.0 / points.len() as f64, sum.1 / points.len() as f64)
    };
    shapes.iter().map(mean).collect()
}

fn are_the_pair(text: &str) {
    let centers = centers(text);
    assert_eq!(centers.len(), 2, "{text}");
    for ((x, y), known) in centers.iter().zip([(30.0, 30.0), (90.0, 40.0)]) {
        assert!((x - known.0).hypot(y - known.1) < 1.0, "{x}, {y}");
    }
}

#[test]
fn each_part_is_a_start_and_holes_are_told() {
    let folder = folder();
    let (one, two) = (square(30.0, 30.0, 16.0), square(90.0, 40.0, 16.0));
    let hole = square(30.0, 30.0, 4.0);
    folder.write(
        "parts.geojson",
        format!(r#"{{"type":"MultiPolygon","coordinates":[[{one},{hole}],[{two}]]}}"#),
    );
    let flat = |ring: &str| ring.replace("],[", ",").replace(['[', ']'], "");
    folder.write(
        "parts.json",
        format!(
            r#"{{"annotations":[{{"id":1,"image_id":1,"segmentation":[[{}],[{}]]}}]}}"#,
            flat(&one),
            flat(&two)
        ),
    );
    for (name, holes) in [("parts.geojson", true), ("parts.json", false)] {
        let answer = folder.snake(&["fit", "p.pgm", "--from", name]);
        assert_eq!(answer.code, Some(0), "{name}: {}", answer.err);
        are_the_pair(&answer.out);
        assert_eq!(
            answer.err.contains("1 hole in 1 outline left out"),
            holes,
            "{}",
            answer.err
        );
        let answer = folder.snake(&["fit", "p.pgm", "--from", name, "--out-dir", "out"]);
        assert_eq!(
            answer.err.contains("1 hole in 1 outline left out"),
            holes,
            "{}",
            answer.err
        );
        let answer = folder.snake(&["fit", "p.pgm", "--seeds", name]);
        are_the_pair(&answer.out);
    }
}

#[test]
fn pixels_of_another_size_are_refused_and_soft_masks_are_said_to_be_so() {
    let folder = folder();
    let mask = |x: f64, y: f64| 255.0 * (18.5 - (x - 30.0).hypot(y - 30.0)).clamp(0.0, 1.0);
    folder.write("right.pgm", grey(128, 72, mask));
    folder.write("wrong.pgm", grey(100, 72, mask));
    for flag in ["--from", "--seeds"] {
        let says = ["wrong.pgm", "100×72", "128×72"];
        folder.refused(&["fit", "p.pgm", flag, "wrong.pgm"], &says);
    }
    let answer = folder.snake(&["fit", "p.pgm", "--from", "right.pgm"]);
    assert_eq!(
        (answer.code, centers(&answer.out).len()),
        (Some(0), 1),
        "{}",
        answer.err
    );
    assert!(answer.err.contains("soft mask"), "{}", answer.err);
}

#[test]
fn starts_out_of_all_measure_are_refused_and_wide_ones_are_not() {
    let folder = folder();
    for start in [
        "circle:30,30,1e99",
        "circle:30,30,1e9",
        "circle:30,30,1e6",
        "box:-1e9,-1e9,2e9,2e9",
        "ellipse:30,30,20,1e300",
        "polygon:0,0,1e8,0,0,60",
    ] {
        for method in ["search", "motion"] {
            let args = ["fit", "p.pgm", "--from", start, "--method", method];
            folder.refused(&args, &["--from", "128×72"]);
        }
    }
    folder.write("far.csv", "x,y\n0,0\n1e9,0\n0,1e9\n");
    folder.refused(
        &["fit", "p.pgm", "--from", "far.csv"],
        &["--from", "four times", "512"],
    );
    for start in ["circle:64,36,90", "box:-30,-30,188,132"] {
        let answer = folder.snake(&["fit", "p.pgm", "--from", start]);
        assert_ne!(answer.code, Some(2), "{start}: {}", answer.err);
    }
}

#[test]
fn of_a_file_about_several_pictures_the_own_one_is_taken() {
    let folder = folder();
    let flat = |x: f64, y: f64| {
        square(x, y, 16.0)
            .replace("],[", ",")
            .replace(['[', ']'], "")
    };
    let text = format!(
        r#"{{"images":[{{"id":1,"file_name":"other.png"}},{{"id":2,"file_name":"train/p.pgm"}}],"annotations":[
        {{"id":1,"image_id":1,"segmentation":[[1,1,9,1,9,9]]}},
        {{"id":2,"image_id":2,"segmentation":[[{}]]}},{{"id":3,"image_id":2,"segmentation":[[{}]]}}]}}"#,
        flat(30.0, 30.0),
        flat(90.0, 40.0)
    );
    folder.write("all.json", &text);
    for flag in ["--from", "--seeds"] {
        let answer = folder.snake(&["fit", "p.pgm", flag, "all.json"]);
        assert_eq!(answer.code, Some(0), "{flag}: {}", answer.err);
        are_the_pair(&answer.out);
    }
    folder.write("q.pgm", pair());
    folder.refused(
        &["fit", "q.pgm", "--from", "all.json"],
        &["q.pgm", "other.png, train/p.pgm"],
    );
}

#[test]
fn a_roi_holds_one_outline() {
    let folder = folder();
    folder.write(
        "two.csv",
        "curve,x,y\n1,15,15\n1,45,15\n1,45,45\n1,15,45\n2,75,25\n2,105,25\n2,105,55\n2,75,55\n",
    );
    for more in [&[][..], &["--as", "imagej"]] {
        let args = [&["fit", "p.pgm", "--from", "two.csv", "-o", "x.roi"], more].concat();
        folder.refused(&args, &["--out", "x.roi", ".zip"]);
    }
    let answer = folder.snake(&["fit", "p.pgm", "--seeds", "auto", "-o", "x.roi"]);
    assert_eq!(
        (answer.code, folder.path("x.roi").exists()),
        (Some(2), false),
        "{answer:?}"
    );
    let answer = folder.snake(&["fit", "p.pgm", "--from", "two.csv", "-o", "x.zip"]);
    assert_eq!(answer.code, Some(0), "{}", answer.err);
    let answer = folder.snake(&["fit", "p.pgm", "--from", "circle:30,30,17", "-o", "x.roi"]);
    assert_eq!(answer.code, Some(0), "{}", answer.err);
    assert!(
        std::fs::read(folder.path("x.roi"))
            .unwrap()
            .starts_with(b"Iout")
    );
}

#[test]
fn refusals_say_what_can_be_done_here() {
    let folder = folder();
    let fit = ["fit", "p.pgm", "--from", "circle:30,30,17"];
    for name in ["overlay", "animation"] {
        let args = [&fit[..], &["-o", "x.png", "--as", name]].concat();
        folder.refused(
            &args,
            &[
                &format!("--as: {name} is for --out-dir"),
                &format!("--{name} "),
            ],
        );
    }
    let args = [&fit[..], &["-o", "x.csv", "--as", "paper"]].concat();
    let answer = folder.snake(&args);
    assert!(
        answer.err.contains("deep-labels, got paper"),
        "{}",
        answer.err
    );
    let mut floats = b"Pf\n4 4\n-1.0\n".to_vec();
    (0..16).for_each(|i| floats.extend(if i == 5 { f32::NAN } else { 0.5 }.to_le_bytes()));
    folder.write("nan.pfm", floats);
    let answer = folder.snake(&["fit", "nan.pfm", "--from", "circle:2,2,1"]);
    assert!(
        answer.err.contains("finite") && !answer.err.contains("invalid"),
        "{}",
        answer.err
    );
    let answer = folder.snake(&[&fit[..], &["-o", "none/x.csv"]].concat());
    assert!(
        answer.err.contains("none/x.csv") && !answer.err.contains("being-written"),
        "{}",
        answer.err
    );
    let seeds = folder.write("seed.csv", "x,y\n30,30\n");
    let answer = folder.snake(&[
        "fit",
        "p.pgm",
        "--seeds",
        seeds.to_str().unwrap(),
        "-o",
        "x.csv",
    ]);
    assert!(answer.err.contains("1 object found"), "{}", answer.err);
}

#[test]
fn numbers_of_a_table_keep_their_digits_in_any_unit() {
    let folder = Folder::new();
    // pixels of a twentieth of a thousandth of a millimetre, by the words ImageJ writes
    let text = "ImageJ=1.54f\nunit=m\n\0";
    let mut bytes = b"II*\0".to_vec();
    bytes.extend(8_u32.to_le_bytes());
    let entries: [(u16, u16, u32, u32); 12] = [
        (256, 4, 1, 128),
        (257, 4, 1, 72),
        (258, 4, 1, 8),
        (259, 4, 1, 1),
        (262, 4, 1, 1),
        (270, 2, u32::try_from(text.len()).unwrap(), 200),
        (273, 4, 1, 300),
        (278, 4, 1, 72),
        (279, 4, 1, 128 * 72),
        (282, 5, 1, 240),
        (283, 5, 1, 240),
        (296, 4, 1, 1),
    ];
    bytes.extend(12_u16.to_le_bytes());
    for (tag, kind, count, value) in entries {
        bytes.extend(tag.to_le_bytes());
        bytes.extend(kind.to_le_bytes());
        bytes.extend(count.to_le_bytes());
        bytes.extend(value.to_le_bytes());
    }
    bytes.extend(0_u32.to_le_bytes());
    bytes.resize(200, 0);
    bytes.extend(text.as_bytes());
    bytes.resize(240, 0);
    bytes.extend(40_000_u32.to_le_bytes());
    bytes.extend(1_u32.to_le_bytes());
    bytes.resize(300, 0);
    bytes.extend(&pair()[b"P5\n128 72\n255\n".len()..]);
    folder.write("small.tif", bytes);
    let args = [
        "fit",
        "small.tif",
        "--from",
        "circle:30,30,17",
        "-o",
        "x.csv",
        "--measure",
        "-",
    ];
    let answer = folder.snake(&args);
    let mut lines = answer
        .out
        .lines()
        .map(|line| line.split(',').collect::<Vec<_>>());
    let (names, row) = (lines.next().unwrap(), lines.next().unwrap());
    let of = |name: &str| row[names.iter().position(|known| *known == name).unwrap()];
    let number = |name: &str| of(name).parse::<f64>().unwrap();
    assert_eq!(
        (of("pixel_width"), of("unit")),
        ("0.000025", "m"),
        "{}",
        answer.out
    );
    let share = number("area_unit2") / (number("area_px2") * 0.000_025 * 0.000_025);
    assert!((share - 1.0).abs() < 1e-7, "{share}");
}

#[test]
fn the_page_on_formats_has_the_keys_of_the_line_of_json() {
    let folder = folder();
    let page = include_str!("../../../docs/formats.md");
    let (_, page) = page.split_once("### The line of JSON").unwrap();
    let (page, _) = page.split_once("\n## ").unwrap();
    let words: Vec<&str> = page.split('`').skip(1).step_by(2).collect();
    let start = ["fit", "p.pgm", "-o", "x.csv", "--json", "--pluck", "--from"];
    let one = folder.snake(&[&start[..], &["circle:30,30,17", "--evidence"]].concat());
    let one: serde_json::Value = serde_json::from_str(&one.out).unwrap();
    // what the table of the page has is there
    let table = page
        .lines()
        .filter_map(|line| line.strip_prefix("| `")?.split(" | ").next());
    for name in table.flat_map(|names| names.split(", ")) {
        assert!(one.get(name.trim_matches('`')).is_some(), "{name}");
    }
    // and what is there is on the page
    folder.write(
        "two.csv",
        "curve,x,y\n1,15,15\n1,45,15\n1,30,45\n2,75,25\n2,105,25\n2,90,55\n",
    );
    let several = folder.snake(&[&start[..], &["two.csv"]].concat());
    let seeds = folder.snake(&["fit", "p.pgm", "-o", "x.csv", "--json", "--seeds", "auto"]);
    let many = folder.snake(&[
        "fit",
        "p.pgm",
        "--out-dir",
        "o",
        "--json",
        "--from",
        "two.csv",
    ]);
    let mut waiting = vec![one];
    for answer in [several, seeds, many] {
        waiting.push(serde_json::from_str(&answer.out).unwrap());
    }
    while let Some(value) = waiting.pop() {
        if let serde_json::Value::Object(table) = &value {
            for name in table.keys() {
                assert!(words.contains(&name.as_str()), "{name}");
            }
            waiting.extend(table.values().cloned());
        }
        waiting.extend(value.as_array().into_iter().flatten().cloned());
    }
}

#[test]
fn the_motion_of_the_readme_comes_to_rest() {
    let line = include_str!("../../../README.md")
        .lines()
        .find(|line| line.contains("--force"))
        .unwrap();
    let (command, _) = line.split_once('#').unwrap();
    let mut args: Vec<&str> = command.split_whitespace().skip(1).collect();
    assert_eq!(args[1], "apple.png");
    args[1] = concat!(env!("CARGO_MANIFEST_DIR"), "/../scene/pictures/apple.png");
    let answer = Folder::new().snake(&args);
    assert_eq!(answer.code, Some(0), "{}", answer.err);
}
