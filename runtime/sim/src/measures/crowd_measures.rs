//! The measures of one simulation (`FbCrowd` App. 11), computed frame by frame with two frames in memory.
//!
//! Each value comes from the file of its measure. Positions are those of the root as synthesised. World, metres,
//! seconds.

use glam::Vec2;
use motiondb::body::{Joints, Skeleton};
use serde::Serialize;

use crate::measures::body_penetration::{BodyPenetration, PosedBody};
use crate::measures::collision_rate::Collisions;
use crate::measures::frame_pairs::FramePairs;
use crate::measures::places::{MeasuredPlaces, PlaceMeasures};
use crate::measures::planted_slide::PlantedSlide;
use crate::measures::root_measures::RootMeasures;
use crate::measures::state_visits::{StateMeasures, StateVisits};
use crate::measures::wall_contact::{HeldDisc, WallContact};
use crate::population::Population;
use crate::recording::error::RecordingError;
use crate::recording::frame::AgentFrame;
use crate::recording::reader::Recording;
use crate::scenario::places::state_zones::StateZones;
use crate::scenario::{CharacterSpec, Scenario};

/// The measures of one simulation, under the keys of `fbcrowd measure --json`.
///
/// ```no_run
/// use std::path::Path;
///
/// use fbcrowd_sim::{Recording, measures};
///
/// let recording = Recording::open(Path::new("antipodal.fbrec"))?;
/// let measures = measures::measure(&recording)?;
/// println!("{} of {} agents arrived, C = {:.4}", measures.arrived, measures.agents, measures.collision_rate);
/// # Ok::<(), fbcrowd_sim::recording::RecordingError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Measures {
    /// N: number of agents that were present at any time.
    pub agents: usize,
    /// Number of agents that were born after the start, or came from a source.
    pub born: usize,
    /// Number of agents that were removed.
    pub removed: usize,
    /// Number of agents that were due at a source at the end and had had no room.
    pub waiting: usize,
    /// Time during which sources had no room for an agent that was due, summed over sources, s.
    pub source_blocked_s: f64,
    /// T: number of steps, frames less one.
    pub steps: usize,
    /// Time step, s.
    pub dt_s: f32,
    /// C: collision rate of discs, Eq. 17.
    pub collision_rate: f64,
    /// Least distance between the centres of any two discs, Eq. 16, m; none of a single agent.
    pub minimum_separation_m: Option<f64>,
    /// A: mean acceleration over all agents and steps, Eq. 18, m/s².
    pub mean_acceleration_mps2: f64,
    /// Mean acceleration over the steps before each agent's arrival, m/s²: waiting at the goal does not dilute it.
    pub mean_acceleration_before_arrival_mps2: f64,
    /// Number of agents that came within 0.5 m of their last goal; those that begin in a state: that entered a final
    /// state, or were removed.
    pub arrived: usize,
    /// Number of agents that stayed below 0.1 m/s for 5 s before arriving.
    pub stalled: usize,
    /// Mean time from birth to arrival over the agents that arrived, s; none where no agent did.
    pub mean_time_to_goal_s: Option<f64>,
    /// Length of the path until the arrival, divided by that of the straight path through the waypoints; mean over the
    /// agents that arrived.
    pub path_over_straight_line: Option<f64>,
    /// Share of the steps before each agent's arrival in which it side-steps at held facing.
    pub strafing_share: f64,
    /// Share of the steps before each agent's arrival in which it walks backward at held facing.
    pub stepping_back_share: f64,
    /// Deepest overlap of the capsules of two bodies, summed over pairs and steps, per agent and step, mm.
    pub body_penetration_mm: f64,
    /// Mean of that overlap over the pairs and steps in which bodies touch, mm; none where none ever did.
    pub body_penetration_touching_mm: Option<f64>,
    /// Greatest overlap of any two bodies, mm.
    pub body_penetration_max_mm: f64,
    /// Share of agents and steps in which a body touches another.
    pub body_touching_share: f64,
    /// Share of agents and frames in which a disc is held at a wall.
    pub wall_disc_share: f64,
    /// Share of agents and frames in which a body reaches into a wall.
    pub wall_body_share: f64,
    /// Share of agents and frames in which a body reaches more than 1 cm into a wall.
    pub wall_body_deep_share: f64,
    /// Greatest depth of a body in a wall, mm.
    pub wall_body_max_mm: f64,
    /// Slide of planted feet until each agent's arrival, cm/s; none where no foot was planted.
    pub planted_slide_cm_s: Option<f64>,
    /// Slide of the examples of the active motion over the same contacts, cm/s.
    pub examples_slide_cm_s: Option<f64>,
    /// Share of all feet and frames until each agent's arrival that are planted.
    pub planted_share: f64,
    /// Mean distance between the synthesised root and the position to which the planned velocity leads in a step, m.
    pub root_tracking_error_m: f64,
    /// Greatest distance between the synthesised root and the position to which the planned velocity leads, m.
    pub root_tracking_worst_m: f64,
    /// Mean angle between facing and displacement, degrees, over the steps before each agent's arrival in which it
    /// walks in the turning set.
    pub heading_error_deg: f64,
    /// Mean angle between facing and displacement, degrees, over all steps before each agent's arrival in which it
    /// walks.
    pub walking_heading_error_deg: f64,
    /// The scenario's states, in their order; none where it has no states.
    pub states: Vec<StateMeasures>,
    /// The scenario's `[[measure]]` tables, in their order.
    pub places: Vec<PlaceMeasures>,
    /// Names of the joints beside the 22 roles that a recording holds, such as `left_index_1`; none where it holds none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub extra_joints: Vec<String>,
}

