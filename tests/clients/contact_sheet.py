#!/usr/bin/env python3
"""A picture of all passes of a camera frame, side by side: usage contact_sheet.py FRAME.exr SHEET.png.

Rows: picture, depth, normals; positions (x, y, z modulo 1 m), motion to the next frame and to the one before; mattes by
agent, by group and by material; agent.id. Motion is grey where nothing moves, redder to the right, greener upwards. Ids are
shown by colours of their bits, and mattes as the sum of all ranks: an edge shows both sides.
"""

import sys

import numpy as np
import OpenImageIO as oiio

COLUMNS = 3


class Frame:
    """Channels of a file, by name."""

    def __init__(self, path):
        picture = oiio.ImageInput.open(path)
        assert picture is not None, f"{path}: {oiio.geterror()}"
        self.names, self.pixels = list(picture.spec().channelnames), np.asarray(picture.read_image("float"))
        # As float, whole numbers would be shares of the greatest one.
        number = self.names.index("agent.id")
        self.agents = np.asarray(picture.read_image(0, 0, number, number + 1, "uint"))

    def channels(self, *names):
        return np.stack([self.pixels[:, :, self.names.index(name)] for name in names], axis=2)

    def motion(self, layer):
        motion = self.channels(f"{layer}.u", f"{layer}.v")
        motion = motion / (2 * max(np.abs(motion).max(), 1)) + 0.5
        return np.concatenate([motion, np.full_like(motion[:, :, :1], 0.5)], axis=2)

    def matte(self, layer):
        total = np.zeros((*self.pixels.shape[:2], 3), np.float32)
        for name in self.names:
            if name.startswith(layer) and name[-1] in "RB":
                ids = self.channels(name).astype(np.float32).view(np.uint32)
                total += of_bits(ids) * self.channels(name[:-1] + {"R": "G", "B": "A"}[name[-1]])
        return total


def of_bits(ids):
    return np.concatenate([(ids >> shift & 255) / 255 for shift in (0, 8, 16)], axis=2).astype(np.float32)


def main():
    source, sheet = sys.argv[1:]
    frame = Frame(source)
    depth = frame.channels("Z")
    near = depth[depth < 1e9].min()
    # Numbers of neighbours are scattered over all colours.
    agents = frame.agents * np.uint32(0x9E3779B1)
    tiles = [
        np.clip(frame.channels("R", "G", "B"), 0, None) ** (1 / 2.2),
        np.repeat(near / depth, 3, axis=2),
        frame.channels("N.X", "N.Y", "N.Z") / 2 + 0.5,
        frame.channels("P.X", "P.Y", "P.Z") % 1,
        frame.motion("forward"),
        frame.motion("backward"),
        frame.matte("CryptoAsset"),
        frame.matte("CryptoGroup"),
        frame.matte("CryptoMaterial"),
        of_bits(agents >> np.uint32(8)),
    ]
    tiles += [np.full_like(tiles[0], 1)] * (-len(tiles) % COLUMNS)
    rows = [np.concatenate(tiles[first : first + COLUMNS], axis=1) for first in range(0, len(tiles), COLUMNS)]
    image = np.concatenate(rows, axis=0)
    height, width = image.shape[:2]
    out = oiio.ImageOutput.create(sheet)
    out.open(sheet, oiio.ImageSpec(width, height, 3, "uint8"))
    out.write_image(np.ascontiguousarray(np.clip(image, 0, 1), dtype=np.float32))
    out.close()


if __name__ == "__main__":
    main()
