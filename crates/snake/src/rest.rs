//! Whether a snake is at rest, and if it never will be, why.
//! Long because the three tests below share what they have seen of a run.
//!
//! A test on pixels per step calls anything at rest that moves slowly enough or whose step is small
//! enough. Here three things must hold together, and each is a ratio, so that neither the number of
//! nodes nor the step, the size of a pixel or the scale of the grey levels enters:
//!
//! - *balance*: the net force on every node is a small share of the forces that cancel there;
//! - *travel*: since the run was five sixths as old as it is now, no node has gone farther than a small
//!   share of the curve's size, and at its speed of late none would in as long again. The speed is that over the
//!   last eighth of that time, since a node on a wall trembles by gravity times the step;
//! - *energy*: what is left of the motion is a small share of the most there was.

use glam::DVec2;
use integrator::{State, System};
use lanes::{flat, flat_mut, wide};

use crate::force::Acting;
use crate::{ImageForce, Outcome, Snake};

/// What counts as rest. All three are ratios.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rest {
    /// Net force on a node against the largest forces that any node of the run has felt.
    pub balance: f64,
    /// Way of a node in the last sixth of the run against the size of the curve (half the diagonal of
    /// its box at the start).
    pub travel: f64,
    /// Whether only the shape counts: the way of a node across the curve, and not along it.
    pub shape: bool,
}

impl Default for Rest {
    /// A thousandth of the forces, and a ten-thousandth of the size: 0.006 pixels for a circle of
    /// radius 42.
    fn default() -> Self {
        Self {
            balance: 1e-3,
            travel: 1e-4,
            shape: false,
        }
    }
}

/// What is left of the kinetic energy at rest, against the most there was.
const CALM: f64 = 1e-6;

/// The last share of the run in which travel is measured.
const LAST: f64 = 1.0 / 6.0;

/// The last share of a window, in which speed is measured.
const LATE: f64 = 0.125;

/// Windows in which it must have been as far and come back to be called a cycle. The run grows by a
/// fifth from window to window, so the last is nine times as long as the first: what fades by less
/// than a hundredth meanwhile will not fade in any time one would wait.
const SWINGS: usize = 12;

/// What a look found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Verdict {
    Moving,
    Rest,
    Cycle { reach: f64 },
    Lost,
    Collapsed,
    TurnedOver,
}

impl Verdict {
    /// The end of a run by it; None while something moves.
    pub(crate) const fn outcome(self, step: u64) -> Option<Outcome> {
        Some(match self {
            Self::Moving => return None,
            Self::Rest => Outcome::Settled { step },
            Self::Cycle { reach } => Outcome::Cycles { step, reach },
            Self::Lost => Outcome::Lost { step },
            Self::Collapsed => Outcome::Collapsed { step },
            Self::TurnedOver => Outcome::TurnedOver { step },
        })
    }
}

/// Follows a run and judges it.
#[derive(Debug, Clone)]
pub(crate) struct Watch {
    rest: Rest,
    closed: bool,
    size: f64,
    /// Signed area at the start of a closed curve that enclosed something.
    area: Option<f64>,
    begin: f64,
    /// Where the nodes were at the beginning of the present window, and when.
    mark: Vec<DVec2>,
    since: f64,
    /// The same for the last eighth of the window; None before.
    late: Option<(Vec<DVec2>, f64)>,
    /// Steps taken before the first window begins to count.
    looks: u64,
    /// How long the window was that has just ended.
    ended: Option<f64>,
    /// Most kinetic energy and largest force so far.
    liveliest: f64,
    strongest: f64,
    /// Farthest from the mark in this window, and how near it came again afterwards.
    far: f64,
    near: f64,
    /// The box each node has been in during this window.
    low: Vec<DVec2>,
    high: Vec<DVec2>,
    /// The longest diagonal of such a box, window by window, while the curve goes to and fro.
    swings: Vec<f64>,
    net: Vec<DVec2>,
    one: Vec<DVec2>,
}

