# each: stages with early returns, ternaries and numpy's functions.
import numpy as np


def shaped(distance, scale=4.0):
    if distance > 1.2:
        return 0.0
    return 1 - np.tanh(scale * distance)


def compute_dense_reward(self) -> float:
    hand = get_eef_pos(self)[0]
    quat = get_eef_pos(self)[1]
    cup = get_position(self, "cup")
    goal = get_goal_pose(self)
    target = np.array([0.1, 0.2, 0.3])
    distance = np.linalg.norm(hand - cup)
    reward = shaped(distance) + shaped(np.linalg.norm(cup - goal), scale=2.0)
    speed = np.sqrt(np.square(cup - target).sum()) + np.log(np.exp(distance) + 1)
    reward -= np.clip(speed, 0.0, 1.5) * 0.5
    before = reward
    reward += 0.5
    reward -= 0.25 * before
    bonus = 1.0 if distance < 0.8 else -0.25
    reward += bonus
    facing = np.dot(hand, cup) / (np.linalg.norm(hand) * np.linalg.norm(cup) + 1e-6)
    turn = np.arccos(np.clip(facing, -1, 1)) / np.pi
    reward += max(turn, 0.3) - min(turn, 0.6) + abs(float(facing)) + np.max(cup) - quat[3]
    best = -np.inf
    for part in [hand, cup, goal]:
        best = max(best, part[2])
    reward += best
    if turn > 0.75:
        return reward - 3.0
    inside = (hand > -0.5).all() and (cup < 0.9).all()
    if 0.1 < turn <= 0.9:
        reward = reward + 0.125
    count = 0
    for i in range(len(cup)):
        if cup[i] > 0:
            count += 1
    if not inside:
        return -1.0 + 0.1 * count
    stage = 2 if count > 1 else 1
    reward += stage * 0.5
    return reward
