"""Loads LeRobot data sets with the package lerobot, and trains ACT on one, without downloads."""

import os

import numpy as np
import pytest

os.environ.setdefault("HF_HUB_OFFLINE", "1")
os.environ.setdefault("HF_DATASETS_OFFLINE", "1")
module = pytest.importorskip("lerobot.datasets.lerobot_dataset",
                             reason="lerobot is missing (requirements-lerobot.txt)")
torch = pytest.importorskip("torch")

import simwright as sw  # noqa: E402
from simwright import demonstrations  # noqa: E402

REPO = "simwright/drawers"


@pytest.fixture(scope="module")
def episodes():
    """Three successes and a failure."""
    return list(demonstrations.record("open_drawer", 4, instances=4, image_size=64, seed=3,
                                      keep="all", episode_seconds=4.0))


@pytest.fixture(scope="module")
def folder(tmp_path_factory, episodes):
    root = tmp_path_factory.mktemp("lerobot") / "drawers"
    report = demonstrations.write_lerobot(root, iter(episodes), repo_id=REPO)
    assert report["episodes"] == 4
    assert report["successes"] == sum(episode.success for episode in episodes) == 3
    return root


@pytest.fixture(scope="module")
def dataset(folder):
    return module.LeRobotDataset(REPO, root=folder, video_backend="pyav")


def starts(episodes):
    return np.cumsum([0] + [len(episode) for episode in episodes])


def test_the_data_set_is_version_3(dataset, episodes):
    assert str(dataset.meta.info["codebase_version"]) == "v3.0"
    assert dataset.fps == 20 and dataset.num_episodes == 4
    assert len(dataset) == starts(episodes)[-1]
    assert set(dataset.meta.camera_keys) == {"observation.images.front", "observation.images.wrist"}
    assert set(dataset.meta.video_keys) == set(dataset.meta.camera_keys)
    assert dataset.meta.robot_type == "panda"
    assert dataset.meta.features["observation.state"]["names"][-1] == "gripper_opening"


def test_values_are_those_recorded(dataset, episodes):
    table = dataset.hf_dataset.with_format("numpy")
    for number, (episode, start) in enumerate(zip(episodes, starts(episodes))):
        rows = table[int(start):int(start) + len(episode)]

        def column(name):
            return np.stack([np.asarray(value) for value in rows[name]])

        np.testing.assert_array_equal(column("observation.state")[:, :7],
                                      episode.joints[:-1].astype(np.float32))
        np.testing.assert_array_equal(column("observation.state")[:, 7],
                                      episode.openings[:-1].astype(np.float32))
        np.testing.assert_array_equal(column("observation.environment_state"), episode.states[:-1])
        np.testing.assert_array_equal(column("action"), episode.targets.astype(np.float32))
        np.testing.assert_array_equal(column("policy_action"), episode.actions)
        np.testing.assert_array_equal(column("next.reward").ravel(), episode.rewards)
        np.testing.assert_array_equal(column("next.done").ravel(), episode.dones)
        np.testing.assert_array_equal(column("next.success").ravel(), episode.goals)
        assert (column("episode_success").ravel() == episode.success).all()
        assert (column("episode_index").ravel() == number).all()
        np.testing.assert_allclose(column("timestamp").ravel(), episode.times[:-1], atol=1e-6)


