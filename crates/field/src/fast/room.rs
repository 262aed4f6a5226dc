//! The memory of one worker: numbers that begin at a line of the cache.

/// Numbers in a line of the cache.
pub(super) const CACHE_LINE: usize = 16;

/// Room before and after a row, so that its neighbours one to either side can be read as rows too.
pub(super) const PAD: usize = CACHE_LINE;

/// Numbers from a multiple of 64 bytes on, used again for every tile.
#[derive(Debug, Default)]
pub(super) struct Room(Vec<f32>);

impl Room {
    /// Room for `n` numbers, which hold anything.
    pub(super) fn fit(&mut self, n: usize) -> &mut [f32] {
        let all = n + CACHE_LINE;
        self.0.truncate(all);
        self.0.reserve_exact(all - self.0.len());
        self.0.resize(all, 0.0);
        let begin = self.0.as_ptr().align_offset(4 * CACHE_LINE);
        // an allocation that cannot be aligned is used as it is
        let begin = if begin <= CACHE_LINE { begin } else { 0 };
        &mut self.0[begin..begin + n]
    }
}

/// Rows of `n` numbers each, with [`PAD`] more on either side.
#[derive(Debug)]
pub(super) struct Rows<'a> {
    numbers: &'a mut [f32],
    n: usize,
}

impl<'a> Rows<'a> {
    /// Numbers that `rows` rows of `n` take.
    pub(super) const fn size(rows: usize, n: usize) -> usize {
        rows * (n + 2 * PAD)
    }

    pub(super) const fn new(numbers: &'a mut [f32], n: usize) -> Self {
        Self { numbers, n }
    }

    /// A row as seen from `by` places to the right, at most [`PAD`].
    #[inline(always)]
    pub(super) fn shifted(&self, row: usize, by: isize) -> &[f32] {
        let begin = Self::size(row, self.n) + PAD.saturating_add_signed(by);
        &self.numbers[begin..][..self.n]
    }

    #[inline(always)]
    pub(super) fn get(&self, row: usize) -> &[f32] {
        self.shifted(row, 0)
    }

    #[inline(always)]
    pub(super) fn get_mut(&mut self, row: usize) -> &mut [f32] {
        let begin = Self::size(row, self.n) + PAD;
        &mut self.numbers[begin..][..self.n]
    }

    #[inline(always)]
    pub(super) fn copy(&mut self, from: usize, to: usize) {
        let (begin, size) = (Self::size(from, self.n), Self::size(1, self.n));
        self.numbers
            .copy_within(begin..begin + size, Self::size(to, self.n));
    }

    /// Where row 0 begins, and how far the next one is: for those who write in columns.
    #[inline(always)]
    pub(super) const fn columns(&mut self) -> (&mut [f32], usize, usize) {
        (self.numbers, PAD, self.n + 2 * PAD)
    }
}
