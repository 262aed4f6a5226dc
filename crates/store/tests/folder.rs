//! What is written is read back, by its own reader and by that of the rows of any Parquet file.

#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use glam::DVec2;
use parquet::file::reader::{FileReader as _, SerializedFileReader};
use parquet::record::{Field, Row as Record};
use store::{Results, Row, StoreError, part_name, written};

fn ring() -> Vec<DVec2> {
    [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)]
        .map(|(x, y)| DVec2::new(x, y))
        .to_vec()
}

fn records(path: &std::path::Path) -> Vec<Record> {
    let file = SerializedFileReader::new(std::fs::File::open(path).unwrap()).unwrap();
    file.get_row_iter(None)
        .unwrap()
        .map(Result::unwrap)
        .collect()
}

fn field(record: &Record, name: &str) -> Field {
    let mut columns = record.get_column_iter();
    columns.find(|(own, _)| *own == name).unwrap().1.clone()
}

fn list(record: &Record, name: &str) -> Vec<Field> {
    match field(record, name) {
        Field::ListInternal(list) => list.elements().to_vec(),
        other => vec![other],
    }
}

#[test]
fn a_row_has_all_of_an_outline() {
    let folder = tempfile::tempdir().unwrap();
    let results = Results::open(folder.path()).unwrap();
    let (points, line) = (ring(), ring());
    let row = Row {
        is_outline: false,
        outcome: "settled",
        reason: "no edge",
        errors: &[0.5, f64::NAN, 0.25, 1.0],
        strengths: &[1.0; 4],
        ..Row::of(&points, true)
    };
    let open = Row::of(&line[..3], false);
    let path = results.write("folder/a.png", &[row, open]).unwrap();
    let records = records(&path);
    assert_eq!(records.len(), 2);
    let first = &records[0];
    assert_eq!(field(first, "image"), Field::Str("folder/a.png".to_owned()));
    assert_eq!(field(first, "object"), Field::Int(0));
    assert_eq!(field(first, "is_outline"), Field::Bool(false));
    assert_eq!(field(first, "reason"), Field::Str("no edge".to_owned()));
    assert_eq!(field(first, "nodes"), Field::Int(4));
    assert_eq!(field(first, "area"), Field::Double(12.0));
    assert_eq!(field(first, "perimeter"), Field::Double(14.0));
    assert_eq!(field(first, "centroid_x"), Field::Double(2.0));
    assert_eq!(field(first, "centroid_y"), Field::Double(1.5));
    assert_eq!(list(first, "x"), [0.0, 4.0, 4.0, 0.0].map(Field::Double));
    let errors = [
        Field::Float(0.5),
        Field::Null,
        Field::Float(0.25),
        Field::Float(1.0),
    ];
    assert_eq!(list(first, "error"), errors);
    let Field::Bytes(shape) = field(first, "geometry") else {
        unreachable!("a geometry is bytes")
    };
    // a polygon of one ring of five points, the last of which is the first
    assert_eq!(
        &shape.data()[..13],
        &[1, 3, 0, 0, 0, 1, 0, 0, 0, 5, 0, 0, 0]
    );
    assert_eq!(shape.data().len(), 13 + 5 * 16);
    assert_eq!(&shape.data()[13..29], &shape.data()[77..]);
    let second = &records[1];
    assert_eq!(field(second, "closed"), Field::Bool(false));
    assert_eq!(field(second, "area"), Field::Null);
    assert_eq!(list(second, "strength"), [const { Field::Null }; 3]);
    let Field::Bytes(shape) = field(second, "geometry") else {
        unreachable!("a geometry is bytes")
    };
    assert_eq!(&shape.data()[..9], &[1, 2, 0, 0, 0, 3, 0, 0, 0]);
}

#[test]
fn what_is_finished_is_known_alone_and_joined() {
    let folder = tempfile::tempdir().unwrap();
    let results = Results::open(folder.path()).unwrap();
    let points = ring();
    let good = Row::of(&points, true);
    let bad = Row {
        is_outline: false,
        ..good
    };
    results.write("a", &[good, bad]).unwrap();
    results.refuse("b", "holds no picture").unwrap();
    results.write("c", &[]).unwrap();
    let known = |name: &str| results.doubtful(name).unwrap();
    assert_eq!(
        ["a", "b", "c", "d"].map(known),
        [Some(1), Some(1), Some(1), None]
    );
    assert!(results.is_finished("b") && !results.is_finished("d"));
    std::fs::rename(results.part("a"), folder.path().join("joined.parquet")).unwrap();
    let again = Results::open(folder.path()).unwrap();
    assert_eq!(again.doubtful("a").unwrap(), Some(1));
    assert!(again.is_finished("a") && !again.part("a").exists());
}

#[test]
fn the_same_outlines_are_the_same_bytes() {
    let points = ring();
    let rows = [Row::of(&points, true); 3];
    assert_eq!(written("a", &rows).unwrap(), written("a", &rows).unwrap());
    assert_ne!(written("a", &rows).unwrap(), written("b", &rows).unwrap());
    assert_ne!(part_name("a"), part_name("b"));
}

#[test]
fn a_refusal_has_no_outline() {
    let folder = tempfile::tempdir().unwrap();
    let results = Results::open(folder.path()).unwrap();
    let records = records(&results.refuse("a", "why").unwrap());
    assert_eq!(records.len(), 1);
    assert_eq!(
        field(&records[0], "outcome"),
        Field::Str("refused".to_owned())
    );
    for name in ["object", "closed", "nodes", "area", "x", "geometry"] {
        assert_eq!(field(&records[0], name), Field::Null, "{name}");
    }
}

#[test]
fn what_is_no_table_is_refused_by_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("joined.parquet");
    std::fs::write(&path, b"PAR1 and no more").unwrap();
    let error = Results::open(folder.path()).unwrap_err();
    assert!(matches!(error, StoreError::Foreign { .. }), "{error}");
    assert!(error.to_string().contains("joined.parquet"));
    std::fs::write(folder.path().join("file"), "").unwrap();
    assert!(Results::open(&folder.path().join("file")).is_err());
}
