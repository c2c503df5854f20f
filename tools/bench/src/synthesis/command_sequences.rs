//! Commands to bodies whose quality is measured (`fbcrowd bench quality`): steady walks, and changes.
//!
//! A command sequence is a list of commands, each active until a time. It begins with standing. Each body shortens the
//! standing by a part of a step more than the one before, so that the changes meet every phase of the cycle. Metres,
//! seconds, radians.

use std::f32::consts::{FRAC_PI_2, PI};

use fbcrowd_sim::maths::SplitMix64;
use fbcrowd_sim::planning::Plan;
use fbcrowd_sim::synthesis::HmsParams;
use fbcrowd_sim::synthesis::command::plan_requesting;
use glam::Vec2;
use motiondb::body::Root;
use motiondb::motion::{MotionDb, Parameters};

/// Duration until a steady walk is steady, s.
const SETTLING_S: f32 = 4.0;
/// Duration of the measurement of a steady walk, s: about eight steps.
const MEASURED_S: f32 = 4.0;
/// Duration of standing at the beginning, s: more than a stride.
const STANDING_S: f32 = 1.4;
/// Duration of a command between two changes, s: the body finishes the change and walks again.
const COMMAND_S: f32 = 2.5;
/// Number of commands in the random walk.
const RANDOM_COMMANDS: usize = 24;
/// Least and greatest duration of a command in the random walk, s.
const RANDOM_COMMAND_S: [f32; 2] = [0.4, 2.4];
/// Seed of the random walk.
const SEED: u64 = 6;

/// A command to a body.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Command {
    /// Stand.
    Stand,
    /// Walk with these parameters; the facing follows from them.
    Walk(Parameters),
    /// Walk in a direction of the world; the facing turns into it.
    Towards {
        /// Direction, rad.
        angle_rad: f32,
        /// Speed, m/s.
        speed_mps: f32,
    },
}

/// A command and the time of its end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TimedCommand {
    pub(crate) command: Command,
    pub(crate) until_s: f32,
}

/// A list of commands.
#[derive(Clone, Debug)]
pub(crate) struct CommandSequence {
    pub(crate) name: &'static str,
    /// Whether the end of the last command is measured. Otherwise every command is, from its change on.
    pub(crate) steady: bool,
    pub(crate) commands: Vec<TimedCommand>,
}

impl Command {
    /// The plan for a body at `root`. The command is exact in the body's frame: a blending body turns its velocity to
    /// the wanted facing (`turns_velocity`), semi-procedural locomotion does not.
    pub(crate) fn plan(self, root: &Root, turns_velocity: bool, params: &HmsParams) -> Plan {
        match self {
            Self::Stand => Plan { facing_rad: root.facing_rad, ..Plan::default() },
            Self::Towards { angle_rad, speed_mps } => {
                Plan { velocity_mps: Vec2::from_angle(angle_rad) * speed_mps, facing_rad: angle_rad, ..Plan::default() }
            }
            Self::Walk(parameters) if turns_velocity => plan_requesting(parameters, root, params),
            Self::Walk(parameters) => {
                let local_mps = parameters.velocity_mps();
                let velocity_mps = Vec2::from_angle(root.facing_rad).rotate(local_mps);
                Plan { velocity_mps, ..plan_requesting(parameters, root, params) }
            }
        }
    }
}

impl CommandSequence {
    /// The command at a time, for a body whose first command ends `early_s` earlier.
    pub(crate) fn at(&self, time_s: f32, early_s: f32) -> Command {
        let until_s = |index: usize| self.commands[index].until_s - if index == 0 { early_s } else { 0.0 };
        let index = (0..self.commands.len()).find(|&index| time_s < until_s(index));
        index.map_or(Command::Stand, |index| self.commands[index].command)
    }

    /// Duration of all commands, s.
    pub(crate) fn seconds(&self) -> f32 {
        self.commands.last().map_or(0.0, |last| last.until_s)
    }

    /// Start and end of each interval that is measured, s.
    pub(crate) fn measured_s(&self) -> Vec<[f32; 2]> {
        if self.steady {
            return vec![[self.seconds() - MEASURED_S, self.seconds()]];
        }
        self.commands.windows(2).map(|pair| [pair[0].until_s, pair[1].until_s]).collect()
    }
}

