//! Tests beside the guideline's, as users of such systems ask for them: overtaking somebody who stands, stopping behind
//! each other, and a whole scene turned. World, metres, seconds.

use glam::Vec2;

use crate::cmd::bench::bar::Bar;
use crate::cmd::bench::rimea_cases::{Judged, TOUCH_M, figure, overlap_m};
use crate::cmd::bench::watch::Watched;

/// Overtaking: path over the straight way; a body's width aside over 10 m makes 1.003, a hesitation more.
const DETOUR: f64 = 1.05;
/// Overtaking: who stands is sought out by nobody's way, and stays at its goal, m (`path.rs`).
const STANDS_M: f64 = 0.5;
/// A scene turned: when everybody must still be where it was but for rounding, and how near, s and m. Later that says
/// nothing: who meets whom is chaotic, and rounding of 1e−5 m at 2 s has grown to 0.1 m before 6 s, whatever the turn.
const TURNED_AT_S: f64 = 2.0;
const TURNED_M: f64 = 1e-3;
/// What must hold in the end all the same: mean time to goal, share.
const TURNED_TIME: f64 = 0.01;
/// A scene turned: by so much; first as it is.
pub(super) const TURNED_DEG: &[f32] = &[0.0, 37.0, 90.0, 211.0];

pub(super) fn overtaking(played: &[Watched]) -> Judged {
    let played = &played[0];
    let (mut walked_m, mut pushed_m) = (0.0, 0.0_f64);
    let stood_m = played.scenario.agents[1].position_m;
    for seen in played.steps() {
        walked_m += f64::from(seen.before_m[0].distance(seen.after_m[0]));
        pushed_m = pushed_m.max(seen.after_m[1].distance(stood_m).into());
    }
    let ends_m = [0, played.tracks.frame_count() - 1].map(|frame| played.tracks.frame_m(frame)[0]);
    let detour = walked_m / f64::from(ends_m[0].distance(ends_m[1]));
    Judged {
        figures: vec![
            figure("path over the straight way", detour),
            figure("who stands is pushed by, m", pushed_m),
            figure("least distance of the two, m", played.measures.minimum_separation_m),
        ],
        bars: vec![
            Bar::at_least("overtaking: arrived", 2.0, played.measures.arrived as f64),
            Bar::at_most("overtaking: overlap of discs, m", TOUCH_M, overlap_m(played)),
            Bar::at_most("overtaking: path over the straight way", DETOUR, detour),
            Bar::at_most("overtaking: who stands is pushed by, m", STANDS_M, pushed_m),
        ],
    }
}

pub(super) fn queue(played: &[Watched]) -> Judged {
    let measures = &played[0].measures;
    Judged {
        figures: vec![figure("least distance of any two, m", measures.minimum_separation_m)],
        bars: vec![
            Bar::at_least("queue: arrived", measures.agents as f64, measures.arrived as f64),
            Bar::at_most("queue: overlap of discs, m", TOUCH_M, overlap_m(&played[0])),
        ],
    }
}

pub(super) fn turned(played: &[Watched]) -> Judged {
    let places_m = |(played, turn_deg): (&Watched, &f32)| -> Vec<Vec2> {
        let back = Vec2::from_angle(-turn_deg.to_radians());
        let frame = (TURNED_AT_S / played.dt_s()).round() as usize;
        played.tracks.frame_m(frame).iter().map(|root_m| back.rotate(*root_m)).collect()
    };
    let all_m: Vec<Vec<Vec2>> = played.iter().zip(TURNED_DEG).map(places_m).collect();
    let off_m = |places_m: &Vec<Vec2>| {
        all_m[0].iter().zip(places_m).map(|(one_m, other_m)| one_m.distance(*other_m)).reduce(f32::max)
    };
    let offs_m = || all_m.iter().skip(1).filter_map(off_m).map(f64::from);
    let arrived = played.iter().map(|played| played.measures.arrived).min();
    let times_s: Option<Vec<f64>> = played.iter().map(|played| played.measures.mean_time_to_goal_s).collect();
    let times_s = times_s.unwrap_or_default();
    let off_time = times_s.iter().map(|time_s| (time_s / times_s[0] - 1.0).abs()).reduce(f64::max);
    let of_turns = TURNED_DEG.iter().zip(&times_s);
    let named_times =
        of_turns.map(|(turn, &time_s)| figure(format!("mean time to goal, turned by {turn}°, s"), time_s));
    let named_offs = TURNED_DEG[1..].iter().zip(offs_m());
    let named_offs =
        named_offs.map(|(turn, off_m)| figure(format!("farthest off after 2 s, turned by {turn}°, m"), off_m));
    Judged {
        figures: named_offs.chain(named_times).collect(),
        bars: vec![
            Bar::at_most("turned: farthest off after 2 s, m", TURNED_M, offs_m().reduce(f64::max)),
            Bar::at_least("turned: arrived", 30.0, arrived.map(|arrived| arrived as f64)),
            Bar::at_most("turned: mean time to goal off, share", TURNED_TIME, off_time),
        ],
    }
}
