//! Contacts met in sub-steps that may not stand.

use glam::DVec2;

use crate::{Meeting, Response, System, Touch, Wrapped};

/// What was touched while sub-steps were tried.
#[derive(Debug, Clone, Default)]
pub(crate) struct Watch {
    pub(crate) touched: bool,
    /// How far a node may be off because a contact was met at the end of a step and not before.
    pub(crate) late: f64,
    /// Which of the two sub-steps that may stand is being made.
    pub(crate) half: Option<usize>,
    /// What was met in them.
    pub(crate) met: Vec<(usize, Met)>,
}

/// A meeting to be told of later.
#[derive(Debug, Clone)]
pub(crate) struct Met {
    t: f64,
    late: f64,
    before: (Vec<DVec2>, Vec<DVec2>),
    after: (Vec<DVec2>, Vec<DVec2>),
    support: Vec<DVec2>,
}

impl Met {
    fn of(meeting: &Meeting<'_>) -> Self {
        let own = |(x, v): (&[DVec2], &[DVec2])| (x.to_vec(), v.to_vec());
        Self {
            t: meeting.t,
            late: meeting.late,
            before: own(meeting.before),
            after: own(meeting.after),
            support: meeting.support.to_vec(),
        }
    }
}

impl Watch {
    /// Tell of what was met in one of the two sub-steps.
    pub(crate) fn tell(&self, half: usize, system: &mut dyn System) {
        for (_, met) in self.met.iter().filter(|(when, _)| *when == half) {
            system.met(&Meeting {
                t: met.t,
                late: met.late,
                before: (&met.before.0, &met.before.1),
                after: (&met.after.0, &met.after.1),
                support: &met.support,
            });
        }
    }
}

/// A system whose contacts are watched, and told of once it is decided which sub-steps stand.
pub(crate) struct Watched<'a> {
    pub(crate) inner: &'a mut dyn System,
    pub(crate) watch: &'a mut Watch,
}

impl Wrapped for Watched<'_> {
    fn inner(&self) -> &dyn System {
        &*self.inner
    }

    fn inner_mut(&mut self) -> &mut dyn System {
        &mut *self.inner
    }

    fn contacts(
        &mut self,
        dt: f64,
        before: &[DVec2],
        x: &[DVec2],
        v: &[DVec2],
        touches: &mut Vec<Touch>,
    ) {
        self.inner.contacts(dt, before, x, v, touches);
        self.watch.touched |= !touches.is_empty();
        for touch in &*touches {
            let (Response::Impact { .. }, Some(&v)) = (touch.response, v.get(touch.node)) else {
                continue;
            };
            // out again, and slower along it
            let (away, along) = touch.response.at_most(touch.normal, v);
            let fast = away.hypot(along);
            self.watch.late = self.watch.late.max(dt * fast);
        }
    }

    fn met(&mut self, meeting: &Meeting<'_>) {
        // whether this happens at all is not decided yet
        if let Some(half) = self.watch.half {
            self.watch.met.push((half, Met::of(meeting)));
        }
    }
}
