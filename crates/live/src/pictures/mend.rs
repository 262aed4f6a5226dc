//! The hand on an outline: the stretch about a node becomes a body that the hand pulls by a spring and the picture by
//! its edges; the rest stays as it is.

use std::collections::BTreeSet;

use glam::DVec2;
use scene::elastic;
use scene::fit::{Contour, Edit, Session};

use super::{One, Pictures};
use crate::LiveError;

/// Stiffness of the hand's spring. M L² T⁻².
const SPRING: f64 = 400.0;

/// Steps of the motion in one step of looking, and how many there are at most after it was let go.
const STEPS: u64 = 4;
const MOST_STEPS: u32 = 150;

/// The outline in the hand.
#[derive(Debug, Clone)]
pub(crate) struct Mend {
    pub id: u32,
    session: Session,
    /// Nodes that follow.
    free: Vec<usize>,
    /// The node that is pulled, and where to; None once it was let go.
    pub pull: Option<(usize, DVec2)>,
    steps: u32,
}

impl Mend {
    /// Whether it moves: while it is pulled, and until it has settled.
    pub(super) const fn moves(&self) -> bool {
        self.pull.is_some() || self.steps < MOST_STEPS
    }

    /// Where the nodes are.
    pub(super) fn nodes(&self) -> &[DVec2] {
        self.session.nodes()
    }
}

impl Pictures {
    /// A motion of an outline of which only some nodes may move.
    pub(super) fn session(
        &self,
        one: &One,
        points: &[DVec2],
        free: &[usize],
    ) -> Result<Session, LiveError> {
        let (low, high) = self.corners();
        let curve = Contour {
            points: points.iter().map(|p| p.clamp(low, high)).collect(),
            closed: one.closed,
        };
        let session = self.prepared.session_of_nodes(&curve);
        let mut session = session.map_err(LiveError::of)?;
        let free: BTreeSet<usize> = free.iter().copied().collect();
        let held = (0..points.len()).filter(|i| !free.contains(i) || one.pins.contains(i));
        session
            .edit(Edit::Hold(held.collect()))
            .map_err(LiveError::of)?;
        for (from, radius) in &self.forbidden {
            let push = Edit::Push {
                from: *from,
                reach: 1.5 * radius,
                pulls: 12.0,
            };
            session.edit(push).map_err(LiveError::of)?;
        }
        Ok(session)
    }

    /// Pull a node to a place.
    pub(super) fn drag(
        &mut self,
        id: u32,
        node: usize,
        to: DVec2,
        reach: f64,
    ) -> Result<(), LiveError> {
        let one = self.one(id)?.clone();
        check_node(&one, node)?;
        let same = |mend: &Mend| mend.id == id && mend.pull.is_some_and(|(held, _)| held == node);
        if !self.mend.as_ref().is_some_and(same) {
            self.finish();
            if !(reach.is_finite() && reach > 0.0) {
                return Err(LiveError::new(format!(
                    "the stretch that follows must be longer than 0 pixels, got {reach}"
                )));
            }
            let one = self.one(id)?.clone();
            let free = about(&one.points, one.closed, node, reach);
            self.mend = Some(Mend {
                id,
                session: self.session(&one, &one.points, &free)?,
                free,
                pull: None,
                steps: 0,
            });
        }
        let (low, high) = self.corners();
        if let Some(mend) = &mut self.mend {
            let pull = Edit::Pull {
                node,
                to: to.clamp(low, high),
                stiffness: SPRING,
            };
            mend.session.edit(pull).map_err(LiveError::of)?;
            (mend.pull, mend.steps) = (Some((node, to)), 0);
        }
        Ok(())
    }

    /// Pull no longer. The rest shape is what it is now, so that the stretch stays where the picture holds it.
    pub(super) fn drop(&mut self) -> Result<(), LiveError> {
        let Some(mend) = &self.mend else {
            return Ok(());
        };
        let (id, free) = (mend.id, mend.free.clone());
        let nodes = mend.nodes().to_vec();
        let one = self.one(id)?.clone();
        let session = self.session(&one, &nodes, &free)?;
        if let Some(mend) = &mut self.mend {
            (mend.session, mend.pull, mend.steps) = (session, None, 0);
        }
        Ok(())
    }

