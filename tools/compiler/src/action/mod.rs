//! Actions: idles and transitions, from parts of clips to the frames that a database stores.
//!
//! Enters: the clips on the target body ([`AnalyzedClip`](crate::cycle::analyzed_clip::AnalyzedClip)), then the examples
//! of the set. Leaves: [`JoinedAction`](joined_action::JoinedAction)s, sorted and named, with the examples at both ends.
//!
//! Read `cut_action` (a part of a clip at 60 Hz), then `idles` with `idle_loop`, then `joined_action`.

pub(crate) mod cut_action;
pub(crate) mod idle_loop;
pub(crate) mod idles;
pub(crate) mod joined_action;
