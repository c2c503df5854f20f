//! State machines made at random: no panic, no number that is not finite, no agent lost or doubled.

use std::path::PathBuf;

use motiondb::files::SourceText;
use proptest::prelude::*;

use crate::scenario::parse;
use crate::simulation::tests::started;

/// Any condition of a wild machine, as text.
fn any_when() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        Just("{ reached_m = 0.3 }"),
        Just("{ after_s = { uniform = [0, 3] } }"),
        Just("{ served_s = 0.5 }"),
        Just("{ inside = 'hall' }"),
        Just("{ green = 'light' }"),
        Just("{ number = { inside = 'hall', at_most = 3 } }"),
        Just("{ population = { state = 's1', at_least = 2 } }"),
    ];
    let wrap = |(leaf, kind): (&str, u8)| match kind {
        0 => format!("{{ not = {leaf} }}"),
        1 => format!("{{ all = [{leaf}, {{ after_s = 0.4 }}] }}"),
        2 => format!("{{ any = [{leaf}, {{ after_s = 2 }}] }}"),
        _ => leaf.to_owned(),
    };
    (leaf, 0u8..5).prop_map(wrap)
}

fn any_state() -> impl Strategy<Value = String> {
    let movement = prop_oneof![
        Just("go = 'far'"),
        Just("go = 'busy'\nremember = true"),
        Just("go = 'till'"),
        Just("go = 'own_path'"),
        Just("go = { mirror_m = [1, 0] }"),
        Just("go = { offset_m = [0, 40] }"),
        Just("stand = { facing = 'goal' }"),
        Just("stand = { facing_m = [0, 0] }"),
        Just("walk_mps = [-8, 3]"),
    ];
    let set = prop_oneof![
        Just(""),
        Just("set = { speed_factor = { uniform = [0.2, 3] }, remain = true }"),
        Just("set = { radius_m = { uniform = [0.1, 1] } }"),
        Just("set = { preferred_speed_mps = 0.1, teleport = { rect_m = [-3, -3, 3, 3] } }"),
    ];
    let transition = (any_when(), 0usize..6).prop_map(|(when, to)| {
        let to = ["'s0'", "'s1'", "'s2'", "'back'", "'gone'", "{ s0 = 1, s2 = 2 }"][to];
        format!("{{ when = {when}, to = {to} }}")
    });
    (movement, set, proptest::collection::vec(transition, 0..4))
        .prop_map(|(movement, set, then)| format!("{movement}\n{set}\nthen = [{}]\n", then.join(", ")))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn wild_machines_move_every_body_finitely(
        states in proptest::collection::vec(any_state(), 3),
        coupling in prop_oneof![Just("two_way"), Just("decoupled"), Just("discs")],
        removal in prop_oneof![Just("true"), Just("'at_once'")],
    ) {
        const WORLD: &str = "
            [signals.light]
            green_s = 2
            red_s = 1
            [areas.hall]
            rect_m = [-2, -2, 2, 2]
            [goals.far]
            choose = 'least_busy'
            areas = [{ rect_m = [4, -6, 6, 6] }, { circle_m = [-5, 0, 0.5], capacity = 2 }]
            [goals.busy]
            choose = { nearest_of = 2 }
            capacity = 1
            areas = [{ point_m = [0, 3], facing_deg = 90 }, { point_m = [0, -3] }, { point_m = [3, 3] }]
            [goals.till]
            queue = true
            areas = [{ point_m = [2, 0] }, { point_m = [1, 0] }]
            [[obstacles]]
            polygon_m = [[-1, 5], [1, 5], [1, 5.5], [-1, 5.5]]
            [[sources]]
            rect_m = [-8, -8, 8, -7]
            rate_per_s = 1.5
            state = 's1'
            [[agents]]
            area = { rect_m = [-6, -6, 6, 4], count = 12 }
            pre_movement_s = { uniform = [0, 2] }
            goal_offset_m = [2, 1]
            state = 's0'
        ";
        let named = states.iter().enumerate().map(|(index, state)| format!("[states.s{index}]\n{state}"));
        let named: String = named.collect();
        let text = format!("duration_s = 60\ndt_s = 0.1\ncoupling = '{coupling}'\n{WORLD}\n{named}[states.gone]\nremove = {removal}");
        let parsed = parse(&SourceText { path: PathBuf::from("wild.toml"), text });
        // States that never wait are a mistake in the text.
        let Ok((scenario, _)) = parsed else { return Ok(()) };
        let mut simulation = started(&scenario);
        let mut recorded = 0;
        for _ in 0..200 {
            simulation.step(&mut |_| {});
            let frames = simulation.frames();
            prop_assert!(frames.iter().all(|frame| frame.root.position_m.is_finite() && frame.preferred_mps.is_finite()));
            prop_assert!(frames.windows(2).all(|pair| pair[0].id < pair[1].id));
            prop_assert_eq!(simulation.crowd.agents.len(), frames.len());
            recorded += frames.len();
        }
        let lives = &simulation.population().agents;
        let present: u32 = lives.iter().map(|life| life.removed.unwrap_or(201) - life.born.max(1)).sum();
        prop_assert_eq!(present as usize, recorded);
    }
}
