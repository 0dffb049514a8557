import torch
import numpy as np
from typing import Dict, Tuple

reset_dist: float = 0.8
WEIGHTS = (1.0, 0.01, 0.005)


def compute_reward(pole_angle: torch.Tensor, pole_vel: torch.Tensor, cart_vel: torch.Tensor,
                   cart_pos: torch.Tensor) -> Tuple[torch.Tensor, Dict[str, torch.Tensor]]:
    w_angle, w_cart, w_pole = WEIGHTS
    reward = w_angle - pole_angle * pole_angle - w_cart * torch.abs(cart_vel) - w_pole * torch.abs(pole_vel)
    reward = torch.where(torch.abs(cart_pos) > reset_dist, torch.ones_like(reward) * -2.0, reward)
    reward = torch.where(torch.abs(pole_angle) > np.pi / 2, torch.ones_like(reward) * -2.0, reward)
    upright = torch.abs(pole_angle) < np.deg2rad(12)
    moving = cart_vel.abs() > 0.05
    share = upright.float().mean()
    speed_of_upright = cart_vel[upright].abs().mean()
    most = pole_vel[moving & upright].max()
    count = upright[moving].sum()
    reward = reward + 0.01 * share - 0.001 * speed_of_upright + 0.001 * most + 1e-6 * count
    reward[upright] += 0.5 * torch.exp(-cart_pos.abs())[upright]
    reward[~moving] = reward[~moving] * 0.5
    info = {"share": share, "speed": speed_of_upright, "any": moving.any().float()}
    return reward, info
