//! The method of searches as a library user sees it: outcomes, starts of every kind, what is told.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use crate::common;

use fit::{Choices, Contour, Doubt, Image, Nodes, OptionKey, Options, Prepared, fit};
use glam::DVec2;

const CENTER: DVec2 = DVec2::new(61.3, 58.6);
const RADIUS: f64 = 24.0;

/// A bright disc on a ground with a little texture.
fn disc() -> Image {
    let level = |(y, x): (usize, usize)| {
        let p = DVec2::new(x as f64, y as f64);
        let inside = (0.5 + (RADIUS - p.distance(CENTER)) / 2.0).clamp(0.0, 1.0);
        70.0 + 110.0 * inside + 3.0 * (0.7 * p.x - 0.2 * p.y).sin()
    };
    Image::grey(field::Grid::from_shape_fn((116, 122), level))
}

/// The largest distance of the nodes from the disc's border.
fn off(contour: &Contour) -> f64 {
    let far = contour
        .points
        .iter()
        .map(|p| (p.distance(CENTER) - RADIUS).abs());
    far.fold(0.0, f64::max)
}

#[test]
fn every_start_leads_to_the_same_outline() {
    let image = disc();
    let shift = DVec2::new(2.5, -1.5);
    let starts = [
        Contour::circle(CENTER + shift, 1.12 * RADIUS),
        Contour::circle(CENTER - shift, 1.7 * RADIUS),
        Contour::circle(CENTER + shift, 0.5 * RADIUS),
        Contour::rectangle(CENTER - RADIUS - 2.0, CENTER + RADIUS + 1.0),
        Contour::closed(vec![CENTER + shift]),
        // one that crosses itself: its largest part counts
        Contour::closed(
            [
                (-30.0, -28.0),
                (30.0, -28.0),
                (30.0, 29.0),
                (26.0, 29.0),
                (34.0, 20.0),
                (34.0, 29.0),
                (-30.0, 29.0),
            ]
            .map(|p| CENTER + DVec2::from(p))
            .to_vec(),
        ),
        // one that reaches out of the picture
        Contour::circle(CENTER, 62.0),
    ];
    for (index, start) in starts.iter().enumerate() {
        let found = fit(&image, start, &Options::default()).unwrap();
        assert!(found.is_outline(), "{index}: {}", found.chosen);
        assert!(
            off(&found.contour) < 0.25,
            "{index}: {} {}",
            off(&found.contour),
            found.chosen
        );
        assert_eq!(found.nodes.len(), found.contour.points.len());
        let errors: Vec<f64> = found.nodes.iter().filter_map(|node| node.error).collect();
        assert!(errors.len() > 100 && errors.iter().all(|error| *error < 0.2));
        // bright inside: it gets darker going outwards
        assert!(found.nodes.iter().all(|node| node.slope < 0.0 && node.held));
    }
}

#[test]
fn the_winding_and_the_number_of_nodes_are_those_asked_for() {
    let mut start = Contour::circle(CENTER, 27.0);
    for turned in [false, true] {
        let options = Options {
            nodes: Nodes::Count(40),
            ..Options::default()
        };
        let found = fit(&disc(), &start, &options).unwrap();
        assert_eq!(found.contour.points.len(), 40);
        assert_eq!(elastic::signed_area(&found.contour.points) < 0.0, turned);
        start.points.reverse();
    }
}

#[test]
fn where_there_is_no_boundary_that_is_the_answer_and_the_start_comes_back() {
    let blank = Image::grey(field::Grid::from_elem((100, 100), 12.0));
    let start = Contour::circle(DVec2::new(50.0, 50.0), 20.0);
    let found = fit(&blank, &start, &Options::default()).unwrap();
    assert!(!found.is_outline());
    let doubt = found.quality.as_ref().and_then(|quality| quality.doubt);
    assert!(matches!(doubt, Some(Doubt::NoEdge { .. })), "{doubt:?}");
    let far = found
        .contour
        .points
        .iter()
        .map(|p| (p.distance(DVec2::new(50.0, 50.0)) - 20.0).abs());
    assert!(far.fold(0.0, f64::max) < 1.5);
    // noise of a fixed kind has no outline either
    let noise =
        |(y, x): (usize, usize)| 100.0 + 60.0 * field::drawn::uniform(7, (y * 100 + x) as u64);
    let noise = Image::grey(field::Grid::from_shape_fn((100, 100), noise));
    let found = fit(&noise, &start, &Options::default()).unwrap();
    assert!(!found.is_outline(), "{}", found.chosen);
}

