//! What a scene says of the body beyond its material: frames that turn, damping that is chosen.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use std::ops::ControlFlow;
use std::path::Path;

use glam::DVec2;
use scene::elastic;
use scene::snake::Certificate;
use scene::{Record, SCENES, Scene};

fn changed(name: &str, changes: &[(&str, &str)]) -> Result<Scene, scene::SceneError> {
    let (_, text) = SCENES.iter().find(|(known, _)| *known == name).unwrap();
    let text = changes.iter().fold((*text).to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{name} has no {from}");
        text.replace(from, to)
    });
    Scene::parse(name, &text, Path::new("."))
}

fn run(scene: &mut Scene) -> Record {
    scene.run(&mut |_| ControlFlow::Continue(())).unwrap()
}

fn refused(name: &str, changes: &[(&str, &str)]) -> String {
    changed(name, changes).unwrap_err().to_string()
}

#[test]
fn the_word_critical_gives_the_slowest_mode_that_resists_its_critical_damping() {
    let scene = Scene::named("calmed-oval").unwrap();
    let modes = Certificate::of(&scene.snake, None).modes;
    let slowest = modes.iter().find(|mode| mode.frequency > 0.0).unwrap();
    assert!((slowest.damping_ratio() - 1.0).abs() < 1e-12);
    let third = changed("calmed-oval", &[("\"critical\"", "\"mode(2)\"")]).unwrap();
    let modes = Certificate::of(&third.snake, None).modes;
    let resisting: Vec<_> = modes.iter().filter(|mode| mode.frequency > 0.0).collect();
    assert!((resisting[2].damping_ratio() - 1.0).abs() < 1e-12);
}

#[test]
fn a_calmed_oval_is_at_rest_long_before_the_ringing_one() {
    let mut calm = Scene::named("calmed-oval").unwrap();
    let calmed = run(&mut calm);
    let mut ringing = changed("calmed-oval", &[("\"critical\"", "0.3")]).unwrap();
    let rang = run(&mut ringing);
    assert_eq!(calmed.outcome.name(), "settled");
    assert!(calmed.outcome.step() * 2 < rang.outcome.step());
}

#[test]
fn internal_damping_takes_from_bending_and_nothing_from_flight() {
    let text = [
        (
            "damping = \"critical\"",
            "damping = 0.0\ninternal = \"critical\"",
        ),
        (
            "topology = \"closed\"",
            "topology = \"closed\"\nvelocity = [3.0, 0.0]",
        ),
        ("rest = {}", ""),
        ("time = 200.0", "time = 20.0"),
        ("dt = 0.02", "dt = 0.0004"),
        ("every = 10\n", "every = 10000\n"),
    ];
    let mut scene = changed("calmed-oval", &text).unwrap();
    let record = run(&mut scene);
    let last = record.frames.last().unwrap();
    let energies = last.energies.as_ref().unwrap();
    let flight = 0.5 * scene.snake.body().spacing * 64.0 * 9.0;
    // of the shape nothing is left, of the flight all
    assert!((energies.kinetic / flight - 1.0).abs() < 1e-6);
    // stiff modes creep at half the frequency of the critical one: e^(−2 · 0.226 · 20) = 1e-4
    assert!(energies.elastic() < 1e-3 * energies.damping);
}

#[test]
fn rules_of_damping_that_are_none_are_refused_with_what_would_do() {
    for (word, says) in [
        ("\"criticl\"", "there is no rule \"criticl\""),
        ("\"mode(9000)\"", "no mode 9000"),
        ("\"internal(1)\"", "no rule of this key"),
        ("\"renewed(0)\"", "above 0"),
        ("-1.0", "at least 0"),
    ] {
        let message = refused("calmed-oval", &[("\"critical\"", word)]);
        assert!(message.starts_with("densities.damping: "), "{message}");
        assert!(message.contains(says), "{message}");
    }
    let inside = |word: &str| {
        let text = format!("damping = 0.1\ninternal = {word}");
        refused("calmed-oval", &[("damping = \"critical\"", text.as_str())])
    };
    assert!(inside("\"local\"").contains("densities.internal: local is no rule"));
    assert!(inside("-0.5").contains("internal damping"));
    let looked_after = [
        ("[run]", "[upkeep]\nstretch = 2.0\n[run]"),
        ("\"critical\"", "\"renewed(1)\""),
    ];
    assert!(refused("calmed-oval", &looked_after).contains("needed: \"local\""));
}

