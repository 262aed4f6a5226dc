//! One fit by several ways: at once, step by step, on threads, by many.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use crate::common::{disc, whole};
use fit::{Contour, Edit, Fit, Image, Job, OptionKey, Options, Prepared, fit_many};
use glam::DVec2;

const CENTER: DVec2 = DVec2::new(48.3, 44.8);

fn prepared(options: &Options) -> Prepared {
    Prepared::of(&Image::grey(disc(CENTER, 22.0)), options).unwrap()
}

fn starts() -> Vec<Contour> {
    let start = |k: u32| {
        let off = DVec2::from_angle(f64::from(k)) * 0.3 * f64::from(k);
        Contour::circle(CENTER + off, 20.0 + 0.7 * f64::from(k))
    };
    (0..10).map(start).collect()
}

fn bits(fit: &Fit) -> Vec<[u64; 2]> {
    let points = fit.contour.points.iter();
    points.map(|p| p.to_array().map(f64::to_bits)).collect()
}

#[test]
fn a_session_in_any_parts_is_the_fit_to_the_last_bit() {
    for lazy in [false, true] {
        let options = if lazy { Options::motion() } else { whole() };
        let prepared = prepared(&options);
        let start = &starts()[7];
        let whole = prepared.fit(start).unwrap();
        for part in [1, 3, 1000] {
            let mut session = prepared.session(start).unwrap();
            while session.step(part).is_none() {}
            let steps = session.steps();
            let parts = session.finish();
            assert_eq!((bits(&parts), steps), (bits(&whole), whole.steps));
            assert_eq!(parts, whole);
        }
    }
}

#[test]
fn threads_share_one_image_and_find_the_same_bytes() {
    let (alone, shared) = (prepared(&Options::motion()), prepared(&Options::motion()));
    let starts = starts();
    let expected: Vec<Fit> = starts.iter().map(|s| alone.fit(s).unwrap()).collect();
    let found: Vec<Fit> = std::thread::scope(|scope| {
        let run = |start| {
            let shared = shared.clone();
            scope.spawn(move || shared.fit(start).unwrap())
        };
        let handles: Vec<_> = starts.iter().map(run).collect();
        handles.into_iter().map(|h| h.join().unwrap()).collect()
    });
    assert_eq!(found, expected);
}

#[test]
fn many_fits_come_in_order_and_do_not_depend_on_the_number_of_threads() {
    let prepared = prepared(&Options::motion());
    let mut starts = starts();
    // one is refused
    starts[4] = Contour::circle(DVec2::splat(-9.0), 3.0);
    let jobs: Vec<Job<'_>> = starts
        .iter()
        .map(|start| Job {
            prepared: &prepared,
            start,
        })
        .collect();
    let run = |threads| {
        let mut all = Vec::new();
        fit_many(&jobs, threads, |index, found| all.push((index, found)));
        all
    };
    let one = run(1);
    let order: Vec<usize> = one.iter().map(|(index, _)| *index).collect();
    assert_eq!(order, (0..starts.len()).collect::<Vec<_>>());
    let refused = one[4].1.as_ref().unwrap_err();
    assert_eq!(refused.key, OptionKey::Start);
    for threads in [0, 2, 3, 16] {
        assert_eq!(run(threads), one, "{threads}");
    }
    fit_many(&[], 4, |_, _| unreachable!("there is no job"));
}

#[test]
fn edits_act_and_are_refused_by_their_key() {
    let prepared = prepared(&whole());
    let mut session = prepared.session(&starts()[7]).unwrap();
    assert!(session.step(1000).is_some());
    let before = session.nodes().to_vec();
    // held nodes stay while one beside them is pulled away
    session.edit(Edit::Hold(vec![5, 6])).unwrap();
    session
        .edit(Edit::Pull {
            node: 0,
            to: CENTER + DVec2::new(30.0, 0.0),
            stiffness: 200.0,
        })
        .unwrap();
    assert!(session.step(1000).is_some());
    assert!(session.nodes()[5] == before[5] && session.nodes()[6] == before[6]);
    assert!(session.nodes()[0].distance(before[0]) > 3.0);
    session.edit(Edit::LetGo).unwrap();
    session.edit(Edit::Release(vec![5, 6])).unwrap();
    session.edit(Edit::Strength(2.0)).unwrap();
    session
        .edit(Edit::Material {
            tether: 0.0,
            tension: 5.0,
            rigidity: 20.0,
        })
        .unwrap();
    for (edit, key) in [
        (Edit::Hold(vec![9999]), OptionKey::Nodes),
        (Edit::Release(vec![9999]), OptionKey::Nodes),
        (Edit::Strength(f64::NAN), OptionKey::Strength),
        (
            Edit::Pull {
                node: 9999,
                to: CENTER,
                stiffness: 1.0,
            },
            OptionKey::Nodes,
        ),
        (
            Edit::Pull {
                node: 0,
                to: DVec2::NAN,
                stiffness: 1.0,
            },
            OptionKey::Pull,
        ),
        (
            Edit::Material {
                tether: 0.0,
                tension: -1.0,
                rigidity: 0.0,
            },
            OptionKey::Tension,
        ),
    ] {
        assert_eq!(session.edit(edit).unwrap_err().key, key);
    }
    let fit = session.finish();
    assert!(fit.is_outline());
    let radius = fit.contour.points[0].distance(CENTER);
    assert!((radius - 22.0).abs() < 0.5, "{radius}");
}
