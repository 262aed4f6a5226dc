//! `snake track`: what is refused, and that nothing is written then; an end on the way.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::moving::{START, disc, frames};

#[test]
fn what_makes_no_sense_is_refused_and_nothing_is_written() {
    let folder = frames(2);
    folder.write("t.csv", "mine");
    let refused = |more: &[&str], says: &[&str]| {
        folder.refused(&[&["track", "in", "-q"][..], &START, more].concat(), says);
    };
    refused(
        &["--as", "xml"],
        &["--as: must be one of csv, geojson, coco, ctc, imagej, mot, got xml"],
    );
    refused(
        &["-o", "t.doc"],
        &["--out: t.doc: the ending names no format"],
    );
    refused(
        &["-o", "in/f1.pgm", "--as", "csv"],
        &["in/f1.pgm is a file that is read"],
    );
    refused(
        &["-o", "in", "--as", "ctc"],
        &["in is the folder of the frames"],
    );
    refused(&["-o", "a.csv", "--measure", "a.csv"], &["taken by --out"]);
    refused(
        &["-o", "t.csv", "--no-clobber"],
        &["t.csv is there already"],
    );
    refused(
        &["--overlay", "o.avi"],
        &["--overlay: the name must end in .gif"],
    );
    refused(
        &["--kymograph", "k.gif"],
        &["--kymograph: the name must end in .png or .csv"],
    );
    refused(
        &["--rate", "0"],
        &["--rate: must be from 0.01 to 100, got 0"],
    );
    refused(
        &["--json"],
        &["--json: writes to standard output, and so does --out"],
    );
    refused(
        &["-o", "a.zip", "--resume"],
        &["--resume: goes on with what grows", ".geojson"],
    );
    refused(
        &["-o", "a.csv", "--kymograph", "k.png", "--object", "4"],
        &["no object has the number 4 at first; needed: 1"],
    );
    folder.refused(
        &[
            "track",
            "in",
            "-q",
            "--from",
            "circle:500,500,9",
            "-o",
            "a.csv",
        ],
        &["--from: start 0"],
    );
    folder.refused(
        &["track", "none", "-q", "--from", "circle:20,24,9"],
        &["none: cannot be read: there is no such file"],
    );
    // a film that cannot be leaves no rest of a table
    std::fs::create_dir(folder.path("o.gif.d")).unwrap();
    refused(
        &["-o", "a.csv", "--overlay", "o.gif.d/no/o.gif"],
        &["o.gif.d/no/o.gif: cannot be written"],
    );
    folder.write("in/g1.pgm", disc(1));
    folder.write("in/g2.pgm", disc(2));
    refused(
        &[],
        &[
            "holds two sequences",
            "f0.pgm to f1.pgm (2 files)",
            "g1.pgm to g2.pgm (2 files)",
            "needed",
        ],
    );
    folder.write("cut.pgm", &disc(0)[..40]);
    folder.refused(
        &["track", "cut.pgm", "-q", "--from", "circle:20,24,9"],
        &["first frame: cut.pgm: "],
    );
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_what_was_followed() {
    use std::io::Write as _;
    use std::process::{Command, Stdio};
    let folder = frames(0);
    let mut child = Command::new(env!("CARGO_BIN_EXE_snake"))
        .args(
            [
                &["track", "-"][..],
                &START,
                &["-o", "t.csv", "--overlay", "o.gif"],
            ]
            .concat(),
        )
        .current_dir(folder.path("."))
        .stdin(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = child.stdin.take().unwrap();
    // frames without an end, until nobody reads them any more
    let feeding = std::thread::spawn(move || {
        let mut count = 0;
        while input.write_all(&disc(0)).is_ok() {
            count += 1;
        }
        count
    });
    let part = folder.path("t.csv.part");
    while !std::fs::read_to_string(&part).is_ok_and(|text| text.contains("\n3,1,")) {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let sent = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(sent.unwrap().success());
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(
        said.contains("stopped by Ctrl-C") && feeding.join().unwrap() > 3,
        "{said}"
    );
    let text = std::fs::read_to_string(folder.path("t.csv")).unwrap();
    assert!(
        text.ends_with('\n') && text.contains("\n3,1,") && !part.exists(),
        "{text}"
    );
    assert!(std::fs::read(folder.path("o.gif")).unwrap().ends_with(b";"));
}
