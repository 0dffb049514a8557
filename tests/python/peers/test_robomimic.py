"""robomimic's own loader, tools and training on HDF5 files with images."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

os.environ.setdefault("MUJOCO_GL", "disabled")
h5py = pytest.importorskip("h5py", reason="h5py is missing (requirements-robomimic.txt)")
robomimic = pytest.importorskip("robomimic",
                                reason="robomimic is missing (requirements-robomimic.txt)")
torch = pytest.importorskip("torch")

import simwright as sw  # noqa: E402
from simwright import demonstrations  # noqa: E402

LOW_DIM = ["robot0_joint_pos", "robot0_eef_pos", "robot0_eef_quat", "robot0_gripper_qpos"]


@pytest.fixture(scope="module")
def episodes():
    return list(demonstrations.record("open_drawer", 4, instances=4, image_size=32, seed=3,
                                      keep="all", episode_seconds=4.0, images=["rgb", "depth"]))


@pytest.fixture(scope="module")
def file(tmp_path_factory, episodes):
    path = tmp_path_factory.mktemp("robomimic") / "drawers.hdf5"
    report = demonstrations.write_robomimic(path, iter(episodes))
    assert report["episodes"] == 4 and report["successes"] == 3
    return path


def test_values(file, episodes):
    with h5py.File(file) as opened:
        data = opened["data"]
        assert data.attrs["total"] == sum(len(episode) for episode in episodes)
        told = json.loads(data.attrs["env_args"])
        assert told["env_name"] == "simwright/OpenDrawer-v0" and told["type"] == 2
        assert told["env_kwargs"]["action_space"] == "joint_targets"
        for number, episode in enumerate(episodes):
            demo = data[f"demo_{number}"]
            assert demo.attrs["num_samples"] == len(episode)
            assert demo.attrs["success"] == episode.success
            assert demo.attrs["instruction"] == episode.instruction
            np.testing.assert_array_equal(demo["rewards"], episode.rewards)
            np.testing.assert_array_equal(demo["dones"], episode.dones)
            np.testing.assert_array_equal(demo["policy_actions"], episode.actions)
            assert np.abs(demo["actions"]).max() <= 1.0
            for key, rows in (("obs", slice(None, -1)), ("next_obs", slice(1, None))):
                for name in ("front", "wrist"):
                    image = demo[f"{key}/{name}_image"]
                    assert image.dtype == np.uint8 and image.shape[1:] == (32, 32, 3)
                    np.testing.assert_array_equal(image, episode.images[name][rows])
                    np.testing.assert_array_equal(demo[f"{key}/{name}_depth"][..., 0],
                                                  episode.images[f"{name}_depth"][rows])
                np.testing.assert_array_equal(demo[f"{key}/policy"], episode.states[rows])
                np.testing.assert_array_equal(demo[f"{key}/robot0_joint_pos"],
                                              episode.joints[rows].astype(np.float32))
                np.testing.assert_allclose(demo[f"{key}/robot0_eef_pos"],
                                           episode.tools[rows, :3, 3], atol=1e-6)
                np.testing.assert_allclose(
                    np.linalg.norm(demo[f"{key}/robot0_eef_quat"], axis=1), 1.0, atol=1e-6)
        masks = {name: [text.decode() for text in names] for name, names in opened["mask"].items()}
        assert sorted(masks["train"] + masks["valid"]) == [f"demo_{i}" for i in range(4)]
        assert masks["success"] == [f"demo_{i}" for i in range(4) if episodes[i].success]
        assert masks["failure"] == [f"demo_{i}" for i in range(4) if not episodes[i].success]


def test_robomimics_tool_reads_the_file(file):
    script = Path(robomimic.__path__[0]) / "scripts" / "get_dataset_info.py"
    told = subprocess.run([sys.executable, str(script), "--dataset", str(file)], text=True,
                          capture_output=True)
    assert told.returncode == 0, told.stderr
    assert "simwright/OpenDrawer-v0" in told.stdout and "front_image" in told.stdout


def train(file, folder, low_dim, rgb):
    """Trains BC for two epochs by robomimic's script; returns its losses."""
    import robomimic.utils.train_utils as train_utils
    from robomimic.config import config_factory
    from robomimic.scripts import train as script

    config = config_factory("bc")
    with config.values_unlocked():
        config.train.data = str(file)
        config.train.output_dir = str(folder)
        config.train.hdf5_filter_key, config.train.hdf5_validation_filter_key = "train", "valid"
        config.train.hdf5_cache_mode = None if rgb else "all"
        config.train.num_data_workers, config.train.num_epochs = 0, 2
        config.train.batch_size, config.train.seed = 8, 1
        config.train.cuda = False
        config.experiment.name = "rgb" if rgb else "states"
        config.experiment.validate = True
        config.experiment.rollout.enabled = False
        config.experiment.render_video = False
        config.experiment.logging.log_tb = False
        config.experiment.logging.terminal_output_to_txt = False
        config.experiment.epoch_every_n_steps = 10
        config.experiment.validation_epoch_every_n_steps = 2
        config.experiment.save.enabled = config.experiment.save.on_best_validation = True
        config.observation.modalities.obs.low_dim = low_dim
        config.observation.modalities.obs.rgb = rgb
        config.observation.encoder.rgb.core_class = "VisualCore"
        config.observation.encoder.rgb.core_kwargs = {
            "feature_dimension": 32, "flatten": True, "backbone_class": "ResNet18Conv",
            "backbone_kwargs": {"pretrained": False, "input_coord_conv": False},
            "pool_class": "SpatialSoftmax", "pool_kwargs": {"num_kp": 16}}
    config.lock()
    losses = []
    run_epoch = train_utils.run_epoch

    def watched(*args, **kwargs):
        log = run_epoch(*args, **kwargs)
        losses.append((kwargs.get("validate", False), log["Loss"]))
        return log

    train_utils.run_epoch = watched
    try:
        script.train(config, device=torch.device("cpu"))
    finally:
        train_utils.run_epoch = run_epoch
    assert list(Path(folder).rglob("*.pth"))
    trained = [loss for validated, loss in losses if not validated]
    assert len(trained) == 2 and len(losses) == 4
    assert np.isfinite([loss for _, loss in losses]).all()
    return trained


