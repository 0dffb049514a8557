"""Judges exported worlds of tasks: usd-core's checker, and MuJoCo beside the same world as MJCF."""

import numpy as np
import pytest

from judges import findings, mujoco_model, newton_model
from pxr import Usd, UsdGeom

mujoco = pytest.importorskip("mujoco", reason="mujoco is missing (./setup.sh --usd)")

SECONDS, STEP = 1.0, 1e-3


def own_model(worlds):
    return mujoco.MjModel.from_xml_path(str(worlds["mjcf"] / "world.xml"))


def joints(model):
    """Returns the joints by the end of their name: Newton's begins with their path."""
    return {mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, joint).split("_joints_")[-1]: joint
            for joint in range(model.njnt)}


def own_name(name):
    """Returns the name of a joint in its body: that of MJCF begins with the body's."""
    return name.removeprefix("microwave_1_")


def test_the_checker_finds_nothing(worlds):
    stage = Usd.Stage.Open(str(worlds["usd"] / "world.usda"))
    assert findings(stage) == []
    assert Usd.ModelAPI(stage.GetDefaultPrim()).GetKind() == "assembly"


def test_newton_reads_masses_joints_and_servos(worlds):
    own, read = own_model(worlds), mujoco_model(worlds["usd"] / "world.usda")
    np.testing.assert_allclose(read.body_mass.sum(), own.body_mass.sum(), rtol=1e-6)
    ours, theirs = {own_name(name): joint for name, joint in joints(own).items()}, joints(read)
    assert set(ours) == set(theirs)
    for name, joint in ours.items():
        other = theirs[name]
        assert own.jnt_type[joint] == read.jnt_type[other], name
        np.testing.assert_allclose(read.jnt_range[other], own.jnt_range[joint], atol=1e-6)
        np.testing.assert_allclose(read.dof_frictionloss[read.jnt_dofadr[other]],
                                   own.dof_frictionloss[own.jnt_dofadr[joint]], rtol=1e-6)
    # Stiffnesses and greatest forces of the servos.
    model = newton_model(worlds["usd"] / "world.usda")
    labels = [str(label).split("/")[-1] for label in model.joint_label]
    for actuator in range(own.nu):
        joint = mujoco.mj_id2name(own, mujoco.mjtObj.mjOBJ_ACTUATOR, actuator)
        dof = model.joint_qd_start.numpy()[labels.index(joint)]
        np.testing.assert_allclose(model.joint_target_ke.numpy()[dof],
                                   own.actuator_gainprm[actuator][0], rtol=1e-5)
        np.testing.assert_allclose(model.joint_effort_limit.numpy()[dof],
                                   own.actuator_forcerange[actuator][1], rtol=1e-5)


def test_bodies_are_where_mujoco_has_them(worlds):
    own = own_model(worlds)
    data = mujoco.MjData(own)
    mujoco.mj_resetDataKeyframe(own, data, 0)
    mujoco.mj_forward(own, data)
    stage = Usd.Stage.Open(str(worlds["usd"] / "world.usda"))
    cache = UsdGeom.XformCache()
    compared = 0
    for prim in stage.Traverse():
        name = prim.GetName()
        for candidate in (name, f"microwave_1_{name}"):
            body = mujoco.mj_name2id(own, mujoco.mjtObj.mjOBJ_BODY, candidate)
            if body <= 0 or not prim.HasAPI("PhysicsRigidBodyAPI"):
                continue
            place = np.array(cache.GetLocalToWorldTransform(prim)).T[:3, 3]
            np.testing.assert_allclose(place, data.xpos[body], atol=1e-9)
            compared += 1
    assert compared >= 15


def test_the_arm_starts_and_stays_where_the_task_says(worlds):
    own, model = own_model(worlds), newton_model(worlds["usd"] / "world.usda")
    read = mujoco_model(worlds["usd"] / "world.usda")
    start = mujoco.MjData(own)
    mujoco.mj_resetDataKeyframe(own, start, 0)
    ours, theirs = {own_name(name): joint for name, joint in joints(own).items()}, joints(read)
    data = mujoco.MjData(read)
    data.qpos[:] = model.joint_q.numpy()
    data.ctrl[:] = model.joint_target_q.numpy()[read.actuator_trnid[:, 0]]
    places = {name: read.jnt_qposadr[joint] for name, joint in theirs.items()}
    expected = {name: start.qpos[own.jnt_qposadr[joint]] for name, joint in ours.items()}
    assert any(abs(value) > 1.0 for value in expected.values())
    read.opt.timestep, read.opt.integrator = STEP, mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    for _ in range(round(SECONDS / STEP)):
        for name, value in expected.items():
            assert abs(data.qpos[places[name]] - value) < 2e-3, (name, data.time)
        mujoco.mj_step(read, data)
    assert not any(warning.number for warning in data.warning)
