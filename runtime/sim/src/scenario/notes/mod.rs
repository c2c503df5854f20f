//! What a scenario states without effect: it can be simulated, but probably not as its author means it.
//!
//! `behaviour_notes` (states, conditions, signals), `place_notes` (paths, sources, doors, zones, ground).

pub(crate) mod behaviour_notes;
pub(crate) mod place_notes;

use crate::scenario::resolved::Scenario;

/// What is noted of a ground alone.
const PLAN: &str = "no agents: the plan can be checked; add `[[agents]]` or `[[sources]]` to simulate it";

impl Scenario {
    /// What has no effect, a sentence each.
    pub fn notes(&self) -> Vec<String> {
        if self.is_plan() {
            return vec![PLAN.to_owned()];
        }
        [behaviour_notes::notes(self), place_notes::notes(self)].concat()
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use motiondb::files::SourceText;

    use crate::scenario::parse;

    fn check(text: &str, expected: &[&str]) {
        let text = format!("duration_s = 30\n{text}");
        let (scenario, _) = parse(&SourceText { path: PathBuf::from("x.toml"), text }).expect("a scenario");
        let notes = scenario.notes();
        assert_eq!(notes.len(), expected.len(), "{notes:?}");
        let pairs = notes.iter().zip(expected);
        pairs.for_each(|(note, expected)| assert!(note.contains(expected), "{note}; expected: {expected}"));
    }

    const AGENT: &str = "[[agents]]\nat_m = [0, 0]\nstate = 'a'\n";

    #[test]
    fn transitions_that_are_never_taken_are_noted() {
        let of = |when: &str, expected: &[&str]| {
            let states = format!("[states.a]\ngo = 'g'\nthen = [{{ when = {{ {when} }}, to = 'b' }}]\n");
            let others = "[states.b]\nremove = true\n[signals.red]\ngreen_s = 0\nred_s = 10\n\
                [signals.late]\ngreen_s = 5\nred_s = 95\noffset_s = 20\n";
            check(&format!("[goals.g]\nareas = [{{ point_m = [5, 0] }}]\n{states}{others}{AGENT}"), expected);
        };
        of("reached_m = 0.1", &[]);
        of("served_s = 3", &["state `a`, transition 0: its condition never holds, because goals `g` are no queue"]);
        of("after_s = 31", &["31 s are more than the 30 s of the scenario"]);
        of("green = 'red'", &["signal `red` is never green"]);
        of("green = 'late'", &[]);
        of("population = { state = 'a', at_least = 2 }", &["there are never 2 agents, but 1 at most"]);
        of("any = [{ after_s = 31 }, { reached_m = 1 }]", &[]);
        of("any = [{ after_s = 31 }, { green = 'red' }]", &["31 s are more"]);
    }

    #[test]
    fn states_without_effect_are_noted() {
        check(
            &format!("[states.a]\nstand = {{}}\nthen = [{{ when = {{ after_s = 1 }}, to = 'back' }}]\n{AGENT}"),
            &["leads back"],
        );
        check(
            &format!("[states.a]\nstand = {{}}\nthen = [{{ when = {{ reached_m = 1 }}, to = 'back' }}]\n{AGENT}"),
            &["no state gives agents a goal"],
        );
        check(&format!("[states.a]\ngo = 'own_path'\n{AGENT}"), &["no agent has `goals_m`"]);
        check(
            &format!("[states.a]\nstand = {{}}\n[states.b]\nremove = true\n{AGENT}"),
            &["state `b`: no agent enters it"],
        );
    }

    #[test]
    fn places_without_effect_are_noted() {
        let agent = "[[agents]]\nat_m = [0, 0]\ngoals_m = [[5, 0]]\n";
        check(
            &format!("{agent}[[sources]]\nat_m = [0, 3]\nschedule = [[100, 5]]\ngoals_m = [[5, 3]]\n"),
            &["source 0: no agent is due within 30 s"],
        );
        check(
            &format!(
                "{agent}[signals.red]\ngreen_s = 0\nred_s = 10\n[[obstacles]]\nopen = 'red'\npolygon_m = [[9, -1], [9.2, -1], [9.2, 1], [9, 1]]\n"
            ),
            &["door 0 never opens: signal `red`"],
        );
        check(
            &format!("{agent}[[zones]]\nrect_m = [2, 3, 3, 3.3]\none_way_deg = 0\n"),
            &["one-way zone 0 is 0.30 m wide"],
        );
        check(
            &format!(
                "{agent}[[walkable]]\npolygon_m = [[-1, -1], [10, -1], [10, 9], [-1, 9]]\nholes_m = [[[20, 20], [22, 20], [21, 22]]]\n"
            ),
            &["hole 0 of walkable polygon 0 lies off the walkable ground"],
        );
        check(
            "[[agents]]\nat_m = [9000, 0]\ngoals_m = [[9005, 0]]\n",
            &["9.0 km from the origin, where positions are rounded to 1."],
        );
    }
}
