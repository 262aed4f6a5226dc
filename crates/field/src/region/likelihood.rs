//! Two regions, each with a distribution of its own.

use super::classes::{Classes, Counted};
use super::mixture::{MOST_COMPONENTS, gaussian, learn, mixture};
use super::{Region, RegionScratch};
use crate::error::{FieldError, positive};
use crate::grid::Grid;
use glam::DVec2;
use std::sync::Arc;

/// How a distribution is made of the pixels on one side.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Density {
    /// The histogram, smoothed by a Gaussian of this σ in the units of the channels.
    ///
    /// ```text
    /// p(c) = Σ_k K(k, c) m_k / Σ_k m_k        K(k, c) ∝ e^(−|center_k − center_c|² / 2σ²), Σ_c K(k, c) = 1
    /// ```
    ///
    /// \[parzen62\], \[kim05\]
    Parzen {
        /// σ, above 0.
        bandwidth: f64,
    },
    /// One Gaussian, with the mean and the variance of each channel.
    ///
    /// \[zhu96\]
    Gaussian,
    /// A mixture of so many Gaussians, whose means and variances are learned once from the whole picture, and whose weights
    /// anew from either side.
    ///
    /// Diagonal covariances, at least those within a class. The picture's mixture is *a* best one, by expectation and
    /// maximisation from means spread along the widest channel; the weights are *the* best ones.
    ///
    /// \[dempster77\]
    Mixture {
        /// Gaussians, 2 to 8.
        components: usize,
    },
}

/// Two regions, each with its own distribution of grey, color or texture, the curve between them.
///
/// ```text
/// E = −gain · (Σ_in ln p_in(I) + Σ_out ln p_out(I))
/// f =  gain · (ln p_in(I) − ln p_out(I) + what the pixel does to both distributions)      along the outward normal
/// ```
///
/// Both p are learned anew from either side at each step, one pixel of the whole picture added to each so that no class is impossible.
/// f is minus the derivative of E by the normal motion of the curve; the last term, which \[kim05\] derive, is there
/// for [`Density::Parzen`] and zero for the others, which are at their best. Finds what differs in spread, number of modes or color where
/// means are equal. `gain` is a force per nat: the logarithm of how much likelier a pixel is on one side.
///
/// O(pixels crossed · classes) a step, and the densities once: classes² for the histogram, classes · channels
/// for a Gaussian, at most 300 · classes · components for the mixture. Copies share the picture.
///
/// \[zhu96\], \[kim05\]
#[derive(Debug, Clone, PartialEq)]
pub struct LikelihoodRegions {
    counted: Arc<Counted>,
    model: Model,
    gain: f64,
}

#[derive(Debug, Clone, PartialEq)]
enum Model {
    /// `K[[k, c]]`.
    Parzen(Arc<Grid>),
    Gaussian,
    /// How likely each class is under each Gaussian.
    Mixture(Arc<Grid>),
}

impl LikelihoodRegions {
    /// Prepares the densities of a picture in classes.
    ///
    /// # Errors
    /// A `gain` or a bandwidth that is not above 0; fewer than 2 components or more than 8.
    pub fn new(classes: &Classes, density: Density, gain: f64) -> Result<Self, FieldError> {
        positive("gain", gain)?;
        let counted = classes.data.clone();
        let model = match density {
            Density::Parzen { bandwidth } => {
                positive("bandwidth", bandwidth)?;
                Model::Parzen(Arc::new(kernel(counted.centers(), bandwidth)))
            }
            Density::Mixture { components } => {
                let value = components as f64;
                // one for all would be the same on both sides
                positive("components less 1", value - 1.0)?;
                if components > MOST_COMPONENTS {
                    let most = MOST_COMPONENTS as f64;
                    let name = "components";
                    return Err(FieldError::TooMuch { name, value, most });
                }
                Model::Mixture(Arc::new(learn(&counted, components)))
            }
            Density::Gaussian => Model::Gaussian,
        };
        Ok(Self {
            counted,
            model,
            gain,
        })
    }

    /// What a pixel of each class pushes with, along the outward normal: a log-likelihood ratio, times the gain.
    #[must_use]
    pub fn push_by_class(&self, polygon: &[DVec2]) -> Vec<f64> {
        let mut scratch = RegionScratch::default();
        self.table(polygon, &mut scratch);
        scratch.table
    }

