//! Textures: colours, pixels that are kept, what their alpha hides, and bounds.

use std::fs;

use motiondb::character::{CutOut, Wrap};
use motiondb_compiler::Outside;
use motiondb_compiler::character::{CharacterNote, CharacterReason, CompiledCharacter, compile_character};
use serde_json::{Value, json};

use crate::figure::{Figure, glb};
use crate::support::{check_rejected, compiled, reason};

/// A PNG file of a checkerboard of two colours, 2 by 2 pixels.
fn checkerboard() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 2, 2);
    encoder.set_color(png::ColorType::Rgba);
    let pixels = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [255, 255, 255, 0]];
    encoder.write_header().unwrap().write_image_data(pixels.as_flattened()).unwrap();
    bytes
}

/// The adult with a texture of this content; each vertex lies in the middle of the same pixel.
fn textured(content: &[u8], uv: [f32; 2]) -> (Value, Vec<u8>) {
    let (mut json, mut bytes) = Figure::adult().document();
    let push = |json: &mut Value, array: &str, value: Value| {
        let array = json[array].as_array_mut().unwrap();
        array.push(value);
        array.len() - 1
    };
    let count = json["accessors"][0]["count"].as_u64().unwrap() as usize;
    let view = json!({ "buffer": 0, "byteOffset": bytes.len(), "byteLength": 8 * count });
    let view = push(&mut json, "bufferViews", view);
    (0..count).for_each(|_| bytes.extend(uv.iter().flat_map(|part| part.to_le_bytes())));
    let accessor = json!({ "bufferView": view, "componentType": 5126, "count": count, "type": "VEC2" });
    let accessor = push(&mut json, "accessors", accessor);
    json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(accessor);
    let view = json!({ "buffer": 0, "byteOffset": bytes.len(), "byteLength": content.len() });
    let view = push(&mut json, "bufferViews", view);
    bytes.extend(content);
    json["images"] = json!([{ "bufferView": view, "mimeType": "image/png", "name": "skin" }]);
    json["textures"] = json!([{ "source": 0 }]);
    json["materials"][0] = json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } });
    json["buffers"][0]["byteLength"] = json!(bytes.len());
    (json, bytes)
}

#[test]
fn colours_come_from_textures() {
    let (json, bytes) = textured(&checkerboard(), [0.75, 0.25]);
    let character = compiled(&glb(&json, &bytes)).character;
    assert!(character.mesh.colours.iter().all(|colour| *colour == [0.0, 1.0, 0.0]), "{:?}", character.mesh.colours[0]);
    // A masked material leaves out what the alpha channel hides.
    let (mut json, bytes) = textured(&checkerboard(), [0.75, 0.75]);
    json["materials"][0]["alphaMode"] = json!("MASK");
    assert_eq!(reason(&glb(&json, &bytes)), CharacterReason::NoMesh);
}

#[test]
fn textures_of_other_formats_are_noted() {
    let (json, bytes) = textured(b"RIFF\0\0\0\0WEBPVP8 ", [0.5, 0.5]);
    let CompiledCharacter { character, notes, .. } = compiled(&glb(&json, &bytes));
    assert_eq!(notes, [CharacterNote::UnreadTextures(vec!["skin".into()])]);
    assert!(character.mesh.colours.iter().all(|colour| *colour == [1.0; 3]));
}

/// A PNG file that states a size, with the pixels of the checkerboard.
fn bomb(side: u16) -> Vec<u8> {
    let mut bomb = checkerboard();
    let [high, low] = side.to_be_bytes();
    // Width and height of the header, and its checksum.
    bomb[16..24].copy_from_slice(&[0, 0, high, low, 0, 0, high, low]);
    let checksum = png_checksum(&bomb[12..29]);
    bomb[29..33].copy_from_slice(&checksum.to_be_bytes());
    bomb
}

#[test]
fn texture_bombs_are_rejected_before_they_are_decoded() {
    let (json, bytes) = textured(&bomb(0xffff), [0.5, 0.5]);
    check_rejected(&json, &bytes, "65535 × 65535 pixels, more than 8192 a side");
    let (json, bytes) = textured(&checkerboard()[..60], [0.5, 0.5]);
    check_rejected(&json, &bytes, "image 0");
    let (json, bytes) = textured(&[0xff, 0xd8, 0xff, 0xc0, 0, 17, 8], [0.5, 0.5]);
    check_rejected(&json, &bytes, "image 0");
}

