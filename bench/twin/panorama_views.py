#!/usr/bin/env python3
"""Makes the backgrounds of the table detector's training and test from CC0 panoramas.

    npm pack @pmndrs/assets@1.7.0 && tar xzf pmndrs-assets-1.7.0.tgz
    python3 bench/twin/panorama_views.py package/hdri backgrounds

writes perspective views of 512 x 384 pixels to backgrounds/training and backgrounds/held_out (the
panoramas hall, lab and lobby). It needs numpy, opencv-python and OpenEXR. The panoramas are those of Poly
Haven (CC0), as the package states.
"""

import base64
import pathlib
import re
import sys
import tempfile

import cv2
import numpy as np
import OpenEXR

HELD_OUT = {"hall", "lab", "lobby"}
WIDTH, HEIGHT = 512, 384
VIEWS = 4  # a panorama


def read_panorama(path):
    """Returns the panorama (H x W x 3) in linear RGB of a module that holds an EXR file."""
    coded = re.search(r"base64,([A-Za-z0-9+/=]+)", path.read_text()).group(1)
    with tempfile.NamedTemporaryFile(suffix=".exr") as file:
        file.write(base64.b64decode(coded))
        file.flush()
        return OpenEXR.File(file.name).channels()["RGB"].pixels.astype(np.float32).clip(0, 1e3)


def perspective_view(panorama, yaw, pitch, field_of_view):
    """Returns a view (HEIGHT x WIDTH x 3) as sRGB bytes; angles in rad, up is the first row."""
    focal = 0.5 * WIDTH / np.tan(0.5 * field_of_view)
    x, y = np.meshgrid(np.arange(WIDTH) + 0.5 - WIDTH / 2, np.arange(HEIGHT) + 0.5 - HEIGHT / 2)
    rays = np.stack([x / focal, -y / focal, np.ones_like(x)], axis=-1)
    up = np.cos(pitch) * rays[..., 1] + np.sin(pitch) * rays[..., 2]
    ahead = np.cos(pitch) * rays[..., 2] - np.sin(pitch) * rays[..., 1]
    longitude = yaw + np.arctan2(rays[..., 0], ahead)
    latitude = np.arctan2(up, np.hypot(rays[..., 0], ahead))
    rows, columns = panorama.shape[:2]
    u = (longitude / (2 * np.pi) % 1.0) * columns - 0.5
    v = (0.5 - latitude / np.pi) * rows - 0.5
    seen = cv2.remap(panorama, u.astype(np.float32), v.astype(np.float32), cv2.INTER_LINEAR,
                     borderMode=cv2.BORDER_WRAP)
    seen = np.clip(0.5 * seen / max(1e-6, float(np.median(seen.mean(axis=-1)))), 0.0, None)
    seen = seen / (1.0 + 0.4 * seen)  # keeps windows from burning out
    srgb = np.where(seen < 0.0031308, 12.92 * seen, 1.055 * np.power(seen, 1 / 2.4) - 0.055)
    return (255 * np.clip(srgb, 0, 1)).round().astype(np.uint8)


def main():
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    source, target = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    rng = np.random.default_rng(11)
    for path in sorted(source.glob("*.exr.js")):
        name = path.name.split(".")[0]
        folder = target / ("held_out" if name in HELD_OUT else "training")
        folder.mkdir(parents=True, exist_ok=True)
        panorama = read_panorama(path)
        for view in range(VIEWS):
            yaw = 2 * np.pi * (view + rng.uniform(0, 0.5)) / VIEWS
            pitch = np.radians(rng.uniform(-28, 4))
            seen = perspective_view(panorama, yaw, pitch, np.radians(rng.uniform(60, 95)))
            cv2.imwrite(str(folder / f"{name}_{view}.jpg"), seen[:, :, ::-1],
                        [cv2.IMWRITE_JPEG_QUALITY, 92])


if __name__ == "__main__":
    main()
