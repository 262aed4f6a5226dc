//! The searches on drawn discs: found from near, from outside and from inside, whatever the picture's units.

use field::Grid;
use glam::DVec2;
use search::along::Polygon;
use search::{
    Rules, Search, Searched, Stopped, find, find_around, find_around_unless, find_unless,
};

const CENTER: DVec2 = DVec2::new(70.3, 64.8);
const RADIUS: f64 = 30.0;

/// Levels of a disc with a soft border, and a little texture so that the ground is not constant.
fn level(p: DVec2) -> f64 {
    let inside = (0.5 + (RADIUS - p.distance(CENTER)) / 3.0).clamp(0.0, 1.0);
    let texture = 4.0 * (0.9 * p.x + 0.3 * p.y).sin() * (0.4 * p.x - 1.1 * p.y).cos();
    60.0 + 120.0 * inside + texture
}

fn picture(change: impl Fn(f64) -> f64) -> Grid {
    Grid::from_shape_fn((128, 140), |(y, x)| {
        change(level(DVec2::new(x as f64, y as f64)))
    })
}

fn circle(center: DVec2, radius: f64) -> Polygon {
    let turn = |i: u32| DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / 100.0);
    Polygon {
        points: (0..100).map(|i| center + radius * turn(i)).collect(),
        closed: true,
    }
}

/// The largest distance of a curve's points from the disc's border.
fn off(points: &[DVec2]) -> f64 {
    points
        .iter()
        .map(|p| (p.distance(CENTER) - RADIUS).abs())
        .fold(0.0, f64::max)
}

#[test]
fn it_is_found_from_near_from_outside_and_from_inside() {
    let shift = DVec2::new(2.0, -1.0);
    for (start, beside, around) in [
        (circle(CENTER + shift, 1.1 * RADIUS), true, false),
        (circle(CENTER - shift, 0.96 * RADIUS), true, false),
        (circle(CENTER + shift, 1.6 * RADIUS), false, false),
        (circle(CENTER - shift, 0.45 * RADIUS), true, true),
    ] {
        let found = find(&picture(|v| v), &start, &Rules::default()).unwrap();
        let far = off(&found.taken().points);
        // an edge counts in full within 1.5 pixels of the window, so a start as near draws the curve to it; the last
        // stage goes on from there
        assert!(far < 3.0, "{far}");
        let near = matches!(found.taken().search, Search::Near | Search::Close);
        assert_eq!((near, found.around), (beside, around));
        assert!(found.taken().support.closed > 0.46);
    }
}

#[test]
fn nothing_depends_on_the_units_of_the_picture() {
    let rules = Rules::default();
    let start = circle(CENTER + DVec2::new(3.0, 2.0), 1.2 * RADIUS);
    let plain = find(&picture(|v| v), &start, &rules).unwrap();
    for change in [
        |v: f64| 255.0 - v,
        |v: f64| 0.25 * v,
        |v: f64| 1e30 * v,
        |v: f64| 1e-30 * v - 1e-29,
    ] {
        let other = find(&picture(change), &start, &rules).unwrap();
        let apart = plain.taken().points.iter().zip(&other.taken().points);
        let apart = apart.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(apart < 0.7, "{apart}");
    }
}

#[test]
fn a_click_is_enough_and_one_outside_the_picture_is_refused() {
    let found = find_around(
        &picture(|v| v),
        CENTER + DVec2::new(6.0, 4.0),
        &Rules::default(),
    )
    .unwrap();
    // a region's outline may have a spike of a node, which the last stage smooths
    let points = &found.taken().points;
    let far = points
        .iter()
        .filter(|p| (p.distance(CENTER) - RADIUS).abs() > 2.0)
        .count();
    assert!(50 * far < points.len(), "{far} of {}", points.len());
    assert!(find_around(&picture(|v| v), DVec2::new(-3.0, 4.0), &Rules::default()).is_none());
}

#[test]
fn a_disc_cut_by_the_border_is_free_along_it() {
    // the right third of the disc is not in the picture
    let whole = picture(|v| v);
    let cut = whole.slice(ndarray::s![.., ..80]).to_owned();
    let start = Polygon {
        points: circle(CENTER, 1.12 * RADIUS)
            .points
            .iter()
            .map(|p| p.min(DVec2::new(79.0, 127.0)))
            .collect(),
        closed: true,
    };
    let found = find(&cut, &start, &Rules::default()).unwrap();
    let inner = found.taken().points.iter().filter(|p| p.x < 76.0).copied();
    let inner: Vec<DVec2> = inner.collect();
    assert!(
        off(&inner) < 1.5 && inner.len() > 60,
        "{} {}",
        off(&inner),
        inner.len()
    );
}

