//! `snake fit` over many pictures: going on with a table, pages, what is read in a folder, what is written where.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::Folder;
use crate::common::fits::small_disc;

const START: [&str; 2] = ["--from", "circle:30,24,15"];

fn read(folder: &Folder, name: &str) -> String {
    std::fs::read_to_string(folder.path(name)).unwrap()
}

/// Pictures a to d, of which c is blank.
fn pictures() -> Folder {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("in")).unwrap();
    for (name, contrast) in [("a", 120.0), ("b", 110.0), ("c", 0.0), ("d", 100.0)] {
        folder.write(&format!("in/{name}.pgm"), small_disc(contrast));
    }
    folder
}

#[test]
fn going_on_keeps_the_table_and_knows_what_was_unsure() {
    for formats in ["csv", "geojson", "imagej", "mask"] {
        let folder = pictures();
        let run = |more: &[&str]| {
            let args = [
                &[
                    "fit",
                    "in",
                    "--out-dir",
                    "out",
                    "--measure",
                    "m.csv",
                    "--as",
                    formats,
                ],
                &START[..],
                more,
            ];
            folder.snake(&args.concat())
        };
        let first = run(&[]);
        assert_eq!(first.code, Some(1), "{formats}: {}", first.err);
        let whole = read(&folder, "m.csv");
        assert_eq!(whole.lines().count(), 5, "{whole}");
        // nothing is left to do: the table stays as it is, and so does the answer
        let again = run(&["--resume"]);
        assert_eq!(
            (again.code, read(&folder, "m.csv")),
            (Some(1), whole.clone()),
            "{formats}"
        );
        assert!(
            again.err.contains("4 there already"),
            "{formats}: {}",
            again.err
        );
        assert!(
            again
                .err
                .contains("in/c.pgm: there already, 1 outline unsure"),
            "{}",
            again.err
        );
        // one result is gone: its row stands where it stood
        let gone = folder.listing().into_iter().map(|(path, _)| path);
        let gone = gone.filter(|path| path.parent().unwrap().ends_with("out"));
        for path in gone.filter(|path| path.file_name().unwrap().to_string_lossy().starts_with('b'))
        {
            std::fs::remove_file(path).unwrap();
        }
        let again = run(&["--resume"]);
        assert!(
            again.err.contains("3 there already"),
            "{formats}: {}",
            again.err
        );
        assert_eq!(
            (again.code, read(&folder, "m.csv")),
            (Some(1), whole.clone()),
            "{formats}"
        );
        // a row is gone: its picture is done again
        let lines = whole.lines().filter(|line| !line.starts_with("a.pgm"));
        let cut: String = lines.map(|line| format!("{line}\n")).collect();
        folder.write("m.csv", cut);
        let again = run(&["--resume"]);
        assert!(
            again.err.contains("3 there already"),
            "{formats}: {}",
            again.err
        );
        assert_eq!(read(&folder, "m.csv"), whole, "{formats}");
        // without the blank one all is well
        std::fs::remove_file(folder.path("in/c.pgm")).unwrap();
        assert_eq!(run(&["--resume"]).code, Some(0), "{formats}");
        // whose row is kept nonetheless
        assert_eq!(read(&folder, "m.csv").lines().count(), 5);
    }
}

#[test]
fn going_on_without_a_table_knows_what_was_unsure_by_any_method() {
    for method in ["search", "motion"] {
        for format in ["csv", "geojson", "coco", "labelme", "imagej"] {
            let folder = pictures();
            let args = [
                "fit",
                "in",
                "--out-dir",
                "out",
                "--as",
                format,
                "--method",
                method,
            ];
            let args = [&args[..], &START[..]].concat();
            let first = folder.snake(&args);
            assert_eq!(first.code, Some(1), "{method} {format}: {}", first.err);
            let again = folder.snake(&[&args[..], &["--resume"]].concat());
            assert!(again.err.contains("4 there already"), "{}", again.err);
            assert_eq!(again.code, Some(1), "{method} {format}: {}", again.err);
        }
    }
}

#[test]
fn another_table_is_not_gone_on_with() {
    let folder = pictures();
    folder.write("m.csv", "name,size\na,1\n");
    let args = [
        "fit",
        "in",
        "--out-dir",
        "out",
        "--measure",
        "m.csv",
        "--resume",
    ];
    folder.refused(
        &[&args[..], &START[..]].concat(),
        &["--measure", "m.csv", "columns"],
    );
    let args = [
        "fit",
        "in",
        "--out-dir",
        "out",
        "--measure",
        "-",
        "--resume",
    ];
    folder.refused(
        &[&args[..], &START[..]].concat(),
        &["--measure", "standard output"],
    );
}

#[test]
fn a_table_goes_to_standard_output_as_for_one_picture() {
    let folder = pictures();
    let args = ["fit", "in", "--out-dir", "out", "--measure", "-"];
    let answer = folder.snake(&[&args[..], &START[..]].concat());
    assert_eq!(answer.out.lines().count(), 5, "{answer:?}");
    assert!(!folder.path("-").exists());
    let with_json = [&args[..], &START[..], &["--json"]].concat();
    let answer = folder.snake(&with_json);
    assert_eq!(
        (answer.code, answer.out.as_str()),
        (Some(2), ""),
        "{answer:?}"
    );
    folder.refused(
        &[&["fit", "in", "--out-dir", "-"], &START[..]].concat(),
        &["--out-dir"],
    );
}

