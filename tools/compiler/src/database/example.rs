//! NamedCycle → MotionExample: parameters, key times, slide.
//!
//! Key times and planted-foot slide are those of the definitions in `docs/definitions.md`. Metres, seconds, radians.

use motiondb::motion::MotionExample;

use crate::cycle::foot_slide::{cycle_feet, foot_slide};
use crate::retarget::human_clip::HumanBody;
use crate::select::named_cycles::NamedCycle;

/// The example of a cycle.
pub(crate) fn motion_example(named: &NamedCycle, body: &HumanBody) -> MotionExample {
    let cycle = &named.cycle;
    let slide = foot_slide(cycle, body);
    MotionExample {
        name: named.name.clone(),
        source: named.source,
        window_s: named.window_s.map(|second| second as f32),
        mirrored: named.mirrored,
        parameters: cycle.rates.to_parameters(),
        phase_map: cycle.phase_map,
        key_times_s: if cycle.steps { cycle_feet(cycle, body).key_times_s() } else { None },
        planted_slide_cm_s: slide.slide_cm_s as f32,
        planted_share: slide.planted_share as f32,
    }
}
