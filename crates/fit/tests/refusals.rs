//! What is refused, by which key; and what is no error but an outcome.
#![allow(clippy::unwrap_used, reason = "a test: a broken set-up should stop it")]

use std::any::Any;
use std::sync::Arc;

use crate::common::{disc, whole};
use fit::force::{Edge, ForceKey, Gvf, ImageForceKind, Regions, Sight};
use fit::{Contour, FitForce, Image, MakeForce, Nodes, OptionKey, Options, Step, fit};
use glam::DVec2;
use integrator::Fault;
use snake::{Acting, Curve, Force, Outcome};

const CENTER: DVec2 = DVec2::new(48.3, 44.8);

/// A force that is no number any more after a while.
#[derive(Debug, Clone, Copy)]
struct Bursting;

impl MakeForce for Bursting {
    fn make(&self, _: &Sight, _: &[DVec2], _: bool) -> Result<Vec<Acting>, String> {
        Ok(vec![Acting::new(*self)])
    }
}

impl Force for Bursting {
    fn name(&self) -> &'static str {
        "bursting"
    }
    fn add(&mut self, curve: &Curve<'_>, force: &mut [DVec2]) -> Result<(), Fault> {
        if curve.t > 1.0 {
            force.fill(DVec2::NAN);
        }
        Ok(())
    }
    fn boxed(&self) -> Box<dyn Force> {
        Box::new(*self)
    }
    fn as_any(&self) -> &dyn Any {
        self
    }
}

fn image() -> Image {
    Image::grey(disc(CENTER, 22.0))
}

fn near() -> Contour {
    Contour::circle(CENTER, 25.0)
}

fn key(start: &Contour, options: &Options) -> OptionKey {
    fit(&image(), start, options).unwrap_err().key
}

#[test]
fn numbers_that_make_no_sense_are_refused_by_their_option() {
    for bad in [f64::NAN, f64::INFINITY, -1.0] {
        for (key_of, options) in [
            (
                OptionKey::Tether,
                Options {
                    tether: bad,
                    ..whole()
                },
            ),
            (
                OptionKey::Tension,
                Options {
                    tension: bad,
                    ..whole()
                },
            ),
            (
                OptionKey::Rigidity,
                Options {
                    rigidity: bad,
                    ..whole()
                },
            ),
            (
                OptionKey::Damping,
                Options {
                    damping: bad,
                    ..whole()
                },
            ),
            (
                OptionKey::Sigma,
                Options {
                    sigma: bad,
                    ..whole()
                },
            ),
            (
                OptionKey::Strength,
                Options {
                    strength: bad,
                    ..whole()
                },
            ),
            (
                OptionKey::Step,
                Options {
                    step: Step::Equal(bad),
                    ..whole()
                },
            ),
            (
                OptionKey::Nodes,
                Options {
                    nodes: Nodes::Every(bad),
                    ..whole()
                },
            ),
        ] {
            assert_eq!(key(&near(), &options), key_of, "{bad}");
        }
    }
    let balloon = f64::NAN;
    assert_eq!(
        key(&near(), &Options { balloon, ..whole() }),
        OptionKey::Balloon
    );
    let error = fit(
        &image(),
        &near(),
        &Options {
            sigma: -1.0,
            ..whole()
        },
    )
    .unwrap_err();
    assert_eq!(
        error.to_string(),
        "sigma: must be finite and above 0, got -1"
    );
    for (key_of, options) in [
        (
            OptionKey::Nodes,
            Options {
                nodes: Nodes::Count(2),
                ..whole()
            },
        ),
        (
            OptionKey::Nodes,
            Options {
                nodes: Nodes::Count(usize::MAX),
                ..whole()
            },
        ),
        (
            OptionKey::Sigma,
            Options {
                sigma: 1e300,
                ..whole()
            },
        ),
        (
            OptionKey::Step,
            Options {
                step: Step::Equal(1e3),
                ..whole()
            },
        ),
        (
            OptionKey::Steps,
            Options {
                steps: u64::MAX,
                ..whole()
            },
        ),
    ] {
        assert_eq!(key(&near(), &options), key_of);
    }
}

#[test]
fn starts_that_are_none_are_refused() {
    let outside = Contour::circle(CENTER, 60.0);
    let nowhere = Contour::closed(vec![DVec2::NAN; 5]);
    let few = Contour::closed(vec![CENTER; 2]);
    let none = Contour::open(Vec::new());
    let point = Contour::closed(vec![CENTER; 7]);
    for start in [outside, nowhere, few, none, point] {
        assert_eq!(key(&start, &whole()), OptionKey::Start, "{start:?}");
    }
}

#[test]
fn levels_that_are_no_numbers_are_refused() {
    let mut levels = disc(CENTER, 22.0);
    levels[[3, 4]] = f64::NAN;
    let error = fit(&Image::grey(levels), &near(), &whole()).unwrap_err();
    assert_eq!(error.key, OptionKey::Image);
    let none = Image::grey(field::Grid::zeros((0, 0)));
    assert!(fit(&none, &near(), &whole()).is_err());
}