#[test]
fn a_spinning_oval_keeps_its_energy_by_either_turning_frame_and_moves_alike() {
    let mut equations = Scene::named("spinning-oval").unwrap();
    let by_equations = run(&mut equations);
    let fit = [(
        "frame = { terms = [\"centrifugal\", \"coriolis\", \"transverse\"] }",
        "frame = \"turning\"",
    )];
    let by_fit = run(&mut changed("spinning-oval", &fit).unwrap());
    let pairs = by_equations.frames.iter().zip(&by_fit.frames);
    for (a, b) in pairs {
        let apart = a.nodes().iter().zip(b.nodes()).map(|(a, b)| a.distance(*b));
        // two ways of order 4 over two turns
        assert!(apart.fold(0.0, f64::max) < 1e-5, "at {}", a.t);
    }
    let total = |record: &Record, k: usize| record.frames[k].energies.as_ref().unwrap().total();
    let last = by_equations.frames.len() - 1;
    assert!((total(&by_equations, last) / total(&by_equations, 0) - 1.0).abs() < 1e-7);
}

#[test]
fn a_term_left_out_by_name_changes_the_motion_as_theory_says() {
    // without the centrifugal force nothing widens the oval: its greatest elastic energy falls
    let greatest = |record: &Record| {
        let energies = record
            .frames
            .iter()
            .map(|frame| frame.energies.as_ref().unwrap().elastic());
        energies.fold(0.0, f64::max)
    };
    let whole = run(&mut Scene::named("spinning-oval").unwrap());
    let without = [("\"centrifugal\", ", "")];
    let without = run(&mut changed("spinning-oval", &without).unwrap());
    assert!(greatest(&without) < 0.1 * greatest(&whole));
}

#[test]
fn what_a_turning_frame_cannot_carry_is_refused_by_its_key() {
    for (from, to, says) in [
        ("\"coriolis\"", "\"corioli\"", "did you mean \"coriolis\""),
        (
            "topology = \"closed\"",
            "topology = { head = \"pinned\", tail = \"free\" }",
            "every node free",
        ),
        (
            "[run]",
            "[schedule]\ntension = [[0.0, 1.0], [1.0, 2.0]]\n[run]",
            "stay the same",
        ),
        ("dt = 0.002\n", "dt = \"auto\"\n", "\"auto\""),
        (
            "title",
            "rules = { frame = \"report\" }\ntitle",
            "does not turn",
        ),
    ] {
        let scene = changed("spinning-oval", &[(from, to)]);
        let error = scene
            .and_then(|scene| scene.check())
            .unwrap_err()
            .to_string();
        assert!(error.contains(says), "{to}: {error}");
    }
}

#[test]
fn a_picture_that_rotates_takes_a_turning_oval_with_it_and_strains_one_that_does_not_turn() {
    let strain = |frame: &str| {
        let changes = [
            ("frame = \"turning\"", frame),
            ("time = 630.0", "time = 157.0"),
        ];
        let mut scene = changed("turned-oval", &changes).unwrap();
        let record = run(&mut scene);
        let last = record.frames.last().unwrap();
        // angle of the longer axis, from the second moments
        let center = elastic::center(last.nodes(), None);
        let (mut xx, mut xy) = (0.0, 0.0);
        for p in last.nodes() {
            let q = *p - center;
            xx += q.x * q.x - q.y * q.y;
            xy += 2.0 * q.x * q.y;
        }
        (
            0.5 * xy.atan2(xx),
            last.energies.as_ref().unwrap().elastic(),
        )
    };
    // a quarter turn at 0.01 per unit of time
    let (turned, calm) = strain("frame = \"turning\"");
    assert!(
        (turned.abs() - std::f64::consts::FRAC_PI_2).abs() < 0.1,
        "{turned}"
    );
    let (_, strained) = strain("frame = \"translating\"");
    assert!(calm < 0.05 * strained, "{calm} {strained}");
    for (from, to, says) in [
        ("spin = 0.01\n", "", "needed: spin with it"),
        (
            "about = [63.5, 63.5]",
            "about = [1e12, 0.0]",
            "force 0: about",
        ),
    ] {
        assert!(refused("turned-oval", &[(from, to)]).contains(says));
    }
}

