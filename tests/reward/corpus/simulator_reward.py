# each: a program for one environment, with helpers that are handed the simulator.
def _compute_reward(self):
    eef_pos = get_eef_pos(self)[0]
    handle_pos = get_link_state(self, "microwave", "handle_0")
    reach = -np.linalg.norm(eef_pos - handle_pos)
    angle = get_joint_state(self, "microwave", "joint_0")
    low, high = get_joint_limit(self, "microwave", "joint_0")
    diff = np.abs(angle - high)
    reward = reach + 5 * (-diff)
    success = diff < 0.35 * (high - low)
    cup = get_position(self, "cup")
    min_aabb, max_aabb = get_bounding_box_link(self, "microwave", "link_0")
    size = np.array(max_aabb) - np.array(min_aabb)
    centre = (np.array(min_aabb) + max_aabb) / 2
    inside = in_bbox(self, cup, centre - 0.4 * size, centre + 0.4 * size)
    box_low, box_high = get_bounding_box(self, "cup")
    reward += np.sum(box_high - box_low) * 0.1 + np.zeros(3)[1]
    if inside and not check_grasped(self, "cup", "base"):
        reward += 2.0
        if angle > 0.5:
            reward = reward * 0.5
        elif reach < -1.0 or angle < 0.1:
            reward -= 0.75
        else:
            reward = -reward
    if check_grasped(self, "cup", "base"):
        reward = reward + 1
    return reward, success
