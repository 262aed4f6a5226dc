//! Pictures, outlines, records and tables as files.
//!
//! This is the lowest crate that reads and writes: bytes become a [`Picture`],
//! [`Shapes`](shapes::Shapes) or a [`Record`](record::Record), and these become bytes. A file is
//! written whole or not at all, and what cannot be read is refused by its name, its line, and what
//! is needed instead. Nothing here knows what a scene or a snake is.
//!
//! ```
//! use io::shapes;
//!
//! let outlines = shapes::parse("# contour 1, closed\nx,y\n10,10\n30,10\n20,25\n")?;
//! assert_eq!(outlines[0].first().len(), 3);
//! assert_eq!(shapes::to_text(&outlines), "# contour 1, closed\nx,y\n10,10\n30,10\n20,25\n");
//! # Ok::<(), io::IoError>(())
//! ```

mod animation;
pub mod chart;
mod claims;
mod error;
mod ffmpeg;
pub mod film;
pub mod frames;
mod letters;
pub mod limits;
pub mod numbers;
pub mod page;
pub mod paint;
mod picture;
mod read;
pub mod record;
pub mod shapes;
pub mod text;
pub mod tracks;
mod write;

pub use claims::{Claims, is_standard};
pub use error::IoError;
pub use image::RgbImage;
pub use picture::{Invalid, Picture, PictureReading, PixelSize};
pub use read::{called, read_file, read_text};
pub use write::{ready_file, ready_folder, write_whole};
