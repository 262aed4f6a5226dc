//! One snake of a simulation, with all that moves and watches it.

use elastic::Topology;
use glam::DVec2;
use integrator::{State, System};
use lanes::{flat, wide};

use crate::outcome::FAR;
use crate::rest::{Verdict, Watch};
use crate::{Ledger, Pace, Snake, Term, Tips};

/// One snake of a simulation.
#[derive(Debug, Clone)]
pub struct Member {
    pub(super) id: usize,
    pub(super) snake: Snake,
    pub(super) state: State,
    pub(super) pace: Pace,
    /// The inertial forces of a frame that turns by its own equation, where it does.
    pub(super) terms: Option<Vec<Term>>,
    /// Ends that grow, and after how many steps each time.
    pub(super) tips: Option<(Tips, u64)>,
    /// How often the snake had been changed when its scheme was told last.
    pub(super) told: u64,
    /// Sub-steps that each part of a step is made in, where its nodes have come too close for one.
    pub(super) cuts: u64,
    /// None where no account is kept.
    pub(super) ledger: Option<Ledger>,
    /// Mean distance of neighbors when it joined: what upkeep holds to.
    pub(super) spacing: f64,
    /// The least mass density of a node at any time. M.
    pub(super) lightest: f64,
    pub(super) watch: Option<Watch>,
    pub(super) verdict: Verdict,
}

impl Member {
    /// Its number: never given again when it is gone.
    #[must_use]
    pub const fn id(&self) -> usize {
        self.id
    }

    /// The snake.
    #[must_use]
    pub const fn snake(&self) -> &Snake {
        &self.snake
    }

    /// Where it is.
    #[must_use]
    pub const fn state(&self) -> &State {
        &self.state
    }

    /// Whether its curve is closed.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.snake.body().topology == Topology::Closed
    }

    /// Mass of the stretch of curve that node `i` stands for. M L.
    pub(super) fn mass(&self, i: usize) -> f64 {
        self.snake.mass()[i] * self.snake.body().spacing
    }

    /// Whether its ends still grow.
    pub(super) fn grows(&self) -> bool {
        self.tips
            .as_ref()
            .is_some_and(|(tips, _)| tips.growing().contains(&true))
    }
}

/// The least mass of a node that may move, whatever schedules and maps say.
pub(super) fn lightest(snake: &Snake) -> f64 {
    let hardest = snake.at_its_hardest();
    let all = hardest.iter().chain([snake]).flat_map(|snake| snake.mass());
    all.copied().fold(f64::INFINITY, f64::min)
}

/// The first node that is no longer anywhere.
pub(super) fn astray(x: &[DVec2]) -> Option<usize> {
    let here = |x: &DVec2| (x.x.abs() < FAR) & (x.y.abs() < FAR);
    if all_near(flat(x)) {
        None
    } else {
        x.iter().position(|x| !here(x))
    }
}

wide! {
    /// Whether all numbers are below [`FAR`] in size. No early way out: one comparison a number.
    fn all_near(numbers: &[f64]) -> bool {
        let mut near = 1_u64;
        for number in numbers {
            near &= u64::from(number.abs() < FAR);
        }
        near == 1
    }
}

/// The longest edge, the closing one counted.
pub(super) fn longest(x: &[DVec2], closed: bool) -> f64 {
    let n = x.len();
    let edges = if closed { n } else { n - 1 };
    let lengths = (0..edges).map(|i| x[i].distance(x[(i + 1) % n]));
    lengths.fold(0.0, f64::max)
}
