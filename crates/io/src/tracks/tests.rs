//! Tracks written and read again, and what is refused.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test: a broken set-up should stop it"
)]

use glam::DVec2;

use super::*;
use crate::shapes::{Format, Reading};

pub(super) const SIZE: (usize, usize) = (60, 40);

/// A square of that side about a place, its corners on the sides of pixels.
pub(super) fn square(frame: usize, id: u32, (x, y): (f64, f64), side: f64) -> Tracked {
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
    let points = corners
        .map(|(a, b)| DVec2::new(x + a * side, y + b * side))
        .to_vec();
    Tracked {
        frame,
        id,
        points,
        ..Tracked::default()
    }
}

/// Four frames: 1 is there, away for a frame, and there again; 2 parts into 3 and 4.
pub(super) fn story() -> Vec<Vec<Tracked>> {
    let child = |frame, id, at| Tracked {
        parent: Some(2),
        ..square(frame, id, at, 6.0)
    };
    let sure = |one: Tracked, sure| Tracked {
        confidence: Some(sure),
        ..one
    };
    vec![
        vec![
            sure(square(0, 1, (10.5, 10.5), 8.0), 0.9),
            square(0, 2, (40.5, 20.5), 10.0),
        ],
        vec![
            Tracked {
                frame: 1,
                id: 1,
                ..Tracked::default()
            },
            square(1, 2, (40.5, 20.5), 10.0),
        ],
        vec![
            square(2, 1, (12.5, 10.5), 8.0),
            child(2, 3, (35.5, 20.5)),
            child(2, 4, (47.5, 20.5)),
        ],
        vec![square(3, 1, (13.5, 10.5), 8.0), child(3, 3, (34.5, 20.5))],
    ]
}

pub(super) fn context() -> TrackContext {
    TrackContext {
        size: SIZE,
        frames: Some(4),
        name: "story".to_owned(),
        label: None,
    }
}

pub(super) fn written(path: &Path, format: TrackFormat) -> Vec<String> {
    let mut writer = TrackWriter::begin(path, format, &context()).unwrap();
    for (frame, tracked) in story().iter().enumerate() {
        writer
            .frame(frame, &format!("f{frame}.png"), tracked)
            .unwrap();
    }
    writer.end().unwrap()
}

#[test]
fn a_table_is_read_back_exactly() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.csv");
    written(&path, TrackFormat::Csv);
    let read: Vec<_> = TableFrames::open(&path)
        .unwrap()
        .map(Result::unwrap)
        .collect();
    let plain = |one: &Tracked| (one.frame, one.id, one.points.clone());
    for (frame, own) in &read {
        let given = story()[*frame]
            .iter()
            .filter(|one| !one.points.is_empty())
            .map(plain)
            .collect::<Vec<_>>();
        assert_eq!(own.iter().map(plain).collect::<Vec<_>>(), given);
    }
    assert_eq!(read.len(), 4);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn tables_of_others_are_read_by_their_headings_and_wrong_ones_refused_by_their_lines() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.csv");
    let read = |text: &str| -> Result<Vec<(usize, usize)>, String> {
        std::fs::write(&path, text).unwrap();
        let rows = TableFrames::open(&path).unwrap();
        rows.map(|rows| {
            rows.map(|(frame, own)| (frame, own.len()))
                .map_err(|e| e.to_string())
        })
        .collect()
    };
    assert_eq!(
        read("y;x;track;t\n1;2;1;0\n1;2;2;0\n1;2;1;0\n5;5;1;7\n").unwrap(),
        [(0, 2), (7, 1)]
    );
    assert_eq!(
        read("# from elsewhere\n0,1,2,3\n\n1,1,2,3").unwrap(),
        [(0, 1), (1, 1)]
    );
    assert_eq!(read("frame,id,x,y\n").unwrap(), []);
    for (text, wanted) in [
        ("frame,x,y\n1,2,3\n", "line 1: the heading has no column id"),
        (
            "frame,id,x,y\n1,1,2,3\n0,1,2,3\n",
            "line 3: frame 0 stands behind",
        ),
        ("frame,id,x,y\n1,1,2\n", "line 2: four numbers"),
        (
            "frame,id,x,y\n1,0,2,3\n",
            "line 2: a frame must be a whole number from 0 and an id one from 1, got 1 and 0",
        ),
        ("frame,id,x,y\n1.5,1,2,3\n", "line 2: a frame must be"),
        ("frame,id,x,y\n1,1,nan,3\n", "line 2: "),
        (
            "frame,id,x,y\n1,1,1e300,3\n",
            "line 2: numbers must be from",
        ),
    ] {
        let error = read(text).unwrap_err();
        assert!(error.contains(wanted), "{text}: {error}");
    }
}

#[test]
fn features_have_the_outline_and_all_that_is_known_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.geojson");
    written(&path, TrackFormat::GeoJson);
    let shapes = crate::shapes::load(&path).unwrap();
    assert_eq!(shapes.len(), 8);
    let first = &shapes[0];
    assert_eq!(
        (first.id.as_deref(), first.first()),
        (Some("0-1"), &story()[0][0].points[..])
    );
    assert_eq!(first.properties["confidence"], Value::Number(0.9));
    assert_eq!(shapes[4].properties["parent"], Value::Number(2.0));
    assert_eq!(
        shapes[4].properties["state"],
        Value::Text("tracked".to_owned())
    );
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(
        text.ends_with("\"sequence\":{\"height\":40,\"name\":\"story\",\"width\":60}}\n"),
        "{text}"
    );
}

