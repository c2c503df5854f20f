#!/usr/bin/env python3
"""OpenImageIO reads the frames: usage frames.py PNG_FOLDER EXR_FOLDER.

Both folders hold the same frames of one recording. Checked: size, channels, type, frame rate, and that scene-linear EXR
and sRGB PNG show the same picture.
"""

import sys
from pathlib import Path

import numpy as np
import OpenImageIO as oiio

# Half floats and 8-bit sRGB differ by at most this much, in sRGB.
TOLERANCE = 1.5 / 255


def read(path):
    """The specification and the pixels (height, width, channels) of a picture."""
    picture = oiio.ImageInput.open(str(path))
    assert picture is not None, f"{path}: {oiio.geterror()}"
    spec, pixels = picture.spec(), picture.read_image(oiio.FLOAT)
    picture.close()
    return spec, np.asarray(pixels)


def srgb(linear):
    """Scene-linear values as sRGB (IEC 61966-2-1)."""
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def main():
    png_folder, exr_folder = map(Path, sys.argv[1:])
    pngs, exrs = sorted(png_folder.glob("*.png")), sorted(exr_folder.glob("*.exr"))
    assert pngs and [path.stem for path in pngs] == [path.stem for path in exrs], (pngs, exrs)
    for png, exr in zip(pngs, exrs):
        (png_spec, png_pixels), (exr_spec, exr_pixels) = read(png), read(exr)
        assert (png_spec.width, png_spec.height) == (exr_spec.width, exr_spec.height), png
        assert str(png_spec.format) == "uint8" and str(exr_spec.format) == "half", (png_spec.format, exr_spec.format)
        assert exr_spec.getattribute("FramesPerSecond") is not None, f"{exr} states no frame rate"
        difference = np.abs(srgb(exr_pixels[..., :3]) - png_pixels[..., :3]).max()
        assert difference <= TOLERANCE, f"{exr} differs from {png} by {difference:.4f}"
    print(f"OpenImageIO {oiio.VERSION_STRING}: {len(pngs)} PNG and {len(exrs)} EXR frames show the same pictures")


main()