def test_bc_on_states(file, tmp_path):
    first, second = train(file, tmp_path, LOW_DIM + ["policy"], [])
    assert second < first


def test_bc_on_images(file, tmp_path):
    first, second = train(file, tmp_path, LOW_DIM, ["front_image", "wrist_image"])
    assert second < first


def test_the_policys_actions(tmp_path, episodes):
    path = tmp_path / "own.hdf5"
    demonstrations.write_robomimic(path, episodes[:1], actions="policy")
    with h5py.File(path) as opened:
        np.testing.assert_array_equal(opened["data/demo_0/actions"], episodes[0].actions)
        assert json.loads(opened["data"].attrs["env_args"])["env_kwargs"]["action_space"] == "focus"


def test_errors(tmp_path, episodes):
    with pytest.raises(sw.Error, match="no episode"):
        demonstrations.write_robomimic(tmp_path / "none.hdf5", [])
    other = next(demonstrations.record("open_drawer", 1, instances=4, image_size=16))
    with pytest.raises(sw.Error, match="other observations"):
        demonstrations.write_robomimic(tmp_path / "mixed.hdf5", [episodes[0], other])
    with pytest.raises(sw.Error, match="valid_share"):
        demonstrations.write_robomimic(tmp_path / "all.hdf5", episodes, valid_share=1.0)
    with pytest.raises(sw.Error, match="torques"):
        demonstrations.write_robomimic(tmp_path / "all.hdf5", episodes, actions="torques")
    assert not any(tmp_path.iterdir())
