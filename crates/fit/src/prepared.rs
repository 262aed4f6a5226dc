//! An image made ready for fits: its forces, once for all curves and threads.

use std::sync::{Arc, OnceLock};

use field::{EdgeForce, ForceField, Polarity, Smoothing};
use glam::DVec2;
use snake::{Acting, ImageForce, Pressure, Sampling, World};

use crate::finder::found;
use crate::force::{Edge, ForceKey, ImageForceKind, PULL, Sight, check_smoothing};
use crate::options::{Method, Step};
use crate::session::Session;
use crate::setup::inside;
use crate::{Contour, Fit, FitError, FitForce, Image, OptionKey, Options, Problem};

/// A start of a search may reach beyond the image by so many of its larger sides: work and memory of a search grow
/// with its start.
const MOST_BEYOND: f64 = 4.0;

/// Steps of a motion between two looks at whether it is to end.
const STEPS_A_LOOK: u64 = 50;

/// An image with all that a fit needs of it, for any number of curves. Cloning it costs nothing; it
/// may be shared by threads, and so are the tiles of lazy fields.
///
/// ```
/// use fit::{Contour, Image, Options, Prepared};
/// use glam::DVec2;
///
/// let bright = |x: usize, y: usize| (x as f64 - 30.0).hypot(y as f64 - 30.0) < 15.0;
/// let level = |(y, x)| if bright(x, y) { 200.0 } else { 50.0 };
/// let levels = field::Grid::from_shape_fn((61, 61), level);
/// let prepared = Prepared::of(&Image::grey(levels), &Options::default())?;
/// let starts = [17.0, 18.0, 19.0].map(|radius| Contour::circle(DVec2::new(31.0, 30.0), radius));
/// for start in &starts {
///     assert!(prepared.fit(start)?.outcome.is_good());
/// }
/// # Ok::<(), fit::FitError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Prepared(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    options: Options,
    image: Image,
    /// What a motion needs of the image, once it is asked for.
    forces: OnceLock<Result<Forces, FitError>>,
}

/// The forces of an image.
#[derive(Debug)]
pub(crate) struct Forces {
    pub(crate) sight: Sight,
    /// The field of the usual edge force, where that alone pulls.
    usual: Option<Arc<ForceField>>,
    /// The chosen forces.
    chosen: Vec<Chosen>,
}

/// A chosen force as far as it can be made before the curve is known.
#[derive(Debug)]
struct Chosen {
    force: FitForce,
    acting: Vec<Acting>,
}

impl Prepared {
    /// Make an image ready.
    ///
    /// # Errors
    ///
    /// By its key: an option out of its range, levels that are not finite, a force that asks for
    /// more time or memory than there is.
    pub fn of(image: &Image, options: &Options) -> Result<Self, FitError> {
        options.check()?;
        let inner = Inner {
            options: options.clone(),
            image: image.clone(),
            forces: OnceLock::new(),
        };
        let prepared = Self(Arc::new(inner));
        if options.method == Method::Motion {
            prepared.forces()?;
        }
        Ok(prepared)
    }

    /// Fit a contour that starts there.
    ///
    /// # Errors
    ///
    /// By its key: a start with too few points or outside the image, of a search one that reaches beyond the image
    /// by more than four of its larger sides, too many nodes, a force that only a closed curve can have.
    pub fn fit(&self, start: &Contour) -> Result<Fit, FitError> {
        match self.0.options.method {
            Method::Search => {
                let ended = || Problem::Other("has no answer: the search was ended".to_owned());
                let found = self.fit_unless(start, &|| false)?;
                found.ok_or_else(|| FitError::new(OptionKey::Start, ended()))
            }
            Method::Motion => Ok(self.session(start)?.finish()),
        }
    }

    /// [`Prepared::fit`] that ends early when `asked` says so; None then. It is looked at between the stages of a
    /// search, which take some milliseconds each, and between the steps of a motion.
    ///
    /// ```
    /// use fit::{Contour, Image, Options, Prepared};
    /// use glam::DVec2;
    ///
    /// let image = Image::grey(field::Grid::from_shape_fn((61, 61), |(y, x)| (x * y) as f64 % 256.0));
    /// let prepared = Prepared::of(&image, &Options::default())?;
    /// let start = Contour::circle(DVec2::new(31.0, 30.0), 17.0);
    /// assert!(prepared.fit_unless(&start, &|| true)?.is_none());
    /// assert_eq!(prepared.fit_unless(&start, &|| false)?, Some(prepared.fit(&start)?));
    /// # Ok::<(), fit::FitError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`Prepared::fit`].
    pub fn fit_unless(
        &self,
        start: &Contour,
        asked: &dyn Fn() -> bool,
    ) -> Result<Option<Fit>, FitError> {
        if self.0.options.method == Method::Search {
            self.check_reach(start)
                .map_err(|problem| FitError::new(OptionKey::Start, problem))?;
            return found(self, start, asked);
        }
        let mut session = self.session(start)?;
        while session.step(STEPS_A_LOOK).is_none() {
            if asked() {
                return Ok(None);
            }
        }
        Ok(Some(session.finish()))
    }

