//! What a track is to leave behind: checked before the work.

use std::path::{Path, PathBuf};

use io::film::FilmFormat;
use io::frames::Frames;
use io::tracks::TrackFormat;
use io::{Claims, is_standard};
use scene::SceneError;

use super::flags::Flags;
use crate::args::Words;
use crate::commands::key;
use crate::fit::stem;

/// Where the outlines go, and how.
#[derive(Debug)]
pub(super) struct Plan {
    out: PathBuf,
    pub(super) format: TrackFormat,
    pub(super) film: Option<FilmFormat>,
}

impl Plan {
    pub(super) fn of(flags: &Flags, words: Words) -> Result<Self, SceneError> {
        let out = flags.out.clone().unwrap_or_else(|| PathBuf::from("-"));
        let names = TrackFormat::ALL.map(TrackFormat::name).join(", ");
        let format = match &flags.format {
            Some(name) => TrackFormat::named(name).ok_or_else(|| {
                key(
                    "--as",
                    format!("must be one of {names}, got {}", io::text::clip(name)),
                )
            })?,
            None => TrackFormat::by_ending(&out).ok_or_else(|| {
                let message = format!(
                    "{}: the ending names no format; needed: --as with one of {names}",
                    out.display()
                );
                key("--out", message)
            })?,
        };
        if flags.resume && (!format.grows() || is_standard(&out)) {
            let message = "goes on with what grows frame by frame, and a ZIP, a COCO file or standard output does not; \
                needed: --out with a name that ends in .csv, .geojson or .txt, or a folder of labels";
            return Err(key("--resume", message));
        }
        let film = flags.overlay.as_deref().map(|path| {
            FilmFormat::by_ending(path).ok_or_else(|| {
                let message = "the name must end in .gif, .png, .mp4, .mov, .mkv or .webm";
                key("--overlay", format!("{message}, got {}", path.display()))
            })
        });
        for (flag, path, endings) in [
            ("--kymograph", &flags.kymograph, &["png", "csv"][..]),
            ("--trajectories", &flags.trajectories, &["png", "csv"]),
        ] {
            ends(flag, path.as_deref(), endings)?;
        }
        if !(flags.rate.is_finite() && (0.01..=100.0).contains(&flags.rate)) {
            return Err(key(
                "--rate",
                format!("must be from 0.01 to 100, got {}", flags.rate),
            ));
        }
        let plan = Self {
            out,
            format,
            film: film.transpose()?,
        };
        if words.json
            && let Some((flag, _)) = plan.files(flags).find(|(_, path)| is_standard(path))
        {
            let message =
                format!("writes to standard output, and so does {flag}; give {flag} a file");
            return Err(key("--json", message));
        }
        Ok(plan)
    }

    pub(super) fn out(&self) -> &Path {
        &self.out
    }

    /// What is written, by the flags that ask for it.
    fn files<'a>(&'a self, flags: &'a Flags) -> impl Iterator<Item = (&'static str, &'a Path)> {
        let more = [
            ("--overlay", &flags.overlay),
            ("--measure", &flags.measure),
            ("--events", &flags.events),
            ("--kymograph", &flags.kymograph),
            ("--trajectories", &flags.trajectories),
        ];
        let more = more
            .into_iter()
            .filter_map(|(flag, path)| Some((flag, path.as_deref()?)));
        std::iter::once(("--out", self.out.as_path())).chain(more)
    }

    /// Make sure before the work that everything can be written after it, and takes the place of nothing that is read.
    pub(super) fn check(
        &self,
        flags: &Flags,
        frames: &Frames,
        at: usize,
    ) -> Result<(), SceneError> {
        let mut claims = Claims::default();
        let first = stem(&super::start::file(frames, at));
        for file in frames.files() {
            claims.reads(file);
        }
        let seeds = flags.seeds.as_ref().and_then(|seeds| seeds.file(&first));
        let starts = flags.from.iter().map(|start| start.file(&first));
        let beside: Vec<_> = starts.chain([seeds, flags.mend.clone()]).collect();
        beside.iter().flatten().for_each(|file| claims.reads(file));
        for (flag, path) in self.files(flags) {
            let again = flags.resume && matches!(flag, "--out" | "--measure" | "--events");
            if flags.no_clobber && !again && !is_standard(path) && path.exists() {
                let message = format!("{} is there already; needed: another name", path.display());
                return Err(key(flag, message));
            }
            if flag == "--out" && self.format == TrackFormat::Ctc {
                self.apart(frames)?;
                continue;
            }
            claims.writes(flag, path)?;
        }
        Ok(())
    }

    /// Refuse to write labels where frames are: they would be looked for there.
    fn apart(&self, frames: &Frames) -> Result<(), SceneError> {
        if is_standard(&self.out) {
            return Err(key("--out", "ctc writes a folder; needed: the name of one"));
        }
        let real = std::fs::canonicalize(&self.out).ok();
        let folder = |file: &PathBuf| {
            let parent = file
                .parent()
                .filter(|parent| !parent.as_os_str().is_empty());
            std::fs::canonicalize(parent.unwrap_or_else(|| Path::new("."))).ok()
        };
        if real.is_some() && frames.files().iter().any(|file| folder(file) == real) {
            let message = format!(
                "{} is the folder of the frames; needed: another",
                self.out.display()
            );
            return Err(key("--out", message));
        }
        Ok(())
    }
}

/// Refuse the name of a file that does not end as what is written there.
fn ends(flag: &str, path: Option<&Path>, endings: &[&str]) -> Result<(), SceneError> {
    let Some(path) = path else { return Ok(()) };
    let own = path.extension().unwrap_or_default();
    if endings
        .iter()
        .any(|ending| own.eq_ignore_ascii_case(ending))
    {
        return Ok(());
    }
    let message = format!(
        "the name must end in .{}, got {}",
        endings.join(" or ."),
        path.display()
    );
    Err(key(flag, message))
}
