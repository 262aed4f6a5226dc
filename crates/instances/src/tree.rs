//! The component tree of a grid: how the pixels above a level grow together as the level falls.
//!
//! Components of pixels above a level are nested (a max-tree, \[salembier98\]). Those that are significant where they
//! meet become branches; each branch remembers at which of its levels its border is steepest. Pixels are sorted by
//! counting and joined by union and find, in time that grows with their number.

/// A grid of whole numbers; pixels below `floor` belong to nothing.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Terrain<'a> {
    pub values: &'a [u16],
    pub width: usize,
    pub floor: u16,
}

/// A level of a branch, and what its component is like there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stage {
    pub level: u16,
    pub area: usize,
    /// Sides of pixels along its border.
    pub sides: usize,
    /// Mean fall across them.
    pub fall: f64,
}

/// Components from where one begins, or others meet, to where it meets another.
#[derive(Debug, Clone)]
pub(crate) struct Branch {
    /// Its highest pixel.
    pub peak: usize,
    /// The branch that it becomes a part of.
    pub parent: Option<usize>,
    /// The levels at which its border is steepest, from high to low.
    pub stages: Vec<Stage>,
    /// Leaves of the tree below it: numbers from one to another, the last not included.
    pub leaves: (u32, u32),
}

/// The branches of a grid, parents behind their children, and the leaf that each pixel belongs to.
#[derive(Debug)]
pub(crate) struct Tree {
    pub branches: Vec<Branch>,
    leaf: Vec<u32>,
}

/// No pixel, or no leaf.
const NONE: u32 = u32::MAX;

/// Areas of a branch are looked at in steps of this factor.
const STEP: f64 = 1.25;

/// A component as it grows.
#[derive(Debug)]
struct Part {
    peak: usize,
    area: usize,
    sides: usize,
    fall: f64,
    leaf: u32,
    stages: Vec<Stage>,
    children: Vec<usize>,
}

impl Part {
    /// Remember the present stage, if it is the steepest of its size.
    fn note(&mut self, level: u16, least: usize) {
        if self.area < least || self.sides == 0 {
            return;
        }
        let fall = self.fall / self.sides as f64;
        let stage = Stage {
            level,
            area: self.area,
            sides: self.sides,
            fall,
        };
        match self.stages.last_mut() {
            Some(last) if size(last.area) == size(self.area) => {
                if fall > last.fall {
                    *last = stage;
                }
            }
            _ => self.stages.push(stage),
        }
    }

    /// The stages whose border is steeper than those of the sizes beside them.
    fn best(&self) -> Vec<Stage> {
        let fall = |at: Option<usize>| {
            at.and_then(|at| self.stages.get(at))
                .map_or(0.0, |one| one.fall)
        };
        let count = self.stages.len();
        let is_best = |at: &usize| {
            let own = self.stages[*at].fall;
            own > fall(at.checked_sub(1)) && own >= fall(Some(at + 1))
        };
        (0..count)
            .filter(is_best)
            .map(|at| self.stages[at])
            .collect()
    }
}

/// The number of a size of areas.
#[allow(clippy::cast_possible_truncation, reason = "a logarithm is small")]
fn size(area: usize) -> i32 {
    ((area as f64).ln() / STEP.ln()) as i32
}

/// The four neighbours of a pixel.
pub(crate) fn beside(at: usize, width: usize, count: usize) -> impl Iterator<Item = usize> {
    let x = at % width;
    let all = [
        (at >= width).then(|| at - width),
        (x > 0).then(|| at - 1),
        (x + 1 < width).then(|| at + 1),
        (at + width < count).then(|| at + width),
    ];
    all.into_iter().flatten()
}

