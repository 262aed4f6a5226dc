//! What `snake fit` leaves behind besides outlines: the page of all pictures, what is known of each node, how an outline
//! was found, how firmly the picture holds it; pictures named by patterns.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

mod common;

use common::{Folder, disc};
use serde_json::Value;

const PICTURE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/tests/data/objects/nucleus_442c4eb0.png"
);
const MASK: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/tests/data/objects/nucleus_442c4eb0_mask.png"
);

const SIZE: usize = 96;
const CENTER: [f64; 2] = [47.3, 45.6];
const RADIUS: f64 = 26.0;
const START: &str = "circle:48,46,28";

fn blank() -> Vec<u8> {
    [
        format!("P5 {SIZE} {SIZE} 255\n").as_bytes(),
        &[60; SIZE * SIZE],
    ]
    .concat()
}

/// The disc, its ground as bright as itself left of its middle.
fn faded() -> Vec<u8> {
    let mut bytes = disc(SIZE, CENTER, RADIUS);
    let head = bytes.len() - SIZE * SIZE;
    for (at, level) in bytes[head..].iter_mut().enumerate() {
        if at % SIZE < 47 {
            *level = 200;
        }
    }
    bytes
}

fn text(folder: &Folder, name: &str) -> String {
    std::fs::read_to_string(folder.path(name)).unwrap()
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

/// Whether a number of a JSON, which is read to a part in 1e15 or so, is that one.
fn near(value: &Value, number: f64) -> bool {
    value
        .as_f64()
        .is_some_and(|value| (value - number).abs() < 1e-9)
}

#[test]
fn a_page_has_what_was_refused_first_and_then_the_least_sure() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("in")).unwrap();
    folder.write("in/a_sharp.pgm", disc(SIZE, CENTER, RADIUS));
    folder.write("in/b_blank.pgm", blank());
    folder.write("in/c_broken.png", b"\x89PNG\r\n\x1a\nnothing more");
    folder.write("in/d_faded.pgm", faded());
    let args = [
        "fit",
        "in",
        "--from",
        START,
        "--out-dir",
        "out",
        "--sheet",
        "s.html",
    ];
    let answer = folder.snake(&args);
    assert_eq!(answer.code, Some(1), "{}", answer.err);
    let page = text(&folder, "s.html");
    let at = |part: &str| page.find(part).unwrap_or(usize::MAX);
    let order = [
        "<h1>Outlines of 4 pictures</h1>",
        ">Refused (1)</h2>",
        "c_broken.png</strong>: ",
        ">Unsure (1)</h2>",
        "<h3>b_blank.pgm</h3>",
        ">Found (2)</h2>",
    ];
    assert!(
        order.map(at).is_sorted() && at(order[5]) < page.len(),
        "{answer:?}"
    );
    let strengths = page.split("<dt>edge of four fifths</dt><dd>").skip(1);
    let strengths: Vec<f64> = strengths.map(|rest| rest[..4].parse().unwrap()).collect();
    assert!(
        strengths.is_sorted() && strengths.len() == 3,
        "{strengths:?}"
    );
    assert_eq!(page.matches("<img ").count(), 3);
    assert_eq!(page.matches("src=\"data:image/").count(), 3);
    assert!(page.contains("alt=\"a_sharp.pgm with its starts and outlines: found\""));
    assert!(page.contains("<dt>on an edge</dt><dd>100 %</dd>"));
    // whatever the number of threads, and with what was there already named as such
    let again = folder.snake(&[&args[..], &["--jobs", "1"]].concat());
    assert_eq!((again.code, text(&folder, "s.html")), (Some(1), page));
    folder.snake(&[&args[..], &["--resume"]].concat());
    assert!(text(&folder, "s.html").contains(">There already (3)</h2>"));
    // one picture has a page too
    let one = folder.snake(&[
        "fit",
        "in/a_sharp.pgm",
        "--from",
        START,
        "-o",
        "a.csv",
        "--sheet",
        "one.html",
    ]);
    assert_eq!(one.code, Some(0), "{}", one.err);
    assert!(text(&folder, "one.html").contains("<h1>Outlines of a picture</h1>"));
    let wrong = [
        "fit",
        "in",
        "--from",
        START,
        "--out-dir",
        "new",
        "--sheet",
        "s.png",
    ];
    folder.refused(&wrong, &["--sheet: ", "must end in .html"]);
}

