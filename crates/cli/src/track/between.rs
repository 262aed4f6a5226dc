//! Frames between outlines that are given, followed both ways before anything is written of them: the start, and what
//! was mended by hand. Outlines are kept, frames are read again.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use ::track::{Event, Happening, Options, Outline, State, blended};
use io::Picture;
use io::frames::{Frame, Frames, Numbered};
use scene::SceneError;

use super::run::{Facts, Run, Told};
use crate::commands::key;
use crate::stop::Stop;

/// Frames from the start outwards, as one run has told them: each object blended between what is given of it. None if
/// the user has stopped it.
pub(super) fn outwards(
    frames: &mut Frames,
    main: &mut Run,
    first: Told,
    to: usize,
    options: &Options,
    stop: &Stop,
) -> Result<Option<Vec<Told>>, SceneError> {
    let from = first.index;
    let facts: Facts = main.facts.clone();
    let mut told = vec![first];
    for index in way(from, to) {
        if stop.asked() {
            return Ok(None);
        }
        let Some(frame) = read(frames, index) else {
            break;
        };
        told.push(main.step(frame)?.0);
    }
    let Some(inwards) = inwards(frames, &facts, from, options, stop)? else {
        return Ok(None);
    };
    let ids: BTreeSet<u32> = facts.values().flatten().map(|one| one.id).collect();
    for id in ids {
        blend(&mut told, &inwards, id, &facts);
    }
    Ok(Some(told))
}

/// The places of frames from one to another, without the first.
fn way(from: usize, to: usize) -> Box<dyn Iterator<Item = usize>> {
    if to >= from {
        Box::new(from + 1..=to)
    } else {
        Box::new((to..from).rev())
    }
}

fn read(frames: &mut Frames, index: usize) -> Option<Numbered> {
    if frames.seek(index) {
        frames.next()
    } else {
        None
    }
}

/// The picture of a frame, if it has one.
pub(super) fn picture_of(frame: Numbered) -> Option<Arc<Picture>> {
    match frame.frame {
        Frame::Picture(picture) => Some(Arc::from(picture)),
        Frame::Broken(_) => None,
    }
}

/// Follow what is given from the farthest frame back to the start: outlines by frames and numbers.
fn inwards(
    frames: &mut Frames,
    facts: &Facts,
    start: usize,
    options: &Options,
    stop: &Stop,
) -> Result<Option<BTreeMap<usize, Vec<Outline>>>, SceneError> {
    let mut found = BTreeMap::new();
    let mut facts = facts.clone();
    facts.remove(&start);
    let is_ahead = facts.keys().any(|&frame| frame > start);
    let mut run: Option<Run> = None;
    let Some(farthest) = (if is_ahead {
        facts.keys().next_back().copied()
    } else {
        facts.keys().next().copied()
    }) else {
        return Ok(Some(found));
    };
    let options = Options {
        start: ::track::Start::Exact,
        births: false,
        ..options.clone()
    };
    for index in std::iter::once(farthest).chain(way(farthest, start)) {
        if stop.asked() {
            return Ok(None);
        }
        // nothing is followed before something is given
        if index == start || (run.is_none() && !facts.contains_key(&index)) {
            continue;
        }
        let Some(frame) = read(frames, index) else {
            break;
        };
        if let Some(run) = &mut run {
            let (told, _) = run.step(frame)?;
            found.insert(index, told.outlines);
        } else if let (Some(own), Some(picture)) = (facts.remove(&index), picture_of(frame.clone()))
        {
            let begun = Run::of_facts(&frame, &picture, &own, &options, is_ahead);
            let mut begun =
                begun.map_err(|error| key("--mend", format!("frame {index}: {error}")))?;
            begun.facts = std::mem::take(&mut facts);
            found.insert(index, begun.first(&frame, &picture)?.outlines);
            run = Some(begun);
        }
    }
    Ok(Some(found))
}

/// Blend an object between what is given of it, in frames from the start outwards.
fn blend(told: &mut [Told], inwards: &BTreeMap<usize, Vec<Outline>>, id: u32, facts: &Facts) {
    let own = |list: &[Outline]| list.iter().find(|one| one.id == id).cloned();
    let is_given = |frame: &Told| {
        facts
            .get(&frame.index)
            .is_some_and(|list| list.iter().any(|one| one.id == id))
    };
    let Some(begin) = told.iter().position(|frame| own(&frame.outlines).is_some()) else {
        return;
    };
    let mut known = vec![begin];
    known.extend(
        (begin + 1..told.len()).filter(|&at| is_given(&told[at]) && told[at].broken.is_none()),
    );
    for pair in known.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        let onward: Vec<Option<Outline>> = told[from..=to]
            .iter()
            .map(|frame| own(&frame.outlines))
            .collect();
        let mut back: Vec<Option<Outline>> = told[from..=to]
            .iter()
            .map(|frame| inwards.get(&frame.index).and_then(|list| own(list)))
            .collect();
        // what is given is the same on both ways
        if let Some(last) = back.last_mut() {
            *last = own(&told[to].outlines);
        }
        for (frame, outline) in told[from..=to].iter_mut().zip(blended(&onward, &back)) {
            frame.outlines.retain(|one| one.id != id);
            frame.outlines.extend(outline);
            frame.outlines.sort_by_key(|one| one.id);
        }
    }
}

/// Tell again, by the outlines, when objects begin, are hidden and found: frames in order, up to the first that is told
/// by the run itself.
pub(super) fn retold(told: &mut [Told]) {
    let mut begun = BTreeSet::new();
    for at in 0..told.len() {
        let (before, now) = told.split_at_mut(at);
        let Some(now) = now.first_mut() else { break };
        let before = before.last();
        let frame = now.index;
        let state =
            |list: &[Outline], id| list.iter().find(|one| one.id == id).map(|one| one.state);
        now.events.retain(|event| match event.what {
            Happening::Begun | Happening::Hidden | Happening::Found => false,
            Happening::Lost | Happening::Left => state(&now.outlines, event.id).is_none(),
            _ => true,
        });
        let mut events = Vec::new();
        for one in &now.outlines {
            let was = before.and_then(|before| state(&before.outlines, one.id));
            let born = now
                .events
                .iter()
                .any(|event| event.id == one.id && event.what == Happening::Born);
            let what = if begun.insert(one.id) {
                (one.parent.is_none() && !born).then_some(Happening::Begun)
            } else {
                match (was.is_some_and(State::is_seen), one.state.is_seen()) {
                    // a frame that cannot be used is told as such
                    (true, false) if now.broken.is_none() => Some(Happening::Hidden),
                    (false, true) => Some(Happening::Found),
                    _ => None,
                }
            };
            let sure = one.confidence.clamp(0.0, 1.0);
            events.extend(what.map(|what| Event {
                frame,
                id: one.id,
                confidence: match what {
                    Happening::Begun => 1.0,
                    Happening::Hidden => 1.0 - sure,
                    _ => sure,
                },
                what,
            }));
        }
        events.append(&mut now.events);
        now.events = events;
    }
}
