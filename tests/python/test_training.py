"""Training with the libraries that people use."""

import numpy as np
import pytest

import simwright as sw
from conftest import SOURCE

sb3 = pytest.importorskip("stable_baselines3")
from stable_baselines3.common.callbacks import BaseCallback  # noqa: E402
from stable_baselines3.common.env_checker import check_env  # noqa: E402

from simwright import envs  # noqa: E402
from simwright.sb3 import VecEnv  # noqa: E402


def test_check_env():
    check_env(envs.SkillEnv(cell="open_drawer", instances=4))


class Successes(BaseCallback):
    """Collects the successes of ended episodes."""

    def __init__(self):
        super().__init__()
        self.rates = []

    def _on_step(self):
        return True

    def _on_rollout_end(self):
        self.rates.append(float(np.mean(self.model.ep_success_buffer)))


# Without updates, 0.5 to 0.8 of the episodes with easy starts close the drawer.
def test_ppo_learns_to_close_drawers():
    env = VecEnv("simwright/CloseDrawer-v0", num_envs=64, instances=4, easy_starts=True)
    model = sb3.PPO("MlpPolicy", env, n_steps=64, batch_size=512, n_epochs=8, learning_rate=5e-4,
                    gamma=0.98, policy_kwargs=dict(log_std_init=-1.0, net_arch=[128, 128]), seed=1)
    seen = Successes()
    model.learn(53_248, callback=seen)
    # The first rates count only short, successful episodes; episodes last 160 steps.
    early, late = np.mean(seen.rates[3:6]), np.mean(seen.rates[-3:])
    assert late > max(early + 0.12, 0.82), (early, late, seen.rates)


def test_terminal_observations():
    env = VecEnv("simwright/OpenDrawer-v0", num_envs=2, instances=4, episode_seconds=0.2)
    env.seed(3)
    first = env.reset()
    for _ in range(4):
        observations, rewards, dones, infos = env.step(np.zeros((2, 7), np.float32))
    assert dones.all() and all(info["TimeLimit.truncated"] for info in infos)
    assert infos[0]["episode"]["l"] == 4
    assert not np.array_equal(infos[0]["terminal_observation"], observations[0])
    env.seed(3)
    np.testing.assert_array_equal(first, env.reset())
    with pytest.raises(sw.Error):
        env.set_attr("task", None)


def test_ppo_in_one_file_learns():
    import sys

    sys.path.insert(0, str(SOURCE / "examples" / "python"))
    import ppo

    flags = ppo.arguments().parse_args(["--env", "simwright/CloseDrawer-v0", "--instances", "4",
                                        "--steps", "53248"])
    agent, rates = ppo.train(flags, report=lambda line: None)
    early, late = np.mean(rates[2:6]), np.mean(rates[-3:])
    assert late > max(early + 0.12, 0.82), (early, late, rates)
    assert all(bool(parameter.isfinite().all()) for parameter in agent.parameters())
