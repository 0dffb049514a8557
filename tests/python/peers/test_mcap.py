"""Reads MCAP files with the readers of the packages mcap and mcap-ros2-support."""

import io

import numpy as np
import pytest

reader = pytest.importorskip("mcap.reader", reason="mcap is missing (requirements-mcap.txt)")
decoder = pytest.importorskip("mcap_ros2.decoder", reason="mcap-ros2-support is missing")
Image = pytest.importorskip("PIL.Image", reason="Pillow is missing")

import simwright as sw  # noqa: E402
from simwright import demonstrations  # noqa: E402


@pytest.fixture(scope="module")
def episodes():
    return list(demonstrations.record("open_drawer", 2, instances=4, image_size=24, seed=3))


def messages(path):
    """Returns the messages by topic, as (log time in ns, message)."""
    found = {}
    with open(path, "rb") as stream:
        opened = reader.make_reader(stream, decoder_factories=[decoder.DecoderFactory()])
        assert opened.get_header().profile == "ros2"
        for _, channel, message, decoded in opened.iter_decoded_messages():
            assert channel.message_encoding == "cdr"
            found.setdefault(channel.topic, []).append((message.log_time, decoded))
    return found


def stamp(header):
    return header.stamp.sec * 10**9 + header.stamp.nanosec


def matrix(transform):
    x, y, z, w = (getattr(transform.rotation, axis) for axis in "xyzw")
    pose = np.eye(4)
    # Rotation of each axis by the quaternion, v + 2 w (q x v) + 2 q x (q x v).
    q = np.array([x, y, z])
    for column, axis in enumerate(np.eye(3)):
        pose[:3, column] = axis + 2 * w * np.cross(q, axis) + 2 * np.cross(q, np.cross(q, axis))
    pose[:3, 3] = [getattr(transform.translation, axis) for axis in "xyz"]
    return pose


def test_a_folder_of_files(tmp_path, episodes):
    report = demonstrations.write_mcap(tmp_path / "demos", episodes)
    assert report["episodes"] == 2 and report["successes"] == 2
    assert sorted(file.name for file in (tmp_path / "demos").iterdir()) == [
        "episode_000001.mcap", "episode_000002.mcap"]
    for number, episode in enumerate(episodes, start=1):
        found = messages(tmp_path / "demos" / f"episode_{number:06d}.mcap")
        states = found["/joint_states"]
        assert len(states) == len(episode) + 1
        for step, (time, message) in enumerate(states):
            assert time == stamp(message.header) == step * 50_000_000
            assert list(message.name[:7]) == [f"panda_joint{j}" for j in range(1, 8)]
            np.testing.assert_array_equal(message.position[:7], episode.joints[step])
            assert sum(message.position[7:]) == pytest.approx(episode.openings[step], abs=1e-12)
        commands = [message.position for _, message in found["/joint_commands"]]
        np.testing.assert_array_equal(commands, episode.commands)
        for name in ("front", "wrist"):
            for step, (time, message) in enumerate(found[f"/{name}/image/compressed"]):
                assert time == stamp(message.header) == step * 50_000_000
                image = np.asarray(Image.open(io.BytesIO(bytes(message.data))))
                np.testing.assert_array_equal(image, episode.images[name][step])
            info = found[f"/{name}/camera_info"][0][1]
            assert (info.width, info.height) == (24, 24)
            assert tuple(info.k[i] for i in (0, 4, 2, 5)) == pytest.approx(episode.intrinsics[name])
        assert found["/instruction"][0][1].data == episode.instruction
        assert found["/success"][0][1].data is True
        rewards = [message.data for _, message in found["/reward"]]
        np.testing.assert_array_equal(np.float32(rewards), episode.rewards)


def test_transforms(tmp_path, episodes):
    demonstrations.write_mcap(tmp_path / "one.mcap", episodes[:1])
    episode = episodes[0]
    for step, (_, message) in enumerate(messages(tmp_path / "one.mcap")["/tf"]):
        frames = {one.child_frame_id: one for one in message.transforms}
        tool = frames["tool"]
        assert tool.header.frame_id == "robot_base"
        np.testing.assert_allclose(matrix(tool.transform), episode.tools[step], atol=1e-9)
        (name, entry), = episode.objects.items()
        np.testing.assert_allclose(matrix(frames[name].transform), entry["poses"][step], atol=1e-9)
        np.testing.assert_allclose(matrix(frames["wrist_optical_frame"].transform),
                                   episode.camera_poses["wrist"][step], atol=1e-9)


def test_one_file_of_several_episodes(tmp_path, episodes):
    path = tmp_path / "all.mcap"
    demonstrations.write_mcap(path, iter(episodes), start_seconds=100.0)
    times = [time for time, _ in messages(path)["/joint_states"]]
    first = len(episodes[0]) + 1
    assert times[0] == 100 * 10**9 and np.diff(times)[first - 1] == 10**9
    assert (np.delete(np.diff(times), first - 1) == 50_000_000).all()
    with open(path, "rb") as stream:
        kept = [entry.metadata for entry in reader.make_reader(stream).iter_metadata()]
    assert [entry["task"] for entry in kept] == [episode.task for episode in episodes]
    assert [entry["success"] for entry in kept] == ["true", "true"]


def test_nothing_is_left_of_a_failed_run(tmp_path, episodes):
    def broken():
        yield episodes[0]
        raise sw.Error("the recording: stopped")

    for name in ("one.mcap", "demos"):
        with pytest.raises(sw.Error, match="stopped"):
            demonstrations.write_mcap(tmp_path / name, broken())
        with pytest.raises(sw.Error, match="no episode"):
            demonstrations.write_mcap(tmp_path / name, [])
    assert not any(tmp_path.iterdir())
    (tmp_path / "demos").mkdir()
    with pytest.raises(sw.Error, match="exists"):
        demonstrations.write_mcap(tmp_path / "demos", episodes)


def test_the_command(tmp_path, capsys):
    told = ["--skill", "open_drawer", "--episodes", "1", "--format", "mcap", "--instances", "4",
            "--cameras", "front", "--image-size", "16", "--look", "wide", "--quiet"]
    assert demonstrations.main(told + ["-o", str(tmp_path / "a")]) == 0
    assert "1 episodes" in capsys.readouterr().out
    assert demonstrations.main(told + ["-o", str(tmp_path / "b")]) == 0
    first, second = (next((tmp_path / name).iterdir()).read_bytes() for name in "ab")
    assert first == second
    assert "/front/image/compressed" in messages(tmp_path / "a" / "episode_000001.mcap")
