//! Kinds that compare what is inside a closed curve with what is outside.

use std::sync::Arc;

use field::{
    Classes, Density, Grid, LikelihoodRegions, LocalRegions, MaskedImage, Region, RegionScratch,
    Smoothing, TwoRegions,
};
use glam::DVec2;

use super::{At, above_nothing};
use crate::SceneError;
use crate::file::{DensityText, LikelihoodText, LocalRegionsText, RegionsText, TextureText};

/// σ of a region force unless given: it averages over areas anyway.
const USUAL_SIGMA: f64 = 1.0;

/// Radius of the disks of local regions unless given.
const USUAL_RADIUS: f64 = 10.0;

/// How much likelier a pixel is on one side for it to pull with the strength: e³, 20 times.
const NATS: f64 = 3.0;

/// Classes that pixels are sorted into unless given.
const USUAL_CLASSES: usize = 64;

/// The same for textures.
const TEXTURE_CLASSES: usize = 32;

impl At<'_> {
    /// The channels to look at, smoothed: colors if there are and nobody wants grey.
    fn looked_at(&self, sigma: Option<f64>, grey: bool) -> Result<Vec<MaskedImage>, SceneError> {
        let sigma = self.sigma(sigma, USUAL_SIGMA)?;
        let picture = self.sight.picture;
        let channels = if grey {
            vec![picture.levels().clone()]
        } else {
            picture.channels()
        };
        let smooth = |channel: &Grid| -> Result<MaskedImage, field::FieldError> {
            let smoothed = picture
                .masked(channel)?
                .smoothed(Smoothing::Gaussian(sigma))?;
            picture.masked(&smoothed)
        };
        let smoothed: Result<Vec<MaskedImage>, _> = channels.iter().map(smooth).collect();
        smoothed.map_err(self.refuse())
    }

    /// Two regions in each channel.
    fn two(
        &self,
        sigma: Option<f64>,
        strength: Option<f64>,
        grey: Option<bool>,
    ) -> Result<Vec<TwoRegions>, SceneError> {
        let picture = self.sight.picture;
        let grey = grey.unwrap_or(false);
        let channels = self.looked_at(sigma, grey)?;
        let contrast = |channel: &Grid| picture.contrast(channel);
        let squares: f64 = if grey {
            contrast(picture.levels()).powi(2)
        } else {
            picture.channels().iter().map(|c| contrast(c).powi(2)).sum()
        };
        // a pixel of one mean, with the other mean a contrast away
        let gain = self.pull(strength)? / above_nothing(squares);
        let region = |channel: &MaskedImage| TwoRegions::masked(channel, gain);
        let regions: Result<Vec<TwoRegions>, _> = channels.iter().map(region).collect();
        regions.map_err(self.refuse())
    }

    pub(super) fn regions(&self, text: &RegionsText) -> Result<Arc<dyn Region>, SceneError> {
        let two = self.two(text.sigma, text.strength, text.grey)?;
        Ok(Arc::new(Together(two)))
    }

    pub(super) fn local_regions(
        &self,
        text: &LocalRegionsText,
    ) -> Result<Arc<dyn Region>, SceneError> {
        let radius = self.above_zero("radius", text.radius, USUAL_RADIUS)?;
        let two = self.two(text.sigma, text.strength, text.grey)?;
        let local = two.iter().map(|two| LocalRegions::new(two, radius));
        let local: Result<Vec<LocalRegions>, _> = local.collect();
        Ok(Arc::new(Together(local.map_err(self.refuse())?)))
    }

    pub(super) fn likelihood(&self, text: &LikelihoodText) -> Result<Arc<dyn Region>, SceneError> {
        let grey = text.grey.unwrap_or(false);
        let channels = self.looked_at(text.sigma, grey)?;
        let count = text.classes.unwrap_or(USUAL_CLASSES);
        let at = |name: &str| {
            let key = self.key(name);
            move |error: field::FieldError| SceneError::key(&key, error)
        };
        let classes = match &channels[..] {
            [one] => Classes::grey(one, count),
            many => Classes::clusters(many, count),
        };
        let classes = classes.map_err(at("classes"))?;
        let usual = self.sight.contrast() / 20.0;
        let density = match text.density.unwrap_or(DensityText::Histogram) {
            DensityText::Histogram => Density::Parzen {
                bandwidth: self.above_zero("bandwidth", text.bandwidth, usual)?,
            },
            DensityText::Gaussian => Density::Gaussian,
            DensityText::Mixture => Density::Mixture {
                components: text.components.unwrap_or(3),
            },
        };
        let gain = self.pull(text.strength)? / NATS;
        let regions = LikelihoodRegions::new(&classes, density, gain);
        Ok(Arc::new(regions.map_err(at("components"))?))
    }
}

impl At<'_> {
    pub(super) fn texture(&self, text: &TextureText) -> Result<Arc<dyn Region>, SceneError> {
        let usual = vec![1.5, 3.0];
        let sigmas = self.sigmas(text.sigmas.as_ref().unwrap_or(&usual))?;
        let picture = self.sight.picture;
        let channels = field::texture_channels(picture.levels(), sigmas).map_err(self.refuse())?;
        let masked: Result<Vec<MaskedImage>, _> =
            channels.iter().map(|c| picture.masked(c)).collect();
        let key = self.key("classes");
        let classes = text.classes.unwrap_or(TEXTURE_CLASSES);
        let classes = Classes::clusters(&masked.map_err(self.refuse())?, classes)
            .map_err(|e| SceneError::key(&key, e))?;
        // each channel has its say in the likelihood, and they mostly say the same
        let gain = self.pull(text.strength)? / (NATS * channels.len() as f64);
        let regions = LikelihoodRegions::new(&classes, Density::Gaussian, gain);
        Ok(Arc::new(regions.map_err(self.refuse())?))
    }
}

/// Regions in several channels: their pushes and energies add up.
#[derive(Debug)]
struct Together<R>(Vec<R>);

impl<R: Region> Region for Together<R> {
    fn push_at(
        &self,
        polygon: &[DVec2],
        points: &[DVec2],
        scratch: &mut RegionScratch,
        push: &mut [f64],
    ) {
        let [first, others @ ..] = &self.0[..] else {
            push.fill(0.0);
            return;
        };
        first.push_at(polygon, points, scratch, push);
        if others.is_empty() {
            return;
        }
        let mut own = vec![0.0; push.len()];
        for other in others {
            other.push_at(polygon, points, scratch, &mut own);
            for (push, own) in push.iter_mut().zip(&own) {
                *push += own;
            }
        }
    }

    fn energy(&self, polygon: &[DVec2]) -> Option<f64> {
        self.0.iter().map(|region| region.energy(polygon)).sum()
    }
}
