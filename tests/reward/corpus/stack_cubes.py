import torch
import math
from typing import Tuple, Dict


@torch.jit.script
def compute_reward(cubeA_pos: torch.Tensor, cubeB_pos: torch.Tensor, cubeA_size: float, cubeB_size: float,
                   eef_pos: torch.Tensor, eef_lf_pos: torch.Tensor, eef_rf_pos: torch.Tensor,
                   reset_buf: torch.Tensor, actions: torch.Tensor,
                   ) -> Tuple[torch.Tensor, Dict[str, torch.Tensor]]:
    target_height = cubeB_size * 0.1 + cubeA_size / 20.0
    d = torch.norm(cubeA_pos - eef_pos, dim=-1)
    d_lf = torch.norm(cubeA_pos - eef_lf_pos, dim=-1)
    d_rf = torch.norm(cubeA_pos - eef_rf_pos, dim=-1)
    dist_reward = 1 - torch.tanh(10.0 * (d + d_lf + d_rf) / 3)
    cubeA_height = cubeA_pos[:, 2] - cubeA_size / 20
    cubeA_lifted = (cubeA_height - cubeA_size / 10) > 0.04
    offset = torch.zeros_like(cubeA_pos)
    offset[:, 2] = (cubeA_size + cubeB_size) / 20
    d_ab = torch.norm(cubeB_pos - cubeA_pos + offset, dim=-1)
    align_reward = (1 - torch.tanh(10.0 * d_ab)) * cubeA_lifted
    dist_reward = torch.max(dist_reward, align_reward)
    aligned = torch.norm(cubeA_pos[:, :2] - cubeB_pos[:, :2], dim=-1) < 0.5
    on_b = torch.abs(cubeA_height - target_height) < 0.4
    away = (d > 0.04)
    stacked = aligned & on_b & away
    rewards = torch.where(stacked, 16.0, 0.1 * dist_reward + 1.5 * cubeA_lifted.float() + 2.0 * align_reward)
    angle = math.radians(30.0) + math.atan2(math.sqrt(3), 1) + math.floor(2.7) + math.hypot(3, 4)
    rewards = rewards - 1e-3 * (actions * math.cos(angle)).abs().sum(dim=1) * math.exp(-math.tau / 10)
    rewards = torch.where((reset_buf == 1) & ~stacked, torch.zeros_like(rewards), rewards)
    return rewards, {"dist": dist_reward, "lift": cubeA_lifted, "align": align_reward, "stacked": stacked}
