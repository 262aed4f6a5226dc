//! What the commands do when all is well.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test: small whole numbers"
)]

use crate::common::{Folder, disc, scene};
use io::Picture;
use io::shapes::{self, Shape};
use scene::SCENES;
use scene::integrator::Scheme;

#[test]
fn list_names_every_shipped_scene_on_a_line_of_its_own() {
    let folder = Folder::new();
    for args in [&["list"][..], &["list", "scenes"]] {
        let answer = folder.snake(args);
        let hint = "snake show NAME prints the text of one\n";
        assert_eq!((answer.code, answer.err.as_str()), (Some(0), hint));
        let names: Vec<&str> = answer
            .out
            .lines()
            .map(|l| l.split(' ').next().unwrap())
            .collect();
        let known: Vec<&str> = SCENES.iter().map(|(name, _)| *name).collect();
        assert_eq!(names, known);
        assert!(
            answer
                .out
                .contains("\nsoft-ball                  A soft ball (Figure 2.3)\n")
        );
    }
}

#[test]
fn list_names_every_scheme_with_what_it_is() {
    let answer = Folder::new().snake(&["list", "schemes"]);
    assert_eq!((answer.code, answer.err.as_str()), (Some(0), ""));
    let lines: Vec<&str> = answer.out.lines().collect();
    assert_eq!(lines.len(), Scheme::ALL.len());
    for (line, scheme) in lines.iter().zip(Scheme::ALL) {
        assert!(line.starts_with(&format!("{} ", scheme.name())), "{line}");
        assert!(line.ends_with(scheme.summary()), "{line}");
        assert!(line.chars().count() <= 100, "{line}");
    }
}

#[test]
fn a_record_goes_to_standard_output_as_json_lines() {
    let answer = Folder::new().snake(&["run", "soft-ball", "--steps", "10", "--record", "-"]);
    assert_eq!(answer.code, Some(0));
    assert_eq!(
        answer.err,
        "A soft ball: finished after 10 steps, t = 0.010000\n"
    );
    let lines: Vec<&str> = answer.out.lines().collect();
    assert_eq!(
        lines[0],
        "{\"snake_record\":1,\"scene\":\"soft-ball\",\"title\":\"A soft ball\",\
         \"scheme\":\"report\",\"dt\":0.001,\"closed\":true,\"nodes\":40}"
    );
    // the start and the end: every 50 steps is all the scene asks for
    assert!(
        lines[1].starts_with("{\"step\":0,\"t\":0.0,\"x\":[[6.5,8.0],["),
        "{}",
        lines[1]
    );
    assert!(
        lines[1].contains(",\"energy\":{\"kinetic\":"),
        "{}",
        lines[1]
    );
    assert!(
        lines[2].starts_with("{\"step\":10,\"t\":0.01"),
        "{}",
        lines[2]
    );
    assert_eq!(lines[3..], ["{\"outcome\":\"finished\",\"step\":10}"]);
}

#[test]
fn a_record_goes_to_a_csv_file_by_its_name() {
    let folder = Folder::new();
    let args = [
        "run",
        "soft-ball",
        "--steps",
        "10",
        "--every",
        "5",
        "--velocities",
        "--record",
    ];
    let answer = folder.snake(&[&args[..], &["f.csv"]].concat());
    assert_eq!((answer.code, answer.out.as_str()), (Some(0), ""));
    let text = std::fs::read_to_string(folder.path("f.csv")).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(
        lines[0],
        "# record 1, closed, report, dt 0.001, finished after 10 steps"
    );
    assert_eq!(
        lines[1],
        "step,t,node,x,y,vx,vy,kinetic,tether,tension,rigidity,gravity,wall,damping,contact,frame,scheme,parameters,hand,upkeep,total"
    );
    assert_eq!(lines.len(), 2 + 3 * 40);
    assert!(
        lines[2].starts_with("0,0.0,0,6.5,8.0,-2.5,0.0,"),
        "{}",
        lines[2]
    );
    for line in &lines[2..] {
        let numbers: Vec<f64> = line.split(',').map(|word| word.parse().unwrap()).collect();
        assert_eq!(numbers.len(), lines[1].split(',').count());
    }
    // the same record as JSON Lines, and the same bytes twice
    for name in ["a.jsonl", "b.jsonl"] {
        folder.snake(&[&args[..], &[name]].concat());
    }
    let read = |name: &str| std::fs::read(folder.path(name)).unwrap();
    assert_eq!(read("a.jsonl"), read("b.jsonl"));
}

