"""Prints the microseconds of processor time per call of door_reward.py in python3-torch on one
thread, the median of many runs: time_python.py DOOR_REWARD NUM_ENVS. The environment returns
precomputed tensors."""
import statistics
import sys
import time

import torch

torch.set_num_threads(1)
torch.set_grad_enabled(False)


class Environment:
    def __init__(self, count):
        self.handle, self.gripper = torch.rand(count, 3), torch.rand(count, 3)
        self.joint = torch.rand(count)

    def get_pose_by_link_name(self, asset, link):
        return self.handle

    def get_robot_gripper_pose(self):
        return self.gripper

    def get_state_by_joint_name(self, asset, joint):
        return self.joint

    def get_limits_by_joint_name(self, asset, joint):
        return {"lower": 0.25, "upper": 1.5}


names = {"torch": torch}
exec(open(sys.argv[1]).read(), names)
environment = Environment(int(sys.argv[2]))
runs = []
for _ in range(60):
    start = time.process_time()
    for _ in range(200):
        names["compute_reward"](environment)
    runs.append((time.process_time() - start) / 200 * 1e6)
print(f"{statistics.median(runs):.3f}")
