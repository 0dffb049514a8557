"""Types of arguments and results, for editors and type checkers; no module imports it to run."""

from __future__ import annotations

import os
import pathlib
from typing import (TYPE_CHECKING, Any, Callable, Dict, Iterable, List, Literal, Mapping, Optional,
                    Protocol, Sequence, Tuple, TypedDict, Union)

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from ._core import CameraSpec, Finding, LookRanges, SceneObject

# Arguments.
Path = Union[str, "os.PathLike[str]"]
Paths = Union[Path, Iterable[Path]]
Names = Union[str, Iterable[str]]
# True, False, None (as set_progress states), or f(name, detail, done, total, elapsed in s).
ProgressArgument = Union[bool, None, Callable[[str, str, int, int, float], object]]
Reporter = Callable[[str, str, int, int, float], object]
Range = Tuple[float, float]  # low, high
Split = Literal["train", "unseen"]
UpAxis = Literal["", "x", "y", "z"]
LiftShape = Literal["auto", "fitted", "free"]
PolicyName = Literal["shipped", "expert"]
RunActionSpace = Literal["focus", "guided", "absolute", "delta", "joints", "joint_targets"]
ActionSpace = Literal["focus", "guided", "absolute", "delta", "joints", "joint_targets",
                      "osc_delta"]
TrajectoryFormat = Literal["ros2", "csv", "robomimic"]
TrajectoryPace = Literal["limits", "recorded"]
WorldFormat = Literal["urdf", "sdf", "mjcf", "drake", "usd"]
ImageKind = Literal["rgb", "depth", "segmentation", "normal"]
RenderMode = Literal["rgb_array"]
Keep = Literal["successes", "all"]
RecordedActions = Literal["joint_targets", "policy"]
Cameras = Union[str, "CameraSpec", Iterable[Union[str, "CameraSpec"]]]
ImageKinds = Union[ImageKind, Iterable[ImageKind]]
ImageSize = Union[int, Tuple[int, int]]  # pixels a side, or width and height
LookName = Literal["wide"]
Look = Union[LookName, Mapping[str, Union[float, Range]], "LookRanges", None]

# Results.
FloatArray = NDArray[np.float64]
Float32Array = NDArray[np.float32]
ImageArray = NDArray[Any]  # uint8, float32 or int32, by the kind of image
Report = Dict[str, Any]  # of the program's --json
# An array (O) float32, or with cameras a dict of "state" and images.
Observation = Any
Info = Dict[str, Any]
Intrinsics = Tuple[float, float, float, float]  # fx, fy, cx, cy in pixels


class Acting(Protocol):
    """What maps observations (n, O) float32 to actions (n, A), as a Policy does."""

    def act(self, observations: Float32Array, /) -> ArrayLike: ...


class _Outcome(TypedDict):
    name: str
    folder: Optional[pathlib.Path]
    refusal: str
    findings: List[Finding]


class ImportOutcome(_Outcome, total=False):
    """An entry of what ``assets.import_assets`` returns."""

    grade: str


class LibraryOutcome(ImportOutcome):
    """An entry of what ``assets.library`` returns."""

    kind: str


class LiftOutcome(TypedDict):
    """What ``assets.lift`` returns."""

    folder: pathlib.Path
    silhouette_iou: float
    findings: List[Finding]


class SolidFacts(TypedDict):
    """What ``geometry.make_solid`` says about a solid."""

    method: str
    sheet_thickness: float
    findings: List[Finding]


class DecompositionFacts(TypedDict):
    """What ``geometry.decompose`` says about the parts."""

    concavity: float
    deviation: float
    coverage: float


class Estimate(TypedDict):
    """A range, the sample from it, and the range's source."""

    min: float
    max: float
    sample: float
    source: str


class PhysicalParameters(TypedDict):
    """What ``physics.sample`` returns."""

    category: str
    resolution: str
    material: str
    fill: str
    length: Estimate
    width: Estimate
    height: Estimate
    mass: Estimate
    density: Estimate
    friction: Estimate
    restitution: Estimate


class Images(TypedDict):
    """What ``render.render`` returns."""

    color: NDArray[np.uint8]
    depth: Float32Array
    normal: Float32Array
    mask: Float32Array
    label: NDArray[np.int32]
    triangle: NDArray[np.int32]


class FeasibleScene(TypedDict):
    """What ``scenes.make_feasible`` returns."""

    valid: bool
    objects: List[SceneObject]
    indices: List[int]
    dropped: int
    moved: float
    penetration: float
    drift: float


class Evaluation(TypedDict):
    """What ``skills.evaluate`` returns."""

    episodes: int
    successes: int
    success: float
    interval: Tuple[float, float]
    seconds: float


class RewardInput(TypedDict):
    """An entry of ``rewards.Program.inputs``."""

    key: str
    input: str
    asset: str
    part: str
    width: int
    shape: str
    uniform: bool


class CameraState(TypedDict):
    """What ``SkillEnv.camera`` returns."""

    pose: FloatArray
    intrinsics: Intrinsics
    legend: Dict[int, str]


class ObjectState(TypedDict):
    """An entry of ``objects`` of what ``SkillEnv.state`` returns."""

    pose: FloatArray
    joints: Dict[str, float]


class EnvironmentState(TypedDict):
    """What ``SkillEnv.state`` returns."""

    robot_joints: FloatArray
    robot_command: FloatArray
    gripper_pose: FloatArray
    gripper_opening: float
    grasped: bool
    objects: Dict[str, ObjectState]
    target: str
    seconds: float


class ObjectTrack(TypedDict):
    """An entry of ``demonstrations.Episode.objects``."""

    poses: FloatArray
    joints: FloatArray
    joint_names: List[str]


class Description(TypedDict):
    """What ``demonstrations.describe`` returns."""

    task: str
    instructions: List[str]
    base: FloatArray
    legend: Dict[int, str]


class WrittenTotals(TypedDict):
    """What the writers of demonstrations return."""

    path: str
    episodes: int
    steps: int
    successes: int