#[test]
fn forces_are_refused_by_their_index_and_value() {
    let edge = |sigma| {
        ImageForceKind::Edge(Edge {
            sigma,
            ..Edge::default()
        })
    };
    let regions = ImageForceKind::Regions(Regions::default());
    let gvf = ImageForceKind::Gvf(Gvf {
        knee: f64::NAN,
        ..Gvf::default()
    });
    let arc = Contour::open(near().points[..20].to_vec());
    for (start, kinds, key_of) in [
        (near(), vec![edge(2.0), edge(-2.0)], (1, ForceKey::Sigma)),
        (near(), vec![gvf], (0, ForceKey::Knee)),
        (arc.clone(), vec![edge(2.0), regions], (1, ForceKey::Kind)),
    ] {
        let forces = kinds.into_iter().map(FitForce::of).collect();
        let options = Options { forces, ..whole() };
        assert_eq!(key(&start, &options), OptionKey::Force(key_of.0, key_of.1));
    }
    let balloon = Options {
        balloon: 0.1,
        ..whole()
    };
    assert_eq!(key(&arc, &balloon), OptionKey::Balloon);
    let heavy = FitForce::Image {
        kind: edge(2.0),
        weight: -1.0,
    };
    let options = Options {
        forces: vec![heavy],
        ..whole()
    };
    assert_eq!(
        key(&near(), &options),
        OptionKey::Force(0, ForceKey::Weight)
    );
}

#[test]
fn what_does_not_come_to_rest_or_rests_on_nothing_is_an_outcome() {
    let steps = 3;
    let short = fit(&image(), &near(), &Options { steps, ..whole() }).unwrap();
    assert_eq!(short.outcome, Outcome::Finished { step: 3 });
    assert!(short.quality.is_none() && !short.is_outline() && !short.nodes.is_empty());
    let constant = Image::grey(field::Grid::from_elem((91, 97), 7.0));
    let still = fit(&constant, &near(), &whole()).unwrap();
    assert!(matches!(still.outcome, Outcome::Settled { .. }));
    assert!(!still.is_outline(), "{still:?}");
    let quality = still.quality.unwrap();
    assert!(quality.objection().unwrap().contains("no boundary here"));
    assert!(
        still
            .nodes
            .iter()
            .all(|node| !node.held && node.slope.abs() < 1e-12)
    );
    let bursting = FitForce::Made(Arc::new(Bursting));
    let options = Options {
        forces: vec![bursting],
        ..whole()
    };
    let burst = fit(&image(), &near(), &options).unwrap();
    let blown_up = matches!(burst.outcome, Outcome::Diverged { step: 1.., .. });
    assert!(blown_up, "{:?}", burst.outcome);
    assert!(burst.nodes.is_empty() && !burst.is_outline());
    // shrunk to nothing
    let balloon = -3.0;
    let small = Options { balloon, ..whole() };
    let small = fit(&image(), &near(), &small).unwrap();
    assert!(!small.is_outline(), "{small:?}");
}

#[test]
fn choices_are_told_in_plain_words() {
    let fit = fit(&image(), &near(), &whole()).unwrap();
    assert_eq!(
        fit.chosen.to_string(),
        "contrast: 160.0 levels, from the 2nd to the 98th percentile\n\
         nodes: 39, every 4.02 pixels of the start\n\
         edge force: gain 4.5000, so that an edge as high as the contrast pulls with the strength asked for\n\
         scheme: relaxation, in steps that grow, none of which moves a node farther than 0.79 pixels"
    );
}

#[test]
fn a_start_of_a_search_may_be_wider_than_the_image_but_not_out_of_all_measure() {
    let image = image();
    let (width, height) = image.size();
    let most = 4.0 * width.max(height) as f64;
    let usual = Options::default();
    let reaching = |far: f64| {
        let corner = |x: f64, y: f64| DVec2::new(x, y);
        let points = [
            corner(-0.5 - far, 0.0),
            corner(60.0, 0.0),
            corner(60.0, 80.0),
        ];
        Contour::closed(points.to_vec())
    };
    assert!(fit(&image, &reaching(most), &usual).is_ok());
    assert!(fit(&image, &Contour::circle(CENTER, 0.8 * width as f64), &usual).is_ok());
    for far in [most + 1.0, 1e6, 1e99, f64::MAX / 4.0] {
        let error = fit(&image, &reaching(far), &usual).unwrap_err();
        assert_eq!(error.key, OptionKey::Start);
        let said = error.to_string();
        assert!(
            said.contains("beyond the picture") && said.len() < 200,
            "{said}"
        );
    }
    // the first point that is no place is told as such
    for bad in [f64::NAN, f64::INFINITY] {
        let error = fit(&image, &reaching(bad), &usual).unwrap_err();
        assert!(
            error.to_string().contains("point 0 must be finite"),
            "{error}"
        );
    }
}
