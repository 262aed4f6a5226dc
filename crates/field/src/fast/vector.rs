//! Vectors of `f32`, as wide as the processor has them, and their transposition.
//!
//! Every operation is one addition, subtraction, multiplication or root a lane, in a fixed order, so the result does
//! not depend on the width. All functions are inlined into the dispatched kernel: that is what gives them the wide
//! instructions.

use pulp::Simd;
use pulp::bytemuck::{cast_slice, cast_slice_mut};
use std::any::Any;

/// What the kernels of a tile need of a kind of registers.
pub(super) trait Lanes: Copy {
    /// A vector.
    type V: Copy + 'static;
    /// Whether there are registers for eight sums with what they are made of, or only for four.
    const EIGHT_SUMS: bool;

    fn view(numbers: &[f32]) -> &[Self::V];
    fn view_mut(numbers: &mut [f32]) -> &mut [Self::V];
    fn splat(self, x: f32) -> Self::V;
    fn add(self, a: Self::V, b: Self::V) -> Self::V;
    fn sub(self, a: Self::V, b: Self::V) -> Self::V;
    fn mul(self, a: Self::V, b: Self::V) -> Self::V;
    fn abs(self, a: Self::V) -> Self::V;
    fn sqrt(self, a: Self::V) -> Self::V;

    /// Rows become columns: lane c of vector r changes places with lane r of vector c, of as many vectors as each has
    /// numbers.
    fn turn<const B: usize>(self, vectors: &mut [Self::V; B]);

    /// The differences `d[0] − d[1]` and `d[2] − d[3]` as pairs past the cache, where there is a way to: 16 at a time,
    /// to a multiple of 64 bytes.
    ///
    /// Says whether it was done; then [`Lanes::wait`] before anybody reads them.
    #[inline(always)]
    fn stream(self, _d: [&[f32; 16]; 4], _out: &mut [[f32; 2]; 16]) -> bool {
        false
    }

    /// These numbers will be read soon.
    #[inline(always)]
    fn expect<P>(self, _numbers: &[P]) {}

    /// All that was written past the cache comes before what is written from now on.
    #[inline(always)]
    fn wait(self) {}
}

/// The registers of an instruction set.
#[derive(Clone, Copy)]
pub(super) struct Wide<S>(pub(super) S);

impl<S: Simd> Lanes for Wide<S> {
    type V = S::f32s;
    const EIGHT_SUMS: bool = S::REGISTER_COUNT >= 32;

    #[inline(always)]
    fn view(numbers: &[f32]) -> &[Self::V] {
        S::as_simd_f32s(numbers).0
    }
    #[inline(always)]
    fn view_mut(numbers: &mut [f32]) -> &mut [Self::V] {
        S::as_mut_simd_f32s(numbers).0
    }
    #[inline(always)]
    fn splat(self, x: f32) -> Self::V {
        self.0.splat_f32s(x)
    }
    #[inline(always)]
    fn add(self, a: Self::V, b: Self::V) -> Self::V {
        self.0.add_f32s(a, b)
    }
    #[inline(always)]
    fn sub(self, a: Self::V, b: Self::V) -> Self::V {
        self.0.sub_f32s(a, b)
    }
    #[inline(always)]
    fn mul(self, a: Self::V, b: Self::V) -> Self::V {
        self.0.mul_f32s(a, b)
    }
    #[inline(always)]
    fn abs(self, a: Self::V) -> Self::V {
        self.0.abs_f32s(a)
    }
    #[inline(always)]
    fn sqrt(self, a: Self::V) -> Self::V {
        self.0.sqrt_f32s(a)
    }

