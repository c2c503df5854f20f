//! Random scenario files: obstacles, doors, enclosures, walkable ground with holes, sources, groups, goals, queues, state
//! machines, signals, events, zones that are slow, closed or one-way, and
//! measures, in any combination. Many are rejected: a goal may lie in an obstacle, or have no route.
//! World, metres, seconds.

use std::fmt::Write;

use fbcrowd_sim::maths::SplitMix64;

/// Half the side of the square that holds a scene, m.
const SQUARE_M: f64 = 8.0;
/// Most polygons of a kind.
const POLYGONS_MAX: usize = 4;
/// Most agents of a table.
const AGENTS_MAX: usize = 12;
/// Most states, beside the one that removes.
const STATES_MAX: usize = 4;
/// Number of sets of goals; the last is a queue every other time.
const SETS: usize = 3;
/// Conditions of transitions.
const CONDITIONS: [&str; 9] = [
    "{ reached_m = 0.3 }",
    "{ reached_m = 0 }",
    "{ after_s = { uniform = [0, 3] } }",
    "{ served_s = { normal = [1, 0.5] } }",
    "{ inside = 'hall' }",
    "{ green = 'light' }",
    "{ number = { inside = 'hall', at_most = 3 } }",
    "{ population = { state = 's0', at_least = 2 } }",
    "{ any = [{ not = { green = 'light' } }, { all = [{ inside = 'hall' }, { after_s = 0.4 }] }] }",
];
/// Conditions of events.
const EVENTS: [&str; 4] = [
    "{ after_s = 1.3 }",
    "{ number = { inside = 'hall', at_least = 1 } }",
    "{ population = { state = 'gone', at_most = 0 } }",
    "{ all = [{ after_s = 0.5 }, { not = { green = 'light' } }] }",
];
/// What agents do in a state, beside going to a set of goals.
const MOVEMENTS: [&str; 7] = [
    "go = 'own_path'",
    "go = { mirror_m = [1, 0] }",
    "go = { offset_m = [3, 2] }",
    "stand = {}",
    "stand = { facing = 'goal' }",
    "stand = { facing_m = [0, 0] }",
    "walk_mps = [-1.5, 0.4]",
];
/// What a state sets.
const SETTINGS: [&str; 5] = [
    "",
    "remember = true",
    "set = { speed_factor = { uniform = [0.2, 3] }, remain = true }",
    "set = { radius_m = { uniform = [0.1, 0.6] } }",
    "set = { preferred_speed_mps = 0.5, teleport = { rect_m = [-3, -3, 3, 3] } }",
];
/// How an agent chooses a goal.
const CHOICES: [&str; 6] = ["'nearest'", "'farthest'", "'random'", "'weighted'", "'least_busy'", "{ nearest_of = 2 }"];

/// The text of a seed's scenario.
pub(crate) fn scenario_text(seed: u64) -> String {
    let mut draw = TextDraw { random: SplitMix64::new(seed, 0), text: String::new() };
    draw.head();
    draw.ground();
    draw.behaviour();
    draw.agents();
    draw.sources();
    draw.events();
    draw.zones_and_measures();
    draw.text
}

/// A text while it is drawn.
struct TextDraw {
    random: SplitMix64,
    text: String,
}

impl TextDraw {
    fn below(&mut self, limit: usize) -> usize {
        (self.random.next_u64() % limit as u64) as usize
    }

    fn flip(&mut self) -> bool {
        self.below(2) == 0
    }

    fn one<T: Copy>(&mut self, several: &[T]) -> T {
        several[self.below(several.len())]
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.random.unit()
    }