#[test]
fn a_video_of_coco_has_a_list_for_each_object_with_null_where_it_is_away() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.json");
    written(&path, TrackFormat::Coco);
    let json: serde_json::Value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    assert_eq!(json["videos"][0]["length"], 4);
    let all = json["annotations"].as_array().unwrap();
    let away: Vec<(u64, Vec<usize>)> = all
        .iter()
        .map(|one| {
            let lists =
                ["segmentations", "bboxes", "areas"].map(|name| one[name].as_array().unwrap());
            assert!(lists.iter().all(|list| list.len() == 4));
            let away: Vec<usize> = (0..4).filter(|&at| lists[0][at].is_null()).collect();
            assert!(
                away.iter()
                    .all(|&at| lists[1][at].is_null() && lists[2][at].is_null())
            );
            (one["id"].as_u64().unwrap(), away)
        })
        .collect();
    assert_eq!(
        away,
        [
            (1, vec![1]),
            (2, vec![2, 3]),
            (3, vec![0, 1]),
            (4, vec![0, 1, 3])
        ]
    );
    assert_eq!(
        (&all[0]["areas"][0], &all[0]["bboxes"][0]),
        (&64.into(), &serde_json::json!([7, 7, 8, 8]))
    );
    assert_eq!(
        (&all[2]["parent"], &all[0]["parent"]),
        (&2.into(), &serde_json::Value::Null)
    );
}

#[test]
fn rois_are_read_back_with_their_names_and_boxes_are_counted_from_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.zip");
    written(&path, TrackFormat::ImageJ);
    let reading = Reading {
        format: Some(Format::ImageJ),
        ..Reading::default()
    };
    let shapes = crate::shapes::load_with(&path, &reading).unwrap();
    assert_eq!(shapes.len(), 8);
    assert_eq!(shapes[0].id.as_deref(), Some("frame0001_id1"));
    assert_eq!(shapes[0].first(), &story()[0][0].points[..]);
    let path = folder.path().join("a.txt");
    written(&path, TrackFormat::Mot);
    let text = std::fs::read_to_string(&path).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    // pixels 7 to 14 of the picture, whose first pixel's corner is at 1
    assert_eq!((lines[0], lines.len()), ("1,1,8,8,8,8,0.9,-1,-1,-1", 8));
}

#[test]
fn what_no_format_holds_is_refused_by_its_frame_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    for format in TrackFormat::ALL {
        let path = folder.path().join(format.name());
        let refused = |frame: usize, tracked: &[Tracked]| {
            let mut writer = TrackWriter::begin(&path, format, &context()).unwrap();
            writer.frame(1, "", &[]).unwrap();
            let error = writer.frame(frame, "", tracked).unwrap_err().to_string();
            drop(writer);
            if path.is_dir() {
                std::fs::remove_dir_all(&path).unwrap();
            }
            let _ = std::fs::remove_file(folder.path().join(format!("{}.part", format.name())));
            error
        };
        let good = square(2, 1, (10.0, 10.0), 5.0);
        let bad = |points: Vec<DVec2>| Tracked {
            points,
            ..good.clone()
        };
        assert!(
            refused(2, &[good.clone(), good.clone()]).contains("frame 2: object 1 is there twice")
        );
        assert!(refused(1, &[]).contains("frames must rise"));
        assert!(
            refused(
                2,
                &[Tracked {
                    id: 0,
                    ..good.clone()
                }]
            )
            .contains("numbered from 1")
        );
        assert!(refused(2, &[bad(vec![DVec2::ZERO; 2])]).contains("2 points"));
        assert!(refused(2, &[bad(vec![DVec2::NAN; 3])]).contains("a point at"));
        assert!(
            refused(
                2,
                &[Tracked {
                    confidence: Some(1.5),
                    ..good.clone()
                }]
            )
            .contains("got 1.5")
        );
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    let context = TrackContext::default();
    for format in [TrackFormat::Ctc, TrackFormat::Coco] {
        let error = TrackWriter::begin(&folder.path().join("x"), format, &context)
            .unwrap_err()
            .to_string();
        assert!(error.contains("frames of 0×0 pixels"), "{error}");
    }
}

#[test]
fn formats_are_known_by_their_names_and_endings() {
    for format in TrackFormat::ALL {
        assert_eq!(TrackFormat::named(format.name()), Some(format));
    }
    for (name, format) in [
        ("a.CSV", Some(TrackFormat::Csv)),
        ("a.zip", Some(TrackFormat::ImageJ)),
        ("a.doc", None),
        ("-", Some(TrackFormat::Csv)),
        ("01_RES", Some(TrackFormat::Ctc)),
    ] {
        assert_eq!(TrackFormat::by_ending(Path::new(name)), format, "{name}");
    }
}