/// The distance of a place from the road of the scene of that name, and how far along the road it is.
fn from_road(p: DVec2) -> (f64, f64) {
    let corners = [
        (-10.0, 96.0),
        (10.0, 96.0),
        (30.0, 95.1),
        (46.0, 92.6),
        (58.0, 88.5),
        (68.0, 82.8),
        (78.0, 74.0),
        (88.0, 63.0),
        (98.0, 51.7),
        (110.0, 41.4),
        (124.0, 33.9),
        (138.0, 29.9),
        (150.0, 28.4),
        (160.0, 28.0),
    ];
    let (mut best, mut arc) = ((f64::INFINITY, 0.0), 0.0);
    for pair in corners.windows(2) {
        let (a, b) = (DVec2::from(pair[0]), DVec2::from(pair[1]));
        let along = b - a;
        let share = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        let off = p.distance(a + share * along);
        if off < best.0 {
            best = (off, arc + share * along.length());
        }
        arc += along.length();
    }
    best
}

#[test]
fn tips_find_a_whole_road_in_noise_from_one_stretch_of_it_and_stop_where_it_ends() {
    let text = [("[record]", "[record]\nenergies = true")];
    let mut scene = changed("road", &text).unwrap();
    let record = run(&mut scene);
    let total = |frame: &scene::Frame| frame.energies.as_ref().unwrap().total();
    let (first, end) = (&record.frames[0], record.frames.last().unwrap());
    // growth is booked: rounding of some thousand steps
    let spent = end.energies.as_ref().unwrap().damping;
    assert!(spent > 1.0 && (total(end) - total(first)).abs() < 1e-12 * spent);
    let last = end.nodes();
    let worst = last.iter().map(|&p| from_road(p).0).fold(0.0, f64::max);
    // the road is 4 wide, the noise a fifth of its height, smoothed over some 25 pixels
    assert!(worst < 1.5, "{worst}");
    let (head, tail) = (last[0], last[last.len() - 1]);
    // one end leaves the picture at x = 0, the other is at (160, 28); a look ahead is one and a half spacings of 2.8
    assert!(head.x < 5.0, "{head}");
    assert!(tail.distance(DVec2::new(160.0, 28.0)) < 5.0, "{tail}");
    assert_eq!(record.events.len(), 2, "{:?}", record.events);
    assert!(record.outcome.is_good());
}

#[test]
fn ends_on_the_border_slide_along_it_to_the_edge() {
    let mut scene = Scene::named("sliding-strip").unwrap();
    let record = run(&mut scene);
    let last = record.frames.last().unwrap().nodes();
    for (at, x) in [(last[0], 0.0), (last[39], 95.0)] {
        // the box begins in the middle of row 40
        assert!(
            (at.x - x).abs() < 1e-9 && (at.y - 40.0).abs() < 0.05,
            "{at}"
        );
    }
    assert_eq!(record.outcome.name(), "settled");
    // pinned ones stay where they were let go
    let pinned = [(
        "\"border\", tail = \"border\"",
        "\"pinned\", tail = \"pinned\"",
    )];
    let pinned = run(&mut changed("sliding-strip", &pinned).unwrap());
    assert!((pinned.frames.last().unwrap().nodes()[0].y - 34.0).abs() < 1e-12);
}

