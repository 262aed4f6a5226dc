//! Situations as text, pictures and records as files.
//!
//! This is the first floor with windows: everything below computes and does no I/O. A scene is a
//! TOML text that names a picture, a curve, a material, a world and a plan; [`Scene::parse`] turns
//! it into a snake ready to run and refuses what makes no sense, by its key. The shipped scenes are
//! [`SCENES`]; `docs/formats.md` describes the formats by example.
//!
//! ```
//! use scene::Scene;
//!
//! let mut scene = Scene::named("soft-ball")?;
//! scene.plan.until.steps = 100;
//! let record = scene.run(&mut |_| std::ops::ControlFlow::Continue(()))?;
//! assert_eq!(record.outcome.to_string(), "finished after 100 steps");
//!
//! let error = Scene::named("soft-bal").unwrap_err();
//! assert!(error.to_string().contains("did you mean \"soft-ball\"?"));
//! # Ok::<(), scene::SceneError>(())
//! ```

mod build;
mod catalogue;
mod claims;
mod company;
mod contour;
mod error;
mod file;
mod growing;
mod hand;
mod kinds;
mod limits;
pub mod numbers;
mod page;
pub mod paint;
mod picture;
mod read;
mod record;
mod scene;
mod substeps;
mod toml_error;
mod write;

pub use build::fit_image;
pub use catalogue::{APPLE_DISTURBING, SCENES, contour, headline};
pub use claims::{Claims, is_standard};
pub use company::Company;
pub use contour::Contour;
pub use error::{SceneError, plain};
pub use fit::force::Computing;
pub use fit::{Evidence, Narrow};
pub use hand::Hand;
pub use kinds::{FORCES, ForceChoice, ForceKind};
pub use page::Fields;
pub use picture::{Invalid, Picture};
pub use record::{Curve, Frame, Record};
pub use scene::{Plan, Recording, Scene, View};
pub use write::{ready_file, ready_folder, write_whole};

pub use elastic;
pub use field;
pub use fit;
pub use image::RgbImage;
pub use integrator;
pub use snake;
