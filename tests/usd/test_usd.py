"""Judges exported assets: usd-core's checker, and Newton, which reads their physics."""

import json
import re
import subprocess

import numpy as np
import pytest

from judges import ARTICULATED, KINDS, PROGRAM, findings, newton_model
from pxr import Usd, UsdGeom, UsdPhysics


def links(described):
    return described["links"] if "links" in described else [described]


@pytest.mark.parametrize("kind", KINDS)
def test_the_checker_finds_nothing(exported, kind):
    stage = Usd.Stage.Open(str(exported[kind][1]))
    assert findings(stage) == []
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1.0
    assert UsdGeom.GetStageUpAxis(stage) == "Z"


def test_the_checker_finds_a_fault(exported, tmp_path):
    text = exported["mug"][1].read_text()
    damaged = tmp_path / "damaged.usda"
    damaged.write_text(re.sub(r'prepend apiSchemas = \["MaterialBindingAPI"\]', "", text))
    assert findings(Usd.Stage.Open(str(damaged))) != []


@pytest.mark.parametrize("kind", KINDS)
def test_newton_reads_masses_and_inertias(exported, kind):
    described, layer = exported[kind]
    read = newton_model(layer)
    number_of = {label.split("/")[-1]: number for number, label in enumerate(read.body_label)}
    assert len(number_of) == len(links(described))
    for one in links(described):
        number, inertia = number_of[one["name"]], np.array(one["inertia"])
        np.testing.assert_allclose(read.body_mass.numpy()[number], one["mass"], rtol=1e-6)
        np.testing.assert_allclose(read.body_com.numpy()[number], one["center_of_mass"], atol=1e-7)
        np.testing.assert_allclose(read.body_inertia.numpy()[number], inertia,
                                   atol=2e-6 * np.linalg.norm(inertia))


@pytest.mark.parametrize("kind", ARTICULATED)
def test_newton_reads_joints(exported, kind):
    described, layer = exported[kind]
    read = newton_model(layer)
    moving = [one for one in described["joints"] if one["type"] != "fixed"]
    free = 0 if described["fixed"] else 6
    lower, upper = read.joint_limit_lower.numpy()[free:], read.joint_limit_upper.numpy()[free:]
    # Newton orders joints by the tree, asset.json by its links.
    np.testing.assert_allclose(sorted(upper), sorted(one["upper"] for one in moving), rtol=1e-6)
    np.testing.assert_allclose(lower, 0.0, atol=1e-9)
    for name in ("damping", "friction"):
        values = (read.joint_target_kd if name == "damping" else read.joint_friction).numpy()[free:]
        np.testing.assert_allclose(sorted(values), sorted(one[name] for one in moving), rtol=1e-5)


@pytest.mark.parametrize("kind", ARTICULATED)
def test_joints_turn_where_their_frames_say(exported, kind):
    """Both bodies of a joint state the same frame at position zero."""
    stage = Usd.Stage.Open(str(exported[kind][1]))
    cache = UsdGeom.XformCache()
    joints = [UsdPhysics.Joint(prim) for prim in stage.Traverse() if prim.IsA(UsdPhysics.Joint)]
    assert joints
    for joint in joints:
        frames = []
        for bodies, position, rotation in (
                (joint.GetBody0Rel(), joint.GetLocalPos0Attr(), joint.GetLocalRot0Attr()),
                (joint.GetBody1Rel(), joint.GetLocalPos1Attr(), joint.GetLocalRot1Attr())):
            pose = np.eye(4)
            for target in bodies.GetTargets():
                pose = np.array(cache.GetLocalToWorldTransform(stage.GetPrimAtPath(target))).T
            q = rotation.Get()
            w, v = q.GetReal(), np.array(q.GetImaginary())
            axes = [axis + 2 * w * np.cross(v, axis) + 2 * np.cross(v, np.cross(v, axis))
                    for axis in np.eye(3)]
            local = np.eye(4)
            local[:3, :3], local[:3, 3] = np.array(axes).T, np.array(position.Get())
            frames.append(pose @ local)
        np.testing.assert_allclose(frames[0], frames[1], atol=1e-6)


def test_what_is_no_asset_is_refused_in_one_line(exported, tmp_path):
    folder = exported["mug"][1].parent
    for arguments, word in (((tmp_path,), "asset.json"), ((folder,), "asset.json"),
                            ((folder, "--pace", "recorded"), "--pace")):
        refused = subprocess.run(
            [PROGRAM, "export", *map(str, arguments), "--format", "usd", "-o", str(tmp_path / "out")],
            capture_output=True, text=True)
        assert refused.returncode != 0 and word in refused.stderr
        assert len(refused.stderr.splitlines()) == 1
        assert not (tmp_path / "out").exists()
