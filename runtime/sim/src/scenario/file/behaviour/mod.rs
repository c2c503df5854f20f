//! The keys of behaviour in a scenario file: goals, states, signals; and the [`Behaviour`](crate::behaviour::Behaviour)
//! that they describe.
//!
//! Enters: the tables as written. Leaves: a behaviour in which every name is an index; or the first mistake, at its
//! position in the text.
//!
//! ```toml
//! [signals.crossing]
//! green_s = 45
//! red_s = 75                          # offset_s = 0: a green phase begins at this time
//!
//! [areas.hall]                        # an area that conditions name: see `area_table.rs`
//! rect_m = [0, 0, 30, 20]
//!
//! [goals.booths]
//! choose = "weighted"                 # "nearest" (default), "farthest", "random", "least_busy", { nearest_of = 3 }
//! capacity = 3                        # of each area; default: any number of agents
//! copies_m = [[0, 0], [6, 0]]         # the areas once at each offset
//! areas = [{ rect_m = [0.5, -1.2, 3.5, -0.5], facing_deg = 90, weight = 2 }]
//! [goals.till]
//! queue = true                        # the areas are its places, the head first
//! areas = [{ point_m = [9, 0] }, { point_m = [8, 0] }]
//!
//! [states.walk]
//! go = "booths"                       # or "own_path", { mirror_m = [0, 0] }, { offset_m = [9, 0] }
//! remember = true                     # or the name of the state whose goal it shares
//! set = { speed_factor = { uniform = [0.9, 1.1] }, remain = true }
//! then = [
//!     { when = { reached_m = 0.2 }, to = "look" },
//!     { when = { any = [{ after_s = 60 }, { green = "crossing" }] }, to = { walk = 0.8, leave = 0.2 } },
//! ]
//! [states.look]
//! stand = { facing = "goal" }         # or {}, { facing_deg = 90 }, { facing_m = [0, 0] }
//! then = [{ when = { after_s = { normal = [5, 2], min = 1, max = 9 } }, to = "back" }]
//! [states.gone]
//! remove = true                       # between two steps of the feet; or "at_once"
//! [states.stroll]
//! walk_mps = [1, 0]
//!
//! [events.alarm]                      # once
//! when = { after_s = 60 }
//! from = ["walk", "look"]             # default: agents of all states
//! to = "gone"
//! signals = { crossing = "red" }      # or "green", "phases"
//! ```

mod area_table;
mod events;
mod goal_tables;
mod names;
mod numbers;
mod placed_fault;
mod shared_goals;
mod tables;
mod transitions;

pub(crate) use area_table::{AreaKeys, AreaTable};
pub(crate) use names::StateNames;
pub(crate) use numbers::{DistributionValue, fixed_number, priority};
pub(crate) use placed_fault::Names;
pub(crate) use tables::{BehaviourTables, EventTable, GoalsTable, SignalTable, StateTable};
