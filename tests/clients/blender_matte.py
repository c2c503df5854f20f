#!/usr/bin/env python3
"""Blender's Cryptomatte node gives the matte of an agent: usage blender_matte.py FRAME.exr WIDTH HEIGHT NAME COVERAGE.

COVERAGE is the sum of the agent's coverages in the file, pixels.
"""

import sys
import tempfile
from pathlib import Path

import bpy


def main():
    path, width, height, name, coverage = sys.argv[1:]
    scene = bpy.context.scene
    tree = bpy.data.node_groups.new("matte", "CompositorNodeTree")
    scene.compositing_node_group = tree
    matte = tree.nodes.new("CompositorNodeCryptomatteV2")
    matte.source, matte.image = "IMAGE", bpy.data.images.load(str(Path(path).resolve()))
    matte.layer_name, matte.matte_id = "CryptoAsset", name
    tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    tree.links.new(matte.outputs["Matte"], tree.nodes.new("NodeGroupOutput").inputs[0])
    render = scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = int(width), int(height), 100
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.view_settings.view_transform = "Raw"
    scene.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(scene.camera)
    render.engine, scene.cycles.samples = "CYCLES", 1
    with tempfile.TemporaryDirectory() as folder:
        render.filepath = str(Path(folder, "matte.exr"))
        bpy.ops.render.render(write_still=True)
        pixels = list(bpy.data.images.load(render.filepath).pixels)
    found = sum(pixels[0::4])
    assert abs(found - float(coverage)) < 0.01, f"Blender's matte of {name} covers {found} pixels, the file {coverage}"
    print(f"Blender {bpy.app.version_string}: the matte of {name} covers {found} pixels, as in the file")


if __name__ == "__main__":
    main()