#[test]
fn a_blank_picture_supports_nothing() {
    for blank in [picture(|_| 0.0), picture(|_| 7.5)] {
        let found = find(&blank, &circle(CENTER, RADIUS), &Rules::default()).unwrap();
        assert!(
            found.taken().support.closed < 0.3,
            "{:?}",
            found.taken().support
        );
    }
    let point = Polygon {
        points: vec![CENTER; 8],
        closed: true,
    };
    assert!(find(&picture(|v| v), &point, &Rules::default()).is_none());
}

#[test]
fn an_open_curve_finds_a_line_of_edge() {
    // a border that runs as a wave from left to right
    let wave = |x: f64| 60.0 + 6.0 * (0.08 * x).sin();
    let level = |(y, x): (usize, usize)| {
        80.0 + 100.0 * (0.5 + (y as f64 - wave(x as f64)) / 3.0).clamp(0.0, 1.0)
    };
    let picture = Grid::from_shape_fn((120, 160), level);
    let start = Polygon {
        points: vec![
            DVec2::new(12.0, 63.0),
            DVec2::new(80.0, 58.0),
            DVec2::new(148.0, 62.0),
        ],
        closed: false,
    };
    let found = find(&picture, &start, &Rules::default()).unwrap();
    let worst = found
        .taken()
        .points
        .iter()
        .map(|p| (p.y - wave(p.x)).abs())
        .fold(0.0, f64::max);
    assert!(
        worst < 2.0 && found.taken().support.closed > 0.46,
        "{worst} {:?}",
        found.taken().support
    );
}

/// A picture turned clockwise by a right angle, and a place in it.
fn turned(picture: &Grid) -> Grid {
    let (height, width) = picture.dim();
    Grid::from_shape_fn((width, height), |(y, x)| picture[[height - 1 - x, y]])
}

#[test]
fn a_picture_that_is_turned_has_the_same_outline() {
    // two blobs with texture: rays, bands and regions all have something to find
    let ground = picture(|v| v);
    let blob = |p: DVec2| (-(p - DVec2::new(104.0, 60.0)).length_squared() / 300.0).exp();
    let picture = Grid::from_shape_fn(ground.dim(), |(y, x)| {
        ground[[y, x]] + 90.0 * blob(DVec2::new(x as f64, y as f64))
    });
    let rules = Rules::default();
    for start in [
        circle(CENTER + DVec2::new(2.0, -1.0), 1.1 * RADIUS),
        circle(CENTER + DVec2::new(6.3, 2.0), 1.7 * RADIUS),
        circle(CENTER - DVec2::new(2.0, 1.0), 0.5 * RADIUS),
    ] {
        let found = find(&picture, &start, &rules).unwrap();
        let (mut picture, mut start) = (picture.clone(), start);
        let mut wanted = found.taken().points.clone();
        for _ in 0..3 {
            let last = picture.nrows() as f64 - 1.0;
            let turn = |p: DVec2| DVec2::new(last - p.y, p.x);
            start.points.iter_mut().for_each(|p| *p = turn(*p));
            wanted.iter_mut().for_each(|p| *p = turn(*p));
            picture = turned(&picture);
            let other = find(&picture, &start, &rules).unwrap();
            assert_eq!(found.taken().search, other.taken().search);
            assert_eq!(wanted.len(), other.taken().points.len());
            let apart = wanted.iter().zip(&other.taken().points);
            let apart = apart.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            assert!(apart < 1e-6, "{apart}");
        }
    }
}

/// How often a search is asked whether to end; at each of these it does.
fn looks(search: impl Fn(&dyn Fn() -> bool) -> Result<Option<Searched>, Stopped>) -> usize {
    for last in 0.. {
        let count = std::cell::Cell::new(0);
        let answer = search(&|| {
            count.set(count.get() + 1);
            count.get() > last
        });
        match answer {
            Err(Stopped) => assert_eq!(
                count.get(),
                last + 1,
                "it goes on after it was asked to end"
            ),
            Ok(found) => {
                assert!(found.is_some());
                return last;
            }
        }
    }
    0
}

#[test]
fn a_search_ends_where_it_is_asked_to() {
    let (picture, rules) = (picture(|v| v), Rules::default());
    let start = circle(CENTER + DVec2::new(3.0, 2.0), 1.6 * RADIUS);
    let one = looks(|asked| find_unless(&picture, &start, &rules, asked));
    assert!(one >= 5, "{one}");
    let click = looks(|asked| find_around_unless(&picture, CENTER, &rules, asked));
    assert!(click >= 5 * one, "{click}");
}
