"""Runs COLMAP's structure from motion on FOLDER/photos and writes FOLDER/cameras.json.

The file holds the positions of the placed cameras, the focal length (pixels), the mean reprojection
error (pixels) and the seconds from the first feature to the last adjustment. One camera is shared
by all photos, with radial distortion; nothing is known about its focal length.
"""
import json
import pathlib
import sys
import time

import pycolmap


def main():
    folder = pathlib.Path(sys.argv[1])
    database = folder / "database.db"
    database.unlink(missing_ok=True)
    start = time.monotonic()
    reader = pycolmap.ImageReaderOptions()
    reader.camera_model = "RADIAL"
    pycolmap.extract_features(database, folder / "photos",
                              camera_mode=pycolmap.CameraMode.SINGLE, reader_options=reader)
    pycolmap.match_exhaustive(database)
    models = pycolmap.incremental_mapping(database, folder / "photos", folder)
    seconds = time.monotonic() - start
    if not models:
        raise SystemExit("no model")
    best = max(models.values(), key=lambda model: model.num_reg_images())
    photos = []
    for image in best.images.values():
        if not image.has_pose:
            continue
        photos.append({"index": int(pathlib.Path(image.name).stem),
                       "position": [float(v) for v in image.projection_center()]})
    camera = next(iter(best.cameras.values()))
    (folder / "cameras.json").write_text(json.dumps({
        "photos": photos,
        "focal": float(camera.focal_length),
        "error": float(best.compute_mean_reprojection_error()),
        "seconds": seconds,
    }))


main()