#[test]
fn a_scene_comes_from_standard_input_or_any_file() {
    let folder = Folder::new();
    let answer = folder.snake_reading(&["run", "-", "--out", "-"], scene(&[]));
    assert_eq!(answer.code, Some(0), "{answer:?}");
    let contour = shapes::parse_one(&answer.out).unwrap();
    assert_eq!((contour.closed, contour.first().len()), (Some(true), 20));
    folder.write("without-an-ending", scene(&[]));
    let again = folder.snake(&["run", "without-an-ending", "--out", "-"]);
    assert_eq!(again.out, answer.out);
}

/// Largest distance of a contour's nodes from a circle.
fn off(contour: &Shape, center: [f64; 2], radius: f64) -> f64 {
    contour
        .first()
        .iter()
        .map(|p| ((p.x - center[0]).hypot(p.y - center[1]) - radius).abs())
        .fold(0.0, f64::max)
}

/// A circle of `n` points as a contour file, clockwise on the screen or the other way.
fn circle(center: [f64; 2], radius: f64, n: usize, turn: f64) -> String {
    let mut text = String::from("x,y\n");
    for i in 0..n {
        let (sin, cos) = (turn * std::f64::consts::TAU * i as f64 / n as f64).sin_cos();
        text.push_str(&format!(
            "{},{}\n",
            center[0] + radius * cos,
            center[1] + radius * sin
        ));
    }
    text
}

#[test]
fn a_circle_drawn_off_a_disc_is_pulled_onto_its_border() {
    let folder = Folder::new();
    let (center, radius) = ([48.3, 47.6], 25.0);
    folder.write("disc.pgm", disc(96, center, radius));
    for (name, turn) in [("right.csv", 1.0), ("left.csv", -1.0)] {
        folder.write(name, circle([47.0, 49.0], 29.0, 12, turn));
        let args = [
            "fit",
            "disc.pgm",
            "--from",
            name,
            "--out",
            "found.csv",
            "--overlay",
            "seen.png",
        ];
        let answer = folder.snake(&args);
        assert_eq!(answer.code, Some(0), "{answer:?}");
        assert!(answer.err.contains("came to rest after"), "{answer:?}");
        let found = shapes::load_one(&folder.path("found.csv")).unwrap();
        assert_eq!(found.closed, Some(true));
        let area = scene::elastic::signed_area(found.first());
        assert!(area * turn > 0.0, "{name} keeps its winding: {area}");
        // a Gaussian of σ pulls the edge of a disc inwards by about σ²/(2 r), 0.2 pixels here, the
        // tension of a start too large outwards again
        let off = off(&found, center, radius);
        assert!(off < 0.5, "{name}: {off} pixels off");
        let seen = std::fs::read(folder.path("seen.png")).unwrap();
        let seen = Picture::decode(&seen).unwrap();
        assert_eq!(seen.size(), (96, 96));
        // orange on the border found, blue on the start, nothing of either in a corner
        let colour = |x: u32, y: u32| seen.display().get_pixel(x, y).0;
        let [r, _, b] = colour(73, 48);
        assert!(r > b, "{:?}", colour(73, 48));
        let [r, _, b] = colour(76, 49);
        assert!(b > r, "{:?}", colour(76, 49));
        assert_eq!(colour(2, 2), [60, 60, 60]);
    }
}

#[test]
fn a_fit_writes_to_standard_output_and_reads_a_contour_from_standard_input() {
    let folder = Folder::new();
    folder.write("disc.pgm", disc(96, [48.0, 48.0], 25.0));
    let start = circle([48.0, 48.0], 29.0, 12, 1.0);
    let answer = folder.snake_reading(&["fit", "disc.pgm", "--from", "-"], &start);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    assert!(
        answer.out.starts_with("# contour 1, closed\nx,y\n"),
        "{answer:?}"
    );
    // what was found is where it stays when it is the start
    let again = folder.snake_reading(&["fit", "disc.pgm", "--from", "-"], &answer.out);
    let [first, second] = [&answer, &again].map(|a| shapes::parse_one(&a.out).unwrap());
    assert!(off(&second, [48.0, 48.0], 25.0) <= off(&first, [48.0, 48.0], 25.0) + 0.05);
}

