//! A picture, or a sequence of them, with the outlines in it.

mod arrive;
mod draw;
mod edge;
mod export;
mod field;
mod follow;
mod mend;
mod names;
mod one;
mod refit;
mod start;
mod tile;
mod view;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

use glam::DVec2;
use io::{Picture, PictureReading};
use ndarray::Array2;
use scene::fit::{Image, Options, Prepared};

use crate::LiveError;
use crate::request::{Frames, Outline};
use arrive::Arrival;
pub(crate) use edge::level;
pub(crate) use export::FORMATS;
use follow::Following;
use mend::Mend;
pub(crate) use one::One;
pub(crate) use tile::{Tones, tile};

/// Frames that a sequence may have.
const MOST_FRAMES: usize = 20_000;

/// A frame as it was given: its name, the bytes of its file, and its page of a file of several, from 1.
#[derive(Debug, Clone)]
struct Kept {
    name: Arc<str>,
    bytes: Arc<[u8]>,
    page: Option<usize>,
}

impl Kept {
    /// The frames of a file: its pages, or itself.
    fn all(name: &str, bytes: &Arc<[u8]>) -> Result<Vec<Self>, LiveError> {
        let refused = |error: io::IoError| LiveError::of(error);
        let pages = Picture::pages_named(bytes, Path::new(name), None).map_err(refused)?;
        let one = |page: Option<usize>| Self {
            name: page.map_or_else(|| name.into(), |page| format!("{name}, page {page}").into()),
            bytes: Arc::clone(bytes),
            page,
        };
        Ok(if pages > 1 {
            (1..=pages).map(|page| one(Some(page))).collect()
        } else {
            vec![one(None)]
        })
    }

    /// Its picture.
    fn picture(&self) -> Result<Arc<Picture>, LiveError> {
        let reading = PictureReading {
            page: self.page,
            ..PictureReading::default()
        };
        let picture = Picture::decode_as(&self.bytes, &reading);
        let picture = picture.map_err(|error| LiveError::new(format!("{}: {error}", self.name)))?;
        Ok(Arc::new(picture))
    }
}

/// A picture with outlines; of a sequence, that of the frame which is shown.
#[derive(Debug, Clone)]
pub(crate) struct Pictures {
    frames: Arc<Vec<Kept>>,
    now: usize,
    picture: Arc<Picture>,
    prepared: Prepared,
    /// The outlines of this frame.
    outlines: BTreeMap<u32, Arc<One>>,
    /// Those of the other frames.
    others: BTreeMap<usize, Arc<BTreeMap<u32, Arc<One>>>>,
    /// Frames whose outlines were drawn or mended by hand: they are facts.
    facts: BTreeSet<usize>,
    /// What happened in frames, in words.
    events: BTreeMap<usize, Vec<String>>,
    next_id: u32,
    /// Outlines on their way from their starts.
    arriving: BTreeMap<u32, Arrival>,
    /// The outline that the hand holds, or that settles after it was let go.
    mend: Option<Mend>,
    /// Discs that outlines stay out of.
    forbidden: Vec<(DVec2, f64)>,
    /// Pixels that count; None where all do.
    valid: Option<Arc<Array2<bool>>>,
    following: Option<Following>,
    /// How the picture changed: tiles of another number are out of date.
    version: u64,
}

impl Pictures {
    /// A picture from the bytes of its file.
    pub(crate) fn open(name: &str, bytes: &Arc<[u8]>) -> Result<Self, LiveError> {
        Self::begin(Arc::new(Kept::all(name, bytes)?))
    }

    /// The first of some frames, without any outline.
    fn begin(frames: Arc<Vec<Kept>>) -> Result<Self, LiveError> {
        let picture = frames[0].picture()?;
        let prepared = prepared(&picture, None)?;
        Ok(Self {
            frames,
            now: 0,
            picture,
            prepared,
            outlines: BTreeMap::new(),
            others: BTreeMap::new(),
            facts: BTreeSet::new(),
            events: BTreeMap::new(),
            next_id: 1,
            arriving: BTreeMap::new(),
            mend: None,
            forbidden: Vec::new(),
            valid: None,
            following: None,
            version: 0,
        })
    }

    /// One more frame behind the others, or all pages of one more file.
    pub(crate) fn add_frame(&mut self, name: &str, bytes: &Arc<[u8]>) -> Result<(), LiveError> {
        let more = Kept::all(name, bytes)?;
        if self.frames.len() + more.len() > MOST_FRAMES {
            return Err(LiveError::new(format!(
                "a sequence may have {MOST_FRAMES} frames at most"
            )));
        }
        // further pages when they are looked at
        self.fitting(&more[0])?;
        Arc::make_mut(&mut self.frames).extend(more);
        Ok(())
    }

    /// The picture of a frame, which must be as large as the others.
    fn fitting(&self, kept: &Kept) -> Result<Arc<Picture>, LiveError> {
        let picture = kept.picture()?;
        let (size, got) = (self.picture.size(), picture.size());
        if got == size {
            return Ok(picture);
        }
        Err(LiveError::new(format!(
            "{} has {}×{} pixels; a frame of this sequence must have {}×{}",
            kept.name, got.0, got.1, size.0, size.1
        )))
    }

    /// The same pictures without any outline.
    pub(crate) fn again(&self) -> Result<Self, LiveError> {
        let mut again = Self::begin(Arc::clone(&self.frames))?;
        again.version = self.version + 1;
        Ok(again)
    }

    /// Whether anything moves by itself.
    pub(crate) fn moves(&self) -> bool {
        !self.arriving.is_empty()
            || self.following.is_some()
            || self.mend.as_ref().is_some_and(Mend::moves)
    }

