import torch
import torch.nn.functional as F
from typing import Tuple, Dict


def compute_reward(root_positions: torch.Tensor, target_root_positions: torch.Tensor,
                   root_quats: torch.Tensor, root_linvels: torch.Tensor, root_angvels: torch.Tensor,
                   ) -> Tuple[torch.Tensor, Dict[str, torch.Tensor]]:
    gap = target_root_positions - root_positions
    huber = F.huber_loss(root_positions, target_root_positions, reduction="none", delta=0.3).sum(-1)
    smooth = F.smooth_l1_loss(root_linvels, torch.zeros_like(root_linvels), reduction='none').mean(dim=-1)
    squared = F.mse_loss(root_angvels, torch.zeros_like(root_angvels), reduction="none").sum(dim=1)
    cosine = F.cosine_similarity(gap, root_linvels, dim=-1)
    hover = F.relu(0.5 - torch.dist(root_positions[0], target_root_positions[0])) + F.softplus(-huber, beta=2.0)
    ups = quat_axis(root_quats, 2)
    tiltage = torch.abs(1 - ups[..., 2])
    up_reward = 5.0 / (1.0 + tiltage.square())
    spinnage = torch.abs(root_angvels[..., 2])
    spin_reward = 1.0 / (1.0 + spinnage * spinnage)
    planar = torch.hypot(gap[:, 0], gap[:, 1])
    bounded = torch.clip(planar, 0.0, 1.0).lerp(torch.tanh(planar), 0.25)
    angle = torch.rad2deg(torch.atan2(gap[:, 1], gap[:, 0])).div(180.0)
    selu = F.silu(gap[:, 2]) + F.hardtanh(gap[:, 0] * 3) + F.logsigmoid(gap[:, 1]) + F.softsign(gap[:, 2])
    soft = torch.logsumexp(gap, dim=-1) + torch.exp2(gap[:, 0]) + torch.addcmul(planar, gap[:, 0], gap[:, 1], value=0.5)
    pos_reward = 1.0 / (1.0 + huber)
    reward = pos_reward + pos_reward * (up_reward + spin_reward) - 0.1 * smooth - 0.01 * squared
    reward = reward + 0.05 * cosine + 0.01 * hover - 0.1 * bounded + 0.01 * angle + 0.01 * selu + 0.01 * soft
    reward = torch.nan_to_num(reward, nan=0.0, posinf=10.0, neginf=-10.0)
    return reward, {"pos": pos_reward, "up": up_reward, "spin": spin_reward, "cosine": cosine}
