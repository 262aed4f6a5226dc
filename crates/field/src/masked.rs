//! A picture of which some pixels do not count.
//!
//! Smoothing is a weighted mean of the pixels that count, so what is masked out has no influence at all, and the border of the mask
//! is no edge. Not here yet: masks with shares between 0 and 1.

use crate::edge::{EdgeForce, edge_stages, gradient_force};
use crate::error::{FieldError, positive};
use crate::force_field::ForceField;
use crate::grid::{Grid, admit};
use crate::smooth::Smoothing;
use glam::DVec2;
use ndarray::Array2;

/// A picture and which of its pixels count.
///
/// Pixels that do not count may hold anything, NaN too; nothing here depends on them.
///
/// ```
/// use field::{MaskedImage, Smoothing};
/// let image = ndarray::array![[1.0, 1.0, f64::NAN, 1.0]];
/// let picture = MaskedImage::finite(&image)?;
/// assert_eq!(picture.smoothed(Smoothing::Binomial(3))?, ndarray::array![[1.0, 1.0, 1.0, 1.0]]);
/// # Ok::<(), field::FieldError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct MaskedImage {
    /// Pixels that do not count hold the first one that does.
    image: Grid,
    /// `None`: all count.
    valid: Option<Array2<bool>>,
}

impl MaskedImage {
    /// A picture of which every pixel counts.
    ///
    /// # Errors
    /// An image without pixels, or with one that is not finite (the first is named) or too large.
    pub fn whole(image: &Grid) -> Result<Self, FieldError> {
        let image = admit(image, 1.0)?;
        Ok(Self { image, valid: None })
    }

    /// A picture of which the pixels that are `true` in `valid` count.
    ///
    /// # Errors
    /// Shapes that differ; no pixel that counts; one that counts and is not finite or too large.
    pub fn new(image: &Grid, valid: &Array2<bool>) -> Result<Self, FieldError> {
        if image.dim() != valid.dim() {
            return Err(FieldError::ShapesDiffer {
                first: image.dim(),
                second: valid.dim(),
            });
        }
        let first = valid.indexed_iter().find(|(_, ok)| **ok).map(|(at, _)| at);
        let Some(first) = first else {
            let (height, width) = image.dim();
            return if image.is_empty() {
                Err(FieldError::Empty { width, height })
            } else {
                Err(FieldError::NothingValid { width, height })
            };
        };
        let filled = Grid::from_shape_fn(image.dim(), |at| {
            if valid[at] { image[at] } else { image[first] }
        });
        let image = admit(&filled, 1.0)?;
        let valid = valid.iter().any(|ok| !ok).then(|| valid.clone());
        Ok(Self { image, valid })
    }

    /// A picture of which the pixels that are finite numbers count.
    ///
    /// # Errors
    /// No pixels, or not one that is finite; one that is too large.
    pub fn finite(image: &Grid) -> Result<Self, FieldError> {
        Self::new(image, &image.mapv(f64::is_finite))
    }

    /// Whether a pixel counts; `None` if all do.
    #[must_use]
    pub fn valid(&self) -> Option<&Array2<bool>> {
        self.valid.as_ref()
    }

    /// The picture; where a pixel does not count, another one's value stands.
    pub(crate) fn image(&self) -> &Grid {
        &self.image
    }

    /// The first pixel that counts.
    pub(crate) fn first(&self) -> f64 {
        let counts = |at: &(usize, usize)| self.valid.as_ref().is_none_or(|valid| valid[*at]);
        let mut pixels = self.image.indexed_iter();
        pixels.find(|(at, _)| counts(at)).map_or(0.0, |(_, &v)| v)
    }

    /// Smoothed over the pixels that count: G ∗ (m I) / G ∗ m, with m = 1 where a pixel counts and 0 elsewhere.
    ///
    /// A constant stays one, to the bit. Beyond the mask the picture is continued by the same formula, then by the mean of
    /// the neighbours for the two pixels that derivatives at its border look at; farther out it is the first pixel that
    /// counts. Give this to any strength, with no smoothing of its own (`Smoothing::Binomial(0)`), and what comes
    /// out to [`MaskedImage::force`].
    ///
    /// \[knutsson93\]
    ///
    /// # Errors
    /// A smoothing that [`Smoothing::validate`] refuses.
    pub fn smoothed(&self, smoothing: Smoothing) -> Result<Grid, FieldError> {
        smoothing.validate()?;
        let Some(valid) = &self.valid else {
            return Ok(smoothing.apply(&self.image));
        };
        // about the first pixel, so that a constant is 0 and stays 0
        let offset = self.first();
        let weight = smoothing.apply(&valid.mapv(|ok| f64::from(u8::from(ok))));
        let mut smooth = smoothing.apply(&self.image.mapv(|v| v - offset));
        // no pixel that counts within reach: weights of one side add up without cancelling
        let known = weight.mapv(|w| w > 1e-30);
        ndarray::Zip::from(&mut smooth)
            .and(&weight)
            .and(&known)
            .for_each(|s, &w, &known| *s = if known { *s / w } else { 0.0 });
        let smooth = continued(continued((smooth, known))).0;
        Ok(smooth.mapv(|s| s + offset))
    }

