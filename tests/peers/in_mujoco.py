"""What simwright writes, in MuJoCo: warnings, inertials, stillness, attaching."""

import pathlib

import mujoco
import numpy as np

import inertials


def load(path):
    heard = []
    mujoco.set_mju_user_warning(heard.append)
    model = mujoco.MjModel.from_xml_path(str(path))
    return model, heard


def watch(model, seconds=2.0):
    data = mujoco.MjData(model)
    still = inertials.Stillness()
    while data.time < seconds:
        if data.time == 0.0:
            mujoco.mj_forward(model, data)
        for body in range(1, model.nbody):
            still.see(model.body(body).name, data.xpos[body], data.xmat[body].reshape(3, 3))
        mujoco.mj_step(model, data)
    return still


def inertial_of(model, body):
    axes = inertials.turn_of(*model.body_iquat[body])
    inertia = axes @ np.diag(model.body_inertia[body]) @ axes.T
    return model.body_mass[body], model.body_ipos[body], inertia


def check_attached(text, path, wanted):
    """Twice into a model of the user's, whose options stay."""
    user = mujoco.MjSpec.from_string(
        '<mujoco><option timestep="0.004" integrator="implicitfast"/><worldbody>'
        '<geom name="ground" type="plane" size="5 5 1"/></worldbody></mujoco>'
    )
    for prefix, x in (("first_", 0.0), ("second_", 3.0)):
        frame = user.worldbody.add_frame(pos=[x, 0, 0.01])
        user.attach(mujoco.MjSpec.from_file(str(path)), prefix=prefix, frame=frame)
    model = user.compile()
    assert model.opt.timestep == 0.004 and model.opt.integrator == mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    for prefix in ("first_", "second_"):
        for name, numbers in wanted.items():
            body = model.body(prefix + name).id
            inertials.require_same(inertial_of(model, body), numbers, (path, prefix + name))


def check_asset(folder):
    folder = pathlib.Path(folder)
    text, wanted = inertials.of_asset(folder)
    path = folder / (text["name"] + ".xml")
    source = path.read_text()
    assert "<option" not in source and "<size" not in source, path
    check_attached(text, path, wanted)
    model, heard = load(folder / "scene.xml")
    for name, numbers in wanted.items():
        inertials.require_same(inertial_of(model, model.body(name).id), numbers, (path, name))
    still = watch(model)
    assert not heard, (path, heard)
    still.require(str(path))
    return {"scene.xml": str(still)}


def check_scene(folder):
    path = pathlib.Path(folder) / "scene.xml"
    model, heard = load(path)
    still = watch(model)
    assert not heard, (path, heard)
    still.require(str(path))
    return {"scene.xml": str(still)}
