import torch


def compute_reward(env):
    """Close the door and hold the cup above it."""
    door = env.get_state_by_joint_name("microwave", "joint_0")
    limit = env.get_limits_by_joint_name("microwave", "joint_0")["lower"]
    target = torch.tensor([0.1, 0.2, 0.3]).to(env.device).unsqueeze(0).repeat(env.env_num, 1)
    cup = env.get_pose_by_link_name("cup", "base")
    gripper = env.get_robot_gripper_pose()

    def reach_reward(a, b, scale=1.0):
        return -scale * torch.norm(a - b, dim=-1)

    closing_reward = -torch.abs(door - limit)
    reaching = reach_reward(gripper, cup) + reach_reward(cup, target, scale=0.5)
    is_closed = torch.abs(door - limit) <= 0.05 * 3.14 / 180 + 0.1
    near = (gripper - cup).pow(2).sum(-1).sqrt() < 0.8
    stage = torch.zeros_like(door)
    stage[is_closed] = 1.0
    stage[is_closed & near] += 1.0
    reward = reaching + closing_reward + stage
    success = torch.stack([is_closed, near], dim=-1).all(dim=-1)
    return reward, success