    /// The force of a strength: `gain · ∇P` inside the mask, zero outside. The energy of a point is −`gain` · P.
    ///
    /// # Errors
    /// Shapes that differ, a strength that is not finite, a `gain` that is not above 0.
    pub fn force(&self, strength: &Grid, gain: f64) -> Result<ForceField, FieldError> {
        positive("gain", gain)?;
        if strength.dim() != self.image.dim() {
            return Err(FieldError::ShapesDiffer {
                first: self.image.dim(),
                second: strength.dim(),
            });
        }
        self.cut(&gradient_force(strength, gain)?)
    }

    /// [`edge_force`](crate::edge_force) of the pixels that count; zero at the others.
    ///
    /// # Errors
    /// What `edge_force` refuses.
    pub fn edge_force(&self, rule: &EdgeForce) -> Result<ForceField, FieldError> {
        let unsmoothed = EdgeForce {
            smoothing: Smoothing::Binomial(0),
            gain: rule.gain,
        };
        let stages = edge_stages(&self.smoothed(rule.smoothing)?, &unsmoothed)?;
        self.cut(&stages.force)
    }

    /// A field with no force at the pixels that do not count.
    ///
    /// # Errors
    /// A field of another shape.
    pub fn cut(&self, field: &ForceField) -> Result<ForceField, FieldError> {
        let (first, second) = (self.image.dim(), (field.height(), field.width()));
        if first != second {
            return Err(FieldError::ShapesDiffer { first, second });
        }
        let (mut x, mut y) = field.components();
        if let Some(valid) = &self.valid {
            for (at, _) in valid.indexed_iter().filter(|(_, ok)| !**ok) {
                (x[at], y[at]) = (0.0, 0.0);
            }
        }
        ForceField::from_components(&x, &y)
    }

    /// Whether the pixel nearest to a point counts; outside the picture none does.
    #[must_use]
    pub fn counts_at(&self, p: DVec2) -> bool {
        let (height, width) = self.image.dim();
        let (x, y) = (p.x.round(), p.y.round());
        let inside = x >= 0.0 && y >= 0.0 && x < width as f64 && y < height as f64;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "inside the picture"
        )]
        let at = [y as usize, x as usize];
        inside && self.valid.as_ref().is_none_or(|valid| valid[at])
    }
}

