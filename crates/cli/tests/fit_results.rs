//! What `snake fit` leaves behind besides outlines: the page of all pictures, what is known of each node; pictures
//! named by patterns.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::fits::{CENTER, RADIUS, SIZE, START, blank, json, near, soft, text};
use crate::common::{Folder, disc};
#[test]
fn a_page_has_what_was_refused_first_and_then_the_least_sure() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("in")).unwrap();
    folder.write("in/a_sharp.pgm", disc(SIZE, CENTER, RADIUS));
    folder.write("in/b_blank.pgm", blank());
    folder.write("in/c_broken.png", b"\x89PNG\r\n\x1a\nnothing more");
    folder.write("in/d_soft.pgm", soft(9.0));
    folder.write("in/e_softer.pgm", soft(16.0));
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
        "<h1>Outlines of 5 pictures</h1>",
        ">Refused (1)</h2>",
        "c_broken.png</strong>: ",
        ">Unsure (1)</h2>",
        "<h3>b_blank.pgm</h3>",
        ">Found (3)</h2>",
    ];
    assert!(
        order.map(at).is_sorted() && at(order[5]) < page.len(),
        "{answer:?}"
    );
    let strengths = page.split("<dt>edge on four fifths</dt><dd>").skip(1);
    let strengths: Vec<f64> = strengths.map(|rest| rest[..4].parse().unwrap()).collect();
    assert!(
        strengths.is_sorted() && strengths.len() == 4 && strengths[3] > strengths[1],
        "{strengths:?}"
    );
    assert_eq!(page.matches("<img ").count(), 4);
    assert_eq!(page.matches("src=\"data:image/").count(), 4);
    assert!(page.contains("alt=\"a_sharp.pgm with its starts and outlines: found\""));
    assert!(page.contains("<dt>on an edge</dt><dd>100 %</dd>"));
    // whatever the number of threads, and with what was there already named as such
    let again = folder.snake(&[&args[..], &["--jobs", "1"]].concat());
    assert_eq!((again.code, text(&folder, "s.html")), (Some(1), page));
    folder.snake(&[&args[..], &["--resume"]].concat());
    assert!(text(&folder, "s.html").contains(">There already (4)</h2>"));
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