impl Watch {
    pub(crate) fn new(rest: Rest, snake: &mut Snake, state: &State) -> Self {
        let n = state.len();
        let mut watch = Self {
            rest,
            closed: snake.body().topology.is_closed(),
            size: size(&state.x),
            area: enclosed(snake, &state.x),
            begin: state.t,
            mark: state.x.clone(),
            since: state.t,
            late: None,
            looks: 0,
            ended: None,
            liveliest: 0.0,
            strongest: 0.0,
            far: 0.0,
            near: f64::INFINITY,
            low: state.x.clone(),
            high: state.x.clone(),
            swings: Vec::new(),
            net: vec![DVec2::ZERO; n],
            one: vec![DVec2::ZERO; n],
        };
        watch.liveliest = kinetic(snake, state);
        watch.forces(snake, state, &[]);
        watch
    }

    /// Look at the state after a step; true where a window ends, which [`Watch::judge`] then judges. O(n).
    pub(crate) fn look(&mut self, snake: &Snake, state: &State) -> bool {
        self.looks += 1;
        widen(
            flat(&state.x),
            flat_mut(&mut self.low),
            flat_mut(&mut self.high),
        );
        self.liveliest = self.liveliest.max(kinetic(snake, state));
        let away = farthest_squared(flat(&state.x), flat(&self.mark)).sqrt();
        if away > self.far {
            (self.far, self.near) = (away, away);
        } else {
            self.near = self.near.min(away);
        }
        // a window is the last sixth of the run; a few steps at the least, or rounding decides
        let window = state.t - self.since;
        if self.late.is_none() && window >= (1.0 - LATE) * LAST * (state.t - self.begin) {
            self.late = Some((state.x.clone(), state.t));
        }
        if self.looks < 8 || window < LAST * (state.t - self.begin) {
            return false;
        }
        self.ended = Some(window);
        true
    }

    /// What is found at the end of a window; None within one. `push` is what other snakes push with, if there are
    /// any. Asks for all forces.
    pub(crate) fn judge(
        &mut self,
        snake: &mut Snake,
        state: &State,
        push: &[DVec2],
    ) -> Option<Verdict> {
        let window = self.ended.take()?;
        let verdict = self.verdict(snake, state, push, window);
        self.looks = 0;
        self.mark.copy_from_slice(&state.x);
        self.since = state.t;
        self.late = None;
        (self.far, self.near) = (0.0, f64::INFINITY);
        self.low.copy_from_slice(&state.x);
        self.high.copy_from_slice(&state.x);
        Some(verdict)
    }

    fn verdict(
        &mut self,
        snake: &mut Snake,
        state: &State,
        push: &[DVec2],
        window: f64,
    ) -> Verdict {
        if size(&state.x) < 0.01 * self.size {
            return Verdict::Collapsed;
        }
        if lost(snake, state) {
            return Verdict::Lost;
        }
        let net = self.forces(snake, state, push);
        let speed = self.speed(state);
        let most = self.rest.travel * self.size;
        let far = if self.rest.shape {
            self.way(state, &self.mark)
        } else {
            self.far
        };
        let slow = far <= most && speed * window <= most;
        let calm = self.left(snake, state, most) <= CALM * self.liveliest;
        if slow
            && calm
            && net <= self.rest.balance * self.strongest
            && !is_scheduled(snake, state.t)
        {
            return self.turned(snake, state).unwrap_or(Verdict::Rest);
        }
        // to and fro: it was far and came back, window after window, and always as far
        if self.near < 0.25 * self.far && self.far > most {
            let boxes = self.low.iter().zip(&self.high);
            let longest = boxes.map(|(low, high)| low.distance_squared(*high));
            self.swings.push(longest.fold(0.0, f64::max).sqrt());
        } else {
            self.swings.clear();
        }
        let last = &self.swings[self.swings.len().saturating_sub(SWINGS)..];
        let (least, reach) = last
            .iter()
            .fold((f64::INFINITY, 0.0_f64), |(low, high), &far| {
                (low.min(far), high.max(far))
            });
        if last.len() == SWINGS && least > 0.99 * reach {
            Verdict::Cycle { reach }
        } else {
            Verdict::Moving
        }
    }