/// One more pixel all round what is known: each the mean of its known neighbours.
fn continued((grid, known): (Grid, Array2<bool>)) -> (Grid, Array2<bool>) {
    let (height, width) = grid.dim();
    let (mut grown, mut more) = (grid.clone(), known.clone());
    for ((y, x), _) in known.indexed_iter().filter(|(_, ok)| !**ok) {
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        let around =
            rows.flat_map(|v| (x.saturating_sub(1)..(x + 2).min(width)).map(move |u| [v, u]));
        let (mut sum, mut count) = (0.0, 0.0);
        for at in around.filter(|&at| known[at]) {
            (sum, count) = (sum + grid[at], count + 1.0);
        }
        if count > 0.0 {
            grown[[y, x]] = sum / count;
            more[[y, x]] = true;
        }
    }
    (grown, more)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{color_edge_strength, edge_force};

    const RULE: EdgeForce = EdgeForce {
        smoothing: Smoothing::Gaussian(1.5),
        gain: 3.0,
    };

    fn texture(height: usize, width: usize) -> Grid {
        Grid::from_shape_fn((height, width), |(y, x)| {
            ((x * 37 + y * 91 + x * y * 3) % 101) as f64
        })
    }

    #[test]
    fn a_picture_of_which_all_counts_is_a_picture_like_any_other() {
        let image = texture(20, 23);
        let all = Array2::from_elem((20, 23), true);
        for picture in [
            MaskedImage::whole(&image).unwrap(),
            MaskedImage::new(&image, &all).unwrap(),
            MaskedImage::finite(&image).unwrap(),
        ] {
            assert_eq!(
                picture.edge_force(&RULE).unwrap(),
                edge_force(&image, &RULE).unwrap()
            );
        }
    }

    #[test]
    fn the_border_of_a_mask_is_no_edge() {
        // constant where it counts, wild where not; masks with holes, islands and single pixels
        for pick in [3_usize, 5, 11] {
            let valid = Array2::from_shape_fn((30, 31), |(y, x)| {
                (x + 2 * y) % pick != 0 && x * x + y * y > 200
            });
            let image =
                Grid::from_shape_fn((30, 31), |at| if valid[at] { 0.1 } else { f64::INFINITY });
            let picture = MaskedImage::new(&image, &valid).unwrap();
            for smoothing in [
                Smoothing::Binomial(0),
                Smoothing::Binomial(4),
                Smoothing::Gaussian(3.0),
            ] {
                let rule = EdgeForce {
                    smoothing,
                    gain: 1.0,
                };
                let largest = picture.edge_force(&rule).unwrap().largest();
                assert!(largest <= 0.0, "{largest}");
            }
        }
    }

    #[test]
    fn an_edge_that_runs_into_the_mask_is_found_as_if_nothing_were_missing() {
        // vertical edge, everything below row 14 missing: weights of rows and columns separate, so exactly so
        let image = Grid::from_shape_fn((30, 40), |(_, x)| if x > 19 { 90.0 } else { 10.0 });
        let mut holed = image.clone();
        holed
            .rows_mut()
            .into_iter()
            .skip(15)
            .for_each(|mut row| row.fill(f64::NAN));
        let picture = MaskedImage::finite(&holed).unwrap();
        let (whole, cut) = (
            edge_force(&image, &RULE).unwrap(),
            picture.edge_force(&RULE).unwrap(),
        );
        for y in 0..30 {
            for x in 0..40 {
                let (a, b) = (whole.pixel(x, y).unwrap(), cut.pixel(x, y).unwrap());
                // forces of some tens
                let expected = if y < 15 { a } else { DVec2::ZERO };
                assert!((b - expected).length() < 1e-10, "{x} {y}: {b} {expected}");
            }
        }
    }

    #[test]
    fn far_from_the_mask_nothing_changes_and_beneath_it_nothing_matters() {
        let image = texture(40, 60);
        let valid = Array2::from_shape_fn((40, 60), |(_, x)| x < 30);
        let mut wild = image.clone();
        wild.columns_mut()
            .into_iter()
            .skip(30)
            .for_each(|mut c| c.fill(-1e9));
        let (a, b) = (
            MaskedImage::new(&image, &valid).unwrap(),
            MaskedImage::new(&wild, &valid).unwrap(),
        );
        let (a, b) = (a.edge_force(&RULE).unwrap(), b.edge_force(&RULE).unwrap());
        assert_eq!(a, b);
        let whole = edge_force(&image, &RULE).unwrap();
        // 8.6 σ is where the weights end
        for x in 0..13 {
            let (got, expected) = (a.pixel(x, 20).unwrap(), whole.pixel(x, 20).unwrap());
            assert!((got - expected).length() < 1e-9);
        }
    }

    #[test]
    fn strengths_are_made_of_the_smoothed_picture_and_cut() {
        let image = texture(25, 25);
        let valid = Array2::from_shape_fn((25, 25), |(y, x)| x.abs_diff(12) + y.abs_diff(12) < 9);
        let picture = MaskedImage::new(&image, &valid).unwrap();
        let smooth = picture.smoothed(RULE.smoothing).unwrap();
        let strength = color_edge_strength(&[smooth], Smoothing::Binomial(0)).unwrap();
        let force = picture.force(&strength, RULE.gain).unwrap();
        let direct = picture.edge_force(&RULE).unwrap();
        for ((y, x), ok) in valid.indexed_iter() {
            let (f, g) = (force.pixel(x, y).unwrap(), direct.pixel(x, y).unwrap());
            assert!((f - g).length() < 1e-9);
            assert_eq!(picture.counts_at(DVec2::new(x as f64 + 0.3, y as f64)), *ok);
            assert!(*ok || f == DVec2::ZERO);
        }
        assert!(!picture.counts_at(DVec2::new(-0.6, 3.0)) && !picture.counts_at(DVec2::NAN));
    }

    #[test]
    fn masks_that_do_not_fit_and_pixels_that_count_and_are_none_are_refused() {
        let image = texture(4, 5);
        let none = Array2::from_elem((4, 5), false);
        let error = MaskedImage::new(&image, &none).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the mask leaves none of 5 × 4 pixels; at least one must count"
        );
        assert!(MaskedImage::new(&image, &Array2::from_elem((5, 4), true)).is_err());
        assert!(MaskedImage::finite(&Grid::zeros((0, 3))).is_err());
        let mut bad = image.clone();
        bad[[2, 1]] = f64::NAN;
        let all = Array2::from_elem((4, 5), true);
        assert!(matches!(
            MaskedImage::new(&bad, &all),
            Err(FieldError::NotFinite {
                column: 1,
                row: 2,
                ..
            })
        ));
        let picture = MaskedImage::finite(&bad).unwrap();
        assert!(picture.smoothed(Smoothing::Gaussian(0.0)).is_err());
        assert!(picture.force(&Grid::zeros((3, 3)), 1.0).is_err());
        assert!(picture.force(&Grid::zeros((4, 5)), 0.0).is_err());
    }
}
