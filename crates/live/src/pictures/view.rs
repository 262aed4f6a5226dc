//! A picture with its outlines as it is to be drawn.

use serde_json::{Value, json};

use super::Pictures;
use super::start::drawn_curve;
use super::tile::usual;
use crate::packet::Packet;
use crate::request::Drawn;
use crate::{LiveError, Pair};

impl Pictures {
    /// What stays from frame to frame.
    pub(crate) fn about(&self) -> Value {
        let (width, height) = self.picture.size();
        let tones = usual(&self.picture);
        let pixel = self.picture.pixel_size();
        json!({
            "name": &*self.frames[self.now].name, "size": [width, height],
            "frames": self.frames.len(), "version": self.version,
            "tones": [tones.low, tones.high, tones.gamma],
            "notes": self.picture.notes(), "pixel": pixel.map(|pixel| format!("{pixel:?}")),
            "color": self.picture.is_color(),
        })
    }

    pub(crate) const fn picture(&self) -> &std::sync::Arc<io::Picture> {
        &self.picture
    }

    pub(crate) const fn version(&self) -> u64 {
        self.version
    }

    /// The outlines now.
    pub(crate) fn frame(&self, packet: &mut Packet) -> Value {
        let outlines = self.outlines.iter().map(|(id, one)| {
            let points = self.shown(*id, one);
            let whole = points.len() == one.points.len();
            let area = one
                .closed
                .then(|| scene::elastic::signed_area(points).abs());
            json!({
                "id": id, "label": one.label, "class": one.class, "closed": one.closed,
                "x": packet.points(points), "arriving": self.arriving.contains_key(id),
                "strength": (whole && one.strength.len() == points.len())
                    .then(|| packet.numbers(one.strength.iter().copied())),
                "error": (whole && one.error.len() == points.len())
                    .then(|| packet.numbers(one.error.iter().map(|e| e.unwrap_or(-1.0)))),
                "pins": one.pins, "sure": one.sure, "words": one.words, "area": area,
                "mean-error": one.mean_error(),
            })
        });
        let outlines: Vec<Value> = outlines.collect();
        let pull = self.mend.as_ref().and_then(|mend| {
            let (node, to) = mend.pull?;
            Some(json!({"id": mend.id, "node": node, "to": to.to_array()}))
        });
        json!({
            "frame": self.now, "outlines": outlines, "pull": pull, "version": self.version,
            "forbidden": self.forbidden.iter().map(|(at, radius)| json!({"at": at.to_array(), "radius": radius}))
                .collect::<Vec<Value>>(),
            "facts": self.facts, "with-outlines": self.with_outlines(),
            "events": self.events.get(&self.now), "following": self.following.is_some(),
        })
    }

    /// Frames that have outlines.
    fn with_outlines(&self) -> Vec<usize> {
        let now = (!self.outlines.is_empty()).then_some(self.now);
        self.others.keys().copied().chain(now).collect()
    }

    /// A start as it will be.
    pub(crate) fn preview(
        drawn: Drawn,
        points: &[Pair],
        closed: bool,
        packet: &mut Packet,
    ) -> Result<Value, LiveError> {
        let curve = drawn_curve(drawn, points, closed)?;
        Ok(json!({"x": packet.points(&curve.points), "closed": curve.closed}))
    }

    /// All there is to know of an outline.
    pub(crate) fn explained(&self, id: u32, packet: &mut Packet) -> Result<Value, LiveError> {
        let one = self.one(id)?;
        let candidates: Vec<Value> = one
            .candidates
            .iter()
            .map(|curve| packet.points(curve))
            .collect();
        Ok(json!({
            "id": id, "words": one.words, "explained": one.explained, "start": packet.points(&one.start),
            "candidates": candidates,
        }))
    }
}
