//! The report of a character: its sizes, the joint of each role, what was left out, and its feet in a recording.

use std::path::Path;

use fbcrowd_jobs::character::{LoadedCharacter, size_warning};
use fbcrowd_sim::measures::CharacterSoles;
use motiondb::body::{Joint, Skeleton};
use motiondb::character::{Character, CharacterExtra, CharacterFit};
use motiondb_compiler::character::{CharacterNote, RolesFrom};
use schemars::JsonSchema;
use serde::Serialize;

use crate::report::plain_text::one_line;

/// A character alone.
#[derive(JsonSchema, Serialize)]
pub(crate) struct CharacterInspection {
    /// The character.
    pub(crate) character: CharacterReport,
}

/// A figure that bodies wear.
#[derive(JsonSchema, Serialize)]
pub(crate) struct CharacterReport {
    /// The file, as named.
    file: String,
    /// Name of the character.
    name: String,
    /// Checksum of its `.fbchar`, eight hexadecimal digits.
    checksum: String,
    /// How the roles of joints were found: `vrm` (its bone table) or `bind_pose` (names and shape); null of a `.fbchar`.
    roles_from: Option<&'static str>,
    /// Every role of the canonical humanoid and the joint that has it, in order.
    roles: Vec<RoleOfJoint>,
    /// Joints beside the 22 roles that poses move: of fingers and toes, and twist bones; left out where there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    extra_joints: Vec<ExtraOfJoint>,
    /// Meshes that are worn, by the nodes that draw them.
    meshes: Vec<MeshReport>,
    /// Width and height of each texture that is kept, pixels.
    textures_px: Vec<[u32; 2]>,
    /// Number of joints that are kept.
    joints: usize,
    /// Number of vertices.
    vertices: usize,
    /// Number of triangles.
    triangles: usize,
    /// Number of materials.
    materials: usize,
    /// Height of the hip joints over the soles, m.
    hips_over_soles_m: f32,
    /// Thigh plus shank, m.
    leg_length_m: f32,
    /// Height over the soles, m.
    height_m: f32,
    /// Radius of the disc around trunk and hanging arms, m.
    radius_m: f32,
    /// What was left out or assumed.
    notes: Vec<NoteReport>,
    /// How the character wears the bodies of a recording; only with `--recording`.
    #[serde(skip_serializing_if = "Option::is_none")]
    fit: Option<FitReport>,
    /// What its feet do in a recording; only with `--recording`.
    #[serde(skip_serializing_if = "Option::is_none")]
    soles: Option<SolesReport>,
}

/// A role and its joint.
#[derive(JsonSchema, Serialize)]
struct RoleOfJoint {
    /// Name of the role.
    role: &'static str,
    /// Name of the joint in the file; null where no joint has the role.
    joint: Option<String>,
}

/// An extra joint and its joint.
#[derive(JsonSchema, Serialize)]
struct ExtraOfJoint {
    /// Name of the extra joint, such as `left_index_1`.
    extra: String,
    /// Name of the joint in the file.
    joint: String,
}

/// A mesh of a character.
#[derive(JsonSchema, Serialize)]
struct MeshReport {
    /// Name of the node that draws it.
    name: String,
    /// Number of triangles.
    triangles: u32,
}

/// A note about a character.
#[derive(JsonSchema, Serialize)]
struct NoteReport {
    /// Name of the finding; it does not change between versions.
    code: &'static str,
    /// The note as a sentence.
    text: String,
}

/// A character on the skeleton of a recording.
#[derive(JsonSchema, Serialize)]
struct FitReport {
    /// Factor of all lengths of the character.
    scale: f32,
    /// Whether the scale differs from 1 by more than a tenth.
    is_scaled: bool,
    /// Height of the crowd's hips over the soles, m.
    crowd_hips_over_soles_m: f32,
    /// Height of the character as worn, m.
    worn_height_m: f32,
}

/// The feet of a character in a recording.
#[derive(JsonSchema, Serialize)]
struct SolesReport {
    /// Number of agents.
    agents: usize,
    /// Number of frames.
    frames: usize,
    /// Mean speed of the character's planted contact points, cm/s; null where no foot is ever planted.
    planted_slide_cm_s: Option<f64>,
    /// The same of the recorded bodies, cm/s.
    crowd_slide_cm_s: Option<f64>,
    /// Greatest depth of a sole under the ground, cm.
    sole_depth_cm: f64,
    /// Mean over frames and agents of the greatest depth of the soles, cm.
    mean_sole_depth_cm: f64,
    /// Greatest depth of the recorded bodies' own soles, cm.
    crowd_sole_depth_cm: f64,
    /// Mean height of planted feet over the ground, cm; null where no foot is ever planted.
    planted_height_cm: Option<f64>,
}

impl From<CharacterSoles> for SolesReport {
    fn from(soles: CharacterSoles) -> Self {
        Self {
            agents: soles.agents,
            frames: soles.frames,
            planted_slide_cm_s: soles.planted_slide_cm_s,
            crowd_slide_cm_s: soles.crowd_slide_cm_s,
            sole_depth_cm: soles.sole_depth_cm,
            mean_sole_depth_cm: soles.mean_sole_depth_cm,
            crowd_sole_depth_cm: soles.crowd_sole_depth_cm,
            planted_height_cm: soles.planted_height_cm,
        }
    }
}

