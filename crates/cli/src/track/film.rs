//! Frames with the outlines over them.

use std::path::Path;

use glam::DVec2;
use io::film::{Film, FilmFormat, dashes};
use io::paint::{self, Lettering};
use io::tracks::{TrackState, Tracked};
use io::{Picture, RgbImage};
use scene::SceneError;

/// A side of the film is at most so long, and small frames are enlarged to about so much.
const LONGEST: u32 = 1280;
const SEEN: f64 = 640.0;
const MOST_ZOOM: f64 = 8.0;

/// A dash and the space behind it where an object is not seen. Pixels of the film.
const DASH: f64 = 7.0;
const SPACE: f64 = 5.0;

/// A film of what was seen.
#[derive(Debug)]
pub(super) struct Seen {
    film: Film,
    /// So many pixels are made one, and each is so large.
    fewer: f64,
    zoom: f64,
    /// The levels that are black and white in all frames.
    limits: Option<(f64, f64)>,
    /// What is shown where a frame is broken.
    before: RgbImage,
}

impl Seen {
    pub(super) fn begin(
        path: &Path,
        format: FilmFormat,
        picture: &Picture,
        rate: f64,
    ) -> Result<Self, SceneError> {
        let limits = picture.shown_limits();
        let (width, height) = picture.size();
        let longest = width.max(height) as f64;
        let fewer = (longest / f64::from(LONGEST)).ceil().max(1.0);
        let zoom = (SEEN / longest).floor().clamp(1.0, MOST_ZOOM);
        let mut seen = Shape { fewer, zoom };
        let ground = seen.ground(&picture.shown_between(limits));
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a rate from 0.01 to 100"
        )]
        let hold = (100.0 / rate).round().clamp(1.0, 65535.0) as u16;
        let film = Film::begin(path, format, ground.dimensions(), hold, picture.is_color())?;
        Ok(Self {
            film,
            fewer,
            zoom,
            limits,
            before: ground,
        })
    }

    /// Show a frame, the one before where there is none, with its outlines.
    pub(super) fn show(
        &mut self,
        frame: usize,
        picture: Option<&Picture>,
        list: &[Tracked],
    ) -> Result<(), SceneError> {
        let mut shape = Shape {
            fewer: self.fewer,
            zoom: self.zoom,
        };
        if let Some(picture) = picture {
            self.before = shape.ground(&picture.shown_between(self.limits));
        }
        let mut image = self.before.clone();
        let side = f64::from(image.width().max(image.height()));
        let wide = (side / 320.0).clamp(1.5, 4.0);
        for one in list.iter().filter(|one| !one.points.is_empty()) {
            let color = paint::color_of(one.id);
            let nodes = shape.placed(&one.points);
            if one.state == TrackState::Coasting {
                for piece in dashes(&nodes, true, DASH, SPACE) {
                    paint::draw_curve(&mut image, &piece, false, wide, color);
                }
            } else {
                paint::draw_curve(&mut image, &nodes, true, wide, color);
            }
        }
        let height = (side / 45.0).clamp(7.0, 16.0);
        let how = |color: [u8; 3], before: f64| Lettering {
            height,
            color,
            before,
            casing: Some([0; 3]),
            ..Lettering::default()
        };
        if list.len() > 1 {
            for one in list {
                if let Some((low, high)) = one.bounds() {
                    let top = shape.placed(&[DVec2::new(0.5 * (low.x + high.x), low.y)]);
                    let at = (top[0] - DVec2::new(0.0, 0.5 * height)).max(DVec2::splat(height));
                    paint::draw_text(
                        &mut image,
                        at,
                        &one.id.to_string(),
                        &how(paint::color_of(one.id), 0.5),
                    );
                }
            }
        }
        let text = if picture.is_some() {
            format!("{frame}")
        } else {
            format!("{frame} (no frame)")
        };
        let place = DVec2::new(0.7 * height, f64::from(image.height()) - 0.7 * height);
        paint::draw_text(&mut image, place, &text, &how([255; 3], 0.0));
        Ok(self.film.show(&image)?)
    }

    pub(super) fn end(self) -> Result<(), SceneError> {
        Ok(self.film.end()?)
    }
}

/// How frames are made smaller or larger.
#[derive(Debug, Clone, Copy)]
struct Shape {
    fewer: f64,
    zoom: f64,
}

impl Shape {
    fn ground(&mut self, image: &RgbImage) -> RgbImage {
        if self.fewer > 1.0 {
            return paint::shrunk(image, LONGEST);
        }
        paint::enlarged(image, self.zoom)
    }

    /// Where points of a frame are.
    fn placed(&self, points: &[DVec2]) -> Vec<DVec2> {
        points
            .iter()
            .map(|p| ((*p + 0.5) / self.fewer - 0.5) * self.zoom)
            .collect()
    }
}
