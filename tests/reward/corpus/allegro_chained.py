import torch
from typing import Dict, Tuple


def compute_reward(dof_pos: torch.Tensor, dof_vel: torch.Tensor, object_pos: torch.Tensor,
                   object_linvel: torch.Tensor, prev_torques: torch.Tensor, torques: torch.Tensor):
    with torch.no_grad():
        spread = dof_pos.std(dim=-1) + dof_pos.var(dim=-1, unbiased=False)
        slow = dof_vel.abs().amax(dim=-1).mul(-0.1).exp()
        energy = (torques * dof_vel).abs().sum(dim=-1, keepdim=True)
    jerk = torques.sub(prev_torques).square().mean(-1)
    drop = object_pos[:, 2].lt(-0.5)
    ok = torch.logical_and(torch.logical_and(~drop, jerk < 0.9), slow.ge(0.5))
    ok = ok.logical_or(object_pos[:, 0] > 0.9)
    reward = 0.1 * spread + slow - 0.01 * energy.squeeze(-1) - 0.05 * jerk
    reward.add_(0.25).mul_(2.0)
    reward.clamp_(min=-1.0, max=4.0)
    reward.sub_(object_linvel.norm(dim=-1), alpha=0.1)
    masked = reward.clone()
    masked.masked_fill_(drop, -3.0)
    reward = masked.masked_fill(~ok & drop, -4.0)
    any_fast = torch.any(torch.abs(dof_vel) > 0.99, dim=-1)
    all_in = torch.all((dof_pos > -0.999) & (dof_pos < 0.999), dim=1)
    reward = reward - any_fast.float() + all_in.type_as(reward) * 0.1
    order = torch.sort(torch.abs(object_pos), dim=-1)[0]
    top = torch.topk(object_pos, k=2, dim=-1).values.sum(dim=-1)
    running = torch.cumsum(object_pos, dim=-1)[:, 1]
    back = object_pos[:, [2, 1, 0]] - torch.roll(object_pos, 1, dims=-1)
    reward = reward + 0.1 * order[:, 0] + 0.1 * top + 0.1 * running + 0.05 * back[..., 0]
    height = object_pos.index_select(1, torch.tensor([2])).flatten()
    reward = reward + torch.outer(height, torch.ones(2)).sum(-1) * 0.1
    return reward, {'spread': spread, 'slow': slow, 'jerk': jerk, 'ok': ok.float()}
