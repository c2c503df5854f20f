//! `remember = "NAME"`: states that share the goal of another one. That one keeps its goal, too.

use std::collections::BTreeMap;
use std::ops::Range;

use toml::Spanned;

use crate::behaviour::{Movement, State};
use crate::scenario::file::behaviour::placed_fault::{PlacedFault, fault};
use crate::scenario::file::behaviour::tables::StateTable;

/// Lets every state that others name remember its goal, and all that share it name the same state. `states` begin with
/// the one that no table describes.
pub(crate) fn share_goals(
    states: &mut [State],
    tables: &BTreeMap<String, Spanned<StateTable>>,
    is_queue: impl Fn(&Movement) -> bool,
) -> Result<(), PlacedFault> {
    let named: Vec<Option<usize>> = states.iter().map(|state| memory(state).map(|of| of as usize)).collect();
    for (index, table) in (1..).zip(tables.values()) {
        let Some(mut owner) = named[index] else { continue };
        let span = table.get_ref().remember.as_ref().map_or_else(|| table.span(), Spanned::span);
        let mut steps = 0;
        while let Some(next) = named[owner].filter(|next| *next != owner) {
            owner = next;
            steps += 1;
            if steps > named.len() {
                return Err(in_a_circle(&span, &states[index].name));
            }
        }
        if !matches!(states[owner].movement, Movement::Goals { .. }) || is_queue(&states[owner].movement) {
            return Err(without_goal(&span, &states[owner].name));
        }
        for sharing in [owner, index] {
            if let Movement::Goals { memory, .. } = &mut states[sharing].movement {
                *memory = Some(owner as u32);
            }
        }
    }
    Ok(())
}

fn memory(state: &State) -> Option<u32> {
    match state.movement {
        Movement::Goals { memory, .. } => memory,
        _ => None,
    }
}

fn in_a_circle(span: &Range<usize>, name: &str) -> PlacedFault {
    let message = format!("`remember` of state `{name}` leads in a circle from state to state");
    fault(span, message, "write `remember = true` in one of these states")
}

fn without_goal(span: &Range<usize>, name: &str) -> PlacedFault {
    let message = format!("state `{name}` has no goal that another state can share");
    fault(span, message, "name a state with `go` to goals that are no queue")
}