impl CharacterReport {
    pub(crate) fn new(file: &Path, loaded: &LoadedCharacter) -> Self {
        let LoadedCharacter { character, checksum, roles_from, notes } = loaded;
        let note = |note: &CharacterNote| NoteReport { code: note.code(), text: note.to_string() };
        Self {
            file: file.display().to_string(),
            name: character.name.clone(),
            checksum: format!("{checksum:08x}"),
            roles_from: roles_from.map(|from| match from {
                RolesFrom::Vrm => "vrm",
                RolesFrom::BindPose => "bind_pose",
            }),
            roles: roles(character),
            extra_joints: extra_joints(character),
            meshes: meshes(character),
            textures_px: character.textures.iter().map(|texture| texture.size_px).collect(),
            joints: character.joints.len(),
            vertices: character.mesh.positions_m.len(),
            triangles: character.mesh.triangles.len(),
            materials: character.mesh.materials.len(),
            hips_over_soles_m: character.hips_over_soles_m,
            leg_length_m: character.leg_length_m,
            height_m: character.height_m,
            radius_m: character.radius_m,
            notes: notes.iter().map(note).collect(),
            fit: None,
            soles: None,
        }
    }

    /// Adds how the character wears the bodies of a recording.
    pub(crate) fn add_recording(&mut self, character: &Character, skeleton: &Skeleton, soles: CharacterSoles) {
        let fit = CharacterFit::new(character, skeleton);
        self.fit = Some(FitReport {
            scale: fit.scale,
            is_scaled: fit.is_scaled(),
            crowd_hips_over_soles_m: fit.hips_over_soles_m,
            worn_height_m: fit.height_m(),
        });
        if let Some(text) = size_warning(&fit) {
            self.notes.push(NoteReport { code: "scaled_legs", text });
        }
        self.soles = Some(soles.into());
    }

    /// The report as tables.
    pub(crate) fn text(&self) -> String {
        let mut text = format!("{:<20}joint\n", "role");
        for RoleOfJoint { role, joint } in &self.roles {
            text += &format!("{role:<20}{}\n", joint.as_deref().map_or("–".into(), one_line));
        }
        for ExtraOfJoint { extra, joint } in &self.extra_joints {
            text += &format!("{extra:<20}{}\n", one_line(joint));
        }
        let row = |name: &str, value: String| format!("{name:<20}{value}\n");
        let counts = [(self.joints, "joints"), (self.vertices, "vertices"), (self.triangles, "triangles")];
        let counts: Vec<String> = counts.iter().map(|(count, what)| format!("{count} {what}")).collect();
        text += &row("\ncharacter", format!(" {} ({})", one_line(&self.name), counts.join(", ")));
        let hips = format!("hips {:.3} m over the soles, legs {:.3} m", self.hips_over_soles_m, self.leg_length_m);
        text += &row("sizes", format!("height {:.3} m, {hips}, radius {:.3} m", self.height_m, self.radius_m));
        let meshes: Vec<String> = self.meshes.iter().map(|mesh| one_line(&mesh.name)).collect();
        text += &row("meshes", meshes.join(", "));
        if !self.textures_px.is_empty() {
            let sizes: Vec<String> =
                self.textures_px.iter().map(|[width, height]| format!("{width} × {height}")).collect();
            text += &row("textures", format!("{} pixels", sizes.join(", ")));
        }
        text += &row("checksum", self.checksum.clone());
        if let Some(FitReport { scale, crowd_hips_over_soles_m, worn_height_m, .. }) = &self.fit {
            let hips = format!("hips of the crowd {crowd_hips_over_soles_m:.3} m");
            text += &row("worn", format!("scaled by {scale:.3} ({hips}), height {worn_height_m:.3} m"));
        }
        if let Some(soles) = &self.soles {
            let slide = |slide: Option<f64>| slide.map_or("–".into(), |slide| format!("{slide:.2} cm/s"));
            let [own, crowd] = [soles.planted_slide_cm_s, soles.crowd_slide_cm_s].map(slide);
            text += &row("planted slide", format!("{own} (the bodies' own {crowd})"));
            let depths = [soles.sole_depth_cm, soles.mean_sole_depth_cm, soles.crowd_sole_depth_cm];
            let [worst, mean, crowd] = depths.map(|depth| format!("{depth:.2} cm"));
            text += &row("soles under ground", format!("{worst} at most, {mean} on average (the bodies' own {crowd})"));
        }
        for note in &self.notes {
            text += &row("note", one_line(&note.text));
        }
        text
    }
}

fn meshes(character: &Character) -> Vec<MeshReport> {
    let mut meshes: Vec<MeshReport> = Vec::new();
    for material in &character.mesh.materials {
        match meshes.iter_mut().find(|mesh| mesh.name == material.mesh) {
            Some(mesh) => mesh.triangles += material.triangle_count,
            None => meshes.push(MeshReport { name: material.mesh.clone(), triangles: material.triangle_count }),
        }
    }
    meshes
}

fn roles(character: &Character) -> Vec<RoleOfJoint> {
    let role = |role: Joint| RoleOfJoint {
        role: role.name(),
        joint: character.joint(role).map(|joint| character.joints[joint].name.clone()),
    };
    Joint::ALL.into_iter().map(role).collect()
}

fn extra_joints(character: &Character) -> Vec<ExtraOfJoint> {
    let extra = |known: &CharacterExtra| ExtraOfJoint {
        extra: known.extra.name(),
        joint: character.joints[known.joint as usize].name.clone(),
    };
    character.extra.iter().map(extra).collect()
}
