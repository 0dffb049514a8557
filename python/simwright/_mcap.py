"""MCAP files of ROS 2 messages."""

from __future__ import annotations

import json
import struct
import zlib
from pathlib import Path
from typing import TYPE_CHECKING, Any, Iterable, Sequence

import numpy as np

from . import _arguments as checked
from ._output import Totals, need, placed
from ._robomimic import xyzw

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from . import _types
    from .demonstrations import Episode

_GAP_SECONDS = 1.0
_RULE = "\n" + "=" * 80 + "\n"
_TIME = "int32 sec\nuint32 nanosec\n"
_HEADER = "builtin_interfaces/Time stamp\nstring frame_id\n"
_VECTOR = "float64 x\nfloat64 y\nfloat64 z\n"
_QUATERNION = "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"


def _definition(text: str, **parts: Any) -> str:
    """Joins a message definition and those that it needs, as ros2msg schemas do."""
    names = {"time": ("builtin_interfaces/Time", _TIME), "header": ("std_msgs/Header", _HEADER),
             "vector": ("geometry_msgs/Vector3", _VECTOR),
             "quaternion": ("geometry_msgs/Quaternion", _QUATERNION)}
    known = [names[part] for part in names if parts.pop(part, 0)]
    known += [(name.replace("__", "/"), body) for name, body in parts.items()]
    return text + "".join(f"{_RULE}MSG: {name}\n{body}" for name, body in known)


_STAMPED = ("std_msgs/Header header\nstring child_frame_id\n"
            "geometry_msgs/Transform transform\n")
_TRANSFORM = "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"
_SCHEMAS = {
    "sensor_msgs/msg/JointState": _definition(
        "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
        "float64[] effort\n", time=1, header=1),
    "tf2_msgs/msg/TFMessage": _definition(
        "geometry_msgs/TransformStamped[] transforms\n", time=1, header=1, vector=1, quaternion=1,
        geometry_msgs__TransformStamped=_STAMPED, geometry_msgs__Transform=_TRANSFORM),
    "sensor_msgs/msg/CompressedImage": _definition(
        "std_msgs/Header header\nstring format\nuint8[] data\n", time=1, header=1),
    "sensor_msgs/msg/CameraInfo": _definition(
        "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\n"
        "float64[] d\nfloat64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\n"
        "uint32 binning_y\n"
        "sensor_msgs/RegionOfInterest roi\n", time=1, header=1,
        sensor_msgs__RegionOfInterest="uint32 x_offset\nuint32 y_offset\nuint32 height\n"
                                      "uint32 width\nbool do_rectify\n"),
    "std_msgs/msg/String": "string data\n",
    "std_msgs/msg/Float32": "float32 data\n",
    "std_msgs/msg/Bool": "bool data\n",
}


def png(image: NDArray[np.uint8]) -> bytes:
    """Returns the bytes of a PNG of an image (H, W, 3) uint8 RGB."""
    height, width, _ = image.shape
    rows = np.zeros((height, 1 + 3 * width), np.uint8)  # the first byte of a row: no filter
    rows[:, 1:] = image.reshape(height, 3 * width)

    def chunk(kind: bytes, body: bytes) -> bytes:
        return (struct.pack(">I", len(body)) + kind + body
                + struct.pack(">I", zlib.crc32(kind + body)))

    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head)
            + chunk(b"IDAT", zlib.compress(rows.tobytes(), 6)) + chunk(b"IEND", b""))


def write_mcap(path: _types.Path, episodes: Iterable[Episode],
               start_seconds: float = 0.0) -> _types.WrittenTotals:
    """Writes demonstrations as MCAP files of ROS 2 messages, for ``ros2 bag`` and Foxglove.

    Args:
        path (path): NAME.mcap, one file in which a second separates the episodes, or a folder,
            which must not exist, of one file for each episode (episode_000001.mcap ...).
        episodes: iterable of Episode.
        start_seconds (float): stamp of the first frame, s.

    Returns:
        dict: ``path``, ``episodes``, ``steps``, ``successes``.

    Raises:
        Error: where mcap-ros2-support is missing, or there is no episode.
    """
    ros2 = need("mcap_ros2.writer", "mcap")
    path = checked.path("path", path)
    totals = Totals(path)
    one_file = Path(path).suffix == ".mcap"
    with placed(path, one_file) as partial:
        if one_file:
            with open(partial, "wb") as stream, ros2.Writer(stream) as writer:
                file, begin = _File(writer), start_seconds
                for episode in episodes:
                    file.write(episode, begin)
                    begin += float(episode.times[-1]) + _GAP_SECONDS
                    totals.add(episode)
        else:
            partial.mkdir()
            for episode in episodes:
                name = f"episode_{totals.episodes + 1:06d}.mcap"
                with open(partial / name, "wb") as stream, ros2.Writer(stream) as writer:
                    _File(writer).write(episode, start_seconds)
                totals.add(episode)
        report = totals.report()
    return report