def test_images_and_sentences(dataset, episodes):
    for episode, start in zip(episodes, starts(episodes)):
        for step in (0, len(episode) // 2, len(episode) - 1):
            item = dataset[int(start) + step]
            assert item["task"] == episode.instruction
            for name in ("front", "wrist"):
                image = item[f"observation.images.{name}"]
                assert image.shape == (3, 64, 64) and image.dtype == torch.float32
                error = 255 * image.permute(1, 2, 0).numpy() - episode.images[name][step]
                # The codec is lossy: its mean error is a few levels, of 255.
                assert np.abs(error).mean() < 6.0


def test_statistics_are_numpys(dataset, episodes):
    joints = np.concatenate([episode.joints[:-1] for episode in episodes]).astype(np.float32)
    found = dataset.meta.stats["observation.state"]
    np.testing.assert_allclose(found["mean"][:7], joints.mean(axis=0), atol=1e-4)
    np.testing.assert_allclose(found["std"][:7], joints.std(axis=0), atol=1e-4)
    np.testing.assert_allclose(found["min"][:7], joints.min(axis=0), atol=1e-6)
    np.testing.assert_allclose(found["max"][:7], joints.max(axis=0), atol=1e-6)


def test_act_trains(folder):
    from lerobot.configs.types import FeatureType
    from lerobot.datasets.utils import dataset_to_policy_features
    from lerobot.policies.act.configuration_act import ACTConfig
    from lerobot.policies.act.modeling_act import ACTPolicy
    from lerobot.policies.factory import make_pre_post_processors

    chunk = 10
    dataset = module.LeRobotDataset(REPO, root=folder, video_backend="pyav", delta_timestamps={
        "action": [step / 20 for step in range(chunk)]})
    features = dataset_to_policy_features(dataset.meta.features)
    outputs = {key: value for key, value in features.items() if value.type is FeatureType.ACTION}
    assert list(outputs) == ["action"]
    inputs = {key: value for key, value in features.items() if key not in outputs}
    del inputs["observation.environment_state"]  # ACT sees the images and the robot alone
    torch.manual_seed(1)
    torch.set_num_threads(2)
    config = ACTConfig(input_features=inputs, output_features=outputs, chunk_size=chunk,
                       n_action_steps=chunk, pretrained_backbone_weights=None, dim_model=64,
                       n_heads=4, dim_feedforward=128, n_encoder_layers=2, n_vae_encoder_layers=2,
                       latent_dim=8, device="cpu", optimizer_lr=3e-4)
    policy = ACTPolicy(config)
    prepare, _ = make_pre_post_processors(config, dataset_stats=dataset.meta.stats)
    optimizer = torch.optim.AdamW(policy.parameters(), lr=3e-4)
    loader = torch.utils.data.DataLoader(dataset, batch_size=8, shuffle=True, num_workers=0,
                                         generator=torch.Generator().manual_seed(1))
    losses = []
    while len(losses) < 20:
        for batch in loader:
            loss, _ = policy(prepare(batch))
            optimizer.zero_grad()
            loss.backward()
            optimizer.step()
            losses.append(float(loss))
            if len(losses) == 20:
                break
    assert np.isfinite(losses).all() and np.mean(losses[-5:]) < 0.7 * np.mean(losses[:5])


def test_images_in_tables(tmp_path, episodes):
    root = tmp_path / "pictures"
    demonstrations.write_lerobot(root, episodes[:1], repo_id=REPO, videos=False, actions="policy")
    dataset = module.LeRobotDataset(REPO, root=root)
    item = dataset[5]
    image = np.rint(255 * item["observation.images.front"].permute(1, 2, 0).numpy())
    np.testing.assert_array_equal(image, episodes[0].images["front"][5])  # PNG loses nothing
    np.testing.assert_array_equal(item["action"].numpy(), episodes[0].actions[5])


def test_errors(tmp_path, folder, episodes):
    with pytest.raises(sw.Error, match="exists"):
        demonstrations.write_lerobot(folder, episodes)
    with pytest.raises(sw.Error, match="no episode"):
        demonstrations.write_lerobot(tmp_path / "none", [])
    with pytest.raises(sw.Error, match="20 frames"):
        demonstrations.write_lerobot(tmp_path / "fast", episodes, fps=30)
    other = demonstrations.record("open_drawer", 1, instances=4, image_size=32)
    with pytest.raises(sw.Error, match="other features"):
        demonstrations.write_lerobot(tmp_path / "mixed", [episodes[0], next(other)])
    assert not any(tmp_path.iterdir())
