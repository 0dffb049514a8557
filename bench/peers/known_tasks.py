"""Compares the sample efficiency of PPO with Stable-Baselines3's on Reacher-v5 and Pusher-v5.

    .venv-python/bin/python bench/peers/known_tasks.py build/bin/bench_known_tasks [--seeds 3]

Both learn in MuJoCo from the model files of Gymnasium, with 16 environments and 2048 samples per
update: ours from bench/rl/mujoco_task.cpp in libmujoco, SB3 with its default settings from
Gymnasium's environments. As the samples grow, 50 episodes are played with the mean action; their
mean return is printed, averaged over the seeds, with the least and the greatest.
"""

import argparse
import subprocess
import sys
from pathlib import Path

import gymnasium
import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.env_util import make_vec_env

TASKS = {"reacher": ("Reacher-v5", "reacher.xml"), "pusher": ("Pusher-v5", "pusher_v5.xml")}
PLAYED, ENVIRONMENTS = 50, 16


def mean_return(model, task):
    """Returns the mean return of PLAYED episodes with the mean action."""
    worlds = gymnasium.make_vec(task, num_envs=PLAYED)
    observations, _ = worlds.reset(seed=12345)
    total, ended = 0.0, np.zeros(PLAYED, bool)
    while not ended.all():
        actions, _ = model.predict(observations, deterministic=True)
        observations, rewards, terminated, truncated, _ = worlds.step(actions)
        total += rewards[~ended].sum()
        ended |= terminated | truncated
    worlds.close()
    return total / PLAYED


class Play(BaseCallback):
    """Plays every `every` samples and keeps the mean returns."""

    def __init__(self, task, every):
        super().__init__()
        self.task, self.every, self.next, self.returns = task, every, every, []

    def _on_step(self):
        return True

    def _on_rollout_start(self):
        if self.num_timesteps >= self.next:
            self.next += self.every
            self.returns.append(mean_return(self.model, self.task))


def of_sb3(task, seed, samples, every):
    """Returns SB3's mean returns at each multiple of `every` samples."""
    model = PPO("MlpPolicy", make_vec_env(task, ENVIRONMENTS, seed=seed), seed=seed, device="cpu",
                n_steps=2048 // ENVIRONMENTS)
    play = Play(task, every)
    model.learn(samples + 2048, callback=play)  # the last evaluation precedes an update
    return play.returns


def of_simwright(program, task, seed, samples, every):
    """Returns our mean returns at each multiple of `every` samples."""
    model = Path(gymnasium.__file__).parent / "envs" / "mujoco" / "assets" / TASKS[task][1]
    lines = subprocess.run(
        [program, "--task", task, "--model", model, "--seeds", "1", "--first-seed", str(seed),
         "--samples", str(samples), "--play-every", str(every), "--threads", "1"],
        check=True, capture_output=True, text=True).stdout.splitlines()
    return [float(line.split()[3]) for line in lines]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", help="bench_known_tasks")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--first-seed", type=int, default=201)
    parser.add_argument("--samples", type=int, default=204_800)
    parser.add_argument("--play-every", type=int, default=40_960)
    options = parser.parse_args()
    torch.set_num_threads(1)
    counts = range(options.play_every, options.samples + 1, options.play_every)
    print("| task | PPO of | " + " | ".join(f"{count // 1000}k" for count in counts) + " |")
    print("|---" * (2 + len(counts)) + "|")
    behind = False
    for task, (name, _) in TASKS.items():
        last = []
        for who in ("Simwright", "SB3"):
            runs = []
            for seed in range(options.first_seed, options.first_seed + options.seeds):
                schedule = (seed, options.samples, options.play_every)
                runs.append(of_simwright(options.program, task, *schedule) if who == "Simwright"
                            else of_sb3(name, *schedule))
            returns = np.array([run[:len(counts)] for run in runs])
            print(f"| {name} | {who} | " + " | ".join(
                f"{mean:.1f} ({low:.1f} to {high:.1f})"
                for mean, low, high in zip(returns.mean(0), returns.min(0), returns.max(0)))
                + " |", flush=True)
            last.append(returns.mean(0)[-1])
        behind |= last[0] < last[1]
    return 1 if behind else 0


if __name__ == "__main__":
    sys.exit(main())