    /// What a closed curve has become that no longer encloses what it did: on the way there it may
    /// come back, at rest it
    /// has not.
    pub(crate) fn turned(&self, snake: &Snake, state: &State) -> Option<Verdict> {
        let area = self.area?;
        match enclosed(snake, &state.x) {
            None => Some(Verdict::Collapsed),
            Some(now) if (now < 0.0) != (area < 0.0) => Some(Verdict::TurnedOver),
            Some(_) => None,
        }
    }

    /// The longest way of a node from where it was; across the curve, if only the shape counts.
    fn way(&self, state: &State, from: &[DVec2]) -> f64 {
        let n = state.len();
        let ways = state.x.iter().zip(from).enumerate().map(|(i, (x, from))| {
            let way = *x - *from;
            if !self.rest.shape {
                return way.length();
            }
            let (before, after) = if self.closed {
                ((i + n - 1) % n, (i + 1) % n)
            } else {
                (i.saturating_sub(1), (i + 1).min(n - 1))
            };
            let along = (state.x[after] - state.x[before]).normalize_or_zero();
            (way - along * way.dot(along)).length()
        });
        ways.fold(0.0, f64::max)
    }

    /// The largest speed of a node over the last stretch of the window.
    fn speed(&self, state: &State) -> f64 {
        match &self.late {
            Some((from, t)) if state.t > *t => self.way(state, from) / (state.t - t),
            _ => state.v.iter().map(|v| v.length()).fold(0.0, f64::max),
        }
    }

    /// Kinetic energy that is left, twice. A node as near to a wall as that, which bounces at every
    /// step or two by what gravity
    /// gives it in one, counts with its mean velocity.
    fn left(&self, snake: &Snake, state: &State, near: f64) -> f64 {
        let Some((from, t)) = self.late.as_ref().filter(|(_, t)| state.t > *t) else {
            return kinetic(snake, state);
        };
        let walls = &snake.world().walls;
        let each = state.v.iter().zip(snake.mass()).enumerate();
        each.map(|(i, (v, m))| {
            let x = state.x[i];
            let bounces = walls.iter().any(|wall| wall.distance(x) <= near);
            let v = if bounces {
                (x - from[i]) / (state.t - t)
            } else {
                *v
            };
            m * v.length_squared()
        })
        .sum()
    }

    /// The largest net force on a node; the strongest single forces are remembered.
    fn forces(&mut self, snake: &mut Snake, state: &State, push: &[DVec2]) -> f64 {
        let still = State {
            v: vec![DVec2::ZERO; state.len()],
            ..state.clone()
        };
        snake.strain_force(&still.x, &mut self.net);
        let mut felt: Vec<f64> = self.net.iter().map(|f| f.length()).collect();
        for index in 0..snake.world().forces.len() {
            self.one.fill(DVec2::ZERO);
            if snake.force_of(index, &still, &mut self.one).is_err() {
                return f64::INFINITY; // the next step ends the run with its own outcome
            }
            for i in 0..state.len() {
                self.net[i] += self.one[i];
                felt[i] += self.one[i].length();
            }
        }
        for (i, &push) in push.iter().enumerate() {
            self.net[i] += push;
            felt[i] += push.length();
        }
        self.strongest = felt.iter().copied().fold(self.strongest, f64::max);
        // a way that counts as none
        let near = self.rest.travel * self.size;
        let dt = (state.t - self.since) / self.looks.max(1) as f64;
        snake.largest_push(&still, &self.net, (near, dt))
    }
}

fn kinetic(snake: &Snake, state: &State) -> f64 {
    twice_kinetic(flat(&state.v), snake.mass())
}