/// Computes [`Measures`] from frames that come one by one, so that a crowd is measured while it runs.
#[derive(Debug)]
pub struct Measuring {
    skeleton: Skeleton,
    dt_s: f32,
    steps: usize,
    before: Vec<AgentFrame>,
    /// Joints of every agent in the present frame, in the roots' frames, at the agent's stature.
    joints: Vec<Joints>,
    collisions: Collisions,
    roots: RootMeasures,
    slide: PlantedSlide,
    bodies: BodyPenetration,
    walls: WallContact,
    state_zones: StateZones,
    states: StateVisits,
    places: MeasuredPlaces,
    /// Radii of the segments of each character; none where its size is not known.
    character_radii_m: Vec<Vec<f32>>,
}

impl Measuring {
    /// Begins with the start of a scenario. The population must list every agent of the frame; it may list later ones.
    pub fn new(skeleton: &Skeleton, scenario: &Scenario, population: &Population, start: &[AgentFrame]) -> Self {
        let dt_s = scenario.dt_s;
        let mut measuring = Self {
            skeleton: skeleton.clone(),
            dt_s,
            steps: 0,
            before: start.to_vec(),
            joints: Vec::with_capacity(start.len()),
            collisions: Collisions::default(),
            roots: RootMeasures::new(scenario, population, start),
            states: StateVisits::new(scenario, start),
            slide: PlantedSlide::new(start.len(), dt_s),
            bodies: BodyPenetration::new(skeleton),
            walls: WallContact::new(skeleton, scenario),
            state_zones: StateZones::new(scenario),
            places: MeasuredPlaces::new(scenario, start, population.closed_doors(0)),
            character_radii_m: scenario.characters.iter().map(segment_radii_m).collect(),
        };
        measuring.pose(population, start);
        let Self { skeleton, slide, roots, joints, .. } = &mut measuring;
        follow_feet(slide, roots, skeleton, population, start, joints);
        measuring
    }

    /// Adds one step, given every present agent after it, in the order of ids, and a population that lists them.
    pub fn push(&mut self, population: &Population, after: &[AgentFrame]) {
        self.steps += 1;
        self.pose(population, after);
        let frame = self.steps as u32;
        let life = |agent: &AgentFrame| &population.agents[agent.id.index()];
        let mut pairs = FramePairs::new(&self.before, after);
        pairs.common.retain(|(_, after)| !life(after).is_teleported(frame));
        let (before_m, after_m): (Vec<Vec2>, Vec<Vec2>) =
            pairs.common.iter().map(|(before, after)| (before.root.position_m, after.root.position_m)).unzip();
        let radii_m: Vec<f32> = pairs.common.iter().map(|(_, after)| life(after).radius_m(frame)).collect();
        self.collisions.push(&radii_m, &before_m, &after_m);
        let teleported = after.iter().filter(|agent| life(agent).is_teleported(frame));
        teleported.for_each(|agent| self.slide.lift(agent.id.index()));
        let Self { skeleton, slide, roots, joints, .. } = self;
        follow_feet(slide, roots, skeleton, population, after, joints);
        self.roots.push(population, &pairs);
        self.states.push(after);
        let closed = population.closed_doors(frame);
        self.places.set_doors(&closed);
        self.places.push(frame, &pairs, after);
        let radii_m = |agent: &AgentFrame| {
            let character = life(agent).character?;
            self.character_radii_m.get(character as usize).filter(|radii_m| !radii_m.is_empty()).map(Vec::as_slice)
        };
        self.bodies.push(after.iter().zip(&self.joints).map(|(agent, joints)| PosedBody {
            root: &agent.root,
            joints,
            stature: life(agent).stature,
            character_radii_m: radii_m(agent),
        }));
        let held = after.iter().map(|agent| {
            let (own, radius_m) = (life(agent).spec.closed_zones, life(agent).wall_radius_m(frame));
            let state = usize::from(agent.state);
            let closed_zones = self.state_zones.for_walls(own, state, agent.root.position_m, radius_m);
            HeldDisc { radius_m, closed_zones, stature: life(agent).stature }
        });
        let held: Vec<HeldDisc> = held.collect();
        self.walls.set_doors(closed);
        self.walls.push(after, &self.joints, &held);
        self.before.clear();
        self.before.extend_from_slice(after);
    }