#[test]
fn an_open_contour_stays_open_and_one_out_of_steps_says_so_by_its_code() {
    let folder = Folder::new();
    folder.write("disc.pgm", disc(96, [48.0, 48.0], 25.0));
    folder.write("arc.csv", "# contour 1, open\nx,y\n75,40\n77,48\n75,56\n");
    let answer = folder.snake(&["fit", "disc.pgm", "--from", "arc.csv", "--steps", "3"]);
    assert_eq!(answer.code, Some(1), "{answer:?}");
    assert!(answer.err.contains("finished after 3 steps"), "{answer:?}");
    assert_eq!(shapes::parse_one(&answer.out).unwrap().closed, Some(false));
    let closed = folder.snake(&[
        "fit", "disc.pgm", "--from", "arc.csv", "--steps", "3", "--closed",
    ]);
    assert_eq!(shapes::parse_one(&closed.out).unwrap().closed, Some(true));
}

#[test]
fn the_stages_of_a_field_are_written_and_named() {
    let folder = Folder::new();
    folder.write("disc.pgm", disc(40, [20.0, 20.0], 9.0));
    let answer = folder.snake(&["field", "disc.pgm", "--out", "a/b", "--sigma", "2"]);
    assert_eq!(
        (answer.code, answer.err.as_str()),
        (Some(0), ""),
        "{answer:?}"
    );
    let files: Vec<&str> = answer.out.lines().collect();
    let names = [
        "0-picture.png",
        "1-smoothed.png",
        "2-gradient-x.png",
        "3-gradient-y.png",
        "4-edge-strength.png",
        "5-force-x.png",
        "5-force-y.png",
        "5-force-directions.png",
        "5-force-arrows.png",
        "5-force-magnitude.png",
        "5-force-potential.png",
        "5-force-potential.npy",
        "5-force.npy",
        "5-force.tiff",
        "6-report-force-x.png",
        "6-report-force-y.png",
        "6-report-force-directions.png",
        "6-report-force-arrows.png",
        "6-report-force-magnitude.png",
        "6-report-force.npy",
        "6-report-force.tiff",
        "index.html",
    ];
    let named: Vec<String> = names.iter().map(|name| format!("a/b/{name}")).collect();
    assert_eq!(files, named);
    for file in files.iter().filter(|file| file.ends_with(".png")) {
        let picture = Picture::load(&folder.path(file)).unwrap();
        let (width, height) = picture.size();
        assert!(width == height && width >= 40, "{file}");
    }
    assert_eq!(
        std::fs::read_dir(folder.path("a/b")).unwrap().count(),
        files.len()
    );
    let page = std::fs::read_to_string(folder.path("a/b/index.html")).unwrap();
    assert_eq!(page.matches(";base64,").count(), 16);
    assert!(page.contains("<a href=\"5-force-x.png\">"));
}

#[test]
fn a_region_is_a_map_of_what_joins_the_inside_of_a_curve() {
    let folder = Folder::new();
    folder.write("disc.pgm", disc(40, [20.0, 20.0], 9.0));
    folder.write("c.csv", "14,14\n26,14\n26,26\n14,26\n");
    let flags = ["field", "disc.pgm", "--out", "a", "--from", "c.csv"];
    let kinds = ["regions", "local-regions", "likelihood", "texture"];
    for kind in kinds {
        let answer = folder.snake(&[&flags[..], &["--kind", kind]].concat());
        assert_eq!(answer.code, Some(0), "{answer:?}");
        let files = answer.out;
        assert!(files.contains(&format!("a/{kind}-push.png")), "{files}");
        let (shape, push) = numbers(&std::fs::read(folder.path(&format!("a/{kind}.npy"))).unwrap());
        assert_eq!(shape, "(1, 40, 40");
        let at = |x: usize, y: usize| push[y * 40 + x];
        // a texture's filters are too wide for a disc this small
        if kind != "texture" {
            assert!(at(20, 13) > 0.0 && at(20, 35) < 0.0, "{kind}");
        }
    }
    let answer = folder.snake(&["field", "disc.pgm", "--out", "b", "--kind", "regions"]);
    assert!(answer.out.contains("b/regions-push.png"), "{answer:?}");
    folder.write("far.csv", "14,14\n260,14\n26,26\n");
    let flags = [
        "field", "disc.pgm", "--out", "b", "--kind", "regions", "--from", "far.csv",
    ];
    let answer = folder.snake(&flags);
    assert_eq!(answer.code, Some(2));
    let says = ["--from", "outside"].map(|part| answer.err.contains(part));
    assert_eq!(says, [true; 2], "{answer:?}");
}

