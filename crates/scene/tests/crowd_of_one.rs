//! A crowd of one snake is a lone snake: the same end, the same code, the same bytes, for every
//! shipped scene that both can run.
#![allow(
    clippy::unwrap_used,
    reason = "a test: a shipped scene that cannot be read should stop it"
)]

use std::ops::ControlFlow::Continue;

use scene::snake::Upkeep;
use scene::{Company, Scene};

/// Shipped scenes that a crowd refuses: a hand, ends that grow, or a frame of its own equation.
/// Whoever makes one machine
/// of both takes them off.
const REFUSED: &[&str] = &["spinning-oval", "road", "apple-hand"];

/// Enough for contacts, schedules and rest to matter, and few enough for a test.
const STEPS: u64 = 400;

#[test]
fn a_crowd_of_one_is_a_lone_snake() {
    let (mut ran, mut refused) = (0, Vec::new());
    for (name, _) in scene::SCENES {
        let mut lone = Scene::named(name).unwrap();
        if lone.company.is_some() {
            continue; // it is a crowd
        }
        lone.plan.until.steps = lone.plan.until.steps.min(STEPS);
        lone.plan.recording = scene::Recording::default();
        if lone.tips.is_some() || lone.terms.is_some() || !lone.hand.is_empty() || lone.plan.each {
            refused.push(*name);
            continue;
        }
        let mut crowd = lone.clone();
        crowd.company = Some(Company {
            others: Vec::new(),
            contact: None,
            upkeep: Upkeep::default(),
        });
        let one = lone.run(&mut |_| Continue(())).unwrap();
        let other = crowd.run(&mut |_| Continue(())).unwrap();
        assert_eq!(one.outcome, other.outcome, "{name}");
        let (a, b) = (one.last().unwrap(), other.last().unwrap());
        assert_eq!((a.step, a.t.to_bits()), (b.step, b.t.to_bits()), "{name}");
        for (p, q) in a.nodes().iter().zip(b.nodes()) {
            let bits = |x: f64, y: f64| (x.to_bits(), y.to_bits());
            assert_eq!(bits(p.x, p.y), bits(q.x, q.y), "{name}");
        }
        ran += 1;
    }
    assert!(ran > 10, "{ran}");
    assert_eq!(refused, REFUSED);
}
