//! What lies on the ground besides walls: zones, zones that states close, doors, markings, measured lines and areas; and
//! cameras. World, metres.

pub(crate) mod barred_goals;
pub(crate) mod camera_spec;
pub(crate) mod door;
pub(crate) mod marking;
pub(crate) mod measure_spec;
pub(crate) mod shot_spec;
pub(crate) mod state_zones;
pub(crate) mod zone_spec;