#[test]
fn what_is_known_of_each_node_is_written_beside_it_and_read_over() {
    let folder = Folder::new();
    folder.write("d.pgm", disc(SIZE, CENTER, RADIUS));
    let plain = folder.snake(&["fit", "d.pgm", "--from", START]);
    // a start that runs the other way round gives an outline that does
    let back = "polygon:48,18,28,26,20,46,28,66,48,74,68,66,76,46,68,26";
    for start in [START, back] {
        let args = ["fit", "d.pgm", "--from", start, "--evidence"];
        let answer = folder.snake(&[&args[..], &["-o", "e.csv", "--json"]].concat());
        assert_eq!(answer.code, Some(0), "{}", answer.err);
        let table = text(&folder, "e.csv");
        assert!(table.starts_with("# contour 1, closed\nx,y,error,edge\n"));
        let rows: Vec<Vec<f64>> = table
            .lines()
            .skip(2)
            .map(|line| {
                line.split(',')
                    .map(|entry| entry.parse().unwrap())
                    .collect()
            })
            .collect();
        for row in &rows {
            let off = (row[0] - CENTER[0]).hypot(row[1] - CENTER[1]) - RADIUS;
            assert!(
                off.abs() < 0.1 && row[2] > 0.0 && row[2] < 0.2 && row[3] > 0.5,
                "{row:?}"
            );
        }
        let told = json(&answer.out);
        let nodes = told["evidence"].as_array().unwrap();
        assert_eq!(nodes.len(), rows.len());
        assert!(
            nodes
                .iter()
                .zip(&rows)
                .all(|(node, row)| near(&node["edge"], row[3]) && near(&node["error"], row[2]))
        );
        // the same numbers at the same places of a ring that may run the other way
        folder.snake(&[&args[..], &["-o", "e.geojson"]].concat());
        let written = json(&text(&folder, "e.geojson"));
        let feature = &written["features"][0];
        let ring = feature["geometry"]["coordinates"][0].as_array().unwrap();
        assert_eq!(ring.len(), rows.len() + 1);
        for (i, error) in feature["properties"]["node_error"]
            .as_array()
            .unwrap()
            .iter()
            .enumerate()
        {
            let place = |k: usize| ring[i][k].as_f64().unwrap() - 0.5;
            let row = rows
                .iter()
                .find(|row| (row[0] - place(0)).hypot(row[1] - place(1)) < 1e-9);
            assert!(near(error, row.unwrap()[2]), "{error}");
        }
        if start == START {
            // without them it is what it is without the flag
            let bare: Vec<String> = table
                .lines()
                .map(|line| match line.split(',').collect::<Vec<_>>()[..] {
                    [x, y, _, _] => format!("{x},{y}"),
                    _ => line.to_owned(),
                })
                .collect();
            assert_eq!(bare.join("\n") + "\n", plain.out);
        }
        let again = folder.snake(&["fit", "d.pgm", "--from", "e.csv", "-o", "again.csv"]);
        assert_eq!(again.code, Some(0), "{}", again.err);
        // many outlines in one table
        folder.write(
            "two.csv",
            "x,y,curve\n20,20,a\n76,20,a\n76,74,a\n20,74,a\n22,20,b\n76,20,b\n76,74,b\n",
        );
        let two = folder.snake(&["fit", "d.pgm", "--from", "two.csv", "--evidence"]);
        assert!(two.out.contains("\nx,y,curve,error,edge\n"), "{}", two.out);
    }
    // no step, no error: an entry that is empty
    folder.write("b.pgm", blank());
    let none = folder.snake(&["fit", "b.pgm", "--from", START, "--evidence"]);
    assert!(
        none.out.lines().last().unwrap().ends_with(",,0"),
        "{}",
        none.out
    );
    folder.refused(
        &["fit", "d.pgm", "--seeds", "auto", "--evidence"],
        &["--evidence"],
    );
}

