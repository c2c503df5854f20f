//! Styles: a set whose clips have styles becomes a database for each style, over one skeleton.
//!
//! Enters: the analysed clips of a set. Leaves: the [`StylePart`](style_part::StylePart)s, each compiled by itself;
//! then [`MotionDb`](motiondb::motion::MotionDb)s, joined into one. A set without styles is one part.
//!
//! Read `style_part`, then `brief_rest` and `lent_idle`, then `joined_styles`.

pub(crate) mod brief_rest;
pub(crate) mod joined_styles;
pub(crate) mod lent_idle;
pub(crate) mod style_part;

#[cfg(test)]
mod tests;