#[test]
fn the_third_order_closes_the_account_and_lowers_the_step_as_theory_says() {
    let energies = [
        ("[record]", "[record]\nenergies = true"),
        ("time = 200.0", "time = 20.0"),
    ];
    let mut scene = changed("third-order", &energies).unwrap();
    let h = scene.snake.body().spacing;
    let steep = 4.0 / (h * h);
    let limit = 2.0 / (5.0 * steep + 1e4 * steep.powi(3)).sqrt();
    // without the slope of the picture
    let elastic = scene.plan.scheme.step_limit(&scene.snake).unwrap();
    assert!((elastic / limit - 1.0).abs() < 1e-9);
    assert!(scene.step_limit().unwrap() <= limit);
    let record = run(&mut scene);
    assert!(record.terms.iter().any(|name| name == "higher"));
    let total = |k: usize| record.frames[k].energies.as_ref().unwrap().total();
    let first = record.frames[0].energies.as_ref().unwrap();
    let most = first
        .values()
        .iter()
        .fold(0.0_f64, |a, b| a.max(b.abs()))
        .max(100.0);
    // leapfrog at a seventh of its limit: (1/7)² / 24 of the stiffest term at most
    assert!((total(record.frames.len() - 1) - total(0)).abs() < 2e-3 * most);
    for (from, to, says) in [
        ("higher = [10000.0]", "higher = [-1.0]", "weight of order 3"),
        (
            "higher = [10000.0]",
            "higher = [1.0, 1.0, 1.0, 1.0, 1.0]",
            "orders 0 to at most 6",
        ),
    ] {
        let message = refused("third-order", &[(from, to)]);
        assert!(
            message.starts_with("material.higher: ") && message.contains(says),
            "{message}"
        );
    }
    let idle = [
        ("higher = [10000.0]", ""),
        (
            "[densities]",
            "[schedule]\nhigher = [[0.0, 1.0]]\n[densities]",
        ),
    ];
    assert!(refused("third-order", &idle).starts_with("schedule.higher: there is nothing"));
}

#[test]
fn orders_above_the_second_go_with_all_that_a_body_does() {
    let base = [
        ("[record]", "[record]\nenergies = true"),
        ("time = 200.0", "time = 5.0"),
    ];
    let strays = |more: &[(&str, &str)]| {
        let mut scene = changed("third-order", &[&base, more].concat()).unwrap();
        let record = run(&mut scene);
        let kept = |k: usize| record.frames[k].energies.clone().unwrap();
        let (first, last) = (kept(0), kept(record.frames.len() - 1));
        assert_eq!(last.values().len(), record.terms.len());
        assert!(last.higher.unwrap() > 0.0 && record.terms[4] == "higher");
        let size: f64 = last.values().iter().map(|value| value.abs()).sum();
        (last.total() - first.total()).abs() / size
    };
    assert!(strays(&[]) < 1e-12, "{}", strays(&[]));
    // what the leapfrog does is known; of the others the work is summed by the square of the step
    for (allowed, from, to) in [
        (1e-12, "topology", "frame = \"turning\"\ntopology"),
        (1e-12, "higher = [10000.0]", "higher = [0.0, 1000.0]"),
        (1e-12, "damping = 1.0", "damping = 1.0\ninternal = 1e-4"),
        (
            1e-12,
            "[densities]",
            "[schedule]\nhigher = [[0.0, 1.0], [5.0, 0.5]]\n[densities]",
        ),
        // beyond the leapfrog's limit of 0.07
        (3e-3, "dt = 0.01", "dt = 0.1\nscheme = \"newmark\""),
        (3e-2, "dt = 0.01", "dt = 0.1\nscheme = \"imex\""),
    ] {
        let found = strays(&[(from, to)]);
        assert!(found < allowed, "{to}: {found:e}");
    }
    // grows to twice its start, and its rest shape goes with the nodes that are put in
    let drawn = [
        (
            "radius = 30.0 } }",
            "radius = 20.0 } }\nrest = { circle = { center = [49.0, 47.0], radius = 44.0 } }",
        ),
        ("[material]", "[upkeep]\nstretch = 1.5\n[material]"),
        ("dt = 0.01", "dt = 0.01\nscheme = \"newmark\""),
    ];
    let mut scene = changed("third-order", &[&base[..], &drawn].concat()).unwrap();
    let record = run(&mut scene);
    let kept = |k: usize| record.frames[k].energies.clone().unwrap();
    let (first, last) = (kept(0), kept(record.frames.len() - 1));
    let put_in = last.upkeep.abs();
    let nodes = record.frames[record.frames.len() - 1].nodes().len();
    assert!(nodes > 60, "{nodes}");
    let off = (last.total() - first.total()).abs();
    assert!(
        put_in > 0.0 && off < 2e-3 * put_in.max(first.total()),
        "{off} {put_in}"
    );
    assert!(!record.events.is_empty());
}

