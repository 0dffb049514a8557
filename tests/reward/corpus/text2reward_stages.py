# each: one environment at a time
import numpy as np


def staged(value, thresholds, gains):
    total = 0.0
    for threshold, gain in zip(thresholds, gains):
        total += gain if value < threshold else gain * np.exp(-5 * (value - threshold))
    return total


def compute_dense_reward(self) -> float:
    ee = get_robot_gripper_position(self)
    cup = get_position(self, "cup")
    velocity = get_linear_velocity(self, "cup")
    dist = np.linalg.norm(ee - cup)
    reaching = 1 - np.tanh(5 * dist)
    grasped = check_grasped(self, "cup")
    reward = 0.3 * reaching
    if dist < 0.9:
        reward += 0.2
        if grasped:
            reward += 0.3
            height = np.clip(cup[2], 0.0, 0.5) / 0.5
            reward += 0.2 * height if height > 0.1 else 0.0
        else:
            reward -= 0.1
    elif not grasped and dist > 1.5:
        reward -= 0.05 * min(dist, 2.0)
    is_static = np.max(np.abs(velocity)) <= 0.7
    smoothness = np.sum(np.square(velocity)) * 0.01
    angle = np.arccos(np.clip(np.dot(ee, cup) / (np.linalg.norm(ee) * np.linalg.norm(cup) + 1e-6), -0.99, 0.99))
    reward += 0.5 * is_static - smoothness + 0.01 * np.degrees(angle) / 180 + staged(dist, [0.3, 0.8], (0.5, 0.25))
    reward += 0.1 * np.mean(cup) + 0.1 * np.prod(cup) + 0.05 * np.sign(cup[0]) + 0.1 * np.hypot(cup[0], cup[1])
    return float(reward)
