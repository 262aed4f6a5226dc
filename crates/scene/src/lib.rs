//! Situations as text, and what the text means.
//!
//! A scene is a TOML text that names a picture, a curve, a material, a world and a plan;
//! [`Scene::parse`] turns it into a snake ready to run and refuses what makes no sense, by its key.
//! As a value the text is a [`SceneText`], which is changed key by key and written again. Files are
//! read and written by [`io`]. The shipped scenes are [`SCENES`]; `docs/formats.md` describes the
//! formats by example.
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

mod catalogue;
mod company;
mod course;
mod error;
mod fields;
mod file;
mod hand;
mod kinds;
mod limits;
mod meaning;
mod record;
mod run;
mod scene;
mod substeps;
mod text;
mod toml_error;

pub use catalogue::{APPLE_DISTURBING, SCENES, contour, headline, picture};
pub use company::Company;
pub use course::Course;
pub use error::SceneError;
pub use fields::Fields;
pub use fit::force::Computing;
pub use fit::{Evidence, Narrow};
pub use hand::Hand;
pub use kinds::{FORCES, ForceChoice, ForceKind};
pub use record::{Frame, Record};
pub use scene::{Plan, Recording, Scene, View};
pub use text::SceneText;

pub use elastic;
pub use field;
pub use fit;
pub use integrator;
pub use snake;

use io::Picture;
