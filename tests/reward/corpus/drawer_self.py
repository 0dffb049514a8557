import torch


def compute_reward(self):
    # Reward function for opening the microwave with the sliding tray
    handle_position = self.get_position_by_asset_link_name("microwave", "handle_0")
    gripper_position = self.get_robot_gripper_position()
    distance = torch.norm(handle_position - gripper_position, dim=-1)
    limits = self.get_limits_by_joint_name("microwave", "joint_1")
    state = self.get_state_by_joint_name("microwave", "joint_1")
    lower, upper = limits["lower"], limits["upper"]
    openness = (state - lower) / (upper - lower)
    bonus = torch.zeros(self.num_envs, device=self.device)
    bonus = torch.where(openness > 0.9, bonus + 1.0, bonus)
    cost = distance + torch.abs(1.0 - openness)
    reward = -cost + bonus
    success = torch.logical_and(openness > 0.95, distance < 0.5)
    return reward, success
