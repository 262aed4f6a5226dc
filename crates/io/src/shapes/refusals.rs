//! What is cut, changed or cannot be is refused, in every format.

use super::round_trips::context;
use super::*;
use crate::limits::FARTHEST;

/// Formats that are written.
const WRITTEN: [Format; 9] = [
    Format::Csv,
    Format::GeoJson,
    Format::Coco,
    Format::ImageJ,
    Format::Svg,
    Format::Labelme,
    Format::Mask,
    Format::Labels,
    Format::DeepLabels,
];

/// A file of each format that is read.
fn files() -> Vec<(Format, Vec<u8>)> {
    let square = |at: f64, size: f64| {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        corners
            .map(|(x, y)| DVec2::splat(at) + size * DVec2::new(x, y))
            .to_vec()
    };
    let shape = |id: &str, rings: Vec<Vec<DVec2>>| Shape {
        id: Some(id.to_owned()),
        label: Some("cell".to_owned()),
        closed: Some(true),
        rings,
        ..Shape::default()
    };
    let whole = [
        shape("1", vec![square(2.0, 9.5)]),
        shape("2", vec![square(20.25, 12.0)]),
    ];
    let holes = [
        shape("1", vec![square(2.0, 20.5), square(5.0, 4.0)]),
        shape("2", vec![square(30.0, 9.0)]),
    ];
    let mut files: Vec<(Format, Vec<u8>)> = Vec::new();
    for format in WRITTEN {
        let shapes = if format == Format::Labelme {
            &whole
        } else {
            &holes
        };
        files.push((format, write(shapes, format, &context()).unwrap()));
    }
    files.push((
        Format::ImageJ,
        write(&whole[..1], Format::Roi, &context()).unwrap(),
    ));
    files.push((
        Format::ImageJ,
        write(&holes[..1], Format::Roi, &context()).unwrap(),
    ));
    let packed = r#"[{"image_id":1,"segmentation":{"size":[40,9],"counts":"PACKED"}}]"#;
    files.push((Format::Coco, packed.replace("PACKED", PACKED).into_bytes()));
    let cvat = r#"<?xml version="1.0"?><annotations><image id="0" name="a.png" width="60" height="50">
        <polygon label="cell" points="1,1;5,1;5,5"><attribute name="stage">G1</attribute></polygon>
        <box label="cell" xtl="2" ytl="3" xbr="6" ybr="5" rotation="90"/>
        <ellipse label="cell" cx="20" cy="20" rx="5" ry="5"/>
        <polyline label="line" points="1,1;5,1"/><points label="click" points="1,1;5,1"/>
        <mask label="cell" rle="1, 2, 3" left="7" top="8" width="3" height="2"/></image></annotations>"#;
    files.push((Format::Cvat, cvat.as_bytes().to_vec()));
    let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9"><g transform="translate(2 1) rotate(90)">
        <path id="p" d="M1 1c1 0 2 1 2 2s-1 2-2 2q-1 0-1-2t1-2a1 1 0 0 1 1 1z"/><rect x="1" width="3" height="2" rx="1"/>
        <circle cx="3" cy="3" r="2"/><ellipse rx="2" ry="1"/><polygon points="0,0 1,0 1,1"/><line x2="3"/></g></svg>"#;
    files.push((Format::Svg, svg.as_bytes().to_vec()));
    files
}

/// Runs as pycocotools packs them: a rectangle with a hole in 40 rows and 9 columns.
const PACKED: &str = "c2k0=FDH<8DH<b00000U1";

#[test]
fn formats_are_told_by_their_first_bytes() {
    for (format, bytes) in files() {
        let told = parse_with(&bytes, &Reading::default())
            .unwrap_or_else(|e| unreachable!("{format:?}: {e}"));
        let asked = parse_as(&bytes, format).unwrap_or_else(|e| unreachable!("{format:?}: {e}"));
        assert_eq!(told.len(), asked.len(), "{format:?}");
        assert!(!told.is_empty() && Format::named(format.name()) == Some(format));
    }
}

#[test]
fn what_is_cut_or_changed_never_stops_the_program() {
    let mut steps = 0_u32;
    for (format, bytes) in files() {
        let every = (bytes.len() / 300).max(1);
        for at in (0..bytes.len()).step_by(every) {
            let read = |bytes: &[u8]| {
                let said = parse_as(bytes, format);
                if let Err(error) = said {
                    assert!(error.to_string().len() < 400, "{format:?}: {error}");
                }
            };
            read(&bytes[..at]);
            for flip in [0x01, 0x80, 0xff] {
                let mut other = bytes.clone();
                other[at] ^= flip;
                read(&other);
                steps += 1;
            }
        }
    }
    assert!(steps > 3000, "{steps}");
}

