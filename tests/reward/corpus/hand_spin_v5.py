from typing import Dict, Tuple
import torch
from isaacgymenvs.utils.torch_jit_utils import *


@torch.jit.script
def compute_reward_v5(object_rot: torch.Tensor, goal_rot: torch.Tensor, object_angvel: torch.Tensor,
                      fingertip_pos: torch.Tensor, object_pos: torch.Tensor,
                      dof_vel: torch.Tensor) -> Tuple[torch.Tensor, Dict[str, torch.Tensor]]:
    quat_diff = quat_mul(object_rot, quat_conjugate(goal_rot))
    rot_dist = 2.0 * torch.asin(torch.clamp(torch.norm(quat_diff[:, 0:3], p=2, dim=-1), max=0.99))
    spin = object_angvel[:, 2] - torch.abs(object_angvel[..., 0])
    tips = torch.zeros_like(object_pos[:, 0])
    for i in range(fingertip_pos.shape[1]):
        tips += torch.norm(fingertip_pos[:, i, :] - object_pos, dim=-1)
    offsets = fingertip_pos - object_pos[:, None]
    spread = torch.norm(offsets, dim=2)
    nearest = torch.min(spread, dim=1).values
    furthest, _ = torch.max(spread, dim=1)
    flat = object_pos.clone()
    flat[:, 2] = 0.0
    planar = torch.sqrt((flat * flat).sum(dim=-1) + 1e-6)
    flipped = object_pos.flip(1)[:, 0] + object_pos[:, 1].flip(0)
    direction = torch.nn.functional.normalize(object_pos, dim=-1)
    heading = torch.atan2(direction[:, 1], direction[:, 0])
    close = (rot_dist < 1.5) & ~(spin > 0.9) | (tips <= 2.0)
    keep = (nearest > 0.01).float() * (furthest != 0).type(torch.float32)
    slow = torch.relu(1.0 - torch.abs(dof_vel).mean(dim=-1))
    middle = torch.minimum(torch.min(spin), planar)
    top = torch.max(torch.mul(spin, 0.5), heading)
    rest = torch.log(1.0 + torch.pow(planar, 3)) + torch.stack([spin, planar], dim=-1).sum(dim=-1)
    reward = -rot_dist + 0.3 * spin - 0.1 * tips + keep + slow + middle + top + rest + 0.01 * flipped
    reward = torch.where(close, reward + 5.0, reward)
    reward = torch.where(rot_dist == 0.0, torch.zeros_like(reward), reward)
    rewards_dict: Dict[str, torch.Tensor] = {}
    rewards_dict["rotation"] = -rot_dist
    rewards_dict["close"] = close
    rewards_dict["furthest"] = furthest.unsqueeze(-1)
    rewards_dict["direction"] = direction
    return reward, rewards_dict