    /// One step of the outline in the hand.
    pub(super) fn settle(&mut self) {
        let Some(mend) = &mut self.mend else { return };
        let ended = mend.session.step(STEPS).is_some();
        mend.steps += 1;
        if mend.pull.is_none() && (ended || mend.steps >= MOST_STEPS) {
            self.finish();
        }
    }

    /// Bring what is under way to its end: outlines arrive, and what was pulled stays where it has come to.
    pub(super) fn finish(&mut self) {
        self.arriving.clear();
        let Some(mend) = self.mend.take() else { return };
        let Mend {
            id,
            mut session,
            free,
            pull,
            ..
        } = mend;
        if pull.is_none() {
            session.step(STEPS * u64::from(MOST_STEPS));
        }
        let points = session.nodes().to_vec();
        if let Ok(one) = self.one_mut(id) {
            if !crosses(&points, one.closed) {
                one.take_over(&points, &free);
            } else {
                "the stretch would cross the outline; it is as it was before"
                    .clone_into(&mut one.words);
            }
            self.facts.insert(self.now);
        }
    }

    /// What is shown of an outline: where it is on its way.
    pub(super) fn shown<'a>(&'a self, id: u32, one: &'a One) -> &'a [DVec2] {
        match (&self.mend, self.arriving.get(&id)) {
            (Some(mend), _) if mend.id == id => mend.nodes(),
            (_, Some(arrival)) => arrival.nodes(),
            _ => &one.points,
        }
    }
}

impl One {
    /// Some nodes are elsewhere now, by hand: what was measured of them holds no longer.
    pub(super) fn take_over(&mut self, points: &[DVec2], moved: &[usize]) {
        for &i in moved {
            let there = points[i].distance(self.points[i]) > 1e-9;
            if there && let Some(error) = self.error.get_mut(i) {
                *error = None;
            }
        }
        self.points = points.to_vec();
        "mended by hand".clone_into(&mut self.words);
        self.sure = true;
    }
}

/// Whether a curve crosses itself.
pub(super) fn crosses(points: &[DVec2], closed: bool) -> bool {
    outline::crossings(points, closed).map_or(true, |found| !found.is_empty())
}

/// Refuse a node that an outline has not.
pub(super) fn check_node(one: &One, node: usize) -> Result<(), LiveError> {
    let nodes = one.points.len();
    if node < nodes {
        return Ok(());
    }
    Err(LiveError::new(format!(
        "{} has {nodes} nodes, got node {node}",
        one.label
    )))
}

/// The nodes within a length of curve to either side of a node; at most all but two.
pub(super) fn about(points: &[DVec2], closed: bool, node: usize, reach: f64) -> Vec<usize> {
    let n = points.len();
    let mut free = vec![node];
    for forward in [true, false] {
        let (mut at, mut gone) = (node, 0.0);
        while free.len() + 2 < n {
            let next = match (forward, closed) {
                (true, true) => (at + 1) % n,
                (false, true) => (at + n - 1) % n,
                (true, false) if at + 1 < n => at + 1,
                (false, false) if at > 0 => at - 1,
                _ => break,
            };
            gone += points[at].distance(points[next]);
            if gone > reach || free.contains(&next) {
                break;
            }
            free.push(next);
            at = next;
        }
    }
    free
}

/// The nodes from one to another, along a curve.
pub(super) fn between(n: usize, closed: bool, from: usize, to: usize) -> Vec<usize> {
    if from <= to {
        (from..=to).collect()
    } else if closed {
        (from..n).chain(0..=to).collect()
    } else {
        (to..=from).collect()
    }
}

/// Length of a curve, in words of its outline.
pub(super) fn length(one: &One) -> f64 {
    elastic::length(&one.points, one.closed)
}