    /// One step of all that moves; false where nothing does.
    pub(crate) fn step(&mut self) -> bool {
        if !self.moves() {
            return false;
        }
        self.arrive();
        self.settle();
        self.follow();
        true
    }

    /// Steps in a second of looking.
    pub(crate) const fn pace(&self) -> f64 {
        if self.following.is_some() { 15.0 } else { 60.0 }
    }

    /// Make a change of outlines.
    pub(crate) fn act(&mut self, change: &Outline, rest: &[u8]) -> Result<(), LiveError> {
        match change {
            Outline::Drag { .. } => {}
            // what is under way comes to its end before anything else is done
            _ => self.finish(),
        }
        match change {
            Outline::Start {
                drawn,
                points,
                closed,
            } => self.start(*drawn, points, *closed)?,
            Outline::All => self.find_all()?,
            Outline::File { name, search } => self.start_of_file(name, rest, *search)?,
            Outline::Again { id } => self.search_again(*id)?,
            Outline::Delete { id } => {
                self.one(*id)?;
                self.outlines.remove(id);
            }
            Outline::Name { id, label, class } => self.name(*id, label, class)?,
            Outline::Drag {
                id,
                node,
                to,
                reach,
            } => return self.drag(*id, *node, crate::sandbox::place(*to)?, *reach),
            Outline::Drop => return self.drop(),
            Outline::Pin { id, node } => self.hold(*id, *node, *node, true)?,
            Outline::Unpin { id, node } => self.hold(*id, *node, *node, false)?,
            Outline::Freeze { id, from, to } => self.hold(*id, *from, *to, true)?,
            Outline::Thaw { id } => self.one_mut(*id)?.pins.clear(),
            Outline::Forbid { at, radius } => self.forbid(crate::sandbox::place(*at)?, *radius)?,
            Outline::NotThisEdge { at, reach } => {
                self.not_this_edge(crate::sandbox::place(*at)?, *reach)?;
            }
            Outline::Redraw {
                id,
                from,
                to,
                points,
            } => self.redraw(*id, *from, *to, points)?,
            Outline::AddNode { id, node } => self.add_node(*id, *node)?,
            Outline::DeleteNode { id, node } => self.delete_node(*id, *node)?,
            Outline::Cut { id, from, to } => self.cut(*id, *from, *to)?,
            Outline::Join { id, other } => self.join(*id, *other)?,
            Outline::Part => self.part(),
        }
        self.mended();
        Ok(())
    }

    /// Make a change of the sequence.
    pub(crate) fn frames(&mut self, change: &Frames) -> Result<(), LiveError> {
        self.finish();
        match change {
            Frames::Go { frame } => {
                self.following = None;
                self.go(*frame)
            }
            Frames::Track { births } => self.track(*births),
            Frames::Stop => {
                self.following = None;
                Ok(())
            }
        }
    }

    /// The frame that is shown was drawn or mended by hand.
    fn mended(&mut self) {
        if self.outlines.is_empty() {
            self.facts.remove(&self.now);
        } else {
            self.facts.insert(self.now);
        }
    }

    fn one(&self, id: u32) -> Result<&One, LiveError> {
        let one = self.outlines.get(&id).map(|one| &**one);
        one.ok_or_else(|| LiveError::new(format!("there is no outline {id}")))
    }

    fn one_mut(&mut self, id: u32) -> Result<&mut One, LiveError> {
        let one = self.outlines.get_mut(&id).map(Arc::make_mut);
        one.ok_or_else(|| LiveError::new(format!("there is no outline {id}")))
    }

    /// The first corner of the picture and the last.
    fn corners(&self) -> (DVec2, DVec2) {
        let (width, height) = self.picture.size();
        let far = DVec2::new(width as f64, height as f64) - 0.5;
        (DVec2::splat(-0.5), far)
    }

    /// Everything that tells two states apart, as bytes.
    pub(crate) fn bytes(&self, out: &mut Vec<u8>) {
        for frame in self.frames.iter() {
            out.extend(frame.name.as_bytes());
            out.extend(frame.bytes.len().to_le_bytes());
        }
        out.extend(self.now.to_le_bytes());
        let all = self
            .others
            .iter()
            .map(|(frame, outlines)| (*frame, &**outlines));
        for (frame, outlines) in all.chain([(self.now, &self.outlines)]) {
            out.extend(frame.to_le_bytes());
            for (id, one) in outlines {
                out.extend(id.to_le_bytes());
                for p in &one.points {
                    out.extend(p.x.to_le_bytes());
                    out.extend(p.y.to_le_bytes());
                }
                out.extend(
                    format!("{:?}{}{}{}", one.pins, one.label, one.class, one.closed).as_bytes(),
                );
            }
        }
        let moving = (self.arriving.keys(), self.mend.is_some());
        out.extend(
            format!(
                "{:?}{:?}{moving:?}{:?}",
                self.facts, self.forbidden, self.next_id
            )
            .as_bytes(),
        );
        if let Some(valid) = &self.valid {
            out.extend(valid.iter().filter(|ok| !**ok).count().to_le_bytes());
        }
    }
}

/// A picture ready for searches, of which only these pixels count.
fn prepared(picture: &Arc<Picture>, valid: Option<&Array2<bool>>) -> Result<Prepared, LiveError> {
    let mut image = Image::of(Arc::<Picture>::clone(picture));
    if let Some(valid) = valid {
        image = image.with_mask(valid.clone()).map_err(LiveError::of)?;
    }
    Prepared::of(&image, &Options::default()).map_err(LiveError::of)
}
