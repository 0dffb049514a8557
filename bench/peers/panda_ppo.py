"""Compares PPO on the Panda with Stable-Baselines3 on PyBullet, in control steps per second.

    .venv-python/bin/python bench/peers/panda_ppo.py

Both train on the same bodies: the Panda of robots/, a microwave of the library, whose door has to
be opened, and a cup beside it; 60 Hz of control, 4 substeps, 3 control steps per decision, 70
observations, actor and critic of 256-128-64, 4096 samples per update in 8 epochs of 1024. Ours has
64 environments, which it distributes over two threads. Theirs has --environments processes
(SubprocVecEnv), normalised observations and rewards, and PyTorch on two threads for updates. It
moves joints, without the inverse kinematics, delays and randomised masses of ours, and with 20
solver iterations throughout.
"""

import importlib.metadata
import os
import re
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

import gymnasium
import numpy as np
import pybullet
import torch
from pybullet_utils.bullet_client import BulletClient
from stable_baselines3 import PPO, __version__ as sb3_version
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.vec_env import SubprocVecEnv, VecNormalize

from comparison import Comparison, parser_of, report

SOURCE = Path(__file__).resolve().parents[2]
CONTROL_STEPS, SUBSTEPS, DECISIONS = 3, 4, 160
SAMPLES, MINIBATCH, EPOCHS = 4096, 1024, 8
HOME = (0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785)
FORCES = (87.0, 87.0, 87.0, 87.0, 12.0, 12.0, 12.0, 20.0, 20.0)
OPEN, STEP = 0.04, 0.05  # m, of a finger; rad, of an action


class OpenMicrowave(gymnasium.Env):
    """The Panda in front of a microwave and a cup, in a physics server of its own."""

    def __init__(self, assets):
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (70,), np.float32)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (8,), np.float32)
        self.client = client = BulletClient(pybullet.DIRECT)
        client.setGravity(0, 0, -9.81)
        client.setPhysicsEngineParameter(
            fixedTimeStep=1.0 / 60.0, numSubSteps=SUBSTEPS, numSolverIterations=20)
        plane = client.createCollisionShape(pybullet.GEOM_PLANE)
        client.createMultiBody(0, plane)
        self.robot = client.loadURDF(str(SOURCE / "robots/panda/panda.urdf"), useFixedBase=True)
        self.microwave = client.loadURDF(
            str(assets / "microwave_2/microwave_2.urdf"), [0.675, 0.2, 0.0], useFixedBase=True)
        hull = client.createCollisionShape(
            pybullet.GEOM_MESH, fileName=str(assets / "cup_2/solid.obj"))
        self.cup = client.createMultiBody(0.12, hull, basePosition=[0.45, -0.25, 0.0])
        joints = {}
        for body in (self.robot, self.microwave):
            for joint in range(client.getNumJoints(body)):
                details = client.getJointInfo(body, joint)
                joints[body, details[1].decode()] = joint
                joints[body, details[12].decode()] = joint
                if details[2] != pybullet.JOINT_FIXED:
                    client.setJointMotorControl2(
                        body, joint, pybullet.VELOCITY_CONTROL, force=0.0)
        names = [f"panda_joint{j}" for j in range(1, 8)]
        self.joints = [joints[self.robot, name] for name in
                       names + ["panda_finger_joint1", "panda_finger_joint2"]]
        self.tool = joints[self.robot, "panda_hand"]
        for frame in ("panda_link8", "panda_hand_tcp"):  # PyBullet gives frames a mass of 1 kg
            client.changeDynamics(self.robot, joints[self.robot, frame], mass=1e-4,
                                  localInertiaDiagonal=[1e-7, 1e-7, 1e-7])
        self.door = joints[self.microwave, "door_joint"]
        self.handle = joints[self.microwave, "handle_0"]
        limits = client.getJointInfo(self.microwave, self.door)
        self.lower, self.upper = limits[8], limits[9]
        self.start = client.saveState()
        self.random = np.random.default_rng(0)

    def observe(self):
        """Returns the observation, and sets what the reward reads."""
        client = self.client
        states = client.getJointStates(self.robot, self.joints)
        tool = client.getLinkState(self.robot, self.tool, computeLinkVelocity=1)
        handle = client.getLinkState(self.microwave, self.handle, computeLinkVelocity=1)
        door = client.getJointState(self.microwave, self.door)
        cup, cup_speed = client.getBasePositionAndOrientation(self.cup), \
            client.getBaseVelocity(self.cup)
        offset = np.subtract(handle[4], tool[4])
        self.reach = np.linalg.norm(offset)
        self.moved = (door[0] - self.lower) / (self.upper - self.lower)
        return np.concatenate([
            [state[0] for state in states], [state[1] for state in states],
            tool[4], tool[5], tool[6], tool[7], handle[4], handle[5], handle[6], handle[7],
            door[:2], *cup, *cup_speed, self.action, offset]).astype(np.float32)

    def reset(self, seed=None, options=None):
        if seed is not None:
            self.random = np.random.default_rng(seed)
        self.client.restoreState(self.start)
        self.targets = np.array([*HOME, OPEN, OPEN])
        self.targets[:7] += self.random.uniform(-0.1, 0.1, 7)
        for joint, position in zip(self.joints, self.targets):
            self.client.resetJointState(self.robot, joint, position)
        self.action = np.zeros(8, np.float32)
        self.decision = 0
        return self.observe(), {}

    def step(self, action):
        self.action = np.clip(action, -1.0, 1.0)
        self.targets[7:] = 0.5 * OPEN * (1.0 + self.action[7])
        for _ in range(CONTROL_STEPS):
            self.targets[:7] += STEP / CONTROL_STEPS * self.action[:7]
            self.client.setJointMotorControlArray(
                self.robot, self.joints, pybullet.POSITION_CONTROL, self.targets, forces=FORCES)
            self.client.stepSimulation()
        self.decision += 1
        seen = self.observe()
        reward = 2.0 * min(self.moved, 1.0) - self.reach
        return seen, float(reward), bool(self.moved >= 0.7), self.decision == DECISIONS, {}


