//! The passes that can be requested.

use std::collections::BTreeSet;
use std::fmt;
use std::str::FromStr;

/// A pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Pass {
    /// Depth.
    Depth,
    /// Normals.
    Normal,
    /// Positions.
    Position,
    /// Motion to the next frame and to the one before.
    Motion,
    /// Cryptomatte by agent.
    Agent,
    /// Cryptomatte by group of agents.
    Group,
    /// Cryptomatte by material.
    Material,
    /// Ids of agents.
    Id,
}

impl Pass {
    /// All passes, in the order of their channels here.
    pub const ALL: [Self; 8] =
        [Self::Depth, Self::Normal, Self::Position, Self::Motion, Self::Agent, Self::Group, Self::Material, Self::Id];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Depth => "z",
            Self::Normal => "n",
            Self::Position => "p",
            Self::Motion => "motion",
            Self::Agent => "agent",
            Self::Group => "group",
            Self::Material => "material",
            Self::Id => "id",
        }
    }
}

/// The passes of a sequence, each once.
///
/// ```
/// use fbcrowd_render::passes::{Pass, PassSet};
///
/// let passes: PassSet = "z,motion".parse()?;
/// assert!(passes.holds(Pass::Depth) && !passes.holds(Pass::Normal));
/// assert!("z,depth".parse::<PassSet>().unwrap_err().contains("`depth`"));
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PassSet(BTreeSet<Pass>);

impl PassSet {
    /// Whether no pass is requested.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The Cryptomattes among them.
    pub(crate) fn mattes(&self) -> impl Iterator<Item = Pass> {
        self.0.iter().copied().filter(|pass| matches!(pass, Pass::Agent | Pass::Group | Pass::Material))
    }

    /// Whether a pass is requested.
    pub fn holds(&self, pass: Pass) -> bool {
        self.0.contains(&pass)
    }
}

impl FromStr for PassSet {
    type Err = String;

    /// Names with commas between them; `all` for all passes.
    fn from_str(text: &str) -> Result<Self, String> {
        if text == "all" {
            return Ok(Self(Pass::ALL.into()));
        }
        let of_name = |name: &str| {
            let pass = Pass::ALL.into_iter().find(|pass| pass.name() == name);
            pass.ok_or_else(|| {
                let names = Pass::ALL.map(Pass::name).join(", ");
                format!("no pass is called `{name}`; the passes are {names}, or `all`")
            })
        };
        text.split(',').map(|name| of_name(name.trim())).collect::<Result<_, _>>().map(Self)
    }
}

impl fmt::Display for PassSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.iter().map(|pass| pass.name()).collect::<Vec<_>>().join(","))
    }
}
