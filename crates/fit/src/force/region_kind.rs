//! The kinds of force that compare what is inside a closed curve with what is outside.

/// What is like the inside into the curve: one mean inside, one outside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Regions {
    /// σ of the Gaussian that smooths the image. Pixels.
    pub sigma: f64,
    /// In pulls, on a pixel of one mean with the other mean a contrast away.
    pub strength: f64,
    /// Whether colors are looked at as grey.
    pub grey: bool,
}

impl Default for Regions {
    fn default() -> Self {
        // it averages over areas anyway
        Self {
            sigma: 1.0,
            strength: 1.0,
            grey: false,
        }
    }
}

/// The same with means near each node: uneven light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalRegions {
    /// Smoothing, strength and channels.
    pub regions: Regions,
    /// Radius of the disks that count around a node. Pixels.
    pub radius: f64,
}

impl Default for LocalRegions {
    fn default() -> Self {
        Self {
            regions: Regions::default(),
            radius: 10.0,
        }
    }
}

/// How a distribution is made of the pixels on one side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Densities {
    /// The histogram, smoothed by a Gaussian.
    Histogram {
        /// Its σ; None: a twentieth of the contrast. Levels.
        bandwidth: Option<f64>,
    },
    /// One Gaussian.
    Gaussian,
    /// Several Gaussians.
    Mixture {
        /// How many, 2 to 8.
        components: usize,
    },
}

/// The same by distributions of grey or color.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Likelihood {
    /// σ of the Gaussian that smooths the image. Pixels.
    pub sigma: f64,
    /// In pulls, on a pixel that is 20 times likelier on one side.
    pub strength: f64,
    /// Whether colors are looked at as grey.
    pub grey: bool,
    /// Classes that pixels are sorted into.
    pub classes: usize,
    /// How the distributions are made.
    pub density: Densities,
}

impl Default for Likelihood {
    fn default() -> Self {
        Self {
            sigma: 1.0,
            strength: 1.0,
            grey: false,
            classes: 64,
            density: Densities::Histogram { bandwidth: None },
        }
    }
}

/// The same by the energies of stripes of every direction and width.
#[derive(Debug, Clone, PartialEq)]
pub struct Texture {
    /// 1 to 32 widths of stripes. Pixels.
    pub sigmas: Vec<f64>,
    /// In pulls, on a pixel that is 20 times likelier on one side.
    pub strength: f64,
    /// Classes that pixels are sorted into.
    pub classes: usize,
}

impl Default for Texture {
    fn default() -> Self {
        Self {
            sigmas: vec![1.5, 3.0],
            strength: 1.0,
            classes: 32,
        }
    }
}