class Clock(BaseCallback):
    """Notes when each update's rollout begins."""

    def __init__(self):
        super().__init__()
        self.begins = []

    def _on_rollout_start(self):
        self.begins.append(time.perf_counter())

    def _on_training_end(self):
        self.begins.append(time.perf_counter())

    def _on_step(self):
        return True


def make_world(assets):
    """Makes an environment in a process of its own, whose output is dropped: PyBullet prints."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    return OpenMicrowave(assets)


def make_learner(assets, count):
    worlds = VecNormalize(SubprocVecEnv([lambda: make_world(assets)] * count))
    layers = [256, 128, 64]
    return PPO("MlpPolicy", worlds, n_steps=SAMPLES // count, batch_size=MINIBATCH,
               n_epochs=EPOCHS, learning_rate=1e-3, seed=1, device="cpu",
               policy_kwargs={"net_arch": {"pi": layers, "vf": layers},
                              "activation_fn": torch.nn.ELU})


def processor_seconds(learner):
    """Returns the processor time of this process and of the environments' processes."""
    tick = os.sysconf("SC_CLK_TCK")
    seconds = time.process_time()
    for worker in learner.env.venv.processes:
        words = Path(f"/proc/{worker.pid}/stat").read_text().rsplit(")", 1)[1].split()
        seconds += (int(words[11]) + int(words[12])) / tick
    return seconds


def their_rate(learner, updates):
    """Returns the control steps per second and per second of a core, of whole updates."""
    clock, processor = Clock(), processor_seconds(learner)
    learner.learn(updates * SAMPLES, callback=clock)
    steps = CONTROL_STEPS * SAMPLES * updates
    return (steps / (clock.begins[-1] - clock.begins[0]),
            steps / (processor_seconds(learner) - processor))


def our_rate(program, updates):
    printed = subprocess.run([program, "--part", "learning", "--repeats", str(updates)],
                             check=True, stdout=subprocess.PIPE, text=True).stdout
    return (float(re.search(r"(\d+) control steps/s", printed)[1]),
            1e6 / float(re.search(r"(\d+) us of a core", printed)[1]))


def make_assets(program, folder):
    for kind in ("microwave", "cup"):
        subprocess.run([program, "library", "--kind", kind, "--count", "1", "--seed", "2",
                        "--no-check", "-o", folder], check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--environments", type=int, default=16, help="of Stable-Baselines3")
    options = parser.parse_args()
    torch.set_num_threads(2)
    rounds, updates = (5, 4) if options.full else (3, 2)
    with tempfile.TemporaryDirectory() as folder:
        make_assets(options.bin / "simwright", folder)
        learner = make_learner(Path(folder), options.environments)
        their_rate(learner, 1)
        mine, theirs = [], []
        for _ in range(rounds):
            mine.append(our_rate(options.bin / "bench_environment_speed", 2 * updates))
            theirs.append(their_rate(learner, updates))
        learner.env.close()
    ratio, of_processor = [statistics.median(own[kind] / other[kind] for own, other in
                                             zip(mine, theirs)) for kind in (0, 1)]
    report(options, [Comparison(
        "ppo",
        f"Stable-Baselines3 {sb3_version}, PyBullet {importlib.metadata.version('pybullet')}",
        "control steps/s of the Panda with learning, 2 threads",
        statistics.median(rate for rate, _ in mine), statistics.median(rate for rate, _ in theirs),
        ratio, f"of processor time {of_processor:.1f}; the same bodies, rates, networks and "
        "batches")])


if __name__ == "__main__":
    main()
