#!/usr/bin/env python3
"""A picture of all passes of a camera frame, side by side: usage contact_sheet.py FRAME.exr SHEET.png.

Rows: picture, depth, normals; positions (x, y, z modulo 1 m), motion to the next frame, the matte by agent. Ids are
shown by colours of their bits.
"""

import sys

import numpy as np
import OpenImageIO as oiio


def main():
    source, sheet = sys.argv[1:]
    picture = oiio.ImageInput.open(source)
    assert picture is not None, f"{source}: {oiio.geterror()}"
    names, pixels = list(picture.spec().channelnames), np.asarray(picture.read_image("float"))
    channel = lambda *of: np.stack([pixels[:, :, names.index(name)] for name in of], axis=2)
    depth = channel("Z")
    near = depth[depth < 1e9].min()
    motion = channel("forward.u", "forward.v") / 8 + 0.5
    ids = channel("CryptoAsset00.R").astype(np.float32).view(np.uint32)
    of_bits = np.concatenate([(ids >> shift & 255) / 255 for shift in (0, 8, 16)], axis=2)
    tiles = [
        [channel("R", "G", "B") ** (1 / 2.2), np.repeat(near / depth, 3, axis=2), channel("N.X", "N.Y", "N.Z") / 2 + 0.5],
        [
            channel("P.X", "P.Y", "P.Z") % 1,
            np.concatenate([motion, np.full_like(depth, 0.5)], axis=2),
            of_bits * channel("CryptoAsset00.G"),
        ],
    ]
    image = np.concatenate([np.concatenate(row, axis=1) for row in tiles], axis=0)
    height, width = image.shape[:2]
    out = oiio.ImageOutput.create(sheet)
    out.open(sheet, oiio.ImageSpec(width, height, 3, "uint8"))
    out.write_image(np.ascontiguousarray(np.clip(image, 0, 1), dtype=np.float32))
    out.close()


if __name__ == "__main__":
    main()
