//! Where an object may be in a frame, before it is looked at: by its motion, by flow, by plain flow since it began.

use glam::DVec2;

use crate::body::Body;
use crate::predict::{Flowed, Prediction, flowed};
use crate::step::Frame;

/// Nodes no farther from each other are carried alike. Cells.
const SAME: f64 = 1.0;

/// Where an object may be in a frame, before it is looked at.
#[derive(Debug)]
pub(crate) struct Predicted {
    pub candidates: Vec<(Prediction, Vec<DVec2>)>,
    pub flow: Option<Flowed>,
    /// Where plain flow carries the outline.
    pub plain: Option<Vec<DVec2>>,
}

impl Predicted {
    /// Where it is most likely to be.
    pub(crate) fn expected(&self) -> &[DVec2] {
        let carried = self.flow.as_ref().filter(|flow| flow.share > 0.5);
        carried.map_or(&self.candidates[0].1, |flow| &flow.bent)
    }
}

impl Body {
    /// Where it may be in the next frame.
    pub(crate) fn predict(&self, frame: Frame<'_>) -> Predicted {
        let block = self.block as f64;
        let flow = frame.before.filter(|_| !self.left);
        let flow = flow
            .and_then(|before| flowed(before, frame.pyramid, &self.curve, &self.quality, block));
        let mut candidates = vec![
            (Prediction::Flown, self.motion.flown(&self.curve)),
            (Prediction::Still, self.curve.clone()),
        ];
        if let Some(flow) = &flow {
            candidates.push((Prediction::Carried, flow.carried.clone()));
            candidates.push((Prediction::Bent, flow.bent.clone()));
        }
        let plain = self.carried(frame, flow.as_ref());
        if let Some(plain) = &plain {
            candidates.push((Prediction::Plain, plain.clone()));
        }
        Predicted {
            candidates,
            flow,
            plain,
        }
    }

    /// Where plain flow carries the outline that it has carried so far.
    fn carried(&self, frame: Frame<'_>, flow: Option<&Flowed>) -> Option<Vec<DVec2>> {
        let (plain, flow) = (self.plain.as_ref()?, flow?);
        let both = || plain.iter().zip(&self.curve);
        if both().all(|(a, b)| a.distance(*b) < SAME) {
            let ways = both().zip(&flow.bent);
            return Some(ways.map(|((a, b), to)| *a + (*to - *b)).collect());
        }
        let all = vec![1.0; plain.len()];
        let block = self.block as f64;
        flowed(frame.before?, frame.pyramid, plain, &all, block).map(|flow| flow.bent)
    }
}
