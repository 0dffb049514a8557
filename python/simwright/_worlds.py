"""What all environments share: their tasks, actions, images, and the end of their use."""

import numpy as np
from gymnasium import spaces

from . import _core
from . import cameras as _cameras
from ._cells import cell_tasks
from ._progress import reporter

# robosuite's OSC_POSE moves by at most 0.05 m and 0.5 rad a step; 1 closes its gripper.
_OSC_SETTINGS = {"reach": 0.2, "turn": 2.0, "delta_share": 0.25}
# The camera of render(): behind and to the right of the robot, in the frame of its base, m.
_RENDER_POSITION = (-0.35, -1.75, 1.45)
_RENDER_TARGET = (0.5, 0.1, 0.3)
_ACTION_SPACES = ("focus", "guided", "delta", "osc_delta", "absolute", "joints", "joint_targets")


def settings_of(action_space, robot, episode_seconds, finger_friction):
    if action_space not in _ACTION_SPACES:
        raise _core.Error(f"action_space: is '{action_space}' (give one of {', '.join(_ACTION_SPACES)})")
    settings = _core.TaskSettings()
    settings.robot = robot
    settings.action_space = "delta" if action_space == "osc_delta" else action_space
    settings.episode_seconds = episode_seconds
    settings.finger_friction = finger_friction
    if action_space == "osc_delta":
        for name, value in _OSC_SETTINGS.items():
            setattr(settings, name, value)
    return settings


def task_file(cell, tasks, robot, split, instances, progress):
    """Returns the task file and the robot of a cell, or of a task file."""
    if (cell is None) == (tasks is None):
        raise _core.Error("environment: needs a cell, or a tasks.json (give one of cell=, tasks=)")
    if tasks is not None:
        return str(tasks), robot or "panda"
    known = next((entry for entry in _core.cells() if entry["name"] == cell), None)
    file = cell_tasks(cell, split, instances, reporter(progress))
    return str(file), robot or known["robot"]


def numbers(actions, shape):
    """Returns actions as float32; raises Error for another shape or type."""
    try:
        array = np.asarray(actions)
        if array.dtype.kind not in "fiub":
            raise TypeError(f"has the type {array.dtype}")
        array = np.ascontiguousarray(array, dtype=np.float32)
    except (TypeError, ValueError) as error:
        raise _core.Error(f"action: is not an array of real numbers ({error})") from None
    if array.shape != shape:
        raise _core.Error(f"action: has the shape {array.shape} (give {shape})")
    return array


def fault_of(action, failed_physics, environment=None):
    """Returns why an episode was ended."""
    where = "" if environment is None else f" of environment {environment}"
    if failed_physics:
        return f"the physics{where} failed"
    bad = ", ".join(str(index) for index in np.flatnonzero(~np.isfinite(action)))
    return f"the action{where} is not finite in {bad}"


class Worlds:
    """What the environments share: their images, and that they can be closed once."""

    _open = True
    _eyes = None  # EpisodeCameras
    _seed = None
    _index = 0
    _flip_gripper = False  # robosuite's sign

    def _prepare(self, file, robot, patterns, action_space, subtask, episode_seconds,
                 finger_friction):
        """Reads the tasks of a file; `subtask` is None where all are executed."""
        patterns = [patterns] if isinstance(patterns, str) else list(patterns)
        settings = settings_of(action_space, robot, episode_seconds, finger_friction)
        self.task = _core.PreparedTask(file, patterns, settings)
        self.tasks_file, self.robot, self.action_space_name = file, robot, action_space
        self.subtask_index = subtask
        self._flip_gripper = action_space == "osc_delta"

    def _require_open(self):
        if not self._open:
            raise _core.Error("the environment: is closed (make a new one)")

    def _number_episode(self, seed):
        """Sets the next episode's seed and index: 0 of a new seed, else one more."""
        if seed is not None or self._seed is None:
            self._seed = int(self.np_random.integers(2**62)) if seed is None else int(seed)
            self._index = 0
        else:
            self._index += 1

    def _sent(self, actions):
        """Returns the actions (..., A) in the compiled module's signs."""
        if not self._flip_gripper:
            return actions
        return np.concatenate([actions[..., :-1], -actions[..., -1:]], axis=-1)

    def _choose_cameras(self, cameras, image_size, images, look, render_mode, render_size):
        """Reads the arguments about cameras; returns the spaces of the images by key."""
        if render_mode not in (None, "rgb_array"):
            raise _core.Error(f"render_mode: is {render_mode!r} (give None or 'rgb_array')")
        self.render_mode = render_mode
        self._kinds = [images] if isinstance(images, str) else list(images)
        specs = _cameras.chosen(cameras, image_size)
        self._seen = [spec.name for spec in specs]
        if "render" in self._seen or "state" in self._seen:
            raise _core.Error("cameras: 'render' and 'state' are taken (choose another name)")
        self._specs = list(specs)
        if render_mode is not None:
            width, height = render_size
            self._specs.append(_cameras.camera("render", position=_RENDER_POSITION,
                                               target=_RENDER_TARGET, mount="robot", width=width,
                                               height=height))
        self._look = _cameras.look(look)
        shapes = {"rgb": (3,), "normal": (3,)}
        limits = {"rgb": (0, 255, np.uint8), "depth": (0.0, np.inf, np.float32),
                  "segmentation": (-1, np.iinfo(np.int32).max, np.int32),
                  "normal": (-1.0, 1.0, np.float32)}
        found = {}
        for spec in specs:
            for kind in self._kinds:
                if kind not in limits:
                    raise _core.Error(f"images: there is no '{kind}' "
                                      f"(give {', '.join(_cameras.KINDS)})")
                low, high, dtype = limits[kind]
                shape = (spec.height, spec.width) + shapes.get(kind, ())
                found[self._key(spec.name, kind)] = spaces.Box(low, high, shape, dtype)
        return found

    @staticmethod
    def _key(camera, kind):
        return camera if kind == "rgb" else f"{camera}_{kind}"

    def _make_cameras(self, subtask, evaluated):
        """Returns the cameras of a subtask, or None if there are none."""
        if not self._specs:
            return None
        return _core.EpisodeCameras(self.task, subtask, evaluated, self._specs, self._look, 1)

    def _space(self, state, images):
        return spaces.Dict({"state": state, **images}) if images else state

    def _with_images(self, state, images):
        """Returns the observation of a state and the images by camera and kind."""
        if not self._seen:
            return state
        observation = {"state": state}
        for camera, kinds in images.items():
            for kind, pixels in kinds.items():
                observation[self._key(camera, kind)] = pixels
        return observation

    def _require_render(self):
        self._require_open()
        if self.render_mode is None:
            raise _core.Error("render: the environment has no render_mode (make it with "
                              "render_mode='rgb_array')")