    /// Writes the push of each class into `scratch.table`; the energy comes back.
    fn table(&self, polygon: &[DVec2], scratch: &mut RegionScratch) -> f64 {
        let total = self.counted.total();
        let n = total.len();
        let RegionScratch {
            table, side, slope, ..
        } = scratch;
        for numbers in [&mut *table, &mut *side, &mut *slope] {
            numbers.clear();
            numbers.resize(n, 0.0);
        }
        if total.iter().filter(|&&count| count > 0.0).count() < 2 {
            // one class: there is nothing to tell apart
            return 0.0;
        }
        let pixels: f64 = total.iter().sum();
        self.counted.inside(polygon, side);
        let mut energy = 0.0;
        for sign in [1.0, -1.0] {
            // one pixel of the whole picture
            for (m, total) in side.iter_mut().zip(total) {
                *m += total / pixels;
            }
            energy += match &self.model {
                Model::Parzen(kernel) => parzen(kernel, side, slope),
                Model::Gaussian => gaussian(&self.counted, side, slope),
                Model::Mixture(parts) => mixture(parts, side, slope),
            };
            for ((table, slope), total) in table.iter_mut().zip(&*slope).zip(total) {
                if *total > 0.0 {
                    *table -= sign * self.gain * slope;
                }
            }
            for (m, total) in side.iter_mut().zip(total) {
                *m = total - (*m - total / pixels);
            }
        }
        self.gain * energy
    }
}

impl Region for LikelihoodRegions {
    fn push_at(
        &self,
        polygon: &[DVec2],
        points: &[DVec2],
        scratch: &mut RegionScratch,
        push: &mut [f64],
    ) {
        self.table(polygon, scratch);
        for (push, &p) in push.iter_mut().zip(points) {
            *push = self.counted.at(p, &scratch.table);
        }
    }

    fn energy(&self, polygon: &[DVec2]) -> Option<f64> {
        Some(self.table(polygon, &mut RegionScratch::default()))
    }
}

/// How much a pixel of class k says about class c.
fn kernel(centers: &Grid, bandwidth: f64) -> Grid {
    let n = centers.nrows();
    let mut kernel = Grid::from_shape_fn((n, n), |(k, c)| {
        let between = centers.row(k).into_iter().zip(centers.row(c));
        let squared: f64 = between.map(|(a, b)| ((a - b) / bandwidth).powi(2)).sum();
        (-0.5 * squared).exp()
    });
    for mut row in kernel.rows_mut() {
        let sum = row.sum();
        row /= sum;
    }
    kernel
}