    #[inline(always)]
    fn turn<const B: usize>(self, vectors: &mut [Self::V; B]) {
        #[cfg(target_arch = "x86_64")]
        {
            use pulp::x86::{V3, V4};
            let (kind, any): (&dyn Any, &mut dyn Any) = (&self.0, vectors);
            if let (Some(&simd), Some(vectors)) = (kind.downcast_ref::<V3>(), any.downcast_mut()) {
                return turn_8(simd, vectors);
            }
            if let (Some(&simd), Some(vectors)) = (kind.downcast_ref::<V4>(), any.downcast_mut()) {
                return turn_16(simd, vectors);
            }
        }
        let before = *vectors;
        for (c, vector) in vectors.iter_mut().enumerate() {
            let lanes: &mut [f32] = cast_slice_mut(std::slice::from_mut(vector));
            for (lane, row) in lanes.iter_mut().zip(&before) {
                let row: &[f32] = cast_slice(std::slice::from_ref(row));
                *lane = row[c];
            }
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn stream(self, d: [&[f32; 16]; 4], out: &mut [[f32; 2]; 16]) -> bool {
        let kind: &dyn Any = &self.0;
        if let Some(&simd) = kind.downcast_ref::<pulp::x86::V3>() {
            return stream(simd, d, out);
        }
        if let Some(&simd) = kind.downcast_ref::<pulp::x86::V4>() {
            return stream(*simd, d, out);
        }
        false
    }

    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn expect<P>(self, numbers: &[P]) {
        const ALL_CACHES: i32 = 3;
        let kind: &dyn Any = &self.0;
        let sse = match (
            kind.downcast_ref::<pulp::x86::V3>(),
            kind.downcast_ref::<pulp::x86::V4>(),
        ) {
            (Some(simd), _) => simd.sse,
            (_, Some(simd)) => simd.sse,
            _ => return,
        };
        for numbers in numbers.chunks(64 / size_of::<P>()) {
            sse._mm_prefetch::<ALL_CACHES>(numbers.as_ptr().cast());
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn wait(self) {
        let kind: &dyn Any = &self.0;
        if let Some(simd) = kind.downcast_ref::<pulp::x86::V3>() {
            simd.sse._mm_sfence();
        }
        if let Some(simd) = kind.downcast_ref::<pulp::x86::V4>() {
            simd.sse._mm_sfence();
        }
    }
}

/// Writes 16 pairs to where they will not be read soon: a line of the cache that is written whole need not be read
/// first.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
#[expect(
    unsafe_code,
    reason = "half of what a large field costs; measured in docs/speed.md, and held against plain writing by a test"
)]
fn stream(simd: pulp::x86::V3, d: [&[f32; 16]; 4], out: &mut [[f32; 2]; 16]) -> bool {
    use pulp::{cast, x86::V3};
    use std::arch::x86_64::__m256;
    let avx = simd.avx;
    let (right, left) = (V3::as_simd_f32s(d[0]).0, V3::as_simd_f32s(d[1]).0);
    let (below, above) = (V3::as_simd_f32s(d[2]).0, V3::as_simd_f32s(d[3]).0);
    let out: &mut [f32] = out.as_flattened_mut();
    if !out.as_ptr().addr().is_multiple_of(32) {
        return false;
    }
    for (i, out) in out.chunks_exact_mut(16).enumerate() {
        let x: __m256 = cast(simd.sub_f32s(right[i], left[i]));
        let y: __m256 = cast(simd.sub_f32s(below[i], above[i]));
        let (low, high) = (avx._mm256_unpacklo_ps(x, y), avx._mm256_unpackhi_ps(x, y));
        let (a, b) = (
            avx._mm256_permute2f128_ps::<0x20>(low, high),
            avx._mm256_permute2f128_ps::<0x31>(low, high),
        );
        let to = out.as_mut_ptr();
        // SAFETY: `out` has 16 numbers, 8 for each, and begins at a multiple of 32 bytes
        unsafe {
            avx._mm256_stream_ps(to, a);
            avx._mm256_stream_ps(to.add(8), b);
        }
    }
    true
}

/// 24 shuffles of eight vectors: pairs, then fours within halves, then the halves.
///
/// Loops, not closures: those would be compiled without the instructions.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn turn_8(simd: pulp::x86::V3, vectors: &mut [pulp::f32x8; 8]) {
    use pulp::cast;
    use std::arch::x86_64::__m256;
    let avx = simd.avx;
    let mut r: [__m256; 8] = [cast(vectors[0]); 8];
    for i in 1..8 {
        r[i] = cast(vectors[i]);
    }
    let mut pairs = r;
    for i in 0..4 {
        pairs[2 * i] = avx._mm256_unpacklo_ps(r[2 * i], r[2 * i + 1]);
        pairs[2 * i + 1] = avx._mm256_unpackhi_ps(r[2 * i], r[2 * i + 1]);
    }
    for i in 0..4 {
        let from = 4 * (i / 2) + i % 2;
        let (a, b) = (cast(pairs[from]), cast(pairs[from + 2]));
        r[2 * i] = cast(avx._mm256_unpacklo_pd(a, b));
        r[2 * i + 1] = cast(avx._mm256_unpackhi_pd(a, b));
    }
    for i in 0..4 {
        let (a, b) = (r[i], r[i + 4]);
        vectors[i] = cast(avx._mm256_permute2f128_ps::<0x20>(a, b));
        vectors[i + 4] = cast(avx._mm256_permute2f128_ps::<0x31>(a, b));
    }
}

/// 64 shuffles of sixteen vectors: pairs, then fours within quarters, then the quarters in two rounds.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn turn_16(simd: pulp::x86::V4, vectors: &mut [pulp::f32x16; 16]) {
    use pulp::cast;
    use std::arch::x86_64::__m512;
    let avx = simd.avx512f;
    let mut r: [__m512; 16] = [cast(vectors[0]); 16];
    for i in 1..16 {
        r[i] = cast(vectors[i]);
    }
    let mut pairs = r;
    for i in 0..8 {
        pairs[2 * i] = avx._mm512_unpacklo_ps(r[2 * i], r[2 * i + 1]);
        pairs[2 * i + 1] = avx._mm512_unpackhi_ps(r[2 * i], r[2 * i + 1]);
    }
    for i in 0..8 {
        let from = 4 * (i / 2) + i % 2;
        let (a, b) = (cast(pairs[from]), cast(pairs[from + 2]));
        r[2 * i] = cast(avx._mm512_unpacklo_pd(a, b));
        r[2 * i + 1] = cast(avx._mm512_unpackhi_pd(a, b));
    }
    for j in 0..4 {
        let (a, b, c, d) = (r[j], r[j + 4], r[j + 8], r[j + 12]);
        let (even, odd) = (
            avx._mm512_shuffle_f32x4::<0x88>(a, b),
            avx._mm512_shuffle_f32x4::<0xdd>(a, b),
        );
        let (more_even, more_odd) = (
            avx._mm512_shuffle_f32x4::<0x88>(c, d),
            avx._mm512_shuffle_f32x4::<0xdd>(c, d),
        );
        vectors[j] = cast(avx._mm512_shuffle_f32x4::<0x88>(even, more_even));
        vectors[j + 4] = cast(avx._mm512_shuffle_f32x4::<0x88>(odd, more_odd));
        vectors[j + 8] = cast(avx._mm512_shuffle_f32x4::<0xdd>(even, more_even));
        vectors[j + 12] = cast(avx._mm512_shuffle_f32x4::<0xdd>(odd, more_odd));
    }
}

