//! A fit that is watched: stepped, edited, finished.

use std::ops::ControlFlow;

use elastic::{Material, Topology};
use glam::DVec2;
use integrator::State;
use snake::{Body, Member, Outcome, Rest, Run, Simulation, Snake, Until};

use crate::nodes::node_evidence;
use crate::setup::{bordered, nodes, place, stepping, unfit, unmoved};
use crate::{Choices, Contour, Evidence, Fit, FitError, Moved, Prepared};

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
#[derive(Debug, Clone)]
pub struct Session {
    pub(crate) prepared: Prepared,
    pub(crate) simulation: Simulation,
    start: Vec<DVec2>,
    closed: bool,
    run: Run,
    outcome: Option<Outcome>,
    chosen: Moved,
}

impl Session {
    pub(crate) fn new(prepared: &Prepared, start: &Contour) -> Result<Self, FitError> {
        let x = place(prepared, start, nodes(prepared, start))?;
        Self::of(prepared, x, start.closed)
    }

    /// A motion of these nodes, which are in the image.
    pub(crate) fn of(prepared: &Prepared, x: Vec<DVec2>, closed: bool) -> Result<Self, FitError> {
        let options = prepared.options();
        let forces = prepared.forces()?;
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
        let snake = Snake::new(body, world).map_err(unfit)?;
        let (stepping, chosen) = stepping(prepared, &snake)?;
        let begun = Simulation::of(snake, State::at_rest(x.clone()), stepping);
        let mut simulation = begun.map_err(unmoved)?;
        let run = simulation.start(&until(options.steps));
        let chosen = Moved {
            contrast: forces.sight.true_contrast(),
            nodes: x.len(),
            spacing,
            gain: prepared.field().map(|_| forces.gain(options)),
            ..chosen
        };
        Ok(Self {
            prepared: prepared.clone(),
            simulation,
            start: x,
            closed,
            run,
            outcome: None,
            chosen,
        })
    }

    /// Make so many steps; how it ended, if it has ended.
    pub fn step(&mut self, steps: u64) -> Option<Outcome> {
        if self.outcome.is_none() {
            let watch = &mut |_: &mut Simulation| ControlFlow::Continue(());
            let step = self.simulation.steps();
            let gone = self.simulation.go_on(&self.run, steps, watch);
            // what an edit has made of the curve cannot be moved: no step was made
            self.outcome = gone.unwrap_or(Some(Outcome::Stopped { step }));
        }
        self.outcome
    }

    /// The curve, and where it is: a session has one.
    pub(crate) fn member(&self) -> &Member {
        &self.simulation.members()[0]
    }

    /// What moves the curve, to be looked at: one snake in its world.
    #[must_use]
    pub const fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// The nodes as they are.
    #[must_use]
    pub fn nodes(&self) -> &[DVec2] {
        &self.member().state().x
    }

    /// The nodes as they were at the start.
    #[must_use]
    pub fn start(&self) -> &[DVec2] {
        &self.start
    }

    /// Steps made so far.
    #[must_use]
    pub const fn steps(&self) -> u64 {
        self.simulation.steps()
    }

    /// What was chosen, and why.
    #[must_use]
    pub const fn chosen(&self) -> &Moved {
        &self.chosen
    }

    /// Look for rest anew.
    pub(crate) fn begin_again(&mut self) {
        // steps that suit the curve as it is now; equal ones that have become too long stay as asked for
        if let Ok((stepping, _)) = stepping(&self.prepared, self.member().snake()) {
            let _ = self.simulation.set_stepping(stepping);
        }
        let until = until(self.prepared.options().steps);
        self.run = self.simulation.start(&until);
        self.outcome = None;
    }

    /// Move on to the end, and say what was found.
    #[must_use]
    pub fn finish(mut self) -> Fit {
        let outcome = self.step(u64::MAX);
        // it always ends: the steps are counted
        let step = self.steps();
        self.found(outcome.unwrap_or(Outcome::Finished { step }))
    }

    /// End it here, and say what there is.
    #[must_use]
    pub fn stop(self) -> Fit {
        let step = self.steps();
        let outcome = self.outcome.unwrap_or(Outcome::Stopped { step });
        self.found(outcome)
    }

    fn found(self, outcome: Outcome) -> Fit {
        let step = self.steps();
        let blown_up = matches!(outcome, Outcome::Diverged { .. });
        let settled = matches!(outcome, Outcome::Settled { .. });
        let sigma = self.prepared.options().sigma;
        let (mut snake, state) = (self.member().snake().clone(), self.member().state());
        let quality =
            settled.then(|| Evidence::of(&mut snake, &self.start, state, Some(RESOLVES * sigma)));
        let nodes = if blown_up {
            Vec::new()
        } else {
            node_evidence(&self.prepared, &mut snake, state)
        };
        Fit {
            contour: Contour {
                points: state.x.clone(),
                closed: self.closed,
            },
            nodes,
            quality,
            outcome,
            steps: step,
            chosen: Choices::Motion(self.chosen),
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
