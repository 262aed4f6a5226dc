//! What each fuzz target does with the bytes it is given. The tests of `scene` include this file
//! and run it on the seeds, so that it compiles and holds on every compiler.

use std::ops::ControlFlow;
use std::path::Path;

use io::{Picture, shapes};
use scene::fit::{self, Image, Nodes, Options};
use scene::{Scene, SceneText, field};

/// A refusal says something, in few words.
fn is_short(said: &str, most: usize) {
    assert!(!said.is_empty() && said.len() < most, "{said}");
}

/// Any text is a contour that is written and read back the same, or is refused; never a panic.
pub fn contour(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    match shapes::parse_one(text) {
        Ok(contour) => {
            let again = shapes::parse_one(&shapes::to_text(std::slice::from_ref(&contour)));
            assert!(again.is_ok_and(|again| again == contour));
            let levels = field::Grid::from_shape_fn((8, 8), |(y, x)| (x * y) as f64);
            let options = Options {
                nodes: Nodes::Count(12),
                steps: 3,
                ..Options::default()
            };
            let start = fit::Contour {
                points: contour.first().to_vec(),
                closed: contour.closed.unwrap_or(true),
            };
            // some lie in this picture; most are refused
            let _ = fit::fit(&Image::grey(levels), &start, &options);
        }
        Err(said) => is_short(&said.to_string(), 400),
    }
}

/// Any bytes are a picture of finite levels, or are refused; never a panic.
pub fn picture(bytes: &[u8]) {
    // few pixels, so that memory stays small however much a head claims
    match Picture::decode_small(bytes, 1 << 16) {
        Ok(picture) => {
            let (width, height) = picture.size();
            assert!(width >= 1 && height >= 1 && width * height <= 1 << 16);
            assert!(picture.levels().iter().all(|level| level.is_finite()));
        }
        Err(said) => is_short(&said, 400),
    }
}

/// Any text is a scene that runs, or is refused; never a panic.
pub fn scene_text(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    // what is read is written so that it is read again the same
    if let Ok(read) = SceneText::parse("fuzz", text, Path::new("/nowhere")) {
        let written = read.to_string();
        let again = SceneText::parse("fuzz", &written, Path::new("/nowhere"));
        assert!(
            again.is_ok_and(|again| again.to_string() == written),
            "{written}"
        );
    }
    // files that a scene names are not looked for
    match Scene::parse("fuzz", text, Path::new("/nowhere")) {
        Ok(mut scene) => {
            if scene.snake.body().len() > 2000 {
                return;
            }
            let _ = scene.step_limit();
            scene.plan.force = true;
            let mut steps = 0;
            let record = scene.run(&mut |_| {
                steps += 1;
                if steps < 5 {
                    ControlFlow::Continue(())
                } else {
                    ControlFlow::Break(())
                }
            });
            if let Ok(record) = record {
                let record = record.written();
                let _ = record.to_csv();
                assert!(record.to_json_lines().is_ok());
            }
        }
        Err(error) => is_short(&error.to_string(), 4000),
    }
}
