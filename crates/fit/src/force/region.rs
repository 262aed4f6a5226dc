//! Kinds that compare what is inside a closed curve with what is outside.

use std::sync::Arc;

use field::{
    Classes, Density, FieldError, Grid, LikelihoodRegions, LocalRegions, MaskedImage, Region,
    RegionScratch, Smoothing, TwoRegions,
};
use glam::DVec2;

use super::{
    Densities, ForceError, ForceKey, Likelihood, LocalRegions as Local, Regions, Sight, Texture,
    above_nothing, above_zero, by, pull,
};

/// How much likelier a pixel is on one side for it to pull with the strength: e³, 20 times.
const NATS: f64 = 3.0;

impl Sight {
    /// The channels to look at, smoothed: colors if there are and grey was not asked for.
    fn looked_at(&self, sigma: f64, grey: bool) -> Result<Vec<MaskedImage>, ForceError> {
        let sigma = self.sigma(sigma)?;
        let image = &self.image;
        let smooth = |channel: &Grid| -> Result<MaskedImage, FieldError> {
            let smoothed = image
                .masked(channel)?
                .smoothed(Smoothing::Gaussian(sigma))?;
            image.masked(&smoothed)
        };
        let smoothed: Result<Vec<MaskedImage>, _> =
            self.channels(grey).iter().map(smooth).collect();
        smoothed.map_err(by(ForceKey::All))
    }

    fn channels(&self, grey: bool) -> Vec<Grid> {
        let pixels = self.image.pixels();
        if grey {
            vec![pixels.levels().clone()]
        } else {
            pixels.channels()
        }
    }

    /// Two regions in each channel.
    fn two(&self, regions: &Regions) -> Result<Vec<TwoRegions>, ForceError> {
        let channels = self.looked_at(regions.sigma, regions.grey)?;
        let contrast = |channel: &Grid| self.image.spread(channel).powi(2);
        let squares: f64 = self.channels(regions.grey).iter().map(contrast).sum();
        // a pixel of one mean, with the other mean a contrast away
        let gain = pull(regions.strength)? / above_nothing(squares);
        let region = |channel: &MaskedImage| TwoRegions::masked(channel, gain);
        let regions: Result<Vec<TwoRegions>, _> = channels.iter().map(region).collect();
        regions.map_err(by(ForceKey::All))
    }

    pub(super) fn regions(&self, regions: &Regions) -> Result<Arc<dyn Region>, ForceError> {
        Ok(Arc::new(Together(self.two(regions)?)))
    }

    pub(super) fn local_regions(&self, local: &Local) -> Result<Arc<dyn Region>, ForceError> {
        let radius = above_zero(ForceKey::Radius, local.radius)?;
        let two = self.two(&local.regions)?;
        let local = two.iter().map(|two| LocalRegions::new(two, radius));
        let local: Result<Vec<LocalRegions>, _> = local.collect();
        Ok(Arc::new(Together(local.map_err(by(ForceKey::All))?)))
    }

    pub(super) fn likelihood(&self, given: &Likelihood) -> Result<Arc<dyn Region>, ForceError> {
        let channels = self.looked_at(given.sigma, given.grey)?;
        let classes = match &channels[..] {
            [one] => Classes::grey(one, given.classes),
            many => Classes::clusters(many, given.classes),
        };
        let classes = classes.map_err(by(ForceKey::Classes))?;
        let usual = self.contrast() / 20.0;
        let density = match given.density {
            Densities::Histogram { bandwidth } => Density::Parzen {
                bandwidth: above_zero(ForceKey::Bandwidth, bandwidth.unwrap_or(usual))?,
            },
            Densities::Gaussian => Density::Gaussian,
            Densities::Mixture { components } => Density::Mixture { components },
        };
        let gain = pull(given.strength)? / NATS;
        let regions = LikelihoodRegions::new(&classes, density, gain);
        Ok(Arc::new(regions.map_err(by(ForceKey::Components))?))
    }

    pub(super) fn texture(&self, given: &Texture) -> Result<Arc<dyn Region>, ForceError> {
        let sigmas = self.sigmas(&given.sigmas)?;
        let levels = self.image.pixels().levels();
        let channels = field::texture_channels(levels, sigmas).map_err(by(ForceKey::All))?;
        let masked: Result<Vec<MaskedImage>, _> =
            channels.iter().map(|c| self.image.masked(c)).collect();
        let classes = Classes::clusters(&masked.map_err(by(ForceKey::All))?, given.classes)
            .map_err(by(ForceKey::Classes))?;
        // each channel has its say in the likelihood, and they mostly say the same
        let gain = pull(given.strength)? / (NATS * channels.len() as f64);
        let regions = LikelihoodRegions::new(&classes, Density::Gaussian, gain);
        Ok(Arc::new(regions.map_err(by(ForceKey::All))?))
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
