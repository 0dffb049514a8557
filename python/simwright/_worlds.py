"""What all environments share: their tasks, actions, images, and the end of their use."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Mapping, Sequence, cast

import numpy as np
from gymnasium import spaces

from . import _arguments as checked
from . import _core
from . import cameras as _cameras
from ._cells import cell_tasks
from ._progress import reporter

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._types import (ActionSpace, Cameras, Float32Array, ImageArray, ImageKinds, ImageSize,
                         Look, Names, Observation, Path, ProgressArgument, Range, RenderMode,
                         Split)

# robosuite's OSC_POSE moves by at most 0.05 m and 0.5 rad a step; 1 closes its gripper.
_OSC_SETTINGS = {"reach": 0.2, "turn": 2.0, "delta_share": 0.25}
# The camera of render(): behind and to the right of the robot, in the frame of its base, m.
_RENDER_POSITION = (-0.35, -1.75, 1.45)
_RENDER_TARGET = (0.5, 0.1, 0.3)
_ACTION_SPACES = ("focus", "guided", "delta", "osc_delta", "absolute", "joints", "joint_targets")


def settings_of(action_space: ActionSpace, robot: str, episode_seconds: float | None,
                finger_friction: Range | None, proved_grasps: bool) -> _core.TaskSettings:
    if not isinstance(action_space, str) or action_space not in _ACTION_SPACES:
        raise _core.Error(f"action_space: is {checked.shown(action_space)} "
                          f"(give one of {', '.join(_ACTION_SPACES)})")
    settings = _core.TaskSettings()
    settings.robot = checked.text("robot", robot)
    settings.action_space = "delta" if action_space == "osc_delta" else action_space
    if episode_seconds is not None:
        settings.episode_seconds = checked.number("episode_seconds", episode_seconds)
    settings.finger_friction = checked.optional_range("finger_friction", finger_friction)
    settings.proved_grasps = checked.instance("proved_grasps", proved_grasps, bool,
                                              "give True or False")
    if action_space == "osc_delta":
        for name, value in _OSC_SETTINGS.items():
            setattr(settings, name, value)
    return settings


def task_file(cell: str | None, tasks: Path | None, robot: str | None, split: Split,
              instances: int | None, progress: ProgressArgument) -> tuple[str, str]:
    """Returns the task file and the robot of a cell, or of a task file."""
    if (cell is None) == (tasks is None):
        raise _core.Error("environment: needs a cell, or a tasks.json (give one of cell=, tasks=)")
    if cell is None:
        return checked.path("tasks", cast("Path", tasks)), robot or "panda"
    file = cell_tasks(cell, split, instances, reporter(progress))
    known = next(entry for entry in _core.cells() if entry["name"] == cell)
    return str(file), robot or known["robot"]


def numbers(actions: ArrayLike, shape: tuple[int, ...] | None) -> Float32Array:
    """Returns actions as float32; raises Error for another shape or type."""
    try:
        array = np.asarray(actions)
        if array.dtype.kind not in "fiub":
            raise TypeError(f"has the type {array.dtype}")
        with np.errstate(over="ignore"):  # to infinity, which ends the episode
            array = np.ascontiguousarray(array, dtype=np.float32)
    except (TypeError, ValueError, RuntimeError) as error:
        raise _core.Error(f"action: is not an array of real numbers ({error})") from None
    if array.shape != shape:
        raise _core.Error(f"action: has the shape {array.shape} (give {shape})")
    return array


def fault_of(action: Float32Array, failed_physics: bool, environment: int | None = None) -> str:
    """Returns why an episode was ended."""
    where = "" if environment is None else f" of environment {environment}"
    if failed_physics:
        return f"the physics{where} failed"
    bad = ", ".join(str(index) for index in np.flatnonzero(~np.isfinite(action)))
    return f"the action{where} is not finite in {bad}"


class Worlds:
    """What the environments share: their images, and that they can be closed once."""

    task: _core.PreparedTask
    tasks_file: str
    robot: str
    action_space_name: ActionSpace
    subtask_index: int | None
    render_mode: str | None
    _open = True
    _begun = False
    _running = False  # of environments of one episode
    _eyes: _core.EpisodeCameras | None = None
    _seed: int | None = None
    _index = 0
    _flip_gripper = False  # robosuite's sign

    def _prepare(self, file: str, robot: str, patterns: Names, action_space: ActionSpace,
                 subtask: int | None, episode_seconds: float | None,
                 finger_friction: Range | None, proved_grasps: bool) -> None:
        """Reads the tasks of a file; `subtask` is None where all are executed."""
        settings = settings_of(action_space, robot, episode_seconds, finger_friction,
                               proved_grasps)
        self.task = _core.PreparedTask(file, checked.texts("task", patterns), settings)
        self.tasks_file, self.robot, self.action_space_name = file, robot, action_space
        self.subtask_index = subtask
        self._flip_gripper = action_space == "osc_delta"

    def _require_open(self) -> None:
        if not self._open:
            raise _core.Error("the environment: is closed (make a new one)")

    def _require_running(self) -> None:
        self._require_open()
        if not self._running:
            state = "has ended" if self._begun else "has not begun"
            raise _core.Error(f"the episode: {state} (call reset())")

    def _number_episode(self, seed: int | None, random: np.random.Generator) -> tuple[int, int]:
        """Returns the next episode's seed and index: 0 of a new seed, else one more."""
        if seed is not None or self._seed is None:
            self._seed = int(random.integers(2**62)) if seed is None else seed
            self._index = 0
        else:
            self._index += 1
        return self._seed, self._index

    def _sent(self, actions: Float32Array) -> Float32Array:
        """Returns the actions (..., A) in the compiled module's signs."""
        if not self._flip_gripper:
            return actions
        return np.concatenate([actions[..., :-1], -actions[..., -1:]], axis=-1)

    def _choose_cameras(self, cameras: Cameras, image_size: ImageSize, images: ImageKinds,
                        look: Look, render_mode: RenderMode | None, render_size: tuple[int, int],
                        ) -> dict[str, spaces.Box]:
        """Reads the arguments about cameras; returns the spaces of the images by key."""
        if render_mode not in (None, "rgb_array"):
            raise _core.Error(f"render_mode: is {render_mode!r} (give None or 'rgb_array')")
        self.render_mode = render_mode
        self._kinds: list[str] = list(dict.fromkeys(checked.texts("images", images)))
        specs = _cameras.chosen(cameras, image_size)
        self._seen = [spec.name for spec in specs]
        if "render" in self._seen or "state" in self._seen:
            raise _core.Error("cameras: 'render' and 'state' are taken (choose another name)")
        for kind in self._kinds:
            if kind not in _cameras.KINDS:
                raise _core.Error(f"images: there is no '{kind}' "
                                  f"(give {', '.join(_cameras.KINDS)})")
        if specs and not self._kinds:
            raise _core.Error(f"images: is empty (give some of {', '.join(_cameras.KINDS)})")
        self._specs = list(specs)
        if render_mode is not None:
            width, height = checked.pixels("render_size", render_size)
            self._specs.append(_cameras.camera("render", position=_RENDER_POSITION,
                                               target=_RENDER_TARGET, mount="robot", width=width,
                                               height=height))
        self._look = _cameras.look(look)
        return self._image_spaces(specs)

    def _image_spaces(self, specs: Sequence[_core.CameraSpec]) -> dict[str, spaces.Box]:
        """Returns the spaces of the images by key; raises Error where two have one key."""
        shapes: dict[str, tuple[int, ...]] = {"rgb": (3,), "normal": (3,)}
        limits: dict[str, tuple[float, float, Any]] = {
            "rgb": (0, 255, np.uint8), "depth": (0.0, np.inf, np.float32),
            "segmentation": (-1, np.iinfo(np.int32).max, np.int32),
            "normal": (-1.0, 1.0, np.float32)}
        found: dict[str, spaces.Box] = {}
        owners: dict[str, str] = {}
        for spec in specs:
            for kind in self._kinds:
                key = self._key(spec.name, kind)
                if key in owners:
                    cameras = (f"two cameras are called '{spec.name}'" if owners[key] == spec.name
                               else f"an image of '{owners[key]}' and one of '{spec.name}' have "
                               f"the key '{key}'")
                    raise _core.Error(f"cameras: {cameras} (give each another name)")
                owners[key] = spec.name
                low, high, dtype = limits[kind]
                shape = (spec.height, spec.width) + shapes.get(kind, ())
                found[key] = spaces.Box(low, high, shape, dtype)
        return found

    @staticmethod
    def _key(camera: str, kind: str) -> str:
        return camera if kind == "rgb" else f"{camera}_{kind}"

    def _make_cameras(self, subtask: int, evaluated: bool) -> _core.EpisodeCameras | None:
        """Returns the cameras of a subtask, or None if there are none."""
        if not self._specs:
            return None
        return _core.EpisodeCameras(self.task, subtask, evaluated, self._specs, self._look, 1)

    def _space(self, state: spaces.Box,
               images: dict[str, spaces.Box]) -> spaces.Box | spaces.Dict:
        return spaces.Dict({"state": state, **images}) if images else state

    def _with_images(self, state: Float32Array,
                     images: Mapping[str, Mapping[str, ImageArray]]) -> Observation:
        """Returns the observation of a state and the images by camera and kind."""
        if not self._seen:
            return state
        observation = {"state": state}
        for camera, kinds in images.items():
            for kind, pixels in kinds.items():
                observation[self._key(camera, kind)] = pixels
        return observation

    def _require_render(self) -> None:
        self._require_open()
        if self.render_mode is None:
            raise _core.Error("render: the environment has no render_mode (make it with "
                              "render_mode='rgb_array')")