#[test]
fn masked_pixels_and_numbers_that_are_none_say_nothing() {
    // a bar of nonsense across the disc
    let mut levels = disc().pixels().levels().clone();
    let mut valid = ndarray::Array2::from_elem(levels.dim(), true);
    for y in 50..56 {
        for x in 0..122 {
            levels[[y, x]] = f64::NAN;
            valid[[y, x]] = false;
        }
    }
    let image = Image::grey(levels).with_mask(valid).unwrap();
    let found = fit(&image, &Contour::circle(CENTER, 27.0), &Options::default()).unwrap();
    assert!(
        found.is_outline() && off(&found.contour) < 0.8,
        "{}",
        off(&found.contour)
    );
    assert!(found.contour.points.iter().all(|p| p.is_finite()));
}

#[test]
fn an_object_at_the_border_is_cut_by_it() {
    let levels = disc()
        .pixels()
        .levels()
        .slice(ndarray::s![.., ..66])
        .to_owned();
    let found = fit(
        &Image::grey(levels),
        &Contour::circle(CENTER, 26.5),
        &Options::default(),
    )
    .unwrap();
    assert!(found.is_outline(), "{:?} {}", found.quality, found.chosen);
    assert!(found.contour.points.iter().all(|p| p.x <= 65.5));
    let inner: Vec<DVec2> = found
        .contour
        .points
        .iter()
        .filter(|p| p.x < 61.0)
        .copied()
        .collect();
    let far = off(&Contour::open(inner));
    assert!(far < 0.5, "{far}");
}

#[test]
fn an_open_curve_is_found_between_its_ends() {
    let level = |(y, x): (usize, usize)| {
        let border = 50.0 + 8.0 * (0.06 * x as f64).sin();
        60.0 + 90.0 * (0.5 + (border - y as f64) / 2.0).clamp(0.0, 1.0)
    };
    let image = Image::grey(field::Grid::from_shape_fn((100, 140), level));
    let start = Contour::open(vec![
        DVec2::new(15.0, 53.0),
        DVec2::new(70.0, 50.0),
        DVec2::new(125.0, 57.0),
    ]);
    let found = fit(&image, &start, &Options::default()).unwrap();
    let far = |p: &DVec2| (p.y - 50.0 - 8.0 * (0.06 * p.x).sin()).abs();
    let points = &found.contour.points;
    let inner = &points[6..points.len() - 6];
    assert!(
        found.is_outline() && !found.contour.closed,
        "{}",
        found.chosen
    );
    let far = inner.iter().map(far).fold(0.0, f64::max);
    assert!(far < 0.3, "{far}");
}

#[test]
fn starts_that_cannot_be_are_refused_with_what_is_needed() {
    let key = |start: &Contour| fit(&disc(), start, &Options::default()).unwrap_err();
    for (start, words) in [
        (
            Contour::closed(vec![CENTER, CENTER + 9.0]),
            "must be at least 3, got 2",
        ),
        (Contour::open(vec![]), "must be at least 2, got 0"),
        (
            Contour::closed(vec![DVec2::new(-4.0, 3.0)]),
            "is outside the picture",
        ),
        (
            Contour::circle(DVec2::new(500.0, 60.0), 20.0),
            "is outside the picture",
        ),
        (
            Contour::closed(vec![CENTER, DVec2::new(f64::NAN, 2.0), CENTER]),
            "must be finite",
        ),
        (Contour::closed(vec![CENTER; 5]), "encloses nothing"),
        (
            Contour::closed(vec![CENTER, CENTER + 8.0, CENTER + 16.0]),
            "encloses nothing",
        ),
    ] {
        let error = key(&start);
        assert_eq!(error.key, OptionKey::Start);
        assert!(error.to_string().contains(words), "{error}");
    }
    let mut options = Options::default();
    options.search.inward = 0.95;
    let error = Prepared::of(&disc(), &options).unwrap_err();
    assert_eq!(error.to_string(), "inward: must be from 0 to 0.9, got 0.95");
}

#[test]
fn what_was_measured_is_told_in_words() {
    let found = fit(&disc(), &Contour::circle(CENTER, 27.0), &Options::default()).unwrap();
    let Choices::Search(search) = &found.chosen else {
        panic!("a search was asked for")
    };
    assert!(search.seen.brighter == Some(true) && search.support.closed > 0.46);
    let text = found.chosen.to_string();
    for words in [
        "brighter than what is around it",
        "near the start: edge",
        "; taken",
        "last stage: 1",
    ] {
        assert!(text.contains(words), "{text}");
    }
}