impl Tree {
    /// The tree of a grid. `counts` says of a component's peak, the level where it meets another, and its area,
    /// whether it is significant there; stages of a smaller area than `least` are not kept.
    #[allow(
        clippy::cast_possible_truncation,
        reason = "a picture has fewer than 2³² pixels"
    )]
    pub(crate) fn of(
        terrain: Terrain<'_>,
        least: usize,
        counts: impl Fn(u16, u16, usize) -> bool,
    ) -> Self {
        let Terrain { values, width, .. } = terrain;
        let count = values.len();
        let mut up: Vec<u32> = vec![NONE; count]; // towards the root of the component
        let mut part_of: Vec<u32> = vec![NONE; count]; // at roots
        let mut leaf: Vec<u32> = vec![NONE; count];
        let mut same: Vec<u32> = Vec::new(); // leaves that are parts of others
        let mut parts: Vec<Option<Part>> = Vec::new();
        let mut free: Vec<u32> = Vec::new();
        let mut branches: Vec<(Branch, Vec<usize>, u32)> = Vec::new();
        // components beside a pixel: their roots, and their numbers
        let (mut roots, mut list): (Vec<u32>, Vec<u32>) = (Vec::new(), Vec::new());
        for at in sorted(terrain) {
            let level = values[at];
            let (mut sides, mut fall) = (0_usize, 0.0);
            let mut inner = 0;
            roots.clear();
            let mut highest: Option<usize> = None;
            for q in beside(at, width, count) {
                let apart = f64::from(values[q]) - f64::from(level);
                fall -= apart;
                if up[q] == NONE {
                    sides += 1;
                    continue;
                }
                inner += 1;
                if highest.is_none_or(|known| values[q] > values[known]) {
                    highest = Some(q);
                }
                let root = root(&mut up, q as u32);
                if !roots.contains(&root) {
                    roots.push(root);
                }
            }
            up[at] = at as u32;
            let own = if let Some(highest) = highest {
                leaf[at] = leaf[highest];
                list.clear();
                list.extend(roots.iter().map(|root| part_of[*root as usize]));
                list.sort_by_key(|one| {
                    let peak = parts[*one as usize].as_ref().map_or(0, |part| part.peak);
                    (std::cmp::Reverse(values[peak]), peak)
                });
                let own = list[0];
                let is_one =
                    |part: &Part| part.area >= least && counts(values[part.peak], level, part.area);
                for &other in &list[1..] {
                    let (Some(mut a), Some(b)) =
                        (parts[own as usize].take(), parts[other as usize].take())
                    else {
                        continue;
                    };
                    free.push(other);
                    let (first, second) = (is_one(&a), is_one(&b));
                    let (area, sides, fall) = (a.area + b.area, a.sides + b.sides, a.fall + b.fall);
                    if first && second {
                        let (peak, leaf) = (a.peak, a.leaf);
                        let children = [a, b].map(|one| close(one, &mut branches));
                        a = Part {
                            peak,
                            area: 0,
                            sides: 0,
                            fall: 0.0,
                            leaf,
                            stages: Vec::new(),
                            children: children.to_vec(),
                        };
                    } else {
                        let (kept, lost) = if second && !first { (b, a) } else { (a, b) };
                        same[lost.leaf as usize] = kept.leaf;
                        a = kept;
                    }
                    (a.area, a.sides, a.fall) = (area, sides, fall);
                    parts[own as usize] = Some(a);
                }
                for root in &roots {
                    up[*root as usize] = at as u32;
                }
                own
            } else {
                let number = same.len() as u32;
                same.push(number);
                leaf[at] = number;
                let new = Part {
                    peak: at,
                    area: 0,
                    sides: 0,
                    fall: 0.0,
                    leaf: number,
                    stages: Vec::new(),
                    children: Vec::new(),
                };
                if let Some(place) = free.pop() {
                    parts[place as usize] = Some(new);
                    place
                } else {
                    parts.push(Some(new));
                    parts.len() as u32 - 1
                }
            };
            part_of[at] = own;
            if let Some(part) = &mut parts[own as usize] {
                part.area += 1;
                // sides to pixels inside are no more sides of the border
                part.sides = (part.sides + sides).saturating_sub(inner);
                part.fall += fall;
                part.note(level, least);
            }
        }
        let mut roots: Vec<usize> = Vec::new();
        for part in parts.into_iter().flatten() {
            if part.area >= least {
                roots.push(close(part, &mut branches));
            }
        }
        numbered(branches, &roots, leaf, &same)
    }

    /// Whether a pixel belongs to a branch, where everything above the floor is divided among the branches.
    pub(crate) fn holds(&self, branch: usize, at: usize) -> bool {
        let (from, to) = self.branches[branch].leaves;
        (from..to).contains(&self.leaf[at])
    }
}

/// End a component: it becomes a branch.
fn close(part: Part, branches: &mut Vec<(Branch, Vec<usize>, u32)>) -> usize {
    let stages = part.best();
    let branch = Branch {
        peak: part.peak,
        parent: None,
        stages,
        leaves: (0, 0),
    };
    branches.push((branch, part.children, part.leaf));
    branches.len() - 1
}

/// Number the leaves so that those of a branch follow each other.
#[allow(
    clippy::cast_possible_truncation,
    reason = "a picture has fewer than 2³² pixels"
)]
fn numbered(
    branches: Vec<(Branch, Vec<usize>, u32)>,
    roots: &[usize],
    mut leaf: Vec<u32>,
    same: &[u32],
) -> Tree {
    let mut children: Vec<Vec<usize>> = Vec::with_capacity(branches.len());
    let mut own: Vec<u32> = Vec::with_capacity(branches.len());
    let mut out: Vec<Branch> = Vec::with_capacity(branches.len());
    for (branch, list, number) in branches {
        out.push(branch);
        children.push(list);
        own.push(number);
    }
    let mut number = vec![NONE; same.len()];
    let mut next = 0;
    let mut open: Vec<(usize, bool)> = roots.iter().rev().map(|&at| (at, false)).collect();
    while let Some((at, is_left)) = open.pop() {
        if is_left {
            out[at].leaves.1 = next;
            continue;
        }
        out[at].leaves.0 = next;
        open.push((at, true));
        if children[at].is_empty() {
            number[own[at] as usize] = next;
            next += 1;
        }
        for &child in children[at].iter().rev() {
            out[child].parent = Some(at);
            open.push((child, false));
        }
    }
    // a leaf that is a part of another takes its number; such chains lead to later decisions, so follow them
    let mut known = same.to_vec();
    for at in leaf.iter_mut().filter(|at| **at != NONE) {
        let root = root(&mut known, *at);
        *at = number[root as usize];
    }
    Tree {
        branches: out,
        leaf,
    }
}

/// The root of a component, with shorter ways to it for later.
fn root(up: &mut [u32], mut at: u32) -> u32 {
    while up[at as usize] != at {
        let next = up[up[at as usize] as usize];
        up[at as usize] = next;
        at = next;
    }
    at
}

/// Pixels from the highest to the floor, in rows where they are equal.
fn sorted(terrain: Terrain<'_>) -> Vec<usize> {
    let mut starts = vec![0_usize; usize::from(u16::MAX) + 2];
    let place = |value: u16| usize::from(u16::MAX - value);
    let all = terrain.values.iter().enumerate();
    let kept = all.filter(|(_, value)| **value >= terrain.floor);
    kept.clone()
        .for_each(|(_, value)| starts[place(*value) + 1] += 1);
    let mut sum = 0;
    for start in &mut starts {
        sum += *start;
        *start = sum;
    }
    let mut out = vec![0; sum];
    for (at, value) in kept {
        out[starts[place(*value)]] = at;
        starts[place(*value)] += 1;
    }
    out
}
