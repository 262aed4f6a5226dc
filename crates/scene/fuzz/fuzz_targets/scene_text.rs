//! Any text is a scene that runs, or is refused; never a panic.
#![no_main]

use std::ops::ControlFlow;
use std::path::Path;

use libfuzzer_sys::fuzz_target;
use scene::Scene;

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
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
                let _ = record.to_csv();
                assert!(record.to_json_lines().is_ok());
            }
        }
        Err(error) => {
            let said = error.to_string();
            assert!(!said.is_empty() && said.len() < 4000, "{said}");
        }
    }
});
