//! A fit that is watched: stepped, edited, finished.

use std::ops::ControlFlow;

use elastic::{Material, Topology};
use glam::DVec2;
use integrator::{State, Stepper};
use snake::{Body, Outcome, Rest, Running, Snake, Until};

use crate::nodes::node_evidence;
use crate::setup::{bordered, mover, place, unfit};
use crate::{Choices, Contour, Evidence, Fit, FitError, Prepared};

/// The least distance of the found sides of a bar that is wide enough, in σ: those of a thin line
/// are 2 σ apart however thin it is, those of a bar of 2 σ are 2.3 σ.
const RESOLVES: f64 = 2.5;

/// A curve on its way to an outline, one step or many at a time.
///
/// ```
/// use fit::{Contour, Edit, Image, Options, Prepared};
/// use glam::DVec2;
///
/// let bright = |x: usize, y: usize| (x as f64 - 30.0).hypot(y as f64 - 30.0) < 15.0;
/// let level = |(y, x)| if bright(x, y) { 200.0 } else { 50.0 };
/// let levels = field::Grid::from_shape_fn((61, 61), level);
/// let prepared = Prepared::of(&Image::grey(levels), &Options::default())?;
/// let mut session = prepared.session(&Contour::circle(DVec2::new(31.0, 30.0), 18.0))?;
/// while session.step(5).is_none() {} // draw session.nodes() here
/// session.edit(Edit::Pull { node: 0, to: DVec2::new(52.0, 30.0), stiffness: 20.0 })?;
/// session.step(200);
/// assert!(session.nodes()[0].x > 47.0);
/// session.edit(Edit::LetGo)?;
/// assert!((session.finish().contour.points[0].x - 45.0).abs() < 1.0);
/// # Ok::<(), fit::FitError>(())
/// ```
#[derive(Debug)]
pub struct Session {
    pub(crate) prepared: Prepared,
    pub(crate) snake: Snake,
    start: Vec<DVec2>,
    closed: bool,
    pub(crate) state: State,
    stepper: Box<dyn Stepper>,
    running: Running,
    outcome: Option<Outcome>,
    chosen: Choices,
}

impl Session {
    pub(crate) fn new(prepared: &Prepared, start: &Contour) -> Result<Self, FitError> {
        let closed = start.closed;
        let x = place(prepared, start)?;
        let options = prepared.options();
        let topology = if closed {
            Topology::Closed
        } else {
            Topology::open(elastic::End::Free)
        };
        let material = Material::uniform(options.tether, options.tension, options.rigidity);
        let body = Body::of(&x, topology, 1.0)
            .map_err(unfit)?
            .with_material(material)
            .with_damping(options.damping);
        let spacing = body.spacing;
        let world = bordered(prepared.world(&x, closed)?, prepared)?;
        let mut snake = Snake::new(body, world).map_err(unfit)?;
        let state = State::at_rest(x.clone());
        let (stepper, chosen) = mover(prepared, &mut snake, &state)?;
        let running = Running::begin(&mut snake, &state, until(options.steps));
        let chosen = Choices {
            contrast: prepared.sight().true_contrast(),
            nodes: x.len(),
            spacing,
            gain: prepared.field().map(|_| prepared.gain()),
            ..chosen
        };
        Ok(Self {
            prepared: prepared.clone(),
            snake,
            start: x,
            closed,
            state,
            stepper,
            running,
            outcome: None,
            chosen,
        })
    }

    /// Make so many steps; how it ended, if it has ended.
    pub fn step(&mut self, steps: u64) -> Option<Outcome> {
        if self.outcome.is_none() {
            let watch = &mut |_: &mut Snake, _: &State| ControlFlow::Continue(());
            let stepper = &mut *self.stepper;
            let running = &mut self.running;
            self.outcome = running.go(&mut self.snake, stepper, &mut self.state, steps, watch);
        }
        self.outcome
    }

    /// The nodes as they are.
    #[must_use]
    pub fn nodes(&self) -> &[DVec2] {
        &self.state.x
    }

    /// The nodes as they were at the start.
    #[must_use]
    pub fn start(&self) -> &[DVec2] {
        &self.start
    }

    /// Steps made so far.
    #[must_use]
    pub const fn steps(&self) -> u64 {
        self.state.step
    }

    /// What was chosen, and why.
    #[must_use]
    pub const fn chosen(&self) -> &Choices {
        &self.chosen
    }

    /// Look for rest anew.
    pub(crate) fn begin_again(&mut self) {
        // steps that suit the curve as it is now; equal ones that have become too long stay as asked for
        match mover(&self.prepared, &mut self.snake, &self.state) {
            Ok((stepper, _)) => self.stepper = stepper,
            Err(_) => self.stepper.resume(&mut self.snake, &self.state),
        }
        let until = until(self.prepared.options().steps);
        self.running = Running::begin(&mut self.snake, &self.state, until);
        self.outcome = None;
    }

    /// Move on to the end, and say what was found.
    #[must_use]
    pub fn finish(mut self) -> Fit {
        let outcome = self.step(u64::MAX);
        // it always ends: the steps are counted
        let step = self.state.step;
        let outcome = outcome.unwrap_or(Outcome::Finished { step });
        let blown_up = matches!(outcome, Outcome::Diverged { .. });
        let settled = matches!(outcome, Outcome::Settled { .. });
        let sigma = self.prepared.options().sigma;
        let quality = settled.then(|| {
            Evidence::of(
                &mut self.snake,
                &self.start,
                &self.state,
                Some(RESOLVES * sigma),
            )
        });
        let nodes = if blown_up {
            Vec::new()
        } else {
            node_evidence(&self.prepared, &mut self.snake, &self.state)
        };
        Fit {
            contour: Contour {
                points: self.state.x,
                closed: self.closed,
            },
            nodes,
            quality,
            outcome,
            steps: step,
            chosen: self.chosen,
        }
    }
}

/// When a fit stops: nodes may slide along the outline for as long as they like.
fn until(steps: u64) -> Until {
    let rest = Rest {
        shape: true,
        ..Rest::default()
    };
    Until::at_rest(rest, steps)
}
