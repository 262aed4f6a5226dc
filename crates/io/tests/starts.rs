//! Outlines read for a picture: parts and holes, the picture's own among several, pixels of another size, soft masks.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use io::shapes::{self, Reading, Shape};

fn read(text: &str, reading: &Reading) -> Result<Vec<Shape>, String> {
    shapes::parse_with(text.as_bytes(), reading).map_err(|error| error.to_string())
}

fn square(x: i32, side: i32) -> String {
    let (y, end, low) = (10, x + side, 10 + side);
    format!("[[{x},{y}],[{end},{y}],[{end},{low}],[{x},{low}],[{x},{y}]]")
}

#[test]
fn each_part_of_an_outline_is_one_of_its_own_with_its_holes() {
    let text = format!(
        r#"{{"type":"Feature","id":7,"properties":{{"classification":{{"name":"cell"}}}},"geometry":
        {{"type":"MultiPolygon","coordinates":[[{}],[{},[[42,12],[44,12],[44,14],[42,14],[42,12]]]]}}}}"#,
        square(0, 10),
        square(40, 20)
    );
    let found = read(&text, &Reading::default()).unwrap();
    let parts = found[0].parts().unwrap();
    let ids: Vec<_> = parts.iter().map(|part| part.id.as_deref()).collect();
    assert_eq!(ids, [Some("7.1"), Some("7.2")]);
    assert_eq!([parts[0].rings.len(), parts[1].rings.len()], [1, 2]);
    assert!(parts[1].first().iter().all(|p| p.x > 39.0));
    assert!(
        parts
            .iter()
            .all(|part| part.label.as_deref() == Some("cell"))
    );
    // one part keeps its name, and lines are parts whatever they enclose
    let one = &parts[1].parts().unwrap()[..];
    assert_eq!(one, &parts[1..]);
    let lines = Shape {
        closed: Some(false),
        ..found[0].clone()
    };
    assert_eq!(lines.parts().unwrap().len(), 3);
}

/// COCO JSON with a triangle at x in the image of each of these names.
fn coco(names: &[&str]) -> String {
    let each = |of: &dyn Fn(usize, &str) -> String| {
        let list = names.iter().enumerate().map(|(i, name)| of(i, name));
        list.collect::<Vec<_>>().join(",")
    };
    let images = each(&|i, name| format!(r#"{{"id":{i},"file_name":"{name}"}}"#));
    let outlines = each(&|i, _| {
        let x = 10 * i;
        format!(
            r#"{{"id":{i},"image_id":{i},"segmentation":[[{x},0,{},0,{x},5]]}}"#,
            x + 5
        )
    });
    format!(r#"{{"images":[{images}],"annotations":[{outlines}]}}"#)
}

fn cvat(names: &[&str]) -> String {
    let image = |(i, name): (usize, &&str)| {
        let x = 10 * i;
        format!(
            r#"<image id="{i}" name="{name}"><polygon label="c" points="{x},0;{},0;{x},5"/></image>"#,
            x + 5
        )
    };
    let images: String = names.iter().enumerate().map(image).collect();
    format!("<annotations>{images}</annotations>")
}

#[test]
fn of_a_file_about_several_pictures_that_of_the_own_name_is_taken() {
    let beside = |name: &str| Reading {
        beside: Some(name.to_owned()),
        ..Reading::default()
    };
    let names = ["set/a.png", "b.jpg", "c.png", "c.jpg"];
    for text in [coco(&names), cvat(&names)] {
        for (name, x) in [("a.png", -0.5), ("b.png", 9.5), ("c.jpg", 29.5)] {
            let found = read(&text, &beside(name)).unwrap();
            assert_eq!(
                (found.len(), found[0].first()[0].x.to_bits()),
                (1, f64::to_bits(x))
            );
        }
        for name in ["d.png", "c.tif"] {
            let error = read(&text, &beside(name)).unwrap_err();
            assert!(
                error.contains(name) && error.contains("set/a.png, b.jpg"),
                "{error}"
            );
        }
        // another name asked for goes before it
        let asked = Reading {
            picture: Some("b.jpg".to_owned()),
            ..beside("a.png")
        };
        assert_eq!(
            read(&text, &asked).unwrap()[0].first()[0].x.to_bits(),
            9.5_f64.to_bits()
        );
    }
    // that of one picture is for whatever picture it is read for
    assert_eq!(read(&coco(&["a.png"]), &beside("q.png")).unwrap().len(), 1);
    assert_eq!(read(&cvat(&["a.png"]), &beside("q.png")).unwrap().len(), 1);
}

/// A grey picture of bytes as PNG, through the writer of pictures in color.
fn grey(width: u32, height: u32, level: impl Fn(f64, f64) -> u8) -> tempfile::NamedTempFile {
    let mut text = format!("P5\n{width} {height}\n255\n").into_bytes();
    for y in 0..height {
        text.extend((0..width).map(|x| level(f64::from(x), f64::from(y))));
    }
    let file = tempfile::Builder::new().suffix(".pgm").tempfile().unwrap();
    std::fs::write(file.path(), text).unwrap();
    file
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "from 0 to 255"
)]
fn disc(x: f64, y: f64) -> u8 {
    let share = 0.5 + 12.0 - (x - 20.3).hypot(y - 19.8);
    (255.0 * share.clamp(0.0, 1.0)).round() as u8
}

#[test]
fn a_mask_with_soft_borders_is_one_outline_between_its_pixels_and_labels_are_many() {
    let file = grey(40, 40, disc);
    let (found, note) = shapes::load_noted(file.path(), &Reading::default()).unwrap();
    assert_eq!(found.len(), 1);
    assert!(note.unwrap().contains("soft mask"));
    for p in found[0].first() {
        let radius = (p.x - 20.3).hypot(p.y - 19.8);
        assert!((radius - 12.0).abs() < 0.1, "{radius}");
    }
    // three labels, one of them black's and white's neighbour
    let file = grey(40, 40, |x, _| {
        if x < 10.0 {
            0
        } else if x < 25.0 {
            7
        } else {
            255
        }
    });
    let (found, note) = shapes::load_noted(file.path(), &Reading::default()).unwrap();
    assert_eq!((found.len(), note), (2, None));
}

#[test]
fn pixels_of_another_size_than_the_pictures_are_refused() {
    let size = |width, height| Reading {
        size: Some((width, height)),
        ..Reading::default()
    };
    let file = grey(40, 30, disc);
    assert!(shapes::load_with(file.path(), &size(40, 30)).is_ok());
    let error = shapes::load_with(file.path(), &size(30, 40))
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("40×30") && error.contains("30×40"),
        "{error}"
    );
    let runs = r#"{"annotations":[{"id":1,"segmentation":{"size":[3,4],"counts":[4,2,6]}}]}"#;
    assert!(read(runs, &size(4, 3)).is_ok());
    let error = read(runs, &size(40, 30)).unwrap_err();
    assert!(error.contains("4×3") && error.contains("40×30"), "{error}");
}
