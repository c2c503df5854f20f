//! Names of joints and forks of trunks in the skeletons of other tools (`names.txt`).

/// One tool's humanoid. `%` in a name stands for the side.
#[derive(Clone, Debug)]
pub(crate) struct Names {
    pub(crate) tool: &'static str,
    /// Left, right.
    pub(crate) sides: [&'static str; 2],
    /// From the file's root down to the joint above the pelvis.
    pub(crate) above: Vec<String>,
    pub(crate) pelvis: String,
    /// From the pelvis up; the last one carries the shoulders.
    pub(crate) spine: Vec<String>,
    pub(crate) neck: Vec<String>,
    pub(crate) head: String,
    /// None to two: collar bones, and helpers within the pelvis above the thighs.
    pub(crate) collar: Vec<String>,
    pub(crate) hip_helper: Vec<String>,
    pub(crate) arm: [String; 3],
    pub(crate) leg: [String; 3],
    /// Ball of the foot and on.
    pub(crate) toes: Vec<String>,
    /// Shoulders hang from the neck, thighs from the first spine joint.
    pub(crate) is_biped: bool,
}

/// Every tool of the table.
pub(crate) fn tools() -> Vec<Names> {
    let rows: Vec<&'static str> = include_str!("names.txt").lines().filter(|line| !line.starts_with('#')).collect();
    rows.chunks(2).map(names).collect()
}

fn names(rows: &[&'static str]) -> Names {
    let cells: Vec<&'static str> = rows.iter().flat_map(|row| row.split('|').map(str::trim)).collect();
    let [tool, sides, prefix, above, pelvis, spine, neck, head, "", collar, arm, hip_helper, leg, toes, kind] =
        cells[..]
    else {
        panic!("not a row of names.txt: {rows:?}");
    };
    let word = |word: &str| if word == "-" { String::new() } else { word.replace('~', " ") };
    let words = |cell: &str| cell.split_whitespace().map(word).collect::<Vec<String>>();
    let prefixed = |cell: &str| words(cell).iter().map(|name| word(prefix) + name).collect::<Vec<String>>();
    let some = |cell: &str| if cell == "-" { Vec::new() } else { prefixed(cell) };
    let three = |cell: &str| prefixed(cell).try_into().expect("three names");
    let sides: Vec<&str> = sides.split(' ').map(|side| side.trim_matches('-')).collect();
    Names {
        tool,
        sides: [sides[0], sides[1]],
        above: if above == "-" { Vec::new() } else { words(above) },
        pelvis: prefixed(pelvis).remove(0),
        spine: prefixed(spine),
        neck: some(neck),
        head: prefixed(head).remove(0),
        collar: some(collar),
        hip_helper: some(hip_helper),
        arm: three(arm),
        leg: three(leg),
        toes: some(toes),
        is_biped: kind == "biped",
    }
}

impl Names {
    /// Whether its names state left and right.
    pub(crate) fn states_sides(&self) -> bool {
        !["A", "1", ""].contains(&self.sides[0]) && self.sides != ["B", "A"]
    }
}
