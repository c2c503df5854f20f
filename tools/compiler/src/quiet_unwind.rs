//! Catches the panics of a foreign parser without a word on standard error.
//!
//! The panic hook is the process's; ours is put before the present one once, and is silent only for threads that are
//! within [`catch`].

use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;

thread_local! {
    static QUIET: Cell<bool> = const { Cell::new(false) };
}
static HOOK: Once = Once::new();

/// The result of `parse`, or none where it panicked. `parse` must own what it leaves half-done.
pub fn catch<T>(parse: impl FnOnce() -> T) -> Option<T> {
    HOOK.call_once(|| {
        let present = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if !QUIET.get() {
                present(info);
            }
        }));
    });
    let before = QUIET.replace(true);
    let result = panic::catch_unwind(AssertUnwindSafe(parse));
    QUIET.set(before);
    result.ok()
}