wide! {
    /// Boxes grow to hold what is in `x`.
    fn widen(x: &[f64], low: &mut [f64], high: &mut [f64]) {
        let (low, high) = (&mut low[..x.len()], &mut high[..x.len()]);
        for k in 0..x.len() {
            low[k] = if x[k] < low[k] { x[k] } else { low[k] };
            high[k] = if x[k] > high[k] { x[k] } else { high[k] };
        }
    }
}

/// Points looked at together: their sums do not wait for each other.
const TOGETHER: usize = 8;

wide! {
    /// Σ m v², in eight parts.
    fn twice_kinetic(v: &[f64], mass: &[f64]) -> f64 {
        let (many, few) = v.as_chunks::<{ 2 * TOGETHER }>();
        let (masses, few_masses) = mass.as_chunks::<TOGETHER>();
        let mut sums = [0.0; TOGETHER];
        for (v, m) in many.iter().zip(masses) {
            for j in 0..TOGETHER {
                sums[j] += m[j] * (v[2 * j] * v[2 * j] + v[2 * j + 1] * v[2 * j + 1]);
            }
        }
        let rest = few.as_chunks::<2>().0.iter().zip(few_masses);
        let rest: f64 = rest.map(|([x, y], m)| m * (x * x + y * y)).sum();
        let [a, b, c, d, e, f, g, h] = sums;
        (((a + b) + (c + d)) + ((e + f) + (g + h))) + rest
    }
}

wide! {
    /// The largest squared distance of a point from its mark.
    fn farthest_squared(x: &[f64], mark: &[f64]) -> f64 {
        let (many, few) = x.as_chunks::<{ 2 * TOGETHER }>();
        let (marks, few_marks) = mark.as_chunks::<{ 2 * TOGETHER }>();
        let mut most = [0.0_f64; TOGETHER];
        for (x, mark) in many.iter().zip(marks) {
            for j in 0..TOGETHER {
                let (dx, dy) = (x[2 * j] - mark[2 * j], x[2 * j + 1] - mark[2 * j + 1]);
                let far = dx * dx + dy * dy;
                most[j] = if far > most[j] { far } else { most[j] };
            }
        }
        let rest = few.as_chunks::<2>().0.iter().zip(few_marks.as_chunks::<2>().0);
        let rest = rest.map(|([x, y], [a, b])| (x - a) * (x - a) + (y - b) * (y - b));
        rest.chain(most).fold(0.0, f64::max)
    }
}

/// Half the diagonal of the box around the nodes.
fn size(x: &[DVec2]) -> f64 {
    let first = x.first().copied().unwrap_or(DVec2::ZERO);
    let (low, high) = x
        .iter()
        .fold((first, first), |(low, high), p| (low.min(*p), high.max(*p)));
    0.5 * (high - low).length()
}

/// A closed curve of less area than this share of its size squared lies flat.
const FLAT: f64 = 1e-3;

/// The signed area of a closed curve, where it encloses something.
fn enclosed(snake: &Snake, x: &[DVec2]) -> Option<f64> {
    let area = elastic::signed_area(x);
    let size = size(x);
    let counts = snake.body().topology.is_closed() && area.abs() > FLAT * size * size;
    counts.then_some(area)
}

/// Whether a schedule or a hand has yet to change something: a snake at rest before that waits.
fn is_scheduled(snake: &Snake, t: f64) -> bool {
    let forces = snake.world().forces.iter().map(Acting::end);
    let end = snake.body().schedules.end().max(snake.expected);
    forces.fold(end, f64::max) > t
}

/// Whether most nodes are at the border of every picture the snake feels, or beyond.
fn lost(snake: &Snake, state: &State) -> bool {
    let pictures = snake.world().forces.iter();
    let mut fields = pictures.filter_map(|acting| acting.downcast::<ImageForce>());
    fields.any(|image| {
        let field = image.field();
        let far = DVec2::new(field.width() as f64, field.height() as f64) - 1.0;
        let inside = |p: &&DVec2| p.cmpgt(DVec2::ZERO).all() && p.cmplt(far).all();
        2 * state.x.iter().filter(inside).count() < state.len()
    })
}