/// The numbers of an NPY file of float64, and its shape as written.
fn numbers(bytes: &[u8]) -> (String, Vec<f64>) {
    let length = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let head = std::str::from_utf8(&bytes[10..length]).unwrap();
    let shape = head.split_once("'shape': ").unwrap().1;
    let shape = shape.split_once(')').unwrap().0.to_owned();
    let (words, _) = bytes[length..].as_chunks::<8>();
    (
        shape,
        words.iter().map(|w| f64::from_le_bytes(*w)).collect(),
    )
}

#[test]
fn the_numbers_of_a_field_are_those_of_the_force() {
    let folder = Folder::new();
    folder.write("disc.pgm", disc(40, [20.0, 20.0], 9.0));
    let sigma = "{ kind = \"edge\", sigma = 2.0 }";
    let kinds = ["--kind", "edge", "--kind", sigma, "--kind", "gvf"];
    let answer = folder.snake(&[&["field", "disc.pgm", "--out", "out"], &kinds[..]].concat());
    assert_eq!((answer.code, answer.err.as_str()), (Some(0), ""));
    for name in ["edge.npy", "edge-2.npy", "gvf.npy", "gvf.tiff"] {
        assert!(folder.path(&format!("out/{name}")).exists(), "{name}");
    }
    let (shape, force) = numbers(&std::fs::read(folder.path("out/edge.npy")).unwrap());
    assert_eq!((shape.as_str(), force.len()), ("(2, 40, 40", 2 * 40 * 40));
    let (_, energy) = numbers(&std::fs::read(folder.path("out/edge-potential.npy")).unwrap());
    // left of the disc to the right, and as the energy falls there; above it down
    let at = |c: usize, x: usize, y: usize| force[c * 1600 + y * 40 + x];
    assert!(at(0, 8, 20) > 1.0 && at(0, 32, 20) < -1.0 && at(1, 20, 8) > 1.0);
    assert!(energy[20 * 40 + 8] > energy[20 * 40 + 9]);
    // far from the edge, only one of them is felt
    let (_, flow) = numbers(&std::fs::read(folder.path("out/gvf.npy")).unwrap());
    let (near, far) = (at(0, 0, 20), flow[20 * 40]);
    assert!(far > 1.0 && near.abs() < 0.5, "{near} {far}");
}

#[test]
fn kinds_of_force_are_listed_refused_and_fitted_with() {
    let folder = Folder::new();
    let listed = folder.snake(&["list", "forces"]);
    assert_eq!((listed.code, listed.err.as_str()), (Some(0), ""));
    for kind in scene::FORCES {
        assert!(
            listed.out.contains(&format!("{} ", kind.name)),
            "{}",
            kind.name
        );
        assert!(listed.out.contains(&format!("energy: {}", kind.energy)));
    }
    let widest = listed.out.lines().map(|line| line.chars().count()).max();
    assert!(widest <= Some(100), "{widest:?}");
    let center = [48.0, 48.0];
    folder.write("disc.pgm", disc(96, center, 25.0));
    folder.write("c.csv", circle(center, 45.0, 12, 1.0));
    let field = ["field", "disc.pgm", "--out", "out", "--kind"];
    folder.refused(&[&field[..], &["gvff"]].concat(), &["--kind", "\"gvf\""]);
    let gravity = "{ kind = \"gravity\", acceleration = [0, 1] }";
    folder.refused(&[&field[..], &[gravity]].concat(), &["--kind", "no field"]);
    let fit = ["fit", "disc.pgm", "--from", "c.csv", "--force"];
    folder.refused(&[&fit[..], &["edg"]].concat(), &["--force", "\"edge\""]);
    let wide = "{ kind = \"edge\", sigma = -1 }";
    folder.refused(&[&fit[..], &[wide]].concat(), &["--force edge: sigma"]);
    // the edge force does not reach twenty pixels, these do
    let reached = |args: &[&str]| {
        let fit = ["fit", "disc.pgm", "--from", "c.csv", "--method", "motion"];
        let answer = folder.snake(&[&fit[..], args].concat());
        off(&shapes::parse_one(&answer.out).unwrap(), center, 25.0)
    };
    assert!(reached(&[]) > 10.0);
    for kind in ["gvf", "vfc", "distance"] {
        let off = reached(&["--force", "edge", "--force", &format!("{kind}:0.5")]);
        assert!(off < 1.0, "{kind}: {off} pixels off");
    }
}