#[test]
fn a_plucked_outline_is_firm_where_it_has_an_edge() {
    let folder = Folder::new();
    folder.write("sharp.pgm", disc(SIZE, CENTER, RADIUS));
    folder.write("faded.pgm", faded());
    folder.write("blank.pgm", blank());
    let circle = format!("circle:{},{},{RADIUS}", CENTER[0], CENTER[1]);
    let told = |picture: &str, more: &[&str]| {
        let mut args = vec![
            "fit",
            picture,
            "--from",
            &circle,
            "--json",
            "-o",
            "o.geojson",
        ];
        // where there is no edge it is to stay about the start
        for rule in ["unsure=0", "pure=1", "region=0", "tether=50", "around=1"] {
            args.extend(["--set", rule]);
        }
        let answer = folder.snake(&[&args[..], more].concat());
        assert!(answer.code.unwrap() < 2, "{answer:?}");
        (json(&answer.out)["pluck"].clone(), answer.err)
    };
    let (sharp, said) = told("sharp.pgm", &["--pluck", "--explain"]);
    assert_eq!(
        (sharp["kick"].as_f64(), sharp["firm"].as_f64()),
        (Some(2.0), Some(1.0))
    );
    assert!(
        said.contains("plucked by 2 pixels: 100 % firm") && said.contains("stretch 1 at "),
        "{said}"
    );
    assert!(text(&folder, "o.geojson").contains("\"firm\":1"));
    let (blank, _) = told("blank.pgm", &["--pluck=3"]);
    assert_eq!(
        (blank["kick"].as_f64(), blank["firm"].as_f64()),
        (Some(3.0), Some(0.0))
    );
    assert_eq!(told("sharp.pgm", &[]).0, Value::Null);
    let (faded, _) = told("faded.pgm", &["--pluck", "--overlay", "seen.png"]);
    for stretch in faded["stretches"].as_array().unwrap() {
        let (x, firmness) = (
            stretch["x"].as_f64().unwrap(),
            stretch["firmness"].as_f64().unwrap(),
        );
        if x > 60.0 {
            assert!(firmness > 0.8, "{stretch}");
        }
        if x < 26.0 {
            assert!(firmness < 0.2, "{stretch}");
        }
    }
    // blue where it is firm, and not blue where it is loose
    let seen = io::Picture::load(&folder.path("seen.png")).unwrap();
    let zoom = seen.size().0 as f64 / SIZE as f64;
    assert!(zoom > 4.0);
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a place in the picture"
    )]
    let blue = |p: &Value| {
        let place = |name: &str| (zoom * p[name].as_f64().unwrap()) as usize;
        (0..9).any(|k| {
            let [r, _, b] = seen.color_at(place("x") - 4 + k, place("y"));
            b > 150.0 && r < 60.0
        })
    };
    for stretch in faded["stretches"].as_array().unwrap() {
        let x = stretch["x"].as_f64().unwrap();
        if !(30.0..=60.0).contains(&x) {
            assert_eq!(blue(stretch), x > 60.0, "{stretch}");
        }
    }
    for (kick, says) in [
        ("0", "--pluck: must be"),
        ("-1", "--pluck: must be"),
        ("30", "three sigma"),
    ] {
        let flag = format!("--pluck={kick}");
        folder.refused(
            &["fit", "sharp.pgm", "--from", START, &flag, "-o", "r.csv"],
            &[says],
        );
    }
    // each of many objects
    folder.write("in.csv", format!("x,y\n{},{}\n", CENTER[0], CENTER[1]));
    let many = folder.snake(&[
        "fit",
        "sharp.pgm",
        "--seeds",
        "in.csv",
        "--pluck",
        "--json",
        "-o",
        "m.csv",
    ]);
    assert_eq!(
        json(&many.out)["outlines"][0]["pluck"]["firm"],
        1.0,
        "{}",
        many.err
    );
}

