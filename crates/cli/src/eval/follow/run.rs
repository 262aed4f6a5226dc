//! A sequence followed and scored.

use score::sequences::Event;
use score::tracking::{FollowedFrame, Following, TrackScores, Tracks};
use track::Options;

use super::clips::{Clip, FOUND};
use super::found::{Follower, Given};
use super::source::Truth;
use crate::eval::clock::Clock;
use crate::eval::rows::Way;

/// A sequence followed from a start.
#[derive(Debug)]
pub(super) struct Followed {
    pub(super) sequence: String,
    pub(super) start: String,
    pub(super) score: Score,
    /// Why it was refused or given up, if it was: from there on nothing was found.
    pub(super) refused: Option<String>,
    /// Events told rightly, told where there is none, and missed, where the truth of them is known.
    pub(super) events: Option<[usize; 3]>,
    /// CPU time a frame; None of what was given. Seconds.
    pub(super) seconds: Option<f64>,
}

/// How well.
#[derive(Debug)]
pub(super) enum Score {
    /// One object: the means, and every frame.
    One(score::tracking::Followed, Vec<FollowedFrame>),
    /// Many.
    Many(TrackScores),
}

/// Follow a sequence from each of its starts.
///
/// # Errors
///
/// A picture or a truth that cannot be read or does not fit; what was given, the same.
pub(super) fn followed(
    clip: &Clip,
    given: Option<&Given>,
    exact: bool,
    way: &Way<'_>,
) -> Result<Vec<Followed>, String> {
    let mut all = Vec::new();
    let named = |error: String| format!("{}: {error}", clip.name);
    for (name, outlines) in &clip.starts {
        if way.stop.asked() {
            break;
        }
        let mut seconds = 0.0;
        let follower = match given {
            Some(given) => Follower::given(given, &clip.name)?,
            None => {
                let options = Options {
                    start: if exact {
                        track::Start::Exact
                    } else {
                        track::Start::Chosen
                    },
                    fit: way.options.clone(),
                    births: clip.source.births(),
                    ..Options::default()
                };
                let first = clip.source.image(0).map_err(named)?;
                let starts = if outlines.is_empty() {
                    clip.source.start().map_err(named)?
                } else {
                    outlines.clone()
                };
                let clock = Clock::start(way.alone);
                let follower = Follower::tracker(&first, starts, &options);
                seconds += clock.seconds();
                follower
            }
        };
        if let Some(mut one) = one(clip, follower, seconds, way).map_err(named)? {
            one.start.clone_from(name);
            if name == FOUND {
                one.seconds = None;
            }
            all.push(one);
        }
    }
    Ok(all)
}

/// Follow a sequence, and score every frame; None if that was stopped.
fn one(
    clip: &Clip,
    mut follower: Follower,
    mut seconds: f64,
    way: &Way<'_>,
) -> Result<Option<Followed>, String> {
    let told = |error: score::ScoreError| error.to_string();
    let frames = clip.source.frames();
    let (mut following, mut each) = (None, Vec::new());
    let (mut tracks, mut segments, mut apart) = (Tracks::default(), Tracks::default(), false);
    for t in 0..frames {
        if way.stop.asked() {
            return Ok(None);
        }
        let image = (t > 0 && follower.looks()).then(|| clip.source.image(t));
        let image = image.transpose()?;
        let clock = Clock::start(way.alone);
        let found = follower.frame(t, image.as_ref())?;
        seconds += clock.seconds();
        match clip.source.truth(t)? {
            Truth::One { rings, mask } => {
                let following = following.get_or_insert_with(|| Following::new(mask.dim()));
                let sure = found.sure;
                let mut outlines: Vec<_> = found.outlines.into_iter().map(|one| one.1).collect();
                if let Some(labels) = found.labels {
                    outlines = score::border(&labels.mapv(|label| label > 0));
                }
                let frame = following.add_to(&outlines, &rings, &mask, sure);
                each.push(frame.map_err(|error| format!("frame {t}: {error}"))?);
            }
            Truth::Many {
                labels,
                segments: others,
            } => {
                let found = follower.labels(t, found, labels.dim());
                let frame = |error: score::ScoreError| format!("frame {t}: {error}");
                tracks.add(&found, &labels).map_err(frame)?;
                if let Some(others) = others {
                    apart = true;
                    if let Some(others) = others {
                        segments.add(&found, &others).map_err(frame)?;
                    }
                }
            }
        }
    }
    follower.check_end(frames)?;
    let score = if let Some(following) = following {
        let means = following.finish();
        let means = means.ok_or_else(|| "a second frame is needed".to_owned())?;
        Score::One(means, each)
    } else {
        let lives = clip.source.lineages();
        let mut scores = tracks.finish(&follower.lineages(), &lives).map_err(told)?;
        if apart {
            scores.seg = segments.finish(&[], &[]).map_err(told)?.seg;
        }
        Score::Many(scores)
    };
    Ok(Some(Followed {
        sequence: clip.name.clone(),
        start: String::new(),
        score,
        events: clip
            .source
            .events()
            .filter(|_| follower.looks())
            .map(|truth| events(follower.events(), &truth)),
        refused: follower.refused().map(str::to_owned),
        seconds: Some(seconds / frames as f64),
    }))
}

/// Events told rightly, told where there is none, and missed: each true one is told by one of its kind within a frame,
/// or within two if it is a return.
fn events(told: &[(usize, Event)], truth: &[(usize, Event)]) -> [usize; 3] {
    let mut left = told.to_vec();
    let mut right = 0;
    for (frame, what) in truth {
        let late = if *what == Event::Returned { 2 } else { 1 };
        let same = |one: &(usize, Event)| one.1 == *what && one.0.abs_diff(*frame) <= late;
        if let Some(at) = left.iter().position(same) {
            left.remove(at);
            right += 1;
        }
    }
    [right, left.len(), truth.len() - right]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_event_counts_once_and_only_when_it_happens() {
        let truth = [(15, Event::Vanished), (20, Event::Returned)];
        let told = [
            (16, Event::Vanished),
            (18, Event::Returned),
            (22, Event::Returned),
        ];
        assert_eq!(events(&told, &truth), [2, 1, 0]);
        assert_eq!(events(&[(17, Event::Vanished)], &truth), [0, 1, 2]);
        assert_eq!(events(&[], &[]), [0, 0, 0]);
    }
}