#[test]
fn hidden_files_are_no_pictures_of_a_folder_or_a_pattern() {
    let folder = pictures();
    folder.write("in/._a.pgm", "no picture");
    folder.write("in/.b.pgm", small_disc(120.0));
    for images in ["in", "in/*.pgm", "./in/*.pgm", "in/*"] {
        let args = [&["fit", images, "--out-dir", "out"], &START[..]].concat();
        let answer = folder.snake(&args);
        assert!(
            answer.err.contains("4 pictures: 4 outlines"),
            "{images}: {}",
            answer.err
        );
    }
    let args = [&["fit", "in/.*.pgm", "--out-dir", "out"], &START[..]].concat();
    let answer = folder.snake(&args);
    assert!(
        answer.err.contains("2 pictures: 1 outline,"),
        "{}",
        answer.err
    );
}

#[test]
fn pictures_are_not_written_where_pictures_are_looked_for() {
    let folder = pictures();
    for images in ["in", "in/*.pgm"] {
        for format in ["mask", "csv,overlay", "labels", "deep-labels"] {
            let args = ["fit", images, "--out-dir", "./in/../in", "--as", format];
            folder.refused(
                &[&args[..], &START[..]].concat(),
                &["--out-dir", "another folder"],
            );
        }
    }
    // tables are no pictures, a folder below is another, and a file that is named is meant
    for (images, out, format) in [
        ("in", "in", "csv,geojson"),
        ("in", "in/found", "mask"),
        ("in/a.pgm", "in", "mask"),
    ] {
        let args = ["fit", images, "--out-dir", out, "--as", format];
        let answer = folder.snake(&[&args[..], &START[..]].concat());
        assert_ne!(answer.code, Some(2), "{images} {out}: {}", answer.err);
    }
}

/// A TIFF of grey pages, uncompressed, each of the picture of one of these contrasts.
fn stack(contrasts: &[f64]) -> Vec<u8> {
    let mut bytes = b"II*\0".to_vec();
    bytes.extend(8_u32.to_le_bytes());
    for (index, contrast) in contrasts.iter().enumerate() {
        let here = u32::try_from(bytes.len()).unwrap();
        let entries: u32 = 8;
        let pixels = here + 2 + 12 * entries + 4;
        let next = pixels + 64 * 48;
        bytes.extend(u16::try_from(entries).unwrap().to_le_bytes());
        let tags: [(u16, u32); 8] = [
            (256, 64),
            (257, 48),
            (258, 8),
            (259, 1),
            (262, 1),
            (273, pixels),
            (278, 48),
            (279, 64 * 48),
        ];
        for (tag, value) in tags {
            bytes.extend(tag.to_le_bytes());
            bytes.extend(4_u16.to_le_bytes());
            bytes.extend(1_u32.to_le_bytes());
            bytes.extend(value.to_le_bytes());
        }
        let last = index + 1 == contrasts.len();
        bytes.extend(if last { 0 } else { next }.to_le_bytes());
        bytes.extend(&small_disc(*contrast)[b"P5\n64 48\n255\n".len()..]);
    }
    bytes
}

#[test]
fn each_page_of_a_stack_is_a_picture_of_its_own() {
    let folder = Folder::new();
    let contrasts: Vec<f64> = (0..11).map(|page| 80.0 + 10.0 * f64::from(page)).collect();
    folder.write("s.tif", stack(&contrasts));
    folder.write("one.pgm", small_disc(100.0));
    let args = [
        "fit",
        "s.tif",
        "one.pgm",
        "--page",
        "all",
        "--out-dir",
        "out",
        "--measure",
        "m.csv",
    ];
    let answer = folder.snake(&[&args[..], &START[..]].concat());
    assert_eq!(answer.code, Some(0), "{}", answer.err);
    let table = read(&folder, "m.csv");
    let names: Vec<&str> = table
        .lines()
        .skip(1)
        .map(|line| line.split(',').next().unwrap())
        .collect();
    assert_eq!(names.len(), 12);
    assert_eq!(
        [names[0], names[10], names[11]],
        ["s_page01.tif", "s_page11.tif", "one.pgm"]
    );
    // the page is the one of that number
    for page in ["2", "11"] {
        let name = format!("out/s_page{page:0>2}.csv");
        let alone = ["fit", "s.tif", "--page", page, "--out", "alone.csv"];
        assert_eq!(
            folder.snake(&[&alone[..], &START[..]].concat()).code,
            Some(0)
        );
        assert_eq!(read(&folder, &name), read(&folder, "alone.csv"));
    }
    // results of one run are the starts of the next
    let args = [
        "fit",
        "s.tif",
        "--page",
        "all",
        "--out-dir",
        "next",
        "--from",
        "out/{stem}.csv",
    ];
    assert_eq!(folder.snake(&args).code, Some(0));
    let args = ["fit", "s.tif", "--page", "all", "-o", "x.csv"];
    folder.refused(&[&args[..], &START[..]].concat(), &["--page", "--out-dir"]);
    let args = ["fit", "s.tif", "--page", "some"];
    let answer = folder.snake(&[&args[..], &START[..]].concat());
    assert!(
        answer.code == Some(2) && answer.err.contains("or all, got some"),
        "{answer:?}"
    );
}
