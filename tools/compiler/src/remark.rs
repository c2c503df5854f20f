//! What is said of a clip in [`motiondb::motion_db::SourceRecord::warnings`], and how much of it a user need read.
//!
//! Records hold plain sentences; some phrases tell their weight, and whoever writes a remark of that weight uses them.

/// Begins the reason why a clip gives no example.
pub const NO_EXAMPLE: &str = "no example: ";
/// Ends the remark that a gait is too fast or too slow for any human.
pub const FRAME_TIME_QUESTION: &str = "is the frame time true?";
/// Tells that of two copies of a take one has a frame time that is not true.
pub const ANOTHER_FRAME_TIME: &str = "at another frame time: one of both is wrong";
/// Ends what the compiler does with every clip like it: nothing is wrong.
const ROUTINE: [&str; 5] = [
    "taken as 0",
    "and are not used",
    "and is not used",
    "left out",
    "is blended in its place",
];
/// Begins what is told of clips that are alike, whether or not one of them is left out for it.
const ALIKE: &str = "the same take as";

/// How much a remark matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Weight {
    /// The clip is used as it is meant to be: nothing to do.
    Note,
    /// The clip is used, but something about it is doubtful.
    Warning,
    /// The clip, or a part of it, gives no example.
    NoExample,
}

/// How much a remark matters.
pub fn weight(remark: &str) -> Weight {
    if remark.starts_with(NO_EXAMPLE) {
        Weight::NoExample
    } else if remark.contains(ANOTHER_FRAME_TIME) {
        Weight::Warning
    } else if ROUTINE.iter().any(|routine| remark.ends_with(routine)) || remark.starts_with(ALIKE) {
        Weight::Note
    } else {
        Weight::Warning
    }
}

/// A remark without the words that tell its weight.
pub fn bare(remark: &str) -> &str {
    remark.strip_prefix(NO_EXAMPLE).unwrap_or(remark)
}
