import math
from typing import Dict, Tuple

import torch
from torch import Tensor


@torch.jit.script
def compute_reward(
    hand_pos: torch.Tensor, hand_rot: torch.Tensor, drawer_pos: torch.Tensor,
    drawer_rot: torch.Tensor, joint_vel: Tensor, actions: Tensor, open_amount: torch.Tensor,
    scale: float, max_length: int
) -> Tuple[torch.Tensor, Dict[str, torch.Tensor]]:
    # temperatures
    temp_reach: float = 0.1
    temp_open: float = 0.5

    distance = torch.norm(hand_pos - drawer_pos, p=2, dim=-1)
    reach_reward = torch.exp(-distance / temp_reach)
    forward = torch.tensor([0.0, 0.0, 1.0], device=hand_pos.device, dtype=torch.float32)
    forward = forward.repeat(hand_pos.shape[0], 1)
    local = quat_rotate_inverse(hand_rot, forward)
    other = quat_rotate_inverse(drawer_rot, forward)
    align = torch.einsum("bi,bi->b", local, other)
    angle = 2.0 * torch.acos(torch.clamp(align, -0.999, 0.999))
    open_reward = torch.sigmoid((open_amount - 0.1) * 4.0) ** 2
    effort = torch.sum(actions ** 2, dim=-1) * 0.01 + joint_vel.pow(2).mean(dim=1)
    touching = torch.where(distance < 0.6, torch.ones_like(distance), torch.zeros_like(distance))

    reward = scale * reach_reward + open_reward + 0.1 * touching \
        - 0.05 * effort
    reward += 0.2 * math.sqrt(2.0) * torch.cos(angle)
    reward -= open_amount.mean() / max_length
    reward_components = {
        "reach_reward": reach_reward,
        "open_reward": open_reward,
        "effort": -effort,
        f"touch_{1}": touching,
        "mean_distance": distance.mean(),
        "constant": 1.0,
    }
    return reward, reward_components
