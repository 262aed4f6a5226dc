//! The kinds of force as plain values, with the defaults of each.

use field::{Falloff, FlowRule, Polarity};

use super::{Likelihood, LocalRegions, Regions, Texture};

/// σ of an edge force unless given: that of the report's twenty passes.
const USUAL_SIGMA: f64 = 3.162_277_660_168_379_5;

/// A force that an image exerts on a curve.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum ImageForceKind {
    /// Edges of the grey image, of both polarities or one.
    Edge(Edge),
    /// Edges in color.
    ColorEdge(ColorEdge),
    /// Edges at several scales at once.
    Scales(Scales),
    /// Edges at one scale after another.
    CoarseToFine(CoarseToFine),
    /// Bright or dark lines.
    Line(Line),
    /// Ends of lines, and corners.
    Termination(Termination),
    /// The nearest edge, with constant pull.
    Distance(Distance),
    /// Gradient vector flow.
    Gvf(Gvf),
    /// Vector field convolution.
    Vfc(Vfc),
    /// One mean inside, one outside.
    Regions(Regions),
    /// The same with means near each node.
    LocalRegions(LocalRegions),
    /// The same by distributions of grey or color.
    Likelihood(Likelihood),
    /// The same by the energies of stripes.
    Texture(Texture),
}

impl ImageForceKind {
    /// The word for it.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Edge(_) => "edge",
            Self::ColorEdge(_) => "color-edge",
            Self::Scales(_) => "scales",
            Self::CoarseToFine(_) => "coarse-to-fine",
            Self::Line(_) => "line",
            Self::Termination(_) => "termination",
            Self::Distance(_) => "distance",
            Self::Gvf(_) => "gvf",
            Self::Vfc(_) => "vfc",
            Self::Regions(_) => "regions",
            Self::LocalRegions(_) => "local-regions",
            Self::Likelihood(_) => "likelihood",
            Self::Texture(_) => "texture",
        }
    }

    /// Whether it is one field of the image, whatever the curve.
    #[must_use]
    pub const fn is_field(&self) -> bool {
        match self {
            Self::Edge(edge) => matches!(edge.polarity, None | Some(Polarity::Either)),
            Self::CoarseToFine(_) => false,
            _ => !self.is_region(),
        }
    }

    /// Whether it compares what is inside a closed curve with what is outside.
    #[must_use]
    pub const fn is_region(&self) -> bool {
        matches!(
            self,
            Self::Regions(_) | Self::LocalRegions(_) | Self::Likelihood(_) | Self::Texture(_)
        )
    }

    /// How many fields, of two numbers a pixel, it keeps.
    pub(crate) const fn fields(&self) -> usize {
        match self {
            Self::CoarseToFine(scales) => scales.sigmas.len(),
            // a number for each stripe and channel
            Self::Texture(_) => 8,
            Self::Regions(_) | Self::LocalRegions(_) | Self::Likelihood(_) => 2,
            _ => 1,
        }
    }
}

/// Edges of the grey image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// σ of the Gaussian that smooths the image; 3.16 unless set. Pixels.
    pub sigma: f64,
    /// In pulls of an edge as high as the contrast.
    pub strength: f64,
    /// Which edges attract, going outwards; None: those of
    /// [`Options::polarity`](crate::Options::polarity), or either where there are no options.
    pub polarity: Option<Polarity>,
}

impl Default for Edge {
    fn default() -> Self {
        Self {
            sigma: USUAL_SIGMA,
            strength: 1.0,
            polarity: None,
        }
    }
}

/// Edges in color, those between colors of equal grey too.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColorEdge {
    /// σ of the Gaussian that smooths each channel; 3.16 unless set. Pixels.
    pub sigma: f64,
    /// In pulls of an edge as high as the contrast of all channels.
    pub strength: f64,
}

impl Default for ColorEdge {
    fn default() -> Self {
        Self {
            sigma: USUAL_SIGMA,
            strength: 1.0,
        }
    }
}

/// Edges at several scales at once: the strongest of them, each times √σ.
#[derive(Debug, Clone, PartialEq)]
pub struct Scales {
    /// 1 to 32 scales. Pixels.
    pub sigmas: Vec<f64>,
    /// In pulls of an edge as high as the contrast, at the finest scale.
    pub strength: f64,
}

