//! Find an outline in an image: draw roughly around an object, and an elastic curve moves onto its edge.
//!
//! ```
//! use snakes::{Contour, Grid, Image, Options, Point, fit};
//!
//! // an image with a bright disc of radius 20, and a circle drawn roughly around it
//! let bright = |x: usize, y: usize| (x as f64 - 48.0).hypot(y as f64 - 44.0) < 20.0;
//! let levels = Grid::from_shape_fn((96, 96), |(y, x)| if bright(x, y) { 200.0 } else { 40.0 });
//! let start = Contour::circle(Point::new(50.0, 43.0), 25.0);
//!
//! let found = fit(&Image::grey(levels), &start, &Options::default())?;
//! assert!(found.is_outline());
//! let area = snakes::elastic::signed_area(&found.contour.points).abs();
//! assert!((area / (20.0 * 20.0 * std::f64::consts::PI) - 1.0).abs() < 0.05);
//! # Ok::<(), snakes::FitError>(())
//! ```
//!
//! From a picture file and back to a file, with the feature `files`, which is on by default:
//!
//! ```no_run
//! # #[cfg(feature = "files")] {
//! use std::{path::Path, sync::Arc};
//!
//! use snakes::io::{Picture, shapes};
//! use snakes::{Contour, Image, Options, Point, fit};
//!
//! let picture = Arc::new(Picture::load(Path::new("photo.png"))?);
//! let start = Contour::circle(Point::new(256.0, 270.0), 220.0);
//! let found = fit(&Image::of(picture), &start, &Options::default())?;
//! let shape = shapes::Shape::curve(found.contour.points, Some(true));
//! shapes::save(&[shape], Path::new("found.csv"))?;
//! # }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! What moves a curve can be had by itself: a [`Simulation`] of snakes in a world of forces and walls, with
//! any of fifteen schemes, contacts, and an account of energies.
//!
//! ```
//! use snakes::integrator::{Scheme, State};
//! use snakes::{Point, Simulation, elastic, snake};
//!
//! let ring = elastic::circle(Point::new(0.0, 10.0), 2.0, 32);
//! let body = snake::Body::of(&ring, elastic::Topology::Closed, 1.0)?
//!     .with_material(elastic::Material::uniform(1.0, 20.0, 4.0));
//! let world = snake::World::default().with_gravity(Point::new(0.0, -9.8));
//! let ball = snake::Snake::new(body, world)?;
//! let stepping = snake::Stepping::of(Scheme::Leapfrog, 0.005);
//! let mut fall = Simulation::of(ball, State::at_rest(ring), stepping)?;
//! fall.run(&snake::Until::steps(200), &mut |_| std::ops::ControlFlow::Continue(()))?;
//! let height = elastic::center(&fall.members()[0].state().x, None).y;
//! assert!((height - (10.0 - 0.5 * 9.8)).abs() < 1e-9); // after one unit of time
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | wanted | in |
//! | --- | --- |
//! | one outline, many outlines, a curve that is watched and pulled | [`fit()`], [`fit_many`], [`Session`] |
//! | every option with its unit and default | [`Options`] |
//! | snakes that move, meet and are edited | [`snake`] |
//! | schemes that move them | [`integrator`] |
//! | an outline followed through frames | [`track`] |
//! | force fields of images | [`field`] |
//! | curves, their energies and measures | [`elastic`] |
//! | crossings, merging, spacing | [`outline`] |
//! | pictures, outlines and records as files | [`io`](https://docs.rs/snakes-io), feature `files` |
//!
//! Units: pixels with x to the right and y down, the first pixel's center at (0, 0); grey levels of any range.

pub use elastic;
pub use field;
pub use field::Grid;
pub use fit::{
    Choices, Contour, Edit, Evidence, Fit, FitError, Image, Job, NodeEvidence, Options, Pixels,
    Pluck, Plucked, Prepared, Session, fit, fit_many,
};
pub use glam;
pub use glam::DVec2 as Point;
pub use integrator;
#[cfg(feature = "files")]
pub use io;
pub use outline;
pub use snake;
pub use snake::{Outcome, Simulation};
pub use track;
