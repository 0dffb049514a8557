from typing import Tuple, Dict
import math
import torch
from torch import Tensor


@torch.jit.script
def compute_reward(root_states: Tensor, targets: Tensor, potentials: Tensor, prev_potentials: Tensor,
                   up_vec: Tensor, heading_vec: Tensor, actions: Tensor, dof_vel: Tensor,
                   dt: float) -> Tuple[Tensor, Dict[str, Tensor]]:
    """Walks to a far target.

    The potential is the negative distance over the time step."""
    torso_position = root_states[:, 0:3]
    velocity = root_states[:, 7:10]
    ang_velocity = root_states[:, 10:13]
    to_target = targets - torso_position
    to_target[:, 2] = 0.0
    potential_now = -torch.norm(to_target, p=2, dim=-1) / dt
    progress_reward: Tensor = potentials - prev_potentials
    direction = torch.nn.functional.normalize(to_target, p=2.0, dim=-1)
    speed = torch.sum(velocity * direction, dim=-1)
    # temperatures
    speed_temperature: float = 0.5
    upright_temperature = 0.2
    forward = torch.exp(speed / speed_temperature) - 1.0
    up_proj = up_vec[:, 2]
    upright = torch.where(up_proj > 0.93, torch.ones_like(up_proj), torch.zeros_like(up_proj))
    heading_weight = torch.ones_like(heading_vec[:, 0]) * 0.5
    heading_reward = torch.where(heading_vec[:, 0] > 0.8, heading_weight, 0.5 * heading_vec[:, 0] / 0.8)
    actions_cost = torch.sum(actions ** 2, dim=-1)
    electricity_cost = torch.sum(torch.abs(actions * dof_vel), dim=-1)
    spin_penalty = torch.exp(-torch.square(ang_velocity).sum(-1) / upright_temperature)
    fallen = torso_position[:, 2] < 0.31
    total_reward = (
        progress_reward
        + forward
        + 0.1 * upright
        + heading_reward
        + spin_penalty
        - 0.005 * actions_cost
        - 0.05 * electricity_cost
        + 1e-3 * potential_now
    )
    total_reward = torch.where(fallen, torch.ones_like(total_reward) * -2.0, total_reward)
    reward_components = {
        "progress": progress_reward,
        "forward": forward,
        "upright": upright,
        'heading': heading_reward,
        f"spin_{upright_temperature:.1f}": spin_penalty,
    }
    return total_reward, reward_components
