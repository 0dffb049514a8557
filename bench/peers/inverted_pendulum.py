"""Counts the samples until Stable-Baselines3's PPO balances Gymnasium's inverted pendulum.

    .venv-python/bin/python bench/peers/inverted_pendulum.py [--seeds 5] [--first-seed 101]

The counterpart of bench_inverted_pendulum: InvertedPendulum-v5 in MuJoCo, SB3's default settings
with one and with 16 environments. Every --play-every samples the policy plays 20 episodes with its
mean action; the samples at which their mean return first reaches 950 of 1000 are printed.
"""

import argparse
import time

import gymnasium
import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.env_util import make_vec_env

TASK = "InvertedPendulum-v5"
PLAYED = 20


def mean_return(model):
    worlds = gymnasium.make_vec(TASK, num_envs=PLAYED)
    observations, _ = worlds.reset(seed=12345)
    lasted = np.zeros(PLAYED, int)
    for step in range(1, 1001):
        actions, _ = model.predict(observations, deterministic=True)
        observations, _, terminated, truncated, _ = worlds.step(actions)
        lasted[(lasted == 0) & (terminated | truncated)] = step
        if lasted.all():
            break
    worlds.close()
    lasted[lasted == 0] = 1000
    return lasted.mean()


class Play(BaseCallback):
    def __init__(self, every):
        super().__init__()
        self.every = self.next = every
        self.solved = 0

    def _on_step(self):
        return self.solved == 0

    def _on_rollout_start(self):
        if self.num_timesteps < self.next:
            return
        self.next = self.num_timesteps + self.every
        if mean_return(self.model) >= 950.0:
            self.solved = self.num_timesteps


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--first-seed", type=int, default=101)
    parser.add_argument("--samples", type=int, default=100_000)
    parser.add_argument("--play-every", type=int, default=2048)
    options = parser.parse_args()
    torch.set_num_threads(1)
    print("| environments | seed | samples to 950 | s |\n|---|---|---|---|")
    for count in (1, 16):
        for seed in range(options.first_seed, options.first_seed + options.seeds):
            start = time.perf_counter()
            # Both numbers of environments have 2048 samples per update.
            model = PPO("MlpPolicy", make_vec_env(TASK, count, seed=seed), seed=seed, device="cpu",
                        n_steps=2048 // count)
            play = Play(options.play_every)
            model.learn(options.samples, callback=play)
            print(f"| {count} | {seed} | {play.solved or 'not'} | "
                  f"{time.perf_counter() - start:.0f} |", flush=True)


if __name__ == "__main__":
    main()