#[test]
fn refusals_say_where_and_what_is_needed() {
    let deep = "[".repeat(5000);
    for (text, says) in [
        (
            r#"{"type":"Polygon","coordinates":[[[0,0],[1,0],[1]]]}"#,
            "coordinates[0][2]: two numbers",
        ),
        (
            r#"{"type":"Polygon","coordinates":[[[0,0],[1,0],[1e10,1]]]}"#,
            "coordinates[0][2]: numbers must",
        ),
        (
            r#"{"type":"Polygon","coordinates":[[[0,0],[1,0],[NaN,1]]]}"#,
            "line 1: ",
        ),
        (
            r#"{"type":"Feature","geometry":{"type":"Apple"}}"#,
            "geometry.type: Polygon",
        ),
        (
            r#"{"annotations":[{"segmentation":[[1,2,3]]}]}"#,
            "annotations[0].segmentation[0]: 3 numbers",
        ),
        (
            r#"{"annotations":[{"segmentation":{"size":[2,2],"counts":[1,2]}}]}"#,
            "counts: the runs have 3 pixels",
        ),
        (
            r#"{"annotations":[{"segmentation":{"size":[999999,999999],"counts":[999998000001]}}]}"#,
            "pixels",
        ),
        (
            r#"{"shapes":[{"shape_type":"circle","points":[[1,2]]}]}"#,
            "shapes[0].points: 1 points; 2",
        ),
        (r#"{"apple":1}"#, "GeoJSON, COCO or labelme is needed"),
        (&deep, "recursion limit"),
        (
            "<svg><path d=\"M 1 2 L apple\"/></svg>",
            "line 1: path: step 2",
        ),
        (
            "<svg><rect width=\"3mm\" height=\"3\"/></svg>",
            "rect: width must be a number of pixels",
        ),
        ("<svg><circle r=\"inf\"/></svg>", "circle: r must"),
        ("<svg>\n<use href=\"#a\"/></svg>", "line 2: use: "),
        (
            "<!DOCTYPE svg [<!ENTITY a \"aaaa\">]><svg>&a;</svg>",
            "an entity of its own",
        ),
        ("<apple/>", "apple: an XML of no known kind"),
        ("<annotations><track/></annotations>", "is of a film"),
        (
            "<annotations><image name=\"a\"><box xtl=\"1\"/></image></annotations>",
            "box: has no ytl",
        ),
    ] {
        let error = parse_with(text.as_bytes(), &Reading::default())
            .unwrap_err()
            .to_string();
        assert!(error.contains(says), "{text:.80}: {error}");
    }
}

#[test]
fn elements_in_elements_without_end_are_read_or_refused() {
    let n = 50_000;
    let svg = format!("<svg>{}{}</svg>", "<g>".repeat(n), "</g>".repeat(n));
    let error = parse_with(svg.as_bytes(), &Reading::default())
        .unwrap_err()
        .to_string();
    assert!(error.contains("no outline"), "{error}");
}

#[test]
fn a_zip_that_inflates_too_far_is_refused_and_names_in_it_are_only_names() {
    use std::io::Write as _;
    let zip = |files: &[(&str, &[u8])]| {
        let mut writer = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
        for (name, bytes) in files {
            writer
                .start_file(*name, zip::write::SimpleFileOptions::default())
                .unwrap();
            writer.write_all(bytes).unwrap();
        }
        writer.finish().unwrap().into_inner()
    };
    let mut bomb = b"Iout".to_vec();
    bomb.resize(64 << 20, 0);
    let bytes = zip(&[("a.roi", &bomb)]);
    assert!(bytes.len() < 1 << 20);
    let error = parse_with(&bytes, &Reading::default())
        .unwrap_err()
        .to_string();
    assert!(
        error.starts_with("a.roi: the files of the ZIP take more"),
        "{error}"
    );
    let ring = vec![DVec2::ZERO, DVec2::new(5.0, 0.0), DVec2::new(0.0, 5.0)];
    let roi = write(
        &[Shape::curve(ring, Some(true))],
        Format::Roi,
        &Context::default(),
    )
    .unwrap();
    let bytes = zip(&[
        ("/etc/one.roi", &roi),
        ("../two.ROI", &roi),
        ("notes.txt", b"x"),
        ("éé", b""),
    ]);
    let read = parse_with(&bytes, &Reading::default()).unwrap();
    let ids: Vec<_> = read
        .iter()
        .map(|shape| shape.id.as_deref().unwrap())
        .collect();
    assert_eq!(ids, ["one", "two"]);
}

#[test]
fn what_a_format_cannot_hold_is_refused() {
    let line = Shape::curve(vec![DVec2::ZERO, DVec2::ONE], Some(false));
    let far = Shape::curve(
        vec![DVec2::ZERO, DVec2::ONE, DVec2::new(2.0 * FARTHEST, 0.0)],
        Some(true),
    );
    let nan = Shape::curve(vec![DVec2::ZERO, DVec2::ONE, DVec2::NAN], Some(true));
    let ring = vec![DVec2::ZERO, DVec2::new(5.0, 0.0), DVec2::new(0.0, 5.0)];
    let large = Shape {
        id: Some("70000".to_owned()),
        ..Shape::curve(ring, Some(true))
    };
    for (shape, format, says) in [
        (&line, Format::Coco, "outline 1 is open"),
        (&line, Format::Mask, "outline 1 is open"),
        (&line, Format::Cvat, "read only"),
        (&far, Format::Csv, "outline 1: numbers must be"),
        (&nan, Format::Svg, "outline 1: numbers must be"),
        (&large, Format::Labels, "70000; 16 bits hold at most 65535"),
        (&Shape::default(), Format::GeoJson, "without points"),
    ] {
        let error = write(std::slice::from_ref(shape), format, &context())
            .unwrap_err()
            .to_string();
        assert!(error.contains(says), "{format:?}: {error}");
    }
    let deep = write(&[large], Format::DeepLabels, &context()).unwrap();
    assert_eq!(
        parse_with(&deep, &Reading::default()).unwrap()[0]
            .id
            .as_deref(),
        Some("70000")
    );
    let error = write(&[line], Format::Svg, &Context::default())
        .unwrap_err()
        .to_string();
    assert!(error.contains("0×0 pixels; its size is needed"), "{error}");
}