#[test]
fn a_certificate_is_said_before_the_run() {
    let folder = Folder::new();
    let answer = folder.snake(&["run", "soft-ball", "--steps", "3", "--certificate"]);
    assert_eq!((answer.code, answer.out.as_str()), (Some(0), ""));
    let lines: Vec<&str> = answer.err.lines().collect();
    assert_eq!(lines[0], "highest frequencies, 1/T");
    let leapfrog = lines.iter().position(|l| l.trim().starts_with("leapfrog "));
    assert!(leapfrog.is_some() && lines.last().unwrap().starts_with("A soft ball: finished"));
}

#[test]
fn help_reads_well_and_names_every_flag() {
    let folder = Folder::new();
    for (command, parts) in [
        (
            "run",
            &[
                "--scheme",
                "--dt",
                "--steps",
                "--force",
                "--record",
                "--every",
                "--out",
                "--overlay",
                "standard input",
            ][..],
        ),
        (
            "field",
            &[
                "--out",
                "--sigma",
                "--passes",
                "--kind",
                "--all",
                "PNG, JPEG, TIFF",
            ],
        ),
        (
            "fit",
            &[
                "--from",
                "--out",
                "--overlay",
                "--open",
                "--closed",
                "--nodes",
                "--tension",
                "--method",
                "20 if not given",
                "pixel's center at 0,0",
            ],
        ),
        ("list", &["scenes", "schemes", "forces"]),
    ] {
        let answer = folder.snake(&["help", command]);
        assert_eq!((answer.code, answer.err.as_str()), (Some(0), ""));
        for part in parts {
            assert!(
                answer.out.contains(part),
                "{command}: {part}\n{}",
                answer.out
            );
        }
        let widest = answer.out.lines().map(|line| line.chars().count()).max();
        assert!(widest <= Some(100), "{command}");
    }
    let answer = folder.snake(&["help"]);
    assert!(answer.out.contains("Exit code 0"), "{answer:?}");
}

#[test]
fn flags_that_are_none_are_refused_on_one_line() {
    let folder = Folder::new();
    folder.refused(
        &["run", "soft-ball", "--stps", "3"],
        &["'--stps'", "'--steps'"],
    );
    folder.refused(
        &["run", "soft-ball", "--steps", "many"],
        &["'many'", "--steps <N>"],
    );
    folder.refused(&["run", "soft-ball", "--steps", "-3"], &["'-3'"]);
    folder.refused(&["run", "soft-ball", "--record", ""], &["--record <FILE>"]);
    folder.refused(
        &["run", "soft-ball", "--every", "0", "--record", "-"],
        &["--every", "at least 1"],
    );
    folder.refused(&["runn"], &["'runn'", "'run'"]);
    folder.refused(&["list", "scheems"], &["'scheems'", "schemes"]);
    folder.refused(
        &["fit", "a.png", "--from", "b", "--open", "--closed"],
        &["--open", "--closed"],
    );
    let answer = folder.snake(&[]);
    assert_eq!(answer.code, Some(2));
    assert!(
        answer.err.contains("Usage: snake [OPTIONS] <COMMAND>"),
        "{answer:?}"
    );
}
