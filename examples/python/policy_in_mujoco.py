"""Runs an exported policy in MuJoCo, in the exported world of a task, and prints the outcome.

    simwright export tasks.json --task pick_up_cup_1 --world --format mjcf -o world
    simwright export --skill pick_up_cup --format onnx -o pick_up_cup.onnx
    pip install mujoco onnxruntime numpy
    python3 policy_in_mujoco.py pick_up_cup.onnx world...
"""

import sys

import onnxruntime

from simwright_policy import ExportedTask


def run(policy, folder):
    """Returns whether the policy succeeds in the world, and the time (s) that it took."""
    world = ExportedTask(folder)
    while world.data.time < world.options["episode_seconds"]:
        observation = world.observe()[None, :]
        action = policy.run(["action"], {"observation": observation})[0][0]
        if world.act(action):
            return True, world.data.time
    return False, world.data.time


if __name__ == "__main__":
    network = onnxruntime.InferenceSession(sys.argv[1])
    outcomes = [run(network, folder) for folder in sys.argv[2:]]
    for folder, (success, seconds) in zip(sys.argv[2:], outcomes):
        print(f"{folder}: {'success' if success else 'failure'} after {seconds:.1f} s")
    print(f"{sum(success for success, _ in outcomes)} of {len(outcomes)} succeed")