#[test]
fn the_last_stage_never_makes_a_curve_worse_by_its_own_evidence() {
    // lines, halos and steps beside each other: whatever the stage does, the edge under the outline stays
    for kind in 0..4 {
        let level = |(y, x): (usize, usize)| {
            let out = DVec2::new(x as f64, y as f64).distance(CENTER) - RADIUS;
            let step = (0.5 - out / 2.0).clamp(0.0, 1.0);
            let line = (-0.5 * ((out - 3.0) / 1.2).powi(2)).exp();
            match kind {
                0 => 70.0 + 60.0 * step + 90.0 * line,
                1 => 70.0 + 60.0 * step - 60.0 * line,
                2 => 70.0 + 90.0 * (-0.5 * (out / 1.5).powi(2)).exp(),
                _ => 70.0 + 50.0 * step + 70.0 * (0.5 - (out - 5.0) / 2.0).clamp(0.0, 1.0),
            }
        };
        let image = Image::grey(field::Grid::from_shape_fn((116, 122), level));
        let found = fit(&image, &Contour::circle(CENTER, 25.0), &Options::default()).unwrap();
        let Choices::Search(search) = &found.chosen else {
            panic!("a search was asked for")
        };
        let before = search.found[search.taken.unwrap()].1;
        assert!(
            search.support.closed > before.closed - 0.05,
            "{kind}: {}",
            found.chosen
        );
        assert!(off(&found.contour) < 7.0 && found.quality.as_ref().unwrap().crossings == 0);
    }
}

#[test]
fn a_polarity_that_is_asked_for_is_kept() {
    let start = Contour::circle(CENTER, 27.0);
    let mut options = Options::default();
    options.search.sign = search::Sign::Brighter;
    assert!(fit(&disc(), &start, &options).unwrap().is_outline());
    options.search.sign = search::Sign::Darker;
    let found = fit(&disc(), &start, &options).unwrap();
    assert!(!found.is_outline(), "{}", found.chosen);
}

#[test]
fn a_slope_is_no_boundary_however_steep() {
    let center = DVec2::new(50.0, 50.0);
    let along = |(_, x): (usize, usize)| 2.0 * x as f64;
    let out = |(y, x): (usize, usize)| 4.0 * DVec2::new(x as f64, y as f64).distance(center);
    for levels in [
        field::Grid::from_shape_fn((100, 100), along),
        field::Grid::from_shape_fn((100, 100), out),
    ] {
        for start in [Contour::circle(center, 25.0), Contour::circle(center, 33.0)] {
            let found = fit(&Image::grey(levels.clone()), &start, &Options::default()).unwrap();
            let doubt = found.quality.as_ref().and_then(|quality| quality.doubt);
            assert!(!found.is_outline() && doubt.is_some(), "{}", found.chosen);
        }
    }
}

#[test]
fn a_click_finds_the_whole_of_an_ellipse() {
    let (center, axes) = (DVec2::new(60.0, 45.0), DVec2::new(32.0, 15.0));
    let inside = |p: DVec2| ((p - center) / axes).length() < 1.0;
    let image = Image::grey(common::drawn((120, 90), inside));
    let truth = std::f64::consts::PI * axes.x * axes.y;
    for (x, y) in [
        (0.0, 0.0),
        (-6.0, 1.0),
        (9.0, -3.0),
        (0.0, 6.0),
        (-14.0, 0.0),
    ] {
        let start = Contour {
            points: vec![center + DVec2::new(x, y)],
            closed: true,
        };
        let found = fit(&image, &start, &Options::default()).unwrap();
        let area = elastic::signed_area(&found.contour.points).abs();
        assert!(
            (area / truth - 1.0).abs() < 0.01,
            "{x} {y}: {area} of {truth}"
        );
    }
}

#[test]
fn a_click_on_one_of_many_discs_finds_that_disc_or_is_unsure() {
    let radius = 9.0;
    let at = |i: u32, j: u32| DVec2::new(25.0 + 24.0 * f64::from(i), 20.0 + 24.0 * f64::from(j));
    let inside = |p: DVec2| (0..25).any(|k| p.distance(at(k % 5, k / 5)) < radius);
    let image = Image::grey(common::drawn((140, 130), inside));
    let truth = std::f64::consts::PI * radius * radius;
    let clicks = [
        (0.0, 0.0),
        (2.0, 1.0),
        (-2.0, -2.0),
        (2.0, -2.0),
        (-3.0, 2.0),
        (3.0, 0.0),
        (0.0, -4.0),
    ];
    let mut right = 0;
    for (x, y) in clicks {
        let start = Contour {
            points: vec![at(2, 2) + DVec2::new(x, y)],
            closed: true,
        };
        let found = fit(&image, &start, &Options::default()).unwrap();
        let area = elastic::signed_area(&found.contour.points).abs();
        let good = (area / truth - 1.0).abs() < 0.02;
        assert!(
            good || !found.is_outline(),
            "{x} {y}: {area} of {truth}, and sure"
        );
        right += u32::from(good && found.is_outline());
    }
    assert!(right >= 5, "{right} of {}", clicks.len());
}