    /// Refuse a start that reaches too far beyond the image, before anything of its size is made.
    fn check_reach(&self, start: &Contour) -> Result<(), Problem> {
        let (width, height) = self.0.image.size();
        let last = DVec2::new(width as f64, height as f64) - 0.5;
        let beyond = |p: &DVec2| (DVec2::splat(-0.5) - p).max(*p - last).max_element();
        // numbers that are not finite are refused by their point
        let finite = start.points.iter().filter(|p| p.is_finite());
        let far = finite.map(beyond).fold(0.0, f64::max);
        let most = MOST_BEYOND * width.max(height) as f64;
        if far <= most {
            return Ok(());
        }
        let far = if far < 1e9 {
            format!("{far:.0}")
        } else {
            format!("{far:.1e}")
        };
        Err(Problem::Other(format!(
            "reaches {far} pixels beyond the picture of {width}×{height} pixels; must be at most {most}, four times its \
             larger side"
        )))
    }

    /// A motion from a start step by step, whatever the method.
    ///
    /// # Errors
    ///
    /// As [`Prepared::fit`].
    pub fn session(&self, start: &Contour) -> Result<Session, FitError> {
        Session::new(self, start)
    }

    /// The same of nodes that stay as they are, each a node of the curve, whatever the options say of their number.
    ///
    /// # Errors
    ///
    /// As [`Prepared::fit`].
    pub fn session_of_nodes(&self, nodes: &Contour) -> Result<Session, FitError> {
        inside(self, &nodes.points)?;
        Session::of(self, nodes.points.clone(), nodes.closed)
    }

    /// The options that it was made ready for.
    #[must_use]
    pub fn options(&self) -> &Options {
        &self.0.options
    }

    /// The image.
    #[must_use]
    pub fn image(&self) -> &Image {
        &self.0.image
    }

    /// The image as forces see it.
    ///
    /// # Errors
    ///
    /// As [`Prepared::of`] with [`Method::Motion`].
    pub fn sight(&self) -> Result<&Sight, FitError> {
        Ok(&self.forces()?.sight)
    }

    /// The field of the edge force, where that alone pulls; None where it does not, or nothing has moved yet.
    #[must_use]
    pub fn field(&self) -> Option<&Arc<ForceField>> {
        self.0.forces.get()?.as_ref().ok()?.usual.as_ref()
    }

    /// What a motion needs of the image, made when it is first asked for.
    pub(crate) fn forces(&self) -> Result<&Forces, FitError> {
        let made = self
            .0
            .forces
            .get_or_init(|| Forces::of(&self.0.image, &self.0.options));
        made.as_ref().map_err(Clone::clone)
    }

    /// The forces on a curve of these nodes.
    pub(crate) fn world(&self, nodes: &[DVec2], closed: bool) -> Result<World, FitError> {
        let options = &self.0.options;
        let Forces {
            sight,
            usual,
            chosen,
        } = self.forces()?;
        let mut world = World::default();
        if let Some(usual) = usual {
            world = world.with(ImageForce::new(Arc::clone(usual), Sampling::Bilinear));
        }
        for (index, chosen) in chosen.iter().enumerate() {
            let list = match &chosen.force {
                FitForce::Image { kind, .. } => {
                    if kind.is_region() && !closed {
                        let key = OptionKey::Force(index, ForceKey::Kind);
                        return Err(FitError::new(key, Problem::Open));
                    }
                    chosen.acting.clone()
                }
                FitForce::Made(made) => {
                    let key = OptionKey::Force(index, ForceKey::All);
                    made.make(sight, nodes, closed)
                        .map_err(|message| FitError::new(key, Problem::Other(message)))?
                }
            };
            world.forces.extend(list);
        }
        if options.balloon.abs() > 0.0 {
            if !closed {
                return Err(FitError::new(OptionKey::Balloon, Problem::Open));
            }
            let pressure = Pressure::constant(PULL * options.balloon);
            world = world.with_acting(Acting::new(pressure).named("balloon"));
        }
        Ok(world)
    }

