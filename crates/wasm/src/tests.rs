//! What a page may hand over, whatever the engine makes of it.

use super::*;

#[test]
fn every_message_is_answered_even_one_that_is_none() {
    for input in [&b""[..], b"{", b"\xff\xfe", b"\0\0\0\0", b"\x02\0\0\0{}"] {
        let mut page = Page::new();
        page.input = input.to_vec();
        let length = page.call();
        assert!(length > 0 && length == page.output.len(), "{input:?}");
        assert_eq!(page.input.capacity(), 0, "handed over and kept: {input:?}");
    }
}

#[test]
fn what_is_to_be_drawn_is_as_long_as_is_said() {
    let mut page = Page::new();
    let length = page.frame();
    assert_eq!(length, page.output.len());
}

#[test]
fn the_input_has_the_length_that_is_asked_for_and_what_there_is_no_memory_for_is_refused() {
    assert!(!input(10).is_null());
    PAGE.with_borrow(|page| assert_eq!(page.input, [0; 10]));
    assert!(input(usize::MAX).is_null());
    PAGE.with_borrow(|page| assert!(page.input.is_empty()));
}