/// The steady walks, then the changes.
pub(crate) fn command_sequences(db: &MotionDb) -> Vec<CommandSequence> {
    let steady = [
        ("straight, slow", [0.5, 0.0, 0.0]),
        ("straight", [1.1, 0.0, 0.0]),
        ("straight, fast", [1.6, 0.0, 0.0]),
        ("jog", [2.4, 0.0, 0.0]),
        ("curved", [0.9, 30.0, 0.0]),
        ("curved, tight", [0.5, -80.0, 0.0]),
        ("side-step", [0.0, 0.0, 0.3]),
        ("side-step, fast", [0.4, 0.0, -0.8]),
        ("backward", [-0.5, 0.0, 0.0]),
    ];
    let steady = steady.map(|(name, [speed_mps, turn_rate_deg_s, strafe_mps])| {
        let parameters = Parameters { speed_mps, turn_rate_rad_s: turn_rate_deg_s.to_radians(), strafe_mps };
        let commands = timed([(Command::Stand, STANDING_S), (Command::Walk(parameters), SETTLING_S + MEASURED_S)]);
        CommandSequence { name, steady: true, commands }
    });
    steady.into_iter().chain([starts_and_stops(), turns(), sideways(), random_walk(db)]).collect()
}

/// Commands with their durations, s, one after the other.
fn timed(commands: impl IntoIterator<Item = (Command, f32)>) -> Vec<TimedCommand> {
    let mut until_s = 0.0;
    let timed = |(command, seconds)| {
        until_s += seconds;
        TimedCommand { command, until_s }
    };
    commands.into_iter().map(timed).collect()
}

fn starts_and_stops() -> CommandSequence {
    let walks = [0.7, 1.3, 1.8].map(|speed_mps| Command::Towards { angle_rad: 0.0, speed_mps });
    let commands = walks.into_iter().flat_map(|walk| [(Command::Stand, COMMAND_S), (walk, COMMAND_S)]);
    CommandSequence {
        name: "start and stop",
        steady: false,
        commands: timed(commands.chain([(Command::Stand, COMMAND_S)])),
    }
}

fn turns() -> CommandSequence {
    let walks = [(0.0, 1.3), (FRAC_PI_2, 1.3), (-0.7, 1.3), (PI - 0.7, 0.9), (0.3, 1.6)];
    let commands = walks.map(|(angle_rad, speed_mps)| (Command::Towards { angle_rad, speed_mps }, COMMAND_S));
    CommandSequence {
        name: "turns",
        steady: false,
        commands: timed([(Command::Stand, STANDING_S)].into_iter().chain(commands)),
    }
}

/// From walking ahead to the side, back, and to the other side.
fn sideways() -> CommandSequence {
    let walks = [[1.2, 0.0], [0.0, 0.3], [0.8, 0.0], [-0.5, 0.0], [0.0, -0.3], [0.0, 0.3], [1.2, 0.0]];
    let commands = walks.map(|[speed_mps, strafe_mps]| {
        (Command::Walk(Parameters { speed_mps, turn_rate_rad_s: 0.0, strafe_mps }), COMMAND_S)
    });
    CommandSequence {
        name: "sidewards",
        steady: false,
        commands: timed([(Command::Stand, STANDING_S)].into_iter().chain(commands)),
    }
}

/// From one random mean of three examples to the next.
fn random_walk(db: &MotionDb) -> CommandSequence {
    let mut random = SplitMix64::new(SEED, 0);
    let mut share = || 0.5 * (random.within(1.0) as f32 + 1.0);
    let commands = (0..RANDOM_COMMANDS).map(|_| {
        let examples = [0; 3].map(|_| (share() * db.examples.len() as f32) as usize);
        let shares = [0; 3].map(|_| share());
        let terms = examples.iter().zip(shares).map(|(&index, share)| share * db.examples[index].parameters.to_vec3());
        let mean = terms.sum::<glam::Vec3>() / shares.iter().sum::<f32>().max(f32::MIN_POSITIVE);
        let seconds = RANDOM_COMMAND_S[0] + share() * (RANDOM_COMMAND_S[1] - RANDOM_COMMAND_S[0]);
        (Command::Walk(Parameters::from_vec3(mean)), seconds)
    });
    let commands: Vec<(Command, f32)> = [(Command::Stand, STANDING_S)].into_iter().chain(commands).collect();
    CommandSequence { name: "random walk", steady: false, commands: timed(commands) }
}
