//! The live engine behind plain functions and one linear memory, for a page that runs it as WebAssembly.
//!
//! The module imports nothing. There is one engine in it, made at the first call. What goes in is written into the
//! input, what comes out is read from the output. Both move when they grow, and all views of the memory end when the
//! memory grows: a page makes its view anew after each call. Addresses are unsigned: in JavaScript `>>> 0`.
//!
//! | function | does | gives |
//! | --- | --- | --- |
//! | `input(length)` | makes the input so many bytes long | its address; 0 if there is no memory for it |
//! | `call()` | hands the input to the engine as a message | the length of the answer, in the output |
//! | `tick(passed, took)` | lets the engine work, as [`Engine::tick`] | 1 if there is something new to be drawn, or 0 |
//! | `frame()` | asks for what is to be drawn | its length, in the output |
//! | `output()` | | the address of the output |
//! | `failure()`, `failed_at()` | after a call has ended in a trap | length and address of the text that says why |
//!
//! After a trap the engine is of no use any more. Elsewhere than in WebAssembly these are functions without exported
//! names, so that their tests run on any machine.

#![cfg_attr(
    target_family = "wasm",
    allow(
        unsafe_code,
        reason = "an exported name is promised to be the only one"
    )
)]

use std::cell::{Cell, RefCell};

use live::Engine;

/// The engine and what passes to and from it.
struct Page {
    engine: Engine,
    input: Vec<u8>,
    output: Vec<u8>,
}

thread_local! {
    static PAGE: RefCell<Page> = RefCell::new(Page::new());
    /// Why a call has ended in a trap; apart from the page, which such a call leaves borrowed.
    static FAILURE: Cell<&'static str> = const { Cell::new("") };
}

impl Page {
    fn new() -> Self {
        // a trap says nothing by itself
        #[cfg(target_family = "wasm")]
        std::panic::set_hook(Box::new(|why| {
            // what follows from the first is of no interest
            if FAILURE.get().is_empty() {
                FAILURE.set(String::leak(why.to_string()));
            }
        }));
        Self {
            engine: Engine::new(),
            input: Vec::new(),
            output: Vec::new(),
        }
    }

    fn call(&mut self) -> usize {
        // not kept: it may be a picture
        let input = std::mem::take(&mut self.input);
        self.output = self.engine.call(&input);
        self.output.len()
    }

    fn frame(&mut self) -> usize {
        self.output = self.engine.frame();
        self.output.len()
    }
}

/// Make the input so many bytes long: its address, or null if there is no memory for it.
#[must_use]
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
pub extern "C" fn input(length: usize) -> *mut u8 {
    PAGE.with_borrow_mut(|page| {
        page.input.clear();
        if page.input.try_reserve_exact(length).is_err() {
            return std::ptr::null_mut();
        }
        page.input.resize(length, 0);
        page.input.as_mut_ptr()
    })
}

/// The address of the output.
#[must_use]
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
pub extern "C" fn output() -> *const u8 {
    PAGE.with_borrow(|page| page.output.as_ptr())
}

/// Hand the input to the engine as a message: the length of the answer.
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
pub extern "C" fn call() -> usize {
    PAGE.with_borrow_mut(Page::call)
}

/// Let the engine work: so many milliseconds have passed, and the last tick took so many. Whether there is something
/// new to be drawn.
#[must_use]
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
pub extern "C" fn tick(passed: f64, took: f64) -> bool {
    PAGE.with_borrow_mut(|page| page.engine.tick(passed, took))
}

/// What is to be drawn now: its length.
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
pub extern "C" fn frame() -> usize {
    PAGE.with_borrow_mut(Page::frame)
}

/// The length of the text that says why a call has ended in a trap.
#[must_use]
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
pub extern "C" fn failure() -> usize {
    FAILURE.get().len()
}

/// The address of that text.
#[must_use]
#[cfg_attr(target_family = "wasm", unsafe(no_mangle))]
pub extern "C" fn failed_at() -> *const u8 {
    FAILURE.get().as_ptr()
}

#[cfg(test)]
mod tests;
