# Both names of each function, and a target made from a list.
def compute_reward(self):
    env = self.env
    cup = self.env.get_position_by_asset_link_name("cup", "base")
    body = self.get_center_by_asset_link_name("microwave", "link_0")
    offset = torch.tensor([0.05, -0.1, 0.2]).to(env.device).unsqueeze(0).repeat(env.env_num, 1)
    goal = env.get_goal_pose()
    low = env.get_joint_limits("microwave", "joint_0")["lower"]
    high = env.get_joint_upper_limit("microwave", "joint_0")
    state = env.get_state_by_asset_joint_name("microwave", "joint_0")
    near = torch.norm(cup - (body + offset), dim=-1)
    far = torch.norm(goal - env.get_robot_gripper_position(), dim=-1)
    shut = torch.abs(state - low) / (high - low)
    reward = -near - 0.25 * far - shut
    success = torch.logical_and(near < 0.9, shut >= 0.05)
    return reward, success
