//! Where the middles of objects went: a picture over the last frame, or a table.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use glam::DVec2;
use io::tracks::{TrackState, Tracked};
use io::{Picture, RgbImage, chart, paint};
use scene::SceneError;

use super::along::middle;
use crate::fit::plain;

/// A small picture is enlarged to about so many pixels, at most so much.
const SEEN: f64 = 640.0;
const MOST_ZOOM: f64 = 8.0;

/// The ways so far.
#[derive(Debug, Default)]
pub(super) struct Ways {
    ways: BTreeMap<u32, Vec<(usize, DVec2, bool)>>,
    /// The last frame that there was.
    ground: Option<RgbImage>,
}

impl Ways {
    /// Take the outlines of a frame.
    pub(super) fn take(
        &mut self,
        frame: usize,
        picture: Option<&Picture>,
        limits: Option<(f64, f64)>,
        list: &[Tracked],
    ) {
        if let Some(picture) = picture {
            self.ground = Some(picture.shown_between(limits));
        }
        for one in list.iter().filter(|one| !one.points.is_empty()) {
            let seen = one.state != TrackState::Coasting;
            self.ways
                .entry(one.id)
                .or_default()
                .push((frame, middle(&one.points), seen));
        }
    }

    /// Write them, as a picture or as a table by the name's ending.
    pub(super) fn write(self, path: &Path) -> Result<(), SceneError> {
        if path
            .extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case("csv"))
        {
            let mut text = String::from("id,frame,x_px,y_px,seen\n");
            for (id, way) in &self.ways {
                for (frame, p, seen) in way {
                    // writing to a String cannot fail
                    let _ = writeln!(
                        text,
                        "{id},{frame},{},{},{}",
                        plain(p.x),
                        plain(p.y),
                        u8::from(*seen)
                    );
                }
            }
            return Ok(io::write_whole(path, text.as_bytes())?);
        }
        let ground = self.ground.unwrap_or_else(|| RgbImage::new(1, 1));
        let zoom = (SEEN / f64::from(ground.width().max(ground.height())))
            .floor()
            .clamp(1.0, MOST_ZOOM);
        let mut image = paint::enlarged(&ground, zoom);
        let way = |(&id, way): (&u32, &Vec<(usize, DVec2, bool)>)| chart::Path {
            id,
            places: way.iter().map(|&(_, p, seen)| (p, seen)).collect(),
        };
        let list: Vec<chart::Path> = self.ways.iter().map(way).collect();
        chart::paths(&mut image, &list, zoom);
        Ok(paint::save_png(&image, path)?)
    }
}
