//! Memory of the fast pipeline, counted by an allocator of this test's own; one test, so that nothing else counts.
#![expect(
    unsafe_code,
    reason = "an allocator is unsafe to write; this one passes everything on"
)]

use field::{EdgeForce, FastForce, Recipe, Smoothing, lazy_force};
use glam::DVec2;
use ndarray::Array2;
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

static NOW: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);

struct Counting;

// SAFETY: every request goes to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let now = NOW.fetch_add(layout.size(), Relaxed) + layout.size();
        MOST.fetch_max(now, Relaxed);
        // SAFETY: the caller keeps the promises of this function, which are those of that one.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        NOW.fetch_sub(layout.size(), Relaxed);
        // SAFETY: `at` came from `System.alloc` with this layout.
        unsafe { System.dealloc(at, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// The most bytes in use at once while `work` ran, beyond those before it.
fn most<T>(work: impl FnOnce() -> T) -> (usize, T) {
    let before = NOW.load(Relaxed);
    MOST.store(before, Relaxed);
    let result = work();
    (MOST.load(Relaxed) - before, result)
}

const MIB: usize = 1 << 20;

#[test]
fn a_field_takes_its_own_bytes_and_a_mebibyte_a_thread_and_a_lazy_one_its_tiles() {
    let (height, width) = (700, 1100);
    let image = Array2::from_shape_fn((height, width), |(y, x)| {
        u16::try_from((x * 7 + y * 13) % 251).unwrap()
    });
    let edge = |smoothing| {
        Recipe::Edge(EdgeForce {
            smoothing,
            gain: 1.0,
        })
    };
    let report = |passes| Recipe::Report {
        passes,
        scale: 0.15,
        gain: 10.0,
    };
    let output = height * width * size_of::<[f32; 2]>();
    for recipe in [
        report(20),
        // the widest filters of the tiles
        report(600),
        edge(Smoothing::Binomial(20)),
        edge(Smoothing::Gaussian(17.5)),
    ] {
        for threads in [1, 2, 3] {
            let (bytes, fast) = most(|| {
                let mut fast = FastForce::new(recipe, threads).unwrap();
                fast.field(image.view()).unwrap();
                fast
            });
            assert!(
                bytes <= output + threads * MIB,
                "{recipe:?}, {threads} threads: {bytes}"
            );
            assert!(bytes >= output, "the count sees the output");
            drop(fast);
        }
    }

    // a contour of 100 px across somewhere in a large picture: at most 4 tiles of 125 × 65 forces at a time, 8 bytes
    // each, and a flag a tile; not the 8 bytes a pixel of the whole
    let large = Array2::from_elem((4000, 5000), 7_u8);
    let (bytes, tiles) = most(|| {
        let field = lazy_force(large, &edge(Smoothing::Binomial(20))).unwrap();
        for i in 0..600 {
            let p = DVec2::new(2511.0, 1987.0) + 50.0 * DVec2::from_angle(f64::from(i) * 0.0105);
            assert!(field.at(p).is_finite());
        }
        field.tiles_computed().unwrap()
    });
    assert!((2..=6).contains(&tiles), "{tiles} tiles");
    assert!(bytes <= MIB, "{bytes} bytes for {tiles} tiles");
}
