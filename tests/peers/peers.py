#!/usr/bin/env python3
"""Makes twelve assets and four scenes with simwright and loads them in Drake, MuJoCo, PyBullet and
yourdfpy: no warning, mass, centre and inertia equal to 1e-6, still within 1 mm and 1 degree for
2 s.

    peers.py PROGRAM FOLDER [--assets DIR...] [--scenes DIR...]

What is in FOLDER already is not made again. With --assets or --scenes those are looked at alone.
"""

import argparse
import pathlib
import subprocess
import sys
import traceback

import in_drake
import in_mujoco
import in_pybullet
import in_yourdfpy

SOURCE = pathlib.Path(__file__).resolve().parents[2]
RIGID = ["book", "domino", "plate", "mug", "phone", "teapot"]
ARTICULATED = ["microwave", "drawer_unit", "box_with_lid", "faucet"]
SCENES = ["breakfast_low", "living_room_shelf", "pantry_shelf", "dimsum"]


def domino_obj(path):
    """A box of 48 x 24 x 7.5 mm."""
    size = (0.048, 0.024, 0.0075)
    corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    faces = ["1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4"]
    lines = ["v %g %g %g" % tuple(c * s for c, s in zip(corner, size)) for corner in corners]
    path.write_text("\n".join(lines + ["f " + face for face in faces]) + "\n")


def make(program, folder):
    """The folders of twelve assets, made where they are missing: of the library, imported, lifted."""

    def run(output, *arguments):
        if not output.exists():
            print("+", *arguments, flush=True)
            subprocess.run([program, *arguments, "-o", str(output), "--quiet"], check=True)

    folder.mkdir(parents=True, exist_ok=True)
    assets = []
    for kind in RIGID + ARTICULATED:
        if kind == "domino":
            mesh = folder / "domino.obj"
            domino_obj(mesh)
            run(folder / kind, "import", str(mesh), "--unit", "m", "--category", "object", "--up", "z")
        else:
            run(folder / kind, "library", "--kind", kind, "--seed", "3")
        assets.append(folder / kind)
    run(folder / "chair", "import", str(SOURCE / "examples/chair.obj"), "--category", "chair")
    run(folder / "apple", "lift", str(SOURCE / "examples/apple.jpg"), "--category", "apple")
    assets += [folder / "chair", folder / "apple"]
    # A folder of assets or one itself.
    return [next(asset.rglob("asset.json")).parent for asset in assets]


def make_scenes(program, folder):
    scenes = []
    for kind in SCENES:
        dataset, worlds = folder / (kind + "_data"), folder / kind
        for output, arguments in (
            (dataset, ["scene", "generate", "--type", kind, "--count", "1"]),
            (worlds, ["scene", "export", str(dataset), "--format", "all"]),
        ):
            if not output.exists():
                print("+", *arguments, flush=True)
                subprocess.run([program, *arguments, "-o", str(output), "--quiet"], check=True)
        scenes.append(worlds / "scene_00000")
    return scenes


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--assets", nargs="*", type=pathlib.Path)
    parser.add_argument("--scenes", nargs="*", type=pathlib.Path)
    flags = parser.parse_args()
    chosen = flags.assets is not None or flags.scenes is not None
    assets = flags.assets or ([] if chosen else make(flags.program, flags.folder))
    scenes = flags.scenes or ([] if chosen else make_scenes(flags.program, flags.folder))
    checks = [
        (peer, place, peer.check_asset)
        for place in assets
        for peer in (in_drake, in_mujoco, in_pybullet, in_yourdfpy)
    ] + [
        (peer, place, peer.check_scene)
        for place in scenes
        for peer in (in_drake, in_mujoco, in_pybullet)
    ]
    failed = 0
    for peer, place, check in checks:
        name = "%-22s %-12s" % (place.name if check.__name__ == "check_asset" else
                                place.parent.name, peer.__name__[3:])
        try:
            said = "  ".join("%s %s" % item for item in check(place).items())
            print("ok    ", name, said, flush=True)
        except Exception as error:  # every fault of a peer is one of this test
            failed += 1
            print("FAILED", name, error, flush=True)
            if not isinstance(error, AssertionError):
                traceback.print_exc()
    print("%d assets and %d scenes, %d of %d checks failed" %
          (len(assets), len(scenes), failed, len(checks)))
    return 1 if failed or not checks else 0


if __name__ == "__main__":
    sys.exit(main())
