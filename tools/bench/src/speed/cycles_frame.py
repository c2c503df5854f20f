"""Times a frame of Cycles on one thread of the CPU: usage cycles_frame.py SCENE_FOLDER TURNS [PICTURE.png].

SCENE_FOLDER holds `camera.json` (size in pixels, eye, axes, tangent of the width), and arrays of little-endian numbers:
`positions.f32` and `colours.f32` of vertices, `triangles.u32`. World, metres, z up. Direct light of a sun and of the sky,
4 samples a pixel, no denoising. Prints Blender's version and the least processor time of a frame, s.
"""

import json
import sys
import time
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix, Vector

SAMPLES = 4
GROUND_M = 1000.0


def append_object(name, data, material=None):
    if material is not None:
        data.materials.append(material)
    made = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(made)
    return made


def diffuse(name, colour):
    """A diffuse material of a colour, or of the colours of vertices."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    surface, output = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
    links.new(surface.outputs["BSDF"], output.inputs["Surface"])
    if colour is None:
        attribute = nodes.new("ShaderNodeAttribute")
        attribute.attribute_name = "colour"
        links.new(attribute.outputs["Color"], surface.inputs["Color"])
    else:
        surface.inputs["Color"].default_value = (*colour, 1)
    return material


def append_crowd(folder):
    positions = np.fromfile(folder / "positions.f32", "<f4")
    colours = np.fromfile(folder / "colours.f32", "<f4").reshape(-1, 3)
    corners = np.fromfile(folder / "triangles.u32", "<u4").astype(np.int32)
    mesh = bpy.data.meshes.new("crowd")
    mesh.vertices.add(len(positions) // 3)
    mesh.vertices.foreach_set("co", positions)
    mesh.loops.add(len(corners))
    mesh.loops.foreach_set("vertex_index", corners)
    mesh.polygons.add(len(corners) // 3)
    mesh.polygons.foreach_set("loop_start", np.arange(0, len(corners), 3, dtype=np.int32))
    with_alpha = np.concatenate([colours, np.ones((len(colours), 1), "<f4")], axis=1)
    mesh.color_attributes.new("colour", "FLOAT_COLOR", "POINT").data.foreach_set("color", with_alpha.ravel())
    mesh.update(calc_edges=True)
    mesh.shade_smooth()
    append_object("crowd", mesh, diffuse("crowd", None))


def append_ground():
    corners = [(x * GROUND_M, y * GROUND_M, 0) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    mesh = bpy.data.meshes.new("ground")
    mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
    append_object("ground", mesh, diffuse("ground", (0.45, 0.45, 0.44)))


def append_light():
    sun = bpy.data.lights.new("sun", "SUN")
    sun.energy, sun.angle = 2.5, 0.022
    append_object("sun", sun).rotation_euler = Vector((-0.503, -0.457, 0.733)).to_track_quat("Z", "Y").to_euler()
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.335, 0.365, 0.42, 1)
    bpy.context.scene.world = world


def append_camera(camera):
    data = bpy.data.cameras.new("camera")
    data.sensor_fit, data.sensor_width, data.lens = "HORIZONTAL", 36, 36 / camera["width_tangent"]
    data.clip_end = 5000
    made = append_object("camera", data)
    right, down, forward, eye = (Vector(camera[key]) for key in ("right", "down", "forward", "eye_m"))
    made.matrix_world = Matrix((right, -down, -forward)).transposed().to_4x4()
    made.location = eye
    bpy.context.scene.camera = made


def set_quality(size_px):
    render, cycles = bpy.context.scene.render, bpy.context.scene.cycles
    render.engine, cycles.device = "CYCLES", "CPU"
    render.threads_mode, render.threads = "FIXED", 1
    render.resolution_x, render.resolution_y, render.resolution_percentage = *size_px, 100
    cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = SAMPLES, False, False
    cycles.max_bounces = 0


def main():
    folder, turns = Path(sys.argv[1]), int(sys.argv[2])
    for made in list(bpy.data.objects):
        bpy.data.objects.remove(made)
    camera = json.loads((folder / "camera.json").read_text())
    append_crowd(folder)
    append_ground()
    append_light()
    append_camera(camera)
    set_quality(camera["size_px"])
    if len(sys.argv) > 3:
        bpy.context.scene.render.filepath = sys.argv[3]
    durations_s = []
    for _ in range(turns):
        start_s = time.process_time()
        bpy.ops.render.render(write_still=len(sys.argv) > 3)
        durations_s.append(time.process_time() - start_s)
    print(f"cycles {bpy.app.version_string} {min(durations_s):.3f}")


main()