    fn line(&mut self, line: impl AsRef<str>) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.text, "{}", line.as_ref());
    }

    fn point(&mut self) -> [f64; 2] {
        [0, 1].map(|_| self.between(-SQUARE_M, SQUARE_M))
    }

    fn head(&mut self) {
        let step = self.one(&["1.6666667e-2", "3.3333335e-2", "0.1"]);
        let coupling = self.one(&["two_way", "two_way", "two_way", "decoupled", "discs"]);
        let planner = self.one(&["mcn", "mcn", "mcn", "orca", "social_force"]);
        let seed = self.below(1000);
        self.line(format!("duration_s = 60\ndt_s = {step}\nseed = {seed}"));
        self.line(format!("coupling = '{coupling}'\nplanner = '{planner}'"));
    }

    fn ground(&mut self) {
        if self.flip() {
            let half_m = SQUARE_M + 0.5;
            let hole = self.polygon(1.5);
            self.line(format!(
                "[[walkable]]\npolygon_m = [[-{half_m}, -{half_m}], [{half_m}, -{half_m}], [{half_m}, {half_m}], \
                 [-{half_m}, {half_m}]]\nholes_m = [{hole}]"
            ));
        }
        if self.flip() {
            // United with the square where it reaches into it; else ground apart.
            let wing = self.polygon(4.0);
            self.line(format!("[[walkable]]\npolygon_m = {wing}"));
        }
        for _ in 0..self.below(POLYGONS_MAX + 1) {
            let size_m = self.one(&[0.3, 1.0, 1.0, 2.0]);
            let polygon = self.polygon(size_m);
            self.line(format!("[[obstacles]]\npolygon_m = {polygon}"));
        }
        if self.flip() {
            self.doors();
        }
        if self.below(3) == 0 {
            let size_m = self.one(&[2.0, 5.0, 14.0]);
            let polygon = self.polygon(size_m);
            self.line(format!("[[obstacles]]\nkind = 'enclosure'\npolygon_m = {polygon}"));
        }
    }

    /// A wall across the square with a gap, and in it a door of one leaf or of two that open apart.
    fn doors(&mut self) {
        let (at, low) = (self.between(-6.0, 6.0), self.between(-5.0, 3.0));
        let high = low + self.between(0.5, 3.0);
        let (is_upright, half_m) = (self.flip(), self.one(&[0.05, 0.15]));
        let leaf = |from: f64, to: f64| {
            let corners = [[at - half_m, from], [at + half_m, from], [at + half_m, to], [at - half_m, to]];
            let corners = corners.map(|[x, y]| if is_upright { [x, y] } else { [y, x] });
            let corners: Vec<String> = corners.iter().map(|[x, y]| format!("[{x:.2}, {y:.2}]")).collect();
            format!("[[obstacles]]\npolygon_m = [{}]", corners.join(", "))
        };
        self.line(leaf(-1.2 * SQUARE_M, low));
        self.line(leaf(high, 1.2 * SQUARE_M));
        let middle = 0.5 * (low + high);
        let signals = self.one(&[["gate", "gate"], ["gate", "light"]]);
        self.line(leaf(low, middle) + &format!("\nopen = '{}'", signals[0]));
        self.line(leaf(middle, high) + &format!("\nopen = '{}'", signals[1]));
    }

    /// A star of three to eight corners about a point: blocks, splinters, and niches.
    fn polygon(&mut self, size_m: f64) -> String {
        let (centre_m, corners) = (self.point(), 3 + self.below(6));
        let stretch = [self.one(&[1.0, 1.0, 0.1]), 1.0];
        let mut text = Vec::new();
        for corner in 0..corners {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * corner as f64 / corners as f64);
            let radius_m = size_m * self.between(0.3, 1.0);
            let [x, y] = [0, 1].map(|axis| centre_m[axis] + stretch[axis] * radius_m * [cos, sin][axis]);
            text.push(format!("[{x:.2}, {y:.2}]"));
        }
        format!("[{}]", text.join(", "))
    }

    /// An area, as the keys of a table.
    fn area(&mut self) -> String {
        let ([x, y], [width, height]) = (self.point(), [self.between(0.3, 3.0), self.between(0.3, 3.0)]);
        match self.below(4) {
            0 => format!("point_m = [{x:.2}, {y:.2}]"),
            1 => format!("circle_m = [{x:.2}, {y:.2}, {width:.2}]"),
            2 => format!("polygon_m = [[{x:.2}, {y:.2}], [{:.2}, {y:.2}], [{x:.2}, {:.2}]]", x + width, y + height),
            _ => format!("rect_m = [{x:.2}, {y:.2}, {:.2}, {:.2}]", x + width, y + height),
        }
    }

    fn behaviour(&mut self) {
        self.line("[signals.light]\ngreen_s = 2\nred_s = 1.5\noffset_s = 0.5\n[areas.hall]\nrect_m = [-3, -3, 3, 3]");
        let offset_s = self.one(&[0.0, 0.7]);
        self.line(format!("[signals.gate]\ngreen_s = 0.8\nred_s = 0.7\noffset_s = {offset_s}"));
        for set in 0..SETS {
            self.goals(set);
        }
        let states = 1 + self.below(STATES_MAX);
        for state in 0..states {
            self.state(state, states);
        }
        let removal = self.one(&["true", "'at_once'"]);
        self.line(format!("[states.gone]\nremove = {removal}"));
    }

    fn goals(&mut self, set: usize) {
        let choice = self.one(&CHOICES);
        self.line(format!("[goals.g{set}]"));
        if set == SETS - 1 && self.flip() {
            let [x, y] = self.point();
            let places: Vec<String> =
                (0..4).map(|place| format!("{{ point_m = [{:.2}, {y:.2}] }}", x + 0.7 * f64::from(place))).collect();
            return self.line(format!("queue = true\nareas = [{}]", places.join(", ")));
        }
        let mut areas = Vec::new();
        for _ in 0..1 + self.below(3) {
            let area = self.area();
            let more = self.one(&["", ", capacity = 1", ", weight = 3", ", facing_deg = 90"]);
            areas.push(format!("{{ {area}{more} }}"));
        }
        let more = self.one(&["", "capacity = 2", "copies_m = [[0, 0], [1, 0.5]]"]);
        self.line(format!("choose = {choice}\n{more}\nareas = [{}]", areas.join(", ")));
    }

    fn state(&mut self, state: usize, states: usize) {
        let set = self.below(SETS);
        let goals = format!("go = 'g{set}'");
        let movement = if self.below(3) > 0 { goals } else { self.one(&MOVEMENTS).to_owned() };
        let settings = self.one(&SETTINGS);
        let mut then = Vec::new();
        for _ in 0..self.below(4) {
            let (when, next) = (self.one(&CONDITIONS), self.below(states));
            let to = self.one(&["next", "next", "back", "gone", "drawn"]);
            let to = match to {
                "next" => format!("'s{next}'"),
                "drawn" => format!("{{ s{next} = 1, gone = 0.2 }}"),
                other => format!("'{other}'"),
            };
            then.push(format!("{{ when = {when}, to = {to} }}"));
        }
        self.line(format!("[states.s{state}]\n{movement}\n{settings}\nthen = [{}]", then.join(", ")));
    }

    /// The keys that agents and sources share.
    fn journey(&mut self) {
        let [x, y] = self.point();
        match self.below(3) {
            0 => self.line(format!("goals_m = [[{x:.2}, {y:.2}]]")),
            1 => self.line(format!("goal_offset_m = [{:.2}, {:.2}]\nstate = 's0'", 0.2 * x, 0.2 * y)),
            _ => self.line("state = 's0'"),
        }
        let leaves = self.one(&["stay", "leave", "leave_at_once"]);
        let speed = self.one(&["preferred_speed_mps = 0.6", "profile = 'any'", "profile = { any = 1, slow = 2 }"]);
        let wait = self.one(&["", "pre_movement_s = { uniform = [0, 2] }"]);
        let groups =
            self.one(&["", "", "groups = { 1 = 1, 2 = 2, 3 = 1 }", "groups = { 4 = 1 }\ngroup_spacing_m = 0.5"]);
        self.line(format!("at_goal = '{leaves}'\n{speed}\n{wait}\n{groups}"));
    }

    fn agents(&mut self) {
        self.line(
            "[profiles.any]\npreferred_speed_mps = { normal = [1.3, 0.3] }\nradius_m = { uniform = [0.15, 0.35] }",
        );
        self.line("[profiles.slow]\ninherits = 'any'\npreferred_speed_mps = 0.3");
        for _ in 0..1 + self.below(2) {
            let ([x, y], count) = (self.point(), 1 + self.below(AGENTS_MAX));
            let (right, top) = (x + self.between(2.0, 8.0), y + self.between(2.0, 8.0));
            self.line(format!(
                "[[agents]]\narea = {{ rect_m = [{x:.2}, {y:.2}, {right:.2}, {top:.2}], count = {count} }}"
            ));
            self.journey();
        }
    }

    fn sources(&mut self) {
        for _ in 0..self.below(3) {
            let ([x, y], rate_per_s) = (self.point(), self.between(0.1, 2.0));
            let (right, top) = (x + self.between(0.0, 2.0), y + self.between(0.0, 2.0));
            let place = match self.below(4) {
                0 => format!("at_m = [{x:.2}, {y:.2}]"),
                1 => format!("rect_m = [{x:.2}, {y:.2}, {right:.2}, {top:.2}]"),
                2 => format!("circle_m = [{x:.2}, {y:.2}, {:.2}]", right - x),
                _ => format!("polygon_m = {}", self.polygon(3.0)),
            };
            let times = match self.below(3) {
                0 => format!("schedule = [[0, 1, {rate_per_s:.2}], [1, 1.5, 0], [2, 60, {:.2}]]", 4.0 * rate_per_s),
                1 => "schedule = [[0, 2], [0.5, 1], [0.5, 3], [2, 9]]".to_owned(),
                _ => format!("rate_per_s = {rate_per_s:.2}"),
            };
            self.line(format!("[[sources]]\n{place}\n{times}\ncount = 15"));
            self.journey();
        }
    }

    fn events(&mut self) {
        for event in 0..self.below(3) {
            let when = self.one(&EVENTS);
            let change = self.one(&[
                "to = 's0'",
                "from = ['s0', 'follow_path']\nto = 'gone'",
                "signals = { gate = 'green' }",
                "signals = { gate = 'red', light = 'phases' }",
                "to = 's0'\nsignals = { gate = 'phases' }",
            ]);
            self.line(format!("[events.e{event}]\nwhen = {when}\n{change}"));
        }
    }

    /// A rectangle along the axes, or turned.
    fn one_way_zone(&mut self) {
        let ([x, y], length_m, width_m) = (self.point(), self.between(0.2, 4.0), self.between(0.2, 4.0));
        if self.flip() {
            let one_way_deg = self.one(&[0, 90, 180, -90]);
            let (to_x, to_y) = (x + length_m, y + width_m);
            return self.line(format!(
                "[[zones]]\nrect_m = [{x:.2}, {y:.2}, {to_x:.2}, {to_y:.2}]\none_way_deg = {one_way_deg}"
            ));
        }
        let one_way_deg = self.between(-180.0, 180.0);
        let (sin, cos) = libm::sincos(one_way_deg.to_radians());
        let corner = |[along_m, left_m]: [f64; 2]| {
            format!("[{:.4}, {:.4}]", x + cos * along_m - sin * left_m, y + sin * along_m + cos * left_m)
        };
        let corners = [[0.0, 0.0], [length_m, 0.0], [length_m, width_m], [0.0, width_m]].map(corner).join(", ");
        self.line(format!("[[zones]]\npolygon_m = [{corners}]\none_way_deg = {one_way_deg:.3}"));
    }

    fn zones_and_measures(&mut self) {
        if self.flip() {
            let polygon = self.polygon(2.5);
            let closed = self.one(&["'any'", "'slow'", "'any', 'slow'"]);
            self.line(format!("[[zones]]\npolygon_m = {polygon}\nclosed_to = [{closed}]"));
        }
        for _ in 0..self.below(3) {
            let ([x, y], size_m, factor) = (self.point(), self.between(0.5, 3.0), self.one(&[0.01, 0.5, 2.0]));
            self.line(format!("[[zones]]\ncircle_m = [{x:.2}, {y:.2}, {size_m:.2}]\nspeed_factor = {factor}"));
        }
        if self.below(3) == 0 {
            let polygon = self.polygon(2.5);
            let states = self.one(&["'s0'", "'gone', 's0'", "'follow_path'"]);
            self.line(format!("[[zones]]\npolygon_m = {polygon}\nclosed_in = [{states}]"));
        }
        for _ in 0..self.below(4) {
            self.one_way_zone();
        }
        let ([x, y], [to_x, to_y]) = (self.point(), self.point());
        self.line(format!("[[measure]]\nname = 'line'\nline_m = [[{x:.2}, {y:.2}], [{to_x:.2}, {to_y:.2}]]"));
        self.line("[[measure]]\nname = 'area'\nrect_m = [-4, -4, 4, 4]\n[[measure]]\nname = 'out'\negress = true");
    }
}