/// Four numbers at a time without any instruction set: the compiler makes of it what it has.
#[derive(Clone, Copy)]
pub(super) struct Four;

impl Lanes for Four {
    type V = [f32; 4];
    const EIGHT_SUMS: bool = false;

    #[inline(always)]
    fn view(numbers: &[f32]) -> &[[f32; 4]] {
        numbers.as_chunks().0
    }
    #[inline(always)]
    fn view_mut(numbers: &mut [f32]) -> &mut [[f32; 4]] {
        numbers.as_chunks_mut().0
    }
    #[inline(always)]
    fn splat(self, x: f32) -> [f32; 4] {
        [x; 4]
    }
    #[inline(always)]
    fn add(self, a: [f32; 4], b: [f32; 4]) -> [f32; 4] {
        std::array::from_fn(|i| a[i] + b[i])
    }
    #[inline(always)]
    fn sub(self, a: [f32; 4], b: [f32; 4]) -> [f32; 4] {
        std::array::from_fn(|i| a[i] - b[i])
    }
    #[inline(always)]
    fn mul(self, a: [f32; 4], b: [f32; 4]) -> [f32; 4] {
        std::array::from_fn(|i| a[i] * b[i])
    }
    #[inline(always)]
    fn abs(self, a: [f32; 4]) -> [f32; 4] {
        a.map(f32::abs)
    }
    #[inline(always)]
    fn sqrt(self, a: [f32; 4]) -> [f32; 4] {
        a.map(f32::sqrt)
    }
    #[inline(always)]
    fn turn<const B: usize>(self, vectors: &mut [[f32; 4]; B]) {
        let before = *vectors;
        for (c, vector) in vectors.iter_mut().enumerate() {
            for (lane, row) in vector.iter_mut().zip(&before) {
                *lane = row[c];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pulp::WithSimd;

    struct Turn;

    impl WithSimd for Turn {
        type Output = ();

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) {
            match S::F32_LANES {
                4 => check::<Wide<S>, 4>(Wide(simd)),
                8 => check::<Wide<S>, 8>(Wide(simd)),
                16 => check::<Wide<S>, 16>(Wide(simd)),
                _ => check::<Wide<S>, 1>(Wide(simd)),
            }
        }
    }

    #[inline(always)]
    fn check<L: Lanes, const B: usize>(lanes: L) {
        let mut numbers: Vec<f32> = (0..B * B).map(|i| i as f32).collect();
        let before = numbers.clone();
        let mut vectors = [lanes.splat(0.0); B];
        vectors.copy_from_slice(L::view(&numbers));
        lanes.turn(&mut vectors);
        L::view_mut(&mut numbers).copy_from_slice(&vectors);
        for (i, &x) in before.iter().enumerate() {
            assert!((numbers[i % B * B + i / B] - x).abs() <= 0.0, "{i} of {B}");
        }
    }

    #[test]
    fn rows_become_columns_in_registers_of_every_width() {
        check::<Four, 4>(Four);
        pulp::Arch::new().dispatch(Turn);
        pulp::Arch::Scalar.dispatch(Turn);
        #[cfg(target_arch = "x86_64")]
        if let Some(avx2) = pulp::x86::V3::try_new() {
            Simd::vectorize(avx2, Turn);
        }
    }
}
