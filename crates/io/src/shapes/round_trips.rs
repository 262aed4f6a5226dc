//! What is written is read back the same, in every format.

use super::*;
use proptest::prelude::*;

pub(super) fn context() -> Context {
    Context {
        picture: Some("cells & <more>.png".to_owned()),
        width: 60,
        height: 50,
        pixel: Some(crate::PixelSize {
            x: 0.25,
            y: 0.25,
            unit: "micron".to_owned(),
        }),
    }
}

/// A star-shaped ring around a center.
fn star(center: DVec2, radii: &[f64]) -> Vec<DVec2> {
    let each = radii.iter().enumerate();
    each.map(|(i, &r)| {
        center + r * DVec2::from_angle(std::f64::consts::TAU * i as f64 / radii.len() as f64)
    })
    .collect()
}

/// Outlines one beside another, some with a hole.
fn outlines(holes: bool) -> impl Strategy<Value = Shapes> {
    let ring = || prop::collection::vec(4.0..8.0_f64, 5..12);
    let one = (
        ring(),
        1.0..3.0_f64,
        any::<bool>(),
        "[a-z][a-z <&\"'é]{0,8}",
    );
    prop::collection::vec(one, 2..5).prop_map(move |list| {
        let shape =
            |(number, (radii, hole, with, label)): (usize, (Vec<f64>, f64, bool, String))| {
                let center = DVec2::new(
                    10.3 + 18.1 * (number % 2) as f64,
                    9.8 + 17.7 * (number / 2) as f64,
                );
                let mut rings = vec![star(center, &radii)];
                if holes && with {
                    rings.push(star(center, &[hole; 7]));
                }
                Shape {
                    id: Some((number + 1).to_string()),
                    label: Some(label.trim().to_owned()),
                    closed: Some(true),
                    rings,
                    properties: BTreeMap::from([(
                        "score".to_owned(),
                        Value::Text("0.5".to_owned()),
                    )]),
                }
            };
        list.into_iter().enumerate().map(shape).collect()
    })
}

/// The largest distance of points of two outlines, whose rings may begin elsewhere and turn otherwise.
fn off(one: &Shape, other: &Shape) -> f64 {
    assert_eq!(one.rings.len(), other.rings.len());
    let rings = one.rings.iter().zip(&other.rings);
    let far = |(a, b): (&Vec<DVec2>, &Vec<DVec2>)| {
        assert_eq!(a.len(), b.len());
        let nearest = |p: &DVec2| {
            b.iter()
                .map(|q| p.distance(*q))
                .fold(f64::INFINITY, f64::min)
        };
        a.iter().map(nearest).fold(0.0, f64::max)
    };
    rings.map(far).fold(0.0, f64::max)
}

fn pixels(shapes: &[Shape]) -> Vec<bool> {
    raster::mask(shapes, 60, 50).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn polygons_come_back_where_they_were(shapes in outlines(true)) {
        // floats of 32 bits are off by 2^-25 of their size
        for (format, most) in [
            (Format::Csv, 0.0),
            (Format::GeoJson, 1e-6),
            (Format::ImageJ, 64.0 / f64::from(1 << 24)),
            (Format::Svg, 1e-6),
        ] {
            let bytes = write(&shapes, format, &context()).unwrap();
            let read = parse_with(&bytes, &Reading::default()).unwrap();
            prop_assert_eq!(read.len(), shapes.len());
            for (a, b) in shapes.iter().zip(&read) {
                prop_assert!(off(a, b) <= most, "{:?}: {}", format, off(a, b));
                prop_assert_eq!(&a.id, &b.id);
                prop_assert_eq!(b.closed, Some(true));
                if format != Format::Csv {
                    prop_assert_eq!(&a.label, &b.label, "{:?}", format);
                }
                if matches!(format, Format::GeoJson | Format::ImageJ) {
                    prop_assert_eq!(&a.properties, &b.properties, "{:?}", format);
                }
            }
        }
    }

    #[test]
    fn polygons_without_holes_come_back_where_they_were(shapes in outlines(false)) {
        for format in [Format::Coco, Format::Labelme] {
            let bytes = write(&shapes, format, &context()).unwrap();
            let read = parse_with(&bytes, &Reading::default()).unwrap();
            prop_assert_eq!(read.len(), shapes.len());
            for (a, b) in shapes.iter().zip(&read) {
                prop_assert!(off(a, b) <= 1e-6, "{:?}: {}", format, off(a, b));
                prop_assert_eq!((&a.id, &a.label, &a.properties), (&b.id, &b.label, &b.properties));
            }
        }
    }

    #[test]
    fn pixels_come_back_the_same(shapes in outlines(true)) {
        let inside = pixels(&shapes);
        for format in [Format::Mask, Format::Labels, Format::DeepLabels, Format::Coco] {
            let bytes = write(&shapes, format, &context()).unwrap();
            let read = parse_with(&bytes, &Reading::default()).unwrap();
            prop_assert!(pixels(&read) == inside, "{:?}", format);
            if format != Format::Mask {
                for (a, b) in shapes.iter().zip(&read) {
                    prop_assert_eq!(&a.id, &b.id);
                    let (a, b) = (std::slice::from_ref(a), std::slice::from_ref(b));
                    prop_assert!(pixels(a) == pixels(b), "{:?}", format);
                }
            }
        }
    }

    #[test]
    fn lines_and_points_come_back_where_they_were(
        points in prop::collection::vec((-50.0..2000.0_f64, 0.0..900.0_f64), 2..30),
        click in (0.0..500.0_f64, 0.0..500.0_f64),
    ) {
        let points = points.into_iter().map(DVec2::from).collect();
        let shapes = [Shape::curve(points, Some(false)), Shape::curve(vec![DVec2::from(click)], None)];
        for format in [Format::GeoJson, Format::ImageJ, Format::Svg, Format::Labelme] {
            let bytes = write(&shapes, format, &context()).unwrap();
            let read = parse_with(&bytes, &Reading::default()).unwrap();
            prop_assert_eq!(read.len(), 2, "{:?}", format);
            let most = if format == Format::ImageJ { 2000.0 / f64::from(1 << 24) } else { 1e-6 };
            for (a, b) in shapes.iter().zip(&read) {
                prop_assert!(off(a, b) <= most, "{:?}: {}", format, off(a, b));
                prop_assert_eq!(a.closed, b.closed, "{:?}", format);
            }
        }
    }

    #[test]
    fn bytes_of_any_kind_are_read_or_refused(
        bytes in prop::collection::vec(any::<u8>(), 0..200),
        begin in 0_usize..8,
    ) {
        let heads: [&[u8]; 8] = [b"", b"{\"shapes\":[", b"<svg><path d=\"", b"Iout\0\xe3", b"PK\x03\x04", b"P5 3 3 255\n", b"[", b"<annotations>"];
        let all = [heads[begin], &bytes].concat();
        let _ = parse_with(&all, &Reading::default());
    }
}
