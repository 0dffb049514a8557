# What a mask picks, reduced or put back.
import torch


def compute_reward(object_pos: torch.Tensor, goal_pos: torch.Tensor, object_vel: torch.Tensor):
    dist = torch.norm(object_pos - goal_pos, dim=-1)
    near = dist < 0.9
    count = near.sum()
    share = dist[near].numel() / len(dist) + object_pos[near].shape[0] / dist.shape[0]
    mean = dist[near].mean() + dist[~near].std() + (dist[near] ** 2).sum() / count
    rows = object_pos[near].mean(dim=0)
    low = object_pos[near, 2].min() + object_pos[:, 1][near].max()
    flags = (object_vel[near] > 0.0).any(dim=1).all().float() + (dist[near] < 0.8).float().mean()
    reward = -dist
    reward[near] = 2.0 - dist[near] * 2.0
    reward[near] *= 0.5
    reward[near] += object_vel[near].norm(dim=-1)
    reward[~near] -= 0.1 * object_vel[~near, 0]
    moved = object_pos.clone()
    moved[near, 2] += 1.0
    moved[near] = goal_pos[near]
    moved[~near, :2] = torch.tensor([0.25, 0.5])
    small = object_vel.clone()
    small[small.abs() < 0.1] = 0.0
    reward += 0.1 * moved.sum(dim=-1) + 0.1 * small.sum(-1) + 0.01 * (share + mean + low + flags)
    return reward + 0.01 * (object_pos - rows).norm(dim=-1)