#[test]
fn how_an_outline_was_found_is_shown_and_recorded() {
    let folder = Folder::new();
    folder.write("d.pgm", disc(SIZE, CENTER, RADIUS));
    let frames = |name: &str| {
        let bytes = std::fs::read(folder.path(name)).unwrap();
        assert!(bytes.starts_with(b"GIF89a") && bytes.ends_with(b";"));
        bytes
            .windows(3)
            .filter(|three| *three == [0x21, 0xF9, 4])
            .count()
    };
    let searched = folder.snake(&[
        "fit",
        PICTURE,
        "--from",
        MASK,
        "-o",
        "s.csv",
        "--animation",
        "s.gif",
        "--explain",
    ]);
    assert!(searched.code.unwrap() < 2, "{}", searched.err);
    // the start, each curve, the one taken, the outline
    let curves = searched.err.matches("taken\n").count();
    assert_eq!(frames("s.gif"), 3 + curves, "{}", searched.err);
    let moved = folder.snake(&[
        "fit",
        "d.pgm",
        "--from",
        START,
        "--method",
        "motion",
        "-o",
        "m.csv",
        "--animation",
        "m.gif",
        "--record",
        "m.jsonl",
    ]);
    assert_eq!(moved.code, Some(0), "{}", moved.err);
    let record = text(&folder, "m.jsonl");
    let lines: Vec<Value> = record.lines().map(json).collect();
    assert_eq!(
        (&lines[0]["snake_record"], &lines[0]["closed"]),
        (&Value::from(1), &Value::from(true))
    );
    let (first, last) = (&lines[1], &lines[lines.len() - 2]);
    assert_eq!(first["step"], 0);
    assert_eq!(lines[lines.len() - 1]["outcome"], "settled");
    assert_eq!(lines[lines.len() - 1]["step"], last["step"]);
    assert!(
        lines[1..lines.len() - 1]
            .windows(2)
            .all(|two| two[0]["t"].as_f64() < two[1]["t"].as_f64())
    );
    assert!(frames("m.gif") > 10);
    // the end is the outline, the beginning the start
    let table = text(&folder, "m.csv");
    let end = last["x"].as_array().unwrap();
    assert_eq!(table.lines().count(), 2 + end.len());
    for (line, node) in table.lines().skip(2).zip(end) {
        let (x, y) = line.split_once(',').unwrap();
        assert!(near(&node[0], x.parse().unwrap()) && near(&node[1], y.parse().unwrap()));
    }
    let begin = first["x"][0].as_array().unwrap();
    assert!((begin[0].as_f64().unwrap() - 76.0).abs() < 1e-6);
    // watched or not, it is the same outline
    let unwatched = folder.snake(&["fit", "d.pgm", "--from", START, "--method", "motion"]);
    assert_eq!(unwatched.out, text(&folder, "m.csv"));
    let other = folder.snake(&[
        "fit", "d.pgm", "--from", START, "--method", "motion", "-o", "t.csv", "--record", "r.csv",
    ]);
    assert_eq!(other.code, Some(0));
    assert!(text(&folder, "r.csv").starts_with("# record 1, closed, "));
    // in a folder too
    let all = folder.snake(&[
        "fit",
        "d.pgm",
        "--from",
        START,
        "--out-dir",
        "out",
        "--as",
        "csv,animation",
    ]);
    assert_eq!(all.code, Some(0), "{}", all.err);
    assert!(frames("out/d.gif") >= 4);
    folder.refused(
        &["fit", "d.pgm", "--from", START, "--record", "x.jsonl"],
        &["--record: ", "no motion", "--method motion", "--animation"],
    );
    folder.refused(
        &["fit", "d.pgm", "--from", START, "--animation", "x.png"],
        &["must end in .gif"],
    );
    folder.refused(
        &["fit", "d.pgm", "--seeds", "auto", "--animation", "x.gif"],
        &["--animation"],
    );
    folder.refused(
        &[
            "fit",
            "d.pgm",
            "--seeds",
            "auto",
            "--out-dir",
            "out",
            "--as",
            "animation",
        ],
        &["--as: ", "--seeds"],
    );
    folder.refused(
        &[
            "fit",
            "d.pgm",
            "--from",
            START,
            "--animation",
            "a.gif",
            "--out",
            "a.gif",
        ],
        &["a.gif"],
    );
}

#[test]
fn names_with_stars_are_read_where_no_shell_has_done_it() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("in")).unwrap();
    for name in ["in/b.pgm", "in/a.pgm", "in/[1].pgm"] {
        folder.write(name, disc(SIZE, CENTER, RADIUS));
    }
    folder.write("in/a.txt", "no picture");
    let rest = ["--from", START, "--out-dir", "out"];
    for (pattern, count) in [
        ("in/*.pgm", 3),
        ("in/[ab].pgm", 2),
        ("in/?.pgm", 2),
        ("*", 3),
    ] {
        let answer = folder.snake(&[&["fit", pattern][..], &rest, &["--json"]].concat());
        assert_eq!(answer.code, Some(0), "{pattern}: {}", answer.err);
        assert_eq!(json(&answer.out)["pictures"], count, "{pattern}");
        std::fs::remove_dir_all(folder.path("out")).unwrap();
    }
    // a file that is called so is that file, and one match is one picture
    for one in ["in/[1].pgm", "in/a.p*"] {
        let answer = folder.snake(&["fit", one, "--from", START]);
        assert_eq!(
            (answer.code, answer.out.is_empty()),
            (Some(0), false),
            "{}",
            answer.err
        );
    }
    let none = [&["fit", "in/*.tif"][..], &rest].concat();
    folder.refused(&none, &["picture: no file is called in/*.tif; needed: "]);
    let wrong = [&["fit", "in/a**b"][..], &rest].concat();
    folder.refused(
        &wrong,
        &["picture: in/a**b is neither a file nor a pattern"],
    );
    let two = ["fit", "in/?.pgm", "--from", START];
    folder.refused(&two, &["--out-dir: is needed for several pictures"]);
}
