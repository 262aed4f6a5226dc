//! `snake eval` on sequences: what `snake track` does, or what a file says, against truth frame by frame.

mod clips;
mod found;
mod run;
mod source;
mod told;

use std::path::Path;

use io::Claims;
use scene::SceneError;

use self::clips::Clip;
use self::found::Given;
use self::run::{Followed, followed};
use super::flags::Eval;
use super::rows::Way;
use super::{End, check_outputs, check_qualities, in_order, one_object_only};
use crate::args::Words;
use crate::commands::{Answer, key};

/// What drawn sequences are called.
const DRAWN: &str = "sequences";

/// The start that is the true outline of the first frame.
const TRUE: &str = "true";

/// Starts that are scored if none is asked for.
const USUAL: [&str; 2] = ["near", TRUE];

/// Score sequences, if that is what the set holds; None if it does not.
pub(super) fn answer(
    flags: &Eval,
    way: &Way<'_>,
    words: Words,
) -> Result<Option<Answer>, SceneError> {
    let mut problems = Vec::new();
    let clips = if flags.set == Path::new(DRAWN) && !flags.set.exists() {
        clips::drawn()
    } else if !flags.first_frames && clips::has_sequences(&flags.set)? {
        clips::of_manifest(&flags.set, &flags.inits, &mut problems)?
    } else if let Some(clips) = clips::of_challenge(&flags.set)? {
        clips
    } else {
        if let Some(path) = &flags.found {
            let message = format!(
                "is for sequences; needed: a manifest with the columns sequence and frame, or folders as 01 and 01_GT, got {}",
                path.display()
            );
            return Err(key("--found", message));
        }
        return Ok(None);
    };
    Ok(Some(scored(flags, way, words, clips, problems)))
}

fn scored(
    flags: &Eval,
    way: &Way<'_>,
    words: Words,
    mut clips: Vec<Clip>,
    problems: Vec<String>,
) -> Answer {
    one_object_only(flags, way, "sequences")?;
    for (flag, given) in [
        ("--sheet", flags.sheet.is_some()),
        ("--seeds", flags.seeds.is_some()),
    ] {
        if given {
            return Err(key(flag, "sequences cannot have it"));
        }
    }
    let mut claims = Claims::default();
    for clip in &clips {
        clip.files().iter().for_each(|path| claims.reads(path));
    }
    let given = flags.found.as_ref().map(|path| Given::of(path, &clips));
    let given = given.transpose()?;
    if given.is_some() {
        // whatever it was started from
        for clip in &mut clips {
            clip.starts = vec![(clips::FOUND.to_owned(), Vec::new())];
        }
        if let Some(name) = flags.quality.first() {
            let message = format!("what was found has no start, got {name}");
            return Err(key("--quality", message));
        }
    } else {
        let known = clips.iter().flat_map(|clip| clip.starts.iter());
        let known: Vec<&str> = known.map(|start| start.0.as_str()).collect();
        check_qualities(&flags.quality, &known)?;
        for clip in &mut clips {
            clip.starts.retain(|(name, _)| {
                let usual = flags.quality.is_empty() && USUAL.contains(&name.as_str());
                usual || flags.quality.contains(name)
            });
        }
    }
    check_outputs(flags, &mut claims, words)?;
    let work = |at: usize| followed(&clips[at], given.as_ref(), flags.exact_start, way);
    let answers = in_order(clips.len(), flags.jobs, work);
    let mut end = End::of(flags, way, words, problems);
    let mut rows: Vec<Followed> = Vec::new();
    for answer in answers {
        match answer {
            Ok(all) => rows.extend(all),
            Err(problem) => end
                .problems
                .push(format!("{problem}; the sequence is left out")),
        }
    }
    end.nothing(rows.is_empty())?;
    end.tell(&told::text(&rows), &told::each(&rows), told::json(&rows))
}