impl Default for Scales {
    fn default() -> Self {
        Self {
            sigmas: vec![8.0, 4.0, 2.0],
            strength: 1.0,
        }
    }
}

/// Edges at one scale after another: a force for each scale, coarse first; each is held, then fades
/// over half that time while the next comes in.
#[derive(Debug, Clone, PartialEq)]
pub struct CoarseToFine {
    /// 1 to 32 scales, falling. Pixels.
    pub sigmas: Vec<f64>,
    /// In pulls of an edge as high as the contrast, at the finest scale.
    pub strength: f64,
    /// Blur of the image's own edges, σ. Pixels.
    pub blur: f64,
    /// How long each scale is held. T.
    pub hold: f64,
}

impl Default for CoarseToFine {
    fn default() -> Self {
        Self {
            sigmas: vec![16.0, 8.0, 4.0, 2.0],
            strength: 1.0,
            blur: 1.0,
            hold: 10.0,
        }
    }
}

/// Bright or dark lines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// σ of the Gaussian that smooths the image. Pixels.
    pub sigma: f64,
    /// In pulls, at the steepest slope of a line as high as the contrast.
    pub strength: f64,
    /// Which lines attract.
    pub shade: field::Line,
}

impl Default for Line {
    fn default() -> Self {
        Self {
            sigma: 2.0,
            strength: 1.0,
            shade: field::Line::Bright,
        }
    }
}

/// Ends of lines, and corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Termination {
    /// σ of the Gaussian that smooths the image. Pixels.
    pub sigma: f64,
    /// In pulls.
    pub strength: f64,
    /// Where the image is flatter than this share of the steepest slope of an edge as high as the
    /// contrast, the direction of its slope counts for less.
    pub floor: f64,
}

impl Default for Termination {
    fn default() -> Self {
        Self {
            sigma: 2.0,
            strength: 1.0,
            floor: 0.1,
        }
    }
}

/// The nearest edge, with constant pull.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distance {
    /// σ of the Gaussian that smooths the image. Pixels.
    pub sigma: f64,
    /// In pulls.
    pub strength: f64,
    /// How steep an edge is at least, as a share of the steepest of one as high as the contrast.
    pub threshold: f64,
    /// Beyond this distance nothing pulls; None: as far as the image goes. Pixels.
    pub reach: Option<f64>,
}

impl Default for Distance {
    fn default() -> Self {
        Self {
            sigma: 2.0,
            strength: 1.0,
            threshold: 0.25,
            reach: None,
        }
    }
}

/// Gradient vector flow: edges from as far as the image is wide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gvf {
    /// σ of the Gaussian that smooths the image. Pixels.
    pub sigma: f64,
    /// In pulls.
    pub strength: f64,
    /// How steep an edge is that counts half, as a share of the steepest of one as high as the
    /// contrast.
    pub threshold: f64,
    /// The trade between smoothness and the edges.
    pub rule: FlowRule,
    /// Where the pull levels off, as a share of its largest.
    pub knee: f64,
}

impl Default for Gvf {
    fn default() -> Self {
        Self {
            sigma: 2.0,
            strength: 1.0,
            threshold: 0.25,
            rule: FlowRule::Plain { smoothness: 0.2 },
            knee: 0.1,
        }
    }
}

/// Vector field convolution: all edges at once, by distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vfc {
    /// σ of the Gaussian that smooths the image. Pixels.
    pub sigma: f64,
    /// In pulls.
    pub strength: f64,
    /// How steep an edge is that counts half, as a share of the steepest of one as high as the
    /// contrast.
    pub threshold: f64,
    /// How the pull of an edge pixel falls with distance. With an exponent of 1 a ring pulls
    /// nothing inside it, so it must be above that.
    pub falloff: Falloff,
    /// Beyond this distance an edge pixel pulls nothing; None: as far as the image goes and memory
    /// allows. Pixels.
    pub reach: Option<f64>,
    /// Where the pull levels off, as a share of its largest.
    pub knee: f64,
}

impl Default for Vfc {
    fn default() -> Self {
        Self {
            sigma: 2.0,
            strength: 1.0,
            threshold: 0.25,
            // the inverse square, which Li and Acton begin with: a whole straight edge then pulls
            // by the inverse of its distance
            falloff: Falloff::Power { exponent: 2.0 },
            reach: None,
            knee: 0.1,
        }
    }
}