#[test]
fn ends_and_tips_that_will_not_do_are_refused_by_their_key() {
    for (name, from, to, says) in [
        (
            "sliding-strip",
            "\"border\", tail",
            "\"bordr\", tail",
            "did you mean \"border\"",
        ),
        (
            "sliding-strip",
            "\"border\", tail",
            "{ rail = [[0.0, 0.0]] }, tail",
            "snake.topology.head",
        ),
        (
            "sliding-strip",
            "\"border\", tail",
            "{ rail = [[20.0, 0.0], [20.0, 80.0]] }, tail",
            "from the line it slides along",
        ),
        (
            "road",
            "topology = { head = \"free\"",
            "topology = { head = \"pinned\"",
            "tips: ends that grow need ends that are free",
        ),
        (
            "road",
            "tension = 60.0",
            "tension = { along = [[0.0, 1.0], [1.0, 2.0]] }",
            "the same all along",
        ),
        (
            "road",
            "least = 0.45",
            "lest = 0.45",
            "did you mean \"least\"",
        ),
        ("road", "every = 40\n", "every = 0\n", "tips.every"),
        (
            "road",
            "kind = \"line\"",
            "kind = \"gravity\"\nacceleration = [0.0, 1.0]",
            "fields of the picture",
        ),
        (
            "road",
            "width = 4.0",
            "width = -4.0",
            "picture.drawn.region.road.width",
        ),
    ] {
        let text = if to.starts_with("kind = \"gravity\"") {
            refused(name, &[("sigma = 3.0\nstrength = 0.3", ""), (from, to)])
        } else {
            refused(name, &[(from, to)])
        };
        assert!(text.contains(says), "{to}: {text}");
    }
}

#[test]
fn sliding_along_a_straight_border_takes_no_energy_and_the_account_closes() {
    let keep = [
        ("every = 100", "every = 10\nenergies = true"),
        ("time = 400.0", "time = 60.0"),
    ];
    let strays = |step: &str| {
        let mut scene = changed("sliding-strip", &[keep[0], keep[1], ("dt = 0.05", step)]).unwrap();
        let record = run(&mut scene);
        let totals = record
            .frames
            .iter()
            .map(|f| f.energies.as_ref().unwrap().total());
        let first = record.frames[0].energies.as_ref().unwrap().total();
        let last = record.frames.last().unwrap().energies.as_ref().unwrap();
        assert!(last.contact.abs() < 1e-9, "{}", last.contact);
        (
            totals.map(|t| (t - first).abs()).fold(0.0, f64::max),
            last.damping,
        )
    };
    let ((coarse, lost), (fine, _)) = (strays("dt = 0.05"), strays("dt = 0.025"));
    // to rounding at either step: some thousand steps, each off by a few parts in 1e16
    assert!(coarse.max(fine) < 1e-11 * lost, "{coarse} {fine} {lost}");
}

#[test]
fn an_end_on_a_line_askew_leaves_the_account_closed() {
    for scheme in ["leapfrog", "report"] {
        let run_by = format!("[run]\nscheme = \"{scheme}\"");
        let text = [
            // whatever pulls across the line must not count as work
            ("[world]", "[world]\ngravity = [0.3, -0.2]"),
            (
                "tail = \"border\"",
                "tail = { rail = [[95.0, 47.0], [70.0, 5.0]] }",
            ),
            ("[run]", run_by.as_str()),
            ("time = 400.0\nrest = {}", "time = 20.0"),
            ("every = 100", "every = 1\nenergies = true"),
        ];
        let mut scene = changed("sliding-strip", &text).unwrap();
        let record = run(&mut scene);
        let totals = record
            .frames
            .iter()
            .map(|frame| frame.energies.as_ref().unwrap().total());
        let totals: Vec<f64> = totals.collect();
        let spent = record
            .frames
            .last()
            .unwrap()
            .energies
            .as_ref()
            .unwrap()
            .damping;
        let gap = totals
            .iter()
            .map(|total| (total - totals[0]).abs())
            .fold(0.0, f64::max);
        // the report's velocities have the rounding of places over the step (D21)
        let open = if scheme == "report" { 1e-9 } else { 1e-12 };
        assert!(
            spent > 1.0 && gap < open * spent,
            "{scheme}: {gap} of {spent}"
        );
    }
}
