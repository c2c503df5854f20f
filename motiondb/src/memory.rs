//! Memory that a job needs, asked of the system before the job begins.

use std::hint::black_box;

/// Whether the system gives so many bytes now. They are given back at once: the answer is a forecast.
///
/// ```
/// assert!(motiondb::memory::has_room(1 << 10));
/// assert!(!motiondb::memory::has_room(usize::MAX / 2));
/// ```
pub fn has_room(bytes: usize) -> bool {
    let mut room = Vec::<u8>::new();
    let is_given = room.try_reserve_exact(bytes).is_ok();
    // The compiler may otherwise leave the allocation out.
    black_box(&mut room);
    is_given
}