/// `−Σ m ln p` of a smoothed histogram, and its derivative by each `m`.
fn parzen(kernel: &Grid, m: &[f64], slope: &mut [f64]) -> f64 {
    let area: f64 = m.iter().sum();
    let n = m.len();
    let mut ratio = [0.0; super::classes::MOST_CLASSES];
    let mut energy = 0.0;
    for c in (0..n).filter(|&c| m[c] > 0.0) {
        let p = (0..n).map(|k| kernel[[k, c]] * m[k]).sum::<f64>() / area;
        energy -= m[c] * p.ln();
        slope[c] = -p.ln();
        ratio[c] = m[c] / (area * p);
    }
    for k in (0..n).filter(|&k| m[k] > 0.0) {
        let said: f64 = (0..n).map(|c| kernel[[k, c]] * ratio[c]).sum();
        slope[k] += 1.0 - said;
    }
    energy
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawn::gauss;
    use crate::masked::MaskedImage;
    use crate::region::TwoRegions;
    use crate::region::tests::{circle, pushes, slope_agrees};
    use proptest::prelude::*;

    const PARZEN: Density = Density::Parzen { bandwidth: 6.0 };
    const MIXTURE: Density = Density::Mixture { components: 2 };

    /// Grey 100 everywhere in the mean, but uneasy within 25 pixels of (40, 40).
    fn uneasy() -> Grid {
        Grid::from_shape_fn((81, 81), |(y, x)| {
            let inside = (x as f64 - 40.0).hypot(y as f64 - 40.0) < 25.0;
            100.0 + gauss((y * 81 + x) as u64) * if inside { 24.0 } else { 8.0 }
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(12))]
        #[test]
        fn the_force_is_minus_the_derivative_of_the_energy(
            radius in 8.0..30.0_f64, (x, y) in (36.0..44.0_f64, 36.0..44.0_f64), bins in 2_usize..24,
        ) {
            let picture = MaskedImage::whole(&uneasy()).unwrap();
            let classes = Classes::grey(&picture, bins).unwrap();
            let polygon = circle(DVec2::new(x, y), radius, 40);
            for density in [PARZEN, Density::Gaussian, MIXTURE] {
                let regions = LikelihoodRegions::new(&classes, density, 2.0).unwrap();
                let table = regions.push_by_class(&polygon);
                let force = |p: DVec2| regions.counted.at(p, &table);
                prop_assert!(slope_agrees(&regions, &polygon, 4e-3, force), "{:?}", density);
            }
        }
    }

    #[test]
    fn what_differs_in_spread_only_is_found_where_means_see_nothing() {
        let image = uneasy();
        let picture = MaskedImage::whole(&image).unwrap();
        let classes = Classes::grey(&picture, 32).unwrap();
        let two = TwoRegions::new(&image, 1.0).unwrap();
        let mean = |region: &dyn Region, radius: f64| {
            let push = pushes(region, &circle(DVec2::splat(40.0), radius, 200));
            let size = push.iter().map(|f| f.abs()).sum::<f64>();
            push.iter().sum::<f64>() / size
        };
        let starts = [(8.0, 1.0), (20.0, 1.0), (30.0, -1.0), (36.0, -1.0)];
        for density in [PARZEN, MIXTURE, Density::Gaussian] {
            let regions = LikelihoodRegions::new(&classes, density, 1.0).unwrap();
            // grown from within, shrunk from without, by far more than the noise of 200 nodes
            for (radius, way) in starts {
                let push = way * mean(&regions, radius);
                assert!(push > 0.15, "{density:?} {radius}: {push}");
            }
        }
        let blind = |&(radius, way): &(f64, f64)| way * mean(&two, radius) < 0.15;
        assert!(starts.iter().any(blind));
    }

    #[test]
    fn the_push_is_the_logarithm_of_how_much_likelier_a_grey_is() {
        // at the true border both distributions are known: σ = 24 inside, 8 outside, mean 100
        let picture = MaskedImage::whole(&uneasy()).unwrap();
        let classes = Classes::grey(&picture, 32).unwrap();
        let polygon = circle(DVec2::splat(40.0), 25.0, 200);
        let regions = LikelihoodRegions::new(&classes, Density::Gaussian, 1.0).unwrap();
        let table = regions.push_by_class(&polygon);
        for (push, center) in table.iter().zip(classes.centers()) {
            let z = center - 100.0;
            let log = |sigma: f64| -0.5 * (z / sigma).powi(2) - sigma.ln();
            // 2000 pixels inside: σ to 2 %, and so the square of three σ to 0.3
            if z.abs() < 24.0 {
                assert!((push - log(24.0) + log(8.0)).abs() < 0.3, "{z}: {push}");
            }
        }
        // a histogram has no model to lean on: the same to the noise of its bins
        let regions =
            LikelihoodRegions::new(&classes, Density::Parzen { bandwidth: 3.0 }, 1.0).unwrap();
        for (push, center) in regions
            .push_by_class(&polygon)
            .iter()
            .zip(classes.centers())
        {
            let z = center - 100.0;
            let log = |sigma: f64| -0.5 * (z / sigma).powi(2) - sigma.ln();
            if z.abs() < 16.0 {
                assert!((push - log(24.0) + log(8.0)).abs() < 0.4, "{z}: {push}");
            }
        }
    }

    #[test]
    fn a_color_of_equal_grey_is_found() {
        let center = DVec2::splat(30.0);
        let inside = |x: usize, y: usize| DVec2::new(x as f64, y as f64).distance(center) < 15.0;
        let channel = |own: f64, other: f64, seed: u64| {
            let grid = Grid::from_shape_fn((61, 61), |(y, x)| {
                let base = if inside(x, y) { own } else { other };
                base + 10.0 * gauss(seed + (y * 61 + x) as u64)
            });
            MaskedImage::whole(&grid).unwrap()
        };
        let channels = [
            channel(140.0, 100.0, 0),
            channel(100.0, 140.0, 9_000),
            channel(60.0, 60.0, 18_000),
        ];
        let classes = Classes::clusters(&channels, 24).unwrap();
        for density in [Density::Parzen { bandwidth: 12.0 }, MIXTURE] {
            let regions = LikelihoodRegions::new(&classes, density, 1.0).unwrap();
            for (radius, way) in [(6.0, 1.0), (13.0, 1.0), (17.0, -1.0), (26.0, -1.0)] {
                let push = pushes(&regions, &circle(center, radius, 60));
                let right = push.iter().filter(|f| way * **f > 0.0).count();
                assert!(right >= 55, "{density:?} {radius}: {right} of 60");
            }
        }
    }

    #[test]
    fn bad_numbers_are_refused() {
        let picture = MaskedImage::whole(&uneasy()).unwrap();
        let classes = Classes::grey(&picture, 8).unwrap();
        let new = |density, gain| LikelihoodRegions::new(&classes, density, gain);
        assert!(new(PARZEN, 0.0).is_err() && new(Density::Parzen { bandwidth: 0.0 }, 1.0).is_err());
        for components in [0, 1, 9] {
            assert!(new(Density::Mixture { components }, 1.0).is_err());
        }
    }
}
