//! Outlines of many pictures as one table: a folder of [GeoParquet](https://geoparquet.org) files that pandas,
//! `DuckDB` and QGIS read.
//!
//! A row is an outline. What a picture gave is one file, written whole or not at all under a name made from the
//! picture's, so that a run that was killed goes on where it was, whichever program began it: the command `snake fit`
//! and the Python package `pysnakes` write the same bytes. Parts may be joined into `joined.parquet`; what that holds
//! is finished too.
//!
//! ```
//! use glam::DVec2;
//! use store::{Results, Row};
//!
//! let folder = tempfile::tempdir()?;
//! let results = Results::open(folder.path())?;
//! let points = [(1.0, 1.0), (5.0, 1.0), (3.0, 4.0)].map(|(x, y)| DVec2::new(x, y));
//! let row = Row { is_outline: true, outcome: "settled", reason: "at rest", ..Row::of(&points, true) };
//! results.write("images/a.png", &[row])?;
//! assert!(results.is_finished("images/a.png") && !results.is_finished("images/b.png"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod read;
mod results;
mod table;

pub use read::StoreError;
pub use results::{Results, name_of, part_name};
pub use table::{Row, empty, refused, written};
