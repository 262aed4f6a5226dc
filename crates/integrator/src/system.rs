//! What is moved, and what moves it.
//!
//! A scheme asks a [`System`] for forces and hands back a [`State`]; it never learns whether the
//! nodes belong to a curve, hang on springs or fall freely.

use banded::Operator;
use glam::{DMat2, DVec2};

/// Where every node is and how fast it moves.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Time.
    pub t: f64,
    /// Steps made so far.
    pub step: u64,
    /// Position of each node.
    pub x: Vec<DVec2>,
    /// Velocity of each node.
    pub v: Vec<DVec2>,
}

impl State {
    /// Nodes at rest at `x`, at time 0.
    #[must_use]
    pub fn at_rest(x: Vec<DVec2>) -> Self {
        let v = vec![DVec2::ZERO; x.len()];
        Self {
            t: 0.0,
            step: 0,
            x,
            v,
        }
    }

    /// Become the same as `other`, in the same memory.
    pub(crate) fn copy(&mut self, other: &Self) {
        self.t = other.t;
        self.step = other.step;
        self.x.clone_from(&other.x);
        self.v.clone_from(&other.v);
    }

    /// Number of nodes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Whether there is no node at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }
}

/// Why a node stopped a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum FaultKind {
    /// An external force has no value there.
    OutsideField,
    /// A position, a velocity or a force became infinite or NaN.
    NotFinite,
    /// Mass, damping or stiffness changed to something the scheme cannot step with.
    NoSolution,
}

/// A step that could not be made, and the node to blame.
///
/// An outcome rather than a mistake: a run that blows up ends here. The state is left as it was
/// before the step.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("node {node} at ({}, {}) {}", at.x, at.y, match kind {
    FaultKind::OutsideField => "is outside the force field",
    FaultKind::NotFinite => "is not finite any more",
    FaultKind::NoSolution => "has mass, damping or stiffness no step can be made with",
})]
pub struct Fault {
    /// The first node concerned.
    pub node: usize,
    /// Where it was.
    pub at: DVec2,
    /// What was wrong.
    pub kind: FaultKind,
}

/// A node that met an obstacle at the end of a step, and what the obstacle does to it.
///
/// The velocity is turned by the scheme, which alone knows how much of the step's forces is in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// The node.
    pub node: usize,
    /// Where it is put.
    pub position: DVec2,
    /// Unit vector away from the obstacle.
    pub normal: DVec2,
    /// What happens to the velocity.
    pub response: Response,
}

/// How an obstacle changes the velocity v of a node; n is the normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Response {
    /// The part across becomes what carried the node to its place, `(position − before)·n / dt`, as in
    /// the report's program (D57). The part along stays.
    Clamp,
    /// The part across turns round, `−restitution v·n`, if it points into the obstacle. The part along
    /// loses at most `friction` times the impulse across (Coulomb).
    Impact {
        /// From 0 (inelastic) to 1 (elastic).
        restitution: f64,
        /// Coulomb's coefficient, at least 0.
        friction: f64,
    },
    /// The part across is lost, whichever way it points: a node that is guided on a line.
    Guide,
}

impl Response {
    /// The largest speed away from the obstacle, and the largest change of speed along it, that an impact
    /// leaves a node of velocity `v` with.
    pub(crate) fn at_most(self, normal: DVec2, v: DVec2) -> (f64, f64) {
        let Self::Impact {
            restitution,
            friction,
        } = self
        else {
            return (0.0, 0.0);
        };
        let across = v.dot(normal);
        let into = (-across).max(0.0);
        let slip = (v - normal * across).length();
        let away = across.max(restitution * into);
        (away, slip.min(friction * (1.0 + restitution) * into))
    }
}

/// Places and velocities of all nodes just before touches and just after.
#[derive(Debug, Clone, Copy)]
pub struct Meeting<'a> {
    /// When.
    pub t: f64,
    /// How far the velocities are behind the places. T.
    pub late: f64,
    /// Places and velocities before.
    pub before: (&'a [DVec2], &'a [DVec2]),
    /// And after.
    pub after: (&'a [DVec2], &'a [DVec2]),
    /// What the obstacles have added to the velocities after the second half of the step's forces;
    /// empty for schemes whose steps have one part.
    pub support: &'a [DVec2],
}

