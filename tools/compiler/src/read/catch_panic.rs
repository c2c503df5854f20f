//! Runs another crate's parser, catches its panics, and prints nothing about them.
//!
//! The panic hook belongs to the whole process. Ours wraps the present hook once, and is silent only for threads that
//! are inside [`catch`].

use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;

thread_local! {
    static IS_QUIET: Cell<bool> = const { Cell::new(false) };
}
static HOOK: Once = Once::new();

/// The result of `parse`; none if it panics. `parse` must own everything that a panic leaves half-done.
pub(crate) fn catch<T>(parse: impl FnOnce() -> T) -> Option<T> {
    HOOK.call_once(|| {
        let present = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if !IS_QUIET.get() {
                present(info);
            }
        }));
    });
    let before = IS_QUIET.replace(true);
    let result = panic::catch_unwind(AssertUnwindSafe(parse));
    IS_QUIET.set(before);
    result.ok()
}
