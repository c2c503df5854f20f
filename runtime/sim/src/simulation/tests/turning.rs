//! Claims about agents whose route leads back.

use glam::Vec2;

use crate::simulation::tests::{run, scenario_of};

#[test]
fn an_agent_turns_on_the_spot_before_it_walks_back() {
    for facing_deg in [180, 150, -120] {
        let text = format!(
            "
            duration_s = 9
            variation = false
            [[agents]]
            at_m = [0, 0]
            goals_m = [[6, 0]]
            facing_deg = {facing_deg}
            "
        );
        let (mut turned_s, mut gone_m) = (f64::INFINITY, 0.0_f32);
        let simulation = run(&scenario_of(&text), |simulation, time_s| {
            let root = &simulation.frames()[0].root;
            if root.forward().x < 0.5 {
                gone_m = gone_m.max(root.position_m.length());
            } else {
                turned_s = turned_s.min(time_s);
            }
        });
        assert!(gone_m < 0.6 && turned_s < 2.2, "{facing_deg}°: {gone_m} m in {turned_s} s");
        assert!(simulation.frames()[0].root.position_m.distance(Vec2::new(6.0, 0.0)) < 0.5);
    }
}
