#!/usr/bin/env python3
"""OpenImageIO reads the passes of a camera frame: usage passes.py FRAME.exr.

Checked: types of the channels; that positions project to their own pixels by the header's matrices and lie at their
depths; that normals are unit vectors; that the ids of the manifest are those of the names (Cryptomatte specification
1.2) and cover what `agent.id` shows; that motion forward and backward is opposite where bodies walk evenly. Prints
`NAME COVERAGE`, the agent that covers most pixels, as the last line.
"""

import json
import struct
import sys

import numpy as np
import OpenImageIO as oiio


def murmur3(data):
    """MurmurHash3, x86, 32 bits, seed 0."""
    mask, value = 0xFFFFFFFF, 0
    rotate = lambda word, by: ((word << by) | (word >> (32 - by))) & mask
    scramble = lambda word: rotate(word * 0xCC9E2D51 & mask, 15) * 0x1B873593 & mask
    whole = len(data) // 4 * 4
    for start in range(0, whole, 4):
        value = rotate(value ^ scramble(int.from_bytes(data[start : start + 4], "little")), 13) * 5 + 0xE6546B64 & mask
    if data[whole:]:
        value ^= scramble(int.from_bytes(data[whole:], "little"))
    value ^= len(data)
    value = (value ^ value >> 16) * 0x85EBCA6B & mask
    value = (value ^ value >> 13) * 0xC2B2AE35 & mask
    return value ^ value >> 16


def as_float(bits):
    return np.float32(struct.unpack("<f", struct.pack("<I", bits))[0])


def main():
    path = sys.argv[1]
    picture = oiio.ImageInput.open(path)
    assert picture is not None, f"{path}: {oiio.geterror()}"
    spec = picture.spec()
    names = list(spec.channelnames)
    types = {name: str(kind) for name, kind in zip(names, spec.channelformats)}
    pixels = np.asarray(picture.read_image("float"))
    channel = lambda *of: np.stack([pixels[:, :, names.index(name)] for name in of], axis=2)
    expected = {"R": "half", "Z": "float", "N.X": "half", "P.X": "float", "forward.u": "half", "agent.id": "uint"}
    assert all(types[name] == kind for name, kind in expected.items()), types

    depth = channel("Z")[:, :, 0]
    seen = depth < 1e9
    position, normal = channel("P.X", "P.Y", "P.Z"), channel("N.X", "N.Y", "N.Z")
    assert np.abs(np.linalg.norm(normal[seen], axis=1) - 1).max() < 2e-3
    row = np.concatenate([position[seen], np.ones((seen.sum(), 1))], axis=1)
    matrix = lambda name: np.array(spec.getattribute(name)).reshape(4, 4)
    camera = row @ matrix("worldToCamera")
    near = depth[seen] < 1000  # beyond, floats of world positions are coarse
    assert (np.abs(-camera[:, 2] - depth[seen]) / depth[seen])[near].max() < 1e-4, "positions lie at their depths"
    device = row @ matrix("worldToNDC")
    device = device[:, :2] / device[:, 3:]
    y, x = np.nonzero(seen)
    off = np.abs((device + 1) / 2 * [spec.width, -spec.height] + [0, spec.height] - np.stack([x, y], axis=1) - 0.5)
    assert off[near].max() < 0.51, f"positions project {off[near].max()} pixels beside their pixels"

    bodies = channel("agent.id")[:, :, 0] > 0
    motion = channel("forward.u", "forward.v") + channel("backward.u", "backward.v")
    assert np.median(np.abs(motion[bodies])) < 0.3, "motion forward and backward is opposite"

    manifest = json.loads(spec.getattribute("cryptomatte/f42029d/manifest"))
    # As float, whole numbers would be shares of the greatest one.
    number = names.index("agent.id")
    agents = np.asarray(picture.read_image(0, 0, number, number + 1, "uint"))[:, :, 0]
    coverage, shown = {}, 0
    for name, digits in manifest.items():
        bits = murmur3(name.encode())
        bits ^= 1 << 23 if bits >> 23 & 0xFF in (0, 255) else 0
        assert f"{bits:08x}" == digits, name
        of_rank = lambda rank, sides: channel(*(f"CryptoAsset{rank:02}.{side}" for side in sides))
        ranks = [of_rank(rank, sides) for rank in (0, 1) for sides in ("RG", "BA")]
        covered = sum(np.where(rank[:, :, 0] == as_float(bits), rank[:, :, 1], 0) for rank in ranks)
        coverage[name] = covered.sum()
        own = agents == int(name.split("_")[1]) + 1
        assert (covered[own] > 0).all(), f"{name} covers the pixels that show its id"
        shown += own.sum()
    assert shown == (agents > 0).sum() > 0, "every id is that of a name"
    name = max(coverage, key=coverage.get)
    print(f"{path}: {len(names)} channels, {len(manifest)} agents in the manifest")
    print(name, coverage[name])


if __name__ == "__main__":
    main()