class _File:
    """Writes the messages of episodes into an open file."""

    def __init__(self, writer: Any) -> None:
        self._writer = writer
        self._schemas: dict[str, Any] = {}
        self._time = 0

    def write(self, episode: Episode, begin: float) -> None:
        """Writes an episode whose first frame has the stamp `begin`, s."""
        for step in range(len(episode) + 1):
            self._time = round((begin + float(episode.times[step])) * 1e9)
            self._write_state(episode, step)
            self._write_images(episode, step)
            sentence = episode.instructions[int(episode.subtasks[step])]
            if step == 0 or episode.subtasks[step] != episode.subtasks[step - 1]:
                self._send("/instruction", "std_msgs/msg/String", {"data": sentence})
            if step > 0:
                self._send("/reward", "std_msgs/msg/Float32",
                           {"data": float(episode.rewards[step - 1])})
        self._send("/success", "std_msgs/msg/Bool", {"data": episode.success})
        self._writer.add_metadata("simwright_episode", {
            "skill": episode.skill, "task": episode.task, "instruction": episode.instruction,
            "robot": episode.robot, "seed": str(episode.seed), "index": str(episode.index),
            "success": str(episode.success).lower(), "legend": json.dumps(episode.legend)})

    def _send(self, topic: str, kind: str, message: dict[str, Any]) -> None:
        if kind not in self._schemas:
            self._schemas[kind] = self._writer.register_msgdef(kind, _SCHEMAS[kind])
        self._writer.write_message(topic, self._schemas[kind], message, self._time, self._time)

    def _header(self, frame: str) -> dict[str, Any]:
        return {"stamp": {"sec": self._time // 10**9, "nanosec": self._time % 10**9},
                "frame_id": frame}

    def _write_state(self, episode: Episode, step: int) -> None:
        finger = 0.5 * float(episode.openings[step])
        fingers = [f"{_prefix(episode)}finger_joint{number}" for number in (1, 2)]
        self._joints("/joint_states", list(episode.joint_names) + fingers,
                     episode.joints[step].tolist() + [finger, finger])
        for name, entry in episode.objects.items():
            if len(entry["joint_names"]):
                self._joints(f"/objects/{name}/joint_states", list(entry["joint_names"]),
                             entry["joints"][step].tolist())
        if step < len(episode):
            self._joints("/joint_commands", list(episode.joint_names) + ["gripper"],
                         episode.commands[step].tolist())
        frames = [("world", "robot_base", episode.base),
                  ("robot_base", "tool", episode.tools[step])]
        frames += [("world", name, entry["poses"][step]) for name, entry in episode.objects.items()]
        frames += [("world", f"{name}_optical_frame", poses[step])
                   for name, poses in episode.camera_poses.items()]
        self._send("/tf", "tf2_msgs/msg/TFMessage",
                   {"transforms": [self._transform(*frame) for frame in frames]})

    def _joints(self, topic: str, names: Sequence[str], positions: Sequence[float]) -> None:
        self._send(topic, "sensor_msgs/msg/JointState",
                   {"header": self._header(""), "name": names, "position": positions,
                    "velocity": [], "effort": []})

    def _transform(self, parent: str, child: str, pose: _types.FloatArray) -> dict[str, Any]:
        quaternion = xyzw(pose[None, :3, :3])[0]
        return {"header": self._header(parent), "child_frame_id": child, "transform": {
            "translation": dict(zip("xyz", map(float, pose[:3, 3]))),
            "rotation": dict(zip("xyzw", map(float, quaternion)))}}

    def _write_images(self, episode: Episode, step: int) -> None:
        for name, intrinsics in episode.intrinsics.items():
            if name not in episode.images:
                continue
            image = episode.images[name][step]
            header = self._header(f"{name}_optical_frame")
            self._send(f"/{name}/image/compressed", "sensor_msgs/msg/CompressedImage",
                       {"header": header, "format": "png", "data": png(image)})
            fx, fy, cx, cy = map(float, intrinsics)
            whole = {"x_offset": 0, "y_offset": 0, "height": 0, "width": 0, "do_rectify": False}
            self._send(f"/{name}/camera_info", "sensor_msgs/msg/CameraInfo", {
                "header": header, "height": image.shape[0], "width": image.shape[1],
                "distortion_model": "plumb_bob", "d": [0.0] * 5,
                "k": [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0],
                "r": [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
                "p": [fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0],
                "binning_x": 0, "binning_y": 0,
                "roi": whole})


def _prefix(episode: Episode) -> str:
    """Returns the prefix of the names of links: that of the Panda's, or none."""
    return "panda_" if episode.joint_names[0].startswith("panda_") else ""
