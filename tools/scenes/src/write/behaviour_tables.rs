//! The tables of goals, areas and states.

use crate::scene::{
    Choose, GoalPlace, Remember, Scene, SceneCondition, SceneGoals, SceneMovement, SceneSettings, SceneState,
    SceneTarget, SceneTransition,
};
use crate::write::words::{LINE_MAX, commented, drawn, key, number, point, quoted, shape};

/// The tables `[goals.NAME]`.
pub(crate) fn goals(scene: &Scene) -> String {
    scene.goals.iter().map(goals_table).collect()
}

fn goals_table(goals: &SceneGoals) -> String {
    let mut text = commented(&format!("[goals.{}]", key(&goals.name)), &goals.origin);
    let choose = match goals.choose {
        Choose::Nearest if goals.places.len() < 2 => None,
        Choose::Nearest => Some("nearest"),
        Choose::Farthest => Some("farthest"),
        Choose::Random => Some("random"),
        Choose::Weighted => Some("weighted"),
    };
    if let Some(choose) = choose {
        text += &format!("choose = \"{choose}\"\n");
    }
    let common = goals.places.first().and_then(|place| place.capacity);
    let common = common.filter(|_| goals.places.iter().all(|place| place.capacity == common));
    if let Some(capacity) = common {
        text += &format!("capacity = {capacity}\n");
    }
    let place = |place: &GoalPlace| {
        let mut keys = shape(&place.shape);
        if let Some(capacity) = place.capacity.filter(|_| common.is_none()) {
            keys += &format!(", capacity = {capacity}");
        }
        if goals.choose == Choose::Weighted && place.weight != 1.0 {
            keys += &format!(", weight = {}", number(place.weight));
        }
        format!("{{ {keys} }}")
    };
    let places: Vec<String> = goals.places.iter().map(place).collect();
    text + &lines("areas", &places) + "\n"
}

/// The tables `[areas.NAME]`.
pub(crate) fn areas(scene: &Scene) -> String {
    scene.areas.iter().map(|area| format!("[areas.{}]\n{}\n\n", key(&area.name), shape(&area.shape))).collect()
}

/// The tables `[states.NAME]`.
pub(crate) fn states(scene: &Scene) -> String {
    scene.states.iter().map(state).collect()
}

fn state(state: &SceneState) -> String {
    let mut text = commented(&format!("[states.{}]", key(&state.name)), &state.comment);
    text += &match &state.movement {
        SceneMovement::Go { goals, .. } => format!("go = {}\n", quoted(goals)),
        SceneMovement::Mirror(centre_m) => format!("go = {{ mirror_m = {} }}\n", point(*centre_m)),
        SceneMovement::Offset(by_m) => format!("go = {{ offset_m = {} }}\n", point(*by_m)),
        SceneMovement::OwnPath => "go = \"own_path\"\n".to_owned(),
        SceneMovement::Stand => "stand = {}\n".to_owned(),
        SceneMovement::Walk(velocity_mps) => format!("walk_mps = {}\n", point(*velocity_mps)),
        SceneMovement::Remove => "remove = true\n".to_owned(),
    };
    if let SceneMovement::Go { remember: Some(remember), .. } = &state.movement {
        text += &match remember {
            Remember::Own => "remember = true\n".to_owned(),
            Remember::Of(of) => format!("remember = {}\n", quoted(of)),
        };
    }
    text += &settings(&state.settings);
    if !state.transitions.is_empty() {
        let transitions: Vec<String> = state.transitions.iter().map(transition).collect();
        text += &lines("then", &transitions);
    }
    text + "\n"
}

fn settings(settings: &SceneSettings) -> String {
    let mut keys = Vec::new();
    let numbers = [
        ("preferred_speed_mps", settings.preferred_speed_mps),
        ("speed_factor", settings.speed_factor),
        ("radius_m", settings.radius_m),
    ];
    keys.extend(
        numbers.into_iter().filter_map(|(name, value)| value.map(|value| format!("{name} = {}", drawn(value)))),
    );
    if settings.remain {
        keys.push("remain = true".to_owned());
    }
    if let Some(area) = &settings.teleport {
        keys.push(format!("teleport = {{ {} }}", shape(area)));
    }
    if keys.is_empty() { String::new() } else { format!("set = {{ {} }}\n", keys.join(", ")) }
}

fn transition(transition: &SceneTransition) -> String {
    let to = match &transition.to {
        SceneTarget::State(name) => quoted(name),
        SceneTarget::Back => quoted("back"),
        SceneTarget::Weights(weights) => {
            let weights: Vec<String> =
                weights.iter().map(|(name, weight)| format!("{} = {}", key(name), number(*weight))).collect();
            format!("{{ {} }}", weights.join(", "))
        }
    };
    match &transition.when {
        SceneCondition::Always => format!("{{ to = {to} }}"),
        when => format!("{{ when = {}, to = {to} }}", condition(when)),
    }
}

/// A condition as an inline table.
fn condition(when: &SceneCondition) -> String {
    let all = |parts: &[SceneCondition]| parts.iter().map(condition).collect::<Vec<_>>().join(", ");
    let keys = match when {
        SceneCondition::Always => return "{}".to_owned(),
        SceneCondition::Reached(within_m) => format!("reached_m = {}", number(*within_m)),
        SceneCondition::After(duration_s) => format!("after_s = {}", drawn(*duration_s)),
        SceneCondition::Inside(area) => format!("inside = {}", quoted(area)),
        SceneCondition::Population(state, least, most) => {
            let bound =
                |name: &str, count: &Option<u64>| count.map_or_else(String::new, |count| format!(", {name} = {count}"));
            let bounds = bound("at_least", least) + &bound("at_most", most);
            format!("population = {{ state = {}{bounds} }}", quoted(state))
        }
        SceneCondition::All(parts) => format!("all = [{}]", all(parts)),
        SceneCondition::Any(parts) => format!("any = [{}]", all(parts)),
        SceneCondition::Not(part) => format!("not = {}", condition(part)),
    };
    format!("{{ {keys} }}")
}

/// `key = [items]` on one line, or an item a line.
fn lines(key: &str, items: &[String]) -> String {
    let one_line = format!("{key} = [{}]\n", items.join(", "));
    if items.len() < 2 || (items.len() < 4 && one_line.chars().count() <= LINE_MAX) {
        return one_line;
    }
    let items: String = items.iter().map(|item| format!("    {item},\n")).collect();
    format!("{key} = [\n{items}]\n")
}