    /// The steepest slope that the usual edge force can have anywhere.
    ///
    /// The field is computed where the curve goes, and not as a whole for this: its slopes are
    /// bounded by the image's range of levels, H. With gain g, the force of one dimension has the
    /// slope g (H/2) ∫|G‴| at most, and ∫|G‴| = 2 (1 + 4 e^(−3/2)) / (√(2π) σ³) for a Gaussian G.
    pub(crate) fn steepest(&self, forces: &Forces) -> f64 {
        let options = &self.0.options;
        let sigma = options.sigma;
        let total = 2.0 * (1.0 + 4.0 * (-1.5_f64).exp());
        let sharp = (std::f64::consts::TAU.sqrt() * sigma.powi(3)).recip();
        0.5 * forces.gain(options) * forces.sight.range() * total * sharp
    }

    /// Whether the usual edge force alone is chosen to pull, in steps of the finder's own choice.
    pub(crate) fn relaxes(&self) -> bool {
        self.field().is_some() && self.0.options.step == Step::Chosen
    }
}

impl Forces {
    fn of(image: &Image, options: &Options) -> Result<Self, FitError> {
        let sight = Sight::of(image.clone(), options.computing, 0)
            .map_err(|problem| FitError::new(OptionKey::Image, problem))?;
        let mut forces = Self {
            sight,
            usual: None,
            chosen: Vec::new(),
        };
        if options.forces.is_empty() && options.polarity == Polarity::Either {
            forces.usual = Some(Arc::new(forces.usual_field(options)?));
        } else {
            forces.choose(options)?;
        }
        Ok(forces)
    }

    /// The gain of the usual edge force.
    pub(crate) fn gain(&self, options: &Options) -> f64 {
        let usual = EdgeForce::as_strong_as_the_report().gain;
        options.strength * usual * 120.0 / self.sight.contrast()
    }

    fn usual_field(&self, options: &Options) -> Result<ForceField, FitError> {
        let rule = EdgeForce {
            smoothing: Smoothing::Gaussian(options.sigma),
            gain: self.gain(options),
        };
        self.sight.edge_field(rule).map_err(|error| {
            let key = match error.key {
                ForceKey::Sigma => OptionKey::Sigma,
                _ => OptionKey::Computing,
            };
            FitError::new(key, error.problem)
        })
    }

    /// The chosen forces, or the usual one of the chosen polarity.
    fn choose(&mut self, options: &Options) -> Result<(), FitError> {
        let mut forces = options.forces.clone();
        if forces.is_empty() {
            let sigma = options.sigma;
            check_smoothing(Smoothing::Gaussian(sigma), self.sight.image().size())
                .map_err(|problem| FitError::new(OptionKey::Sigma, problem))?;
            // that edge force at another σ has another pull
            let strength = options.strength * 10.0 / (sigma * sigma);
            let polarity = Some(options.polarity);
            forces.push(FitForce::of(ImageForceKind::Edge(Edge {
                sigma,
                strength,
                polarity,
            })));
        }
        for force in &mut forces {
            if let FitForce::Image {
                kind: ImageForceKind::Edge(edge),
                ..
            } = force
            {
                edge.polarity.get_or_insert(options.polarity);
            }
        }
        let kinds: Vec<(usize, &ImageForceKind)> = forces
            .iter()
            .enumerate()
            .filter_map(|(index, force)| match force {
                FitForce::Image { kind, .. } => Some((index, kind)),
                FitForce::Made(_) => None,
            })
            .collect();
        self.sight
            .foresee(kinds.iter().map(|(_, kind)| *kind))
            .map_err(|(at, problem)| {
                let index = kinds.get(at).map_or(0, |(index, _)| *index);
                FitError::new(OptionKey::Force(index, ForceKey::Kind), problem)
            })?;
        for (index, force) in forces.into_iter().enumerate() {
            let mut acting = Vec::new();
            if let FitForce::Image { kind, weight } = &force {
                Problem::at_least_zero(*weight).map_err(|problem| {
                    FitError::new(OptionKey::Force(index, ForceKey::Weight), problem)
                })?;
                let made = self.sight.forces(kind).map_err(|error| {
                    FitError::new(OptionKey::Force(index, error.key), error.problem)
                })?;
                let weighted = |one: Acting| one.weighted(elastic::Profile::Uniform(*weight));
                acting.extend(made.into_iter().map(weighted));
            }
            self.chosen.push(Chosen { force, acting });
        }
        Ok(())
    }
}
