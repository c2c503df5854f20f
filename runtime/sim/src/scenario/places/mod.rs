//! What lies on the ground besides walls: zones, markings, measured lines and areas. World, metres.

pub(crate) mod marking;
pub(crate) mod measure_spec;
pub(crate) mod zone_spec;
