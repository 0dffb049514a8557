# each: one environment at a time
import numpy as np
import math


def compute_dense_reward(self):
    ee = np.asarray(get_robot_gripper_pose(self))
    cup = np.array(get_position(self, "cup"), dtype=np.float32)
    tray = get_link_state(self, "microwave", "tray")

    def shaped(x, k=5.0):
        return 1.0 - np.tanh(k * x)

    corners = np.stack([tray, tray + np.array([0.1, 0.0, 0.0]), tray + np.array([0.0, 0.1, 0.0])])
    gaps = np.linalg.norm(corners - cup, axis=1)
    reach = shaped(np.linalg.norm(ee - cup), k=2)
    reward = 0.0
    for corner_gap in gaps:
        reward += 0.1 * shaped(corner_gap)
    closest = np.min(gaps)
    below, above = cup[2] < tray[2], cup[2] >= tray[2]
    stage = 0 if closest > 1.0 else (1 if below else 2)
    if stage == 0:
        reward += reach
    elif stage == 1:
        reward += 1 + reach
    else:
        reward += 2 + np.clip(1 - closest, a_min=0, a_max=1)
    side = np.where(cup[0] > 0, 1.0, -1.0)
    angle = np.arctan2(cup[1], cup[0])
    wrapped = (angle + np.pi) % (2 * np.pi) - np.pi
    reward += 0.05 * side * abs(wrapped) / math.pi + 0.01 * np.sum(np.maximum(cup, 0.0) ** 2)
    reward += 0.02 * np.dot(cup, ee) + 0.01 * np.cross(cup, ee)[2] + 0.01 * np.round(cup[1])
    reward -= 0.1 if not above else 0.05
    if -0.2 <= cup[0] <= 0.2 and not (cup[1] < -0.5 or cup[1] > 0.5):
        return reward + 1.0, True
    return reward, bool(closest < 0.3)
