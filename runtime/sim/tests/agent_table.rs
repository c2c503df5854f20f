//! The table of a recording, with rows computed by hand.

mod common;

use common::{agent, folder, header, record, standing_at};
use fbcrowd_sim::measures::write_table;
use fbcrowd_sim::planning::VelocitySet;
use fbcrowd_sim::recording::AgentFrame;
use fbcrowd_sim::synthesis::Mode;
use glam::Vec2;
use motiondb::body::Root;

/// An agent that walks 0.5 m in +y in two steps of 0.25 s, and one that stands at its goal.
fn frames() -> Vec<Vec<AgentFrame>> {
    let walker = |y: f32| AgentFrame {
        root: Root { position_m: Vec2::new(2.0, y), facing_rad: std::f32::consts::FRAC_PI_2 },
        preferred_mps: Vec2::new(0.0, 1.25),
        planned_mps: Vec2::new(-0.25, 1.0),
        phase: 0.75,
        mode: Mode::SemiProcedural,
        contacts: [1.0, 0.0],
        time_to_landing_s: 0.5,
        set: VelocitySet::Holding,
        strafing_s: 0.25,
        stepping_back_s: 0.125,
        ..standing_at(Vec2::ZERO)
    };
    [0.0, 0.25, 0.5].map(|y| vec![walker(y), standing_at(Vec2::new(9.0, -4.0))]).to_vec()
}

fn table() -> String {
    let header = header(vec![agent([2.0, 0.0], [2.0, 0.875]), agent([9.0, -4.0], [9.0, -4.0])], 0.25);
    let recording = record(&folder("agent_table").join("a.fbrec"), &header, &frames());
    let mut text = Vec::new();
    write_table(&recording, &mut text).unwrap();
    String::from_utf8(text).unwrap()
}

#[test]
fn table_has_field_columns_and_agent_rows() {
    let table = table();
    let rows: Vec<Vec<&str>> = table.split_terminator("\r\n").map(|row| row.split(',').collect()).collect();
    assert_eq!(rows.len(), 1 + 3 * 2);
    assert!(rows.iter().all(|row| row.len() == rows[0].len()), "{table}");
    let field = |row: usize, name: &str| rows[row][rows[0].iter().position(|column| *column == name).unwrap()];
    let last_walker = [
        ("step", "2"),
        ("time_s", "0.500000"),
        ("agent", "0"),
        ("x_m", "2.000000"),
        ("y_m", "0.500000"),
        ("facing_deg", "90.0000"),
        ("velocity_x_mps", "0.000000"),
        ("velocity_y_mps", "1.000000"),
        ("preferred_y_mps", "1.250000"),
        ("planned_x_mps", "-0.250000"),
        ("mode", "semi_procedural"),
        ("velocity_set", "holding"),
        ("strafing_s", "0.250000"),
        ("stepping_back_s", "0.125000"),
        ("phase", "0.750000"),
        ("left_contact", "1.000000"),
        ("right_contact", "0.000000"),
        ("time_to_landing_s", "0.500000"),
        ("arrived", "1"),
    ];
    for (name, value) in last_walker {
        assert_eq!(field(5, name), value, "{name}");
    }
    let arrived = |agent: usize| [1, 3, 5].map(|row| field(row + agent, "arrived"));
    assert_eq!((arrived(0), arrived(1)), (["0", "0", "1"], ["1"; 3]));
    assert_eq!([field(1, "velocity_y_mps"), field(2, "mode")], ["0.000000", "blending"]);
}