/// Nodes with mass, damping, stiffness and external forces: μ v̈ + γ v̇ = elastic + external.
///
/// The elastic force is affine in the positions: `elastic(x) − elastic(y) = −A (x − y)` with
/// `A` = [`stiffness`](Self::stiffness), symmetric and never negative.
pub trait System {
    /// Number of nodes.
    fn len(&self) -> usize;

    /// Whether there is no node at all.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// μ: mass of each node.
    fn mass(&self) -> &[f64];

    /// γ: damping of each node.
    fn damping(&self) -> &[f64];

    /// Nodes that may not move.
    fn held(&self) -> &[bool];

    /// `A`; rows and columns of held nodes are zero.
    fn stiffness(&self) -> &Operator;

    /// Bring what changes with time to `t`, and what changes with place to nodes at `x`. Where that changes mass,
    /// damping or stiffness, the [`revision`](Self::revision) is another afterwards.
    ///
    /// Places are those of the state at that time, and those of its stages in an explicit scheme; in the middle of an implicit
    /// step they are `x + ½ dt v`.
    fn advance(&mut self, t: f64, x: &[DVec2]) {
        let _ = (t, x);
    }

    /// A number that is another one after every change of mass, damping, stiffness, held nodes or
    /// forces. Each scheme compares it with the one it has seen last.
    fn revision(&self) -> u64 {
        0
    }

    /// Whether [`advance`](Self::advance) asks where the nodes are; if not, any places will do.
    fn depends_on_place(&self) -> bool {
        false
    }

    /// Elastic force on every node; overwrites `force`, zero at held nodes.
    fn elastic(&mut self, x: &[DVec2], force: &mut [DVec2]);

    /// Adds the external force on every node to `force`.
    ///
    /// What it does to held nodes has no effect.
    ///
    /// # Errors
    ///
    /// A [`Fault`] where a force has no value.
    fn external(
        &mut self,
        t: f64,
        x: &[DVec2],
        v: &[DVec2],
        force: &mut [DVec2],
    ) -> Result<(), Fault>;

    /// Whether the external force depends neither on place nor on velocity nor on time, as gravity does
    /// not, until the [`revision`](Self::revision) is another.
    ///
    /// Schemes then ask for it once a step, and the exact ones have no error at all.
    fn external_is_constant(&self) -> bool {
        false
    }

    /// Whether the external force depends on velocities; if not, a change of velocities alone leaves it as it is.
    fn external_depends_on_velocity(&self) -> bool {
        true
    }

    /// Nodes that met an obstacle while going from `before` to `x`, appended to `touches`.
    ///
    /// `touches` comes empty, with room for one touch a node.
    fn contacts(
        &mut self,
        dt: f64,
        before: &[DVec2],
        x: &[DVec2],
        v: &[DVec2],
        touches: &mut Vec<Touch>,
    ) {
        let _ = (dt, before, x, v, touches);
    }

    /// What the touches of the last [`contacts`](Self::contacts) have done. The energy account asks for it.
    fn met(&mut self, meeting: &Meeting<'_>) {
        let _ = meeting;
    }

    /// A sub-step within a step ended at this state, and stands; that of the step's own end is not told.
    fn passed(&mut self, state: &State) {
        let _ = state;
    }

    /// The rounds of an implicit step have not come to agree, and the step was made by those there
    /// were: it loses its order, and
    /// backward Euler's is one of imex. Systems that report such steps count them here.
    fn gave_up(&mut self) {}

    /// A frame that moves by an equation of its own, with an inertial force left out of it, has put
    /// that energy in, or taken
    /// it out, during the step. The energy account asks for it.
    fn frame_work(&mut self, work: f64) {
        let _ = work;
    }

    /// Largest stiffness and damping that a penalty contact adds at one node, for step limits.
    fn contact_stiffness(&self) -> (f64, f64) {
        (0.0, 0.0)
    }

    /// β: the external force holds a damping between nodes of at most β times the stiffness, which
    /// schemes see half a step
    /// late, for step limits. T.
    fn internal_damping(&self) -> f64 {
        0.0
    }

    /// ∂(external force)/∂(position) of each node, for linearly implicit schemes.
    ///
    /// False, with `slope` left alone, where it is not known.
    fn external_slope(&mut self, t: f64, x: &[DVec2], slope: &mut [DMat2]) -> bool {
        let _ = (t, x, slope);
        false
    }
}
