//! `assets/clips/README.md`, written from the catalogue so that it cannot disagree with the clips.

use std::fmt::Write;

use crate::catalogue::Clip;

const HEAD: &str = "\
# The bundled clips

Made by `tools/clipgen` (`fbcrowd clips --out assets/clips`) from published gait science. No motion capture is in
them; where nothing is published to the degree (when arms and trunk swing, how far a slow side-step lifts a foot), the
generator's constants were set by the eye beside public captures (CMU, Bandai Namco, SmartBody). Do not edit: a test
compares every byte of this folder with what the generator writes. Licence: MIT, as the code.

Y up, Z forward, X to the body's left, 30 frames a second, a body of 1.75 m (proportions: Drillis and Contini 1966, in
Winter, *Biomechanics and Motor Control of Human Movement*). Most files are BVH, in centimetres; one clip of every
kind is GLB (glTF 2.0, metres) with a skinned body, so that whoever runs the default set runs both importers. No clip
is there twice. Every clip is a whole number of strides of a steady gait (3 to 6; a stride need not be a whole number
of frames); its **last frame is its first one, moved on** by those strides: for a loop leave it out. No two strides of
a clip are the same: their time, length and width, the foot's lift, pelvis, trunk, arms and gaze vary as people's do
(`variation.rs`), about the steady gait that the table lists. Leaf joints `…HeelSole`, `…BallSole`, `…ToeSole` lie on
the soles. Turns and side-steps are to the left; the compiler mirrors them.

v_f forward, ω_t counter-clockwise, ω_s to the left. The step length is that along the path of the root.

| file | v_f m/s | ω_t °/s | ω_s m/s | cadence steps/min | step m |
|---|---|---|---|---|---|
";

const SOURCES: &str = "
Sources: joint curves, foot angles and pelvis amplitudes by speed, Schwartz, Rozumalski and Trost 2008 (*J. Biomech.*
41); cadence, step length and double support, adults of 18–29 years as in `cadence.rs`; arms and trunk as in
`upper_body.rs`; variation from stride to stride, Hausdorff et al. 1999, Beauchet et al. 2009 and Skiadopoulos et al.
2020 as in `variation.rs`.
";

/// The file's bytes.
pub(crate) fn write(clips: &[Clip]) -> Vec<u8> {
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