#[test]
fn many_large_textures_are_rejected_before_one_is_decoded() {
    let (mut json, bytes) = textured(&bomb(8192), [0.5, 0.5]);
    check_rejected(&json, &bytes, "image 0");
    let primitive = json["meshes"][0]["primitives"][0].clone();
    let of_material = |material: usize| {
        let mut primitive = primitive.clone();
        primitive["material"] = json!(material);
        primitive
    };
    json["textures"] = vec![json!({ "source": 0 }); 40].into();
    let material = |index: usize| json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": index } } });
    json["materials"] = (0..40).map(material).collect();
    json["meshes"][0]["primitives"] = (0..40).map(of_material).collect();
    check_rejected(&json, &bytes, "2684354560 pixels in textures");
}

/// CRC-32 of PNG, bit by bit.
fn png_checksum(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| (sum >> 1) ^ (0xedb8_8320 & (sum & 1).wrapping_neg()))
    })
}

#[test]
fn nothing_outside_the_folder_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let inside = folder.path().join("inside");
    fs::create_dir(&inside).unwrap();
    fs::write(folder.path().join("secret.png"), checkerboard()).unwrap();
    let (mut json, bytes) = textured(&checkerboard(), [0.25, 0.25]);
    json["images"][0] = json!({ "uri": "../secret.png" });
    let path = inside.join("figure.glb");
    fs::write(&path, glb(&json, &bytes)).unwrap();
    let rejection = compile_character(&path, Outside::Refused, &[]).unwrap_err().to_string();
    assert!(rejection.contains("`../secret.png` lies outside the document's folder"), "{rejection}");
    let colours = compile_character(&path, Outside::Allowed, &[]).unwrap().character.mesh.colours;
    assert!(colours.iter().all(|colour| *colour == [1.0, 0.0, 0.0]));
}

#[test]
fn pixels_and_coordinates_are_kept() {
    let (mut json, bytes) = textured(&checkerboard(), [0.75, 0.25]);
    json["samplers"] = json!([{ "wrapS": 33071, "wrapT": 33648 }]);
    json["textures"][0]["sampler"] = json!(0);
    json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.5, 1.0, 1.0, 1.0]);
    json["materials"][0]["alphaMode"] = json!("MASK");
    json["materials"][0]["alphaCutoff"] = json!(0.25);
    let character = compiled(&glb(&json, &bytes)).character;
    let [texture] = &character.textures[..] else { panic!("{} textures", character.textures.len()) };
    assert_eq!((texture.size_px, texture.wraps), ([2, 2], [Wrap::Clamp, Wrap::Mirror]));
    assert_eq!(texture.pixels[4..8], [0, 255, 0, 255]);
    assert!(character.mesh.uvs.iter().all(|uv| *uv == [0.75, 0.25]));
    assert!(character.mesh.tints.iter().all(|tint| *tint == [0.5, 1.0, 1.0]));
    let material = &character.mesh.materials[0];
    assert_eq!((material.texture, material.cut_out), (Some(0), CutOut::Below(0.25)));
}

#[test]
fn a_triangle_with_hidden_corners_stays() {
    // Its corners lie in the transparent pixel, its middle in opaque ones.
    let (mut json, mut bytes) = textured(&checkerboard(), [0.75, 0.75]);
    json["materials"][0]["alphaMode"] = json!("MASK");
    let accessor = json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"].as_u64().unwrap() as usize;
    let view = json["accessors"][accessor]["bufferView"].as_u64().unwrap() as usize;
    let start = json["bufferViews"][view]["byteOffset"].as_u64().unwrap() as usize;
    let count = json["accessors"][accessor]["count"].as_u64().unwrap() as usize;
    for vertex in 0..count {
        let uv: [f32; 2] = [0.75 + (vertex % 3) as f32, 0.75];
        for (axis, part) in uv.iter().enumerate() {
            bytes[start + 8 * vertex + 4 * axis..][..4].copy_from_slice(&part.to_le_bytes());
        }
    }
    let character = compiled(&glb(&json, &bytes)).character;
    assert!(!character.mesh.triangles.is_empty());
}

#[test]
fn large_textures_are_halved() {
    let mut content = Vec::new();
    let mut encoder = png::Encoder::new(&mut content, 5000, 10);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.write_header().unwrap().write_image_data(&[200; 50_000]).unwrap();
    let (json, bytes) = textured(&content, [0.5, 0.5]);
    let texture = &compiled(&glb(&json, &bytes)).character.textures[0];
    assert_eq!(texture.size_px, [2500, 5]);
    assert!(texture.pixels.chunks(4).all(|pixel| pixel == [200, 200, 200, 255]));
}
