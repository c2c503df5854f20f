//! `assets/clips/README.md`, written from the catalogue, so that it cannot disagree with the clips.

use std::fmt::Write;

use crate::catalogue::PlannedClip;

/// Text before the rows of the table.
const HEAD: &str = "\
# The bundled clips

`tools/clipgen` makes these clips from published gait science (`fbcrowd clips --out assets/clips`). They hold no motion
capture. Where no figures are published (when arms and trunk swing, how far a slow side-step lifts a foot), the
generator's constants were set by eye beside public captures (CMU, Bandai Namco, SmartBody). Do not edit the files: a
test compares every byte of this folder with what the generator writes. Licence: MIT, as the code.

Axes: Y up, Z forward, X to the body's left. 30 frames per second. The body is 1.75 m tall (proportions: Drillis and
Contini 1966, in Winter, *Biomechanics and Motor Control of Human Movement*). Most files are BVH, in centimetres. One
clip of every kind is GLB (glTF 2.0, metres) with a skinned body, so that the default set exercises both importers. No
clip exists in both formats.

Every clip is a whole number of strides of a steady gait (3 to 6; a stride need not be a whole number of frames). Its
**last frame is its first one, moved on** by those strides: for a loop leave it out. No two strides of a clip are
equal: their duration, length and width, the lift of the foot, pelvis, trunk, arms and gaze vary as in humans
(`plan/variation.rs`), about the steady gait that the table lists. Leaf joints `…HeelSole`, `…BallSole`, `…ToeSole` lie
on the soles. Turns and side-steps are to the left; the compiler mirrors them. Idles are loops of 11 to 15 s on feet that
never move; of one frame their last is the first again, too.

v_f is positive forward, ω_t counter-clockwise, ω_s to the left. The step length is measured along the path of the root.

| file | v_f m/s | ω_t °/s | ω_s m/s | cadence steps/min | step m |
|---|---|---|---|---|---|
";

/// Text after the table.
const SOURCES: &str = "
Sources:

- joint curves, foot angles and pelvis amplitudes by speed: Schwartz, Rozumalski and Trost 2008 (*J. Biomech.* 41);
- cadence, step length and double support: adults of 18–29 years, see `plan/gaits.rs`;
- arms and trunk: see `motion/upper_body.rs`;
- standing at ease, on one leg or both: Prado-Rico and Duarte 2019, Duarte and Zatsiorsky 1999 (*Motor Control* 23 and 3);
- variation from stride to stride: Hausdorff et al. 1999, Beauchet et al. 2009, Skiadopoulos et al. 2020, see
  `plan/variation.rs`.
";

/// The bytes of the README.
pub(crate) fn readme_bytes(clips: &[PlannedClip]) -> Vec<u8> {
    let mut text = String::from(HEAD);
    for clip in clips {
        let motion = &clip.motion;
        let turn_deg_s = motion.turn_rate_rad_s.to_degrees();
        // Writing to a string cannot fail.
        let _ = write!(
            text,
            "| {} | {:.2} | {turn_deg_s:.0} | {:.2} |",
            clip.file_name(),
            motion.speed_mps,
            motion.strafe_mps
        );
        let _ = match clip.cadence_and_step_m() {
            Some((cadence, step_m)) => writeln!(text, " {cadence:.1} | {step_m:.3} |"),
            None => writeln!(text, " – | – |"),
        };
    }
    text.push_str(SOURCES);
    text.into_bytes()
}