    /// Whether every agent is near its last goal now; an agent that was and has been pushed away is not.
    pub fn all_are_at_goals(&self) -> bool {
        self.roots.all_are_at_goals()
    }

    /// The measures after the last frame, of the population at that time.
    pub fn finish(self, population: &Population) -> Measures {
        let Population { agents, sources, .. } = population;
        let blocked_frames: u64 = sources.iter().map(|source| u64::from(source.blocked_frames)).sum();
        let (slide, bodies, walls) = (self.slide.finish(), self.bodies.finish(), self.walls.finish());
        Measures {
            agents: agents.len(),
            born: agents.iter().filter(|life| life.born > 0 || life.source.is_some()).count(),
            removed: agents.iter().filter(|life| life.removed.is_some()).count(),
            waiting: sources.iter().map(|source| source.waiting as usize).sum(),
            source_blocked_s: blocked_frames as f64 * f64::from(self.dt_s),
            steps: self.steps,
            dt_s: self.dt_s,
            collision_rate: self.collisions.rate(),
            minimum_separation_m: self.collisions.least_distance_m(),
            mean_acceleration_mps2: self.roots.acceleration_mps2.value(),
            mean_acceleration_before_arrival_mps2: self.roots.acceleration_before_arrival_mps2.value(),
            arrived: self.roots.arrived(),
            stalled: self.roots.stalled(),
            mean_time_to_goal_s: self.roots.mean_time_to_goal_s(),
            path_over_straight_line: self.roots.path_over_straight_line(),
            strafing_share: self.roots.strafing.value(),
            stepping_back_share: self.roots.stepping_back.value(),
            body_penetration_mm: bodies.mean_mm,
            body_penetration_touching_mm: bodies.touching_mm,
            body_penetration_max_mm: bodies.greatest_mm,
            body_touching_share: bodies.touching_share,
            wall_disc_share: walls.disc_share,
            wall_body_share: walls.body_share,
            wall_body_deep_share: walls.deep_body_share,
            wall_body_max_mm: walls.greatest_depth_mm,
            planted_slide_cm_s: slide.slide_cm_s,
            examples_slide_cm_s: slide.examples_slide_cm_s,
            planted_share: slide.planted_share,
            root_tracking_error_m: self.roots.tracking_error_m.value(),
            root_tracking_worst_m: self.roots.tracking_worst_m,
            heading_error_deg: self.roots.heading_error_deg.value(),
            walking_heading_error_deg: self.roots.walking_heading_error_deg.value(),
            states: self.states.finish(&self.before),
            places: self.places.finish(population),
            extra_joints: Vec::new(),
        }
    }

    fn pose(&mut self, population: &Population, agents: &[AgentFrame]) {
        let stature = |agent: &AgentFrame| population.agents[agent.id.index()].stature;
        let joints = |agent: &AgentFrame| agent.pose.forward_kinematics(&self.skeleton).sized(stature(agent));
        self.joints.clear();
        self.joints.extend(agents.iter().map(joints));
    }
}

fn segment_radii_m(character: &CharacterSpec) -> Vec<f32> {
    character.size.as_ref().map(|size| size.segment_radii_m.clone()).unwrap_or_default()
}

/// Measures a recording, read once from its first frame to its last.
///
/// # Errors
/// If a frame cannot be read.
pub fn measure(recording: &Recording) -> Result<Measures, RecordingError> {
    let header = recording.header();
    let mut agents = Vec::new();
    recording.read_frame(0, &mut agents)?;
    let population = recording.population();
    let mut measuring = Measuring::new(header.skeleton(), &header.scenario, population, &agents);
    for frame in 1..recording.frame_count() {
        recording.read_frame(frame, &mut agents)?;
        measuring.push(population, &agents);
    }
    let extra_joints = header.extra_joints.iter().map(|joint| joint.name.clone()).collect();
    Ok(Measures { extra_joints, ..measuring.finish(population) })
}

/// Measures the feet of agents that had not arrived before: waiting at the goal does not dilute the slide.
fn follow_feet(
    slide: &mut PlantedSlide,
    roots: &RootMeasures,
    skeleton: &Skeleton,
    population: &Population,
    agents: &[AgentFrame],
    joints: &[Joints],
) {
    for (agent, joints) in agents.iter().zip(joints).filter(|(agent, _)| !roots.has_arrived(agent.id)) {
        let index = agent.id.index();
        slide.push_one(index, agent, &skeleton.sized(population.agents[index].stature), joints);
    }
}
