//! The agents of two consecutive frames: those in both, those that were removed, and those that were born.

use crate::recording::frame::AgentFrame;

/// The agents of two consecutive frames, each list in the order of ids.
#[derive(Debug, Default)]
pub(crate) struct FramePairs<'a> {
    /// Agents in both frames, before and after the step.
    pub(crate) common: Vec<(&'a AgentFrame, &'a AgentFrame)>,
    /// Agents in the first frame only.
    pub(crate) removed: Vec<&'a AgentFrame>,
    /// Agents in the second frame only.
    pub(crate) born: Vec<&'a AgentFrame>,
}

impl<'a> FramePairs<'a> {
    /// Pairs two frames, whose ids rise.
    pub(crate) fn new(before: &'a [AgentFrame], after: &'a [AgentFrame]) -> Self {
        let mut pairs = Self { common: Vec::with_capacity(after.len()), ..Self::default() };
        let mut later = after.iter().peekable();
        for agent in before {
            while let Some(born) = later.next_if(|next| next.id < agent.id) {
                pairs.born.push(born);
            }
            match later.next_if(|next| next.id == agent.id) {
                Some(next) => pairs.common.push((agent, next)),
                None => pairs.removed.push(agent),
            }
        }
        pairs.born.extend(later);
        pairs
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::population::AgentId;

    #[test]
    fn agents_are_paired_by_id() {
        let frame = |ids: &[u32]| -> Vec<AgentFrame> {
            ids.iter().map(|&id| AgentFrame { id: AgentId(id), ..AgentFrame::default() }).collect()
        };
        let (before, after) = (frame(&[0, 1, 4, 5]), frame(&[1, 2, 5, 6, 7]));
        let pairs = FramePairs::new(&before, &after);
        let ids = |agents: &[&AgentFrame]| agents.iter().map(|agent| agent.id.0).collect::<Vec<_>>();
        assert!(pairs.common.iter().all(|(before, after)| before.id == after.id));
        assert_eq!(ids(&pairs.common.iter().map(|pair| pair.0).collect::<Vec<_>>()), [1, 5]);
        assert_eq!((ids(&pairs.removed), ids(&pairs.born)), (vec![0, 4], vec![2, 6, 7]));
    }
}
