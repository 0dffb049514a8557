"""Simulates exported assets and scenes in MuJoCo, from the models that Newton makes of them."""

import json

import numpy as np
import pytest

from judges import ARTICULATED, RIGID, mujoco_model

mujoco = pytest.importorskip("mujoco", reason="mujoco is missing (./setup.sh --usd)")

STEP = 1e-3  # s
HINGE, SLIDE = int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE)


def moving_joints(model):
    """Returns the hinges and slides by name: Newton names joints by their path."""
    found = {}
    for joint in range(model.njnt):
        if int(model.jnt_type[joint]) in (HINGE, SLIDE):
            name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, joint)
            found[name.split("_joints_")[-1]] = joint
    return found


def motion(model, names, seconds):
    """Returns the joints' positions [steps, joints] after a push from 30 % of their range."""
    model.opt.timestep = STEP
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    model.opt.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    model.opt.solver = mujoco.mjtSolver.mjSOL_NEWTON
    model.opt.tolerance = 1e-12
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_GRAVITY
    # The softness of friction and limits is MuJoCo's own setting; USD has none.
    model.dof_solref[:], model.dof_solimp[:] = (0.004, 1.0), (0.9999, 0.9999, 0.001, 0.5, 2.0)
    model.jnt_solref[:], model.jnt_solimp[:] = (0.004, 1.0), (0.9, 0.95, 0.001, 0.5, 2.0)
    data = mujoco.MjData(model)
    joints = [moving_joints(model)[name] for name in names]
    for number, joint in enumerate(joints):
        hinge = model.jnt_type[joint] == HINGE
        data.qpos[model.jnt_qposadr[joint]] = 0.3 * model.jnt_range[joint][1]
        data.qvel[model.jnt_dofadr[joint]] = (1.0 + 0.1 * number) * (5.0 if hinge else 0.5)
    positions = []
    for _ in range(round(seconds / STEP)):
        mujoco.mj_step(model, data)
        positions.append([data.qpos[model.jnt_qposadr[joint]] for joint in joints])
    assert not any(warning.number for warning in data.warning)
    return np.array(positions)


@pytest.mark.parametrize("kind", ARTICULATED)
def test_joints_move_as_in_the_assets_own_file(exported, assets, kind):
    """The MJCF of the asset, which is checked against Bullet, moves alike."""
    described, layer = exported[kind]
    names = [joint["name"] for joint in described["joints"] if joint["type"] != "fixed"]
    own = assets[kind] / f"{kind}_1.xml"
    expected = motion(mujoco.MjModel.from_xml_path(str(own)), names, 1.5)
    moved = motion(mujoco_model(layer), names, 1.5)
    assert (np.ptp(expected, axis=0) > 2e-4).all()
    np.testing.assert_allclose(moved, expected, atol=1e-6)  # rad or m


def still_for(model, seconds):
    """Returns how far the bodies' origins move from where the layer has them, m."""
    model.opt.timestep = STEP
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    before = data.xpos.copy()
    farthest = 0.0
    for _ in range(round(seconds / STEP)):
        mujoco.mj_step(model, data)
        farthest = max(farthest, np.linalg.norm(data.xpos - before, axis=1).max())
    assert not any(warning.number for warning in data.warning)
    return farthest


@pytest.mark.parametrize("kind", RIGID)
def test_assets_stand_still(exported, kind):
    assert still_for(mujoco_model(exported[kind][1], floor=True), 2.0) < 1e-3


def test_scenes_stand_still(scenes):
    for folder in sorted(scenes.glob("scene_*")):
        objects = json.loads((folder / "scene.json").read_text())["objects"]
        model = mujoco_model(folder / "scene.usda")
        assert model.nv == 6 * sum(not one["welded"] for one in objects)
        assert still_for(model, 2.0) < 1e-3
