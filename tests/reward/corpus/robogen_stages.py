# each: one environment at a time
import numpy as np


def _compute_reward(self):
    # this reward encourages the end-effector to stay near the cup
    eef_pos = get_eef_pos(self)[0]
    cup_pos = get_position(self, "cup")
    reward_near = -np.linalg.norm(eef_pos - cup_pos)
    min_aabb, max_aabb = get_bounding_box(self, "microwave")
    diff = np.array(max_aabb) - np.array(min_aabb)
    min_aabb = np.array(min_aabb) + 0.05 * diff
    max_aabb = np.array(max_aabb) - 0.05 * diff
    reward_in = 1 if in_bbox(self, cup_pos, min_aabb, max_aabb) else 0
    joint_angle = get_joint_state(self, "microwave", "joint_0")
    low, high = get_joint_limit(self, "microwave", "joint_0")
    diff_angle = np.abs(joint_angle - high)
    if check_grasped(self, "cup", "base"):
        reward_grasp = 1.0
        lift = max(0, cup_pos[2] - 0.1)
    elif joint_angle < low + 0.1 and not reward_in:
        reward_grasp = 0.25
        lift = 0
    else:
        reward_grasp, lift = 0, 0.0
    goal = np.array([cup_pos[0], cup_pos[1], max(cup_pos[2], 0.5)])
    height_target = float(np.mean(np.array([min_aabb[2], max_aabb[2]])))
    reward = reward_near + 5 * reward_in + reward_grasp + 0.5 * lift - diff_angle
    reward -= 0.1 * np.linalg.norm(goal - eef_pos) + 0.05 * abs(height_target - cup_pos[2])
    success = diff_angle < 0.35 * (high - low) and np.linalg.norm(goal - eef_pos) < 1.2
    return reward, success
