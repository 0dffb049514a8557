"""Prints how exported USD weighs, stands and swings in Newton, beside Bullet and MuJoCo.

    ./setup.sh --usd
    SIMWRIGHT_PROGRAM=build/bin/simwright .venv-usd/bin/python bench/usd/usd_table.py [FOLDER]

20 rigid and 14 articulated assets of the library and 8 scenes are made (in FOLDER, else a temporary
one), exported and judged: findings of usd-core's validators; the largest relative difference of
masses, centres and inertias that Newton reads from asset.json; the largest motion in 2 s on a floor
in Newton (its MuJoCo solver), of MuJoCo's own file, and in Bullet (`simwright check`); and how far
joints are apart after 1.5 s of free motion in Newton and in the asset's own MJCF.
"""

import json
import pathlib
import sys
import tempfile

import mujoco
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests" / "usd"))
from judges import PROGRAM, findings, mujoco_model, newton_model, run  # noqa: E402
from test_usd_simulation import motion, still_for  # noqa: E402
from pxr import Usd  # noqa: E402
import subprocess  # noqa: E402

RIGID = ("apple bottle book bowl box bucket can candle cereal_box cup die glass hammer jug mug "
         "plate saucer teapot tray tumbler").split()
ARTICULATED = ("box_with_lid cabinet dishwasher door drawer_unit faucet laptop light_switch microwave "
               "oven refrigerator toaster trash_can window").split()
SCENES = ("dimsum", "pantry_shelf", "living_room_shelf", "restaurant_low")


def links(described):
    return described["links"] if "links" in described else [described]


def weighing_difference(described, layer):
    """Returns the largest relative difference of mass, centre (to the size) and inertia."""
    read = newton_model(layer)
    number_of = {label.split("/")[-1]: number for number, label in enumerate(read.body_label)}
    masses, centers = read.body_mass.numpy(), read.body_com.numpy()
    inertias = read.body_inertia.numpy()
    worst = 0.0
    for one in links(described):
        number, inertia = number_of[one["name"]], np.array(one["inertia"])
        size = np.sqrt(np.trace(inertia) / one["mass"])
        worst = max(worst, abs(masses[number] / one["mass"] - 1.0),
                    np.linalg.norm(centers[number] - one["center_of_mass"]) / size,
                    np.linalg.norm(inertias[number] - inertia) / np.linalg.norm(inertia))
    return worst


def checked(folder):
    """Returns the rows of `simwright check` by property."""
    printed = subprocess.run([PROGRAM, "check", str(folder), "--json", "--quiet"],
                             capture_output=True, text=True, check=False).stdout
    return {row["property"]: row["figure"] for row in json.loads(printed)["reports"][0]["rows"]}


def own_model(asset, name):
    scene = "scene.xml" if name != "scene" else "scene_scene.xml"
    return mujoco.MjModel.from_xml_path(str(asset / scene))


def row(*cells):
    print("| " + " | ".join(cells) + " |", flush=True)


def judge_asset(asset, work, articulated):
    described = json.loads((asset / "asset.json").read_text())
    run("export", asset, "--format", "usd", "-o", work)
    layer = work / f"{asset.name}.usda"
    faults = len(findings(Usd.Stage.Open(str(layer))))
    figures = checked(asset)
    cells = [asset.name, str(faults), f"{weighing_difference(described, layer):.1e}"]
    if described.get("fixed"):
        cells += ["fixed"] * 3
    else:
        stands = (still_for(mujoco_model(layer, floor=True), 2.0),
                  still_for(own_model(asset, asset.name), 2.0))
        cells += [f"{1e3 * moved:.3f}" for moved in stands]
        rolled = figures.get("drift-bullet")
        cells.append("rolls" if rolled is None else f"{rolled:.3f}")
    if articulated:
        names = [joint["name"] for joint in described["joints"]
                 if joint["type"] != "fixed" and "mimic" not in joint]
        own = motion(mujoco.MjModel.from_xml_path(str(asset / f"{asset.name}.xml")), names, 1.5)
        apart = np.abs(motion(mujoco_model(layer), names, 1.5) - own).max()
        swings = [value for key, value in figures.items() if key.startswith("swings-bullet-")]
        cells += [f"{apart:.1e}", f"{min(swings):.3f}" if swings else "-"]
    row(*cells)


def main():
    work = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp())
    library = work / "library"
    if not library.exists():
        run("library", "--kind", ",".join(RIGID + ARTICULATED), "--no-check", "-o", library)
    row("asset", "findings", "weighs within", "moves in Newton, mm", "in MuJoCo, mm", "in Bullet, mm",
        "joints apart", "range in Bullet")
    row(*["---"] * 8)
    for kind in RIGID + ARTICULATED:
        judge_asset(library / f"{kind}_1", work / "usd" / kind, kind in ARTICULATED)
    print()
    row("scene", "objects", "findings", "moves in Newton, mm", "in MuJoCo, mm")
    row(*["---"] * 5)
    for kind in SCENES:
        data, out = work / "scenes" / kind, work / "worlds" / kind
        if not out.exists():
            run("scene", "generate", "--type", kind, "--count", 2, "-o", data)
            run("scene", "export", data, "--format", "usd,mjcf", "-o", out)
        for scene in sorted(out.glob("scene_*")):
            described = json.loads((scene / "scene.json").read_text())
            layer = scene / "scene.usda"
            own = mujoco.MjModel.from_xml_path(str(scene / "scene.xml"))
            row(f"{kind} {scene.name}", str(len(described["objects"])),
                str(len(findings(Usd.Stage.Open(str(layer))))),
                f"{1e3 * still_for(mujoco_model(layer), 2.0):.3f}", f"{1e3 * still_for(own, 2.0):.3f}")


if __name__ == "__main__":
    main()
