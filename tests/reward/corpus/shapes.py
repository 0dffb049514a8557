import torch
import torch.nn.functional as F
import numpy as np


def compute_reward(points: torch.Tensor, goal: torch.Tensor, weights: torch.Tensor):
    n, k, d = points.shape
    flat = points.reshape(n, -1)
    again = flat.view(-1, k, d)
    turned = points.transpose(1, 2).permute(0, 2, 1)
    joined = torch.cat([goal, goal * 2.0], dim=-1)
    left, right = joined[:, :3], joined[:, 3:]
    table = torch.stack((left[:, 0], left[:, 1], right[..., -1]), dim=1)
    wide = goal.unsqueeze(1).expand(-1, k, -1)
    gaps = torch.cdist(points, goal.unsqueeze(1)).squeeze(-1)
    near = gaps.min(1)[0] + gaps.min(dim=1).values + torch.argmin(gaps, dim=1).float() * 0.1
    dots = torch.bmm(points, goal.unsqueeze(-1)).squeeze(-1)
    matrix = torch.eye(3)[:, [2, 0, 1]]
    mixed = goal @ matrix + torch.matmul(goal, torch.ones(3, 3))
    crossed = torch.cross(goal, left - weights[:, :3], dim=-1)
    rows = (again - turned).abs().sum(dim=(1, 2)) + (wide - points).pow(2).mean(dim=[1, 2])
    halves = torch.chunk(weights, 2, dim=-1)
    parts = torch.split(weights, 2, dim=1)
    a, b, c, e = weights.unbind(dim=-1)
    soft = torch.softmax(weights, dim=-1)[:, 0] + F.softplus(a) + F.relu(b)
    unit = F.normalize(weights, p=2, dim=-1)
    similar = F.cosine_similarity(goal, mixed, dim=-1)
    picks = weights[:, ::2].sum(-1) + weights[:, -2:].prod(dim=-1) + weights[:, [0, 3]].amax(dim=-1)
    everything = (weights > 0).any(dim=-1).float() + (weights > -0.9).all(dim=1).float()
    counted = (weights > 0.2).sum(dim=-1) // 2 + (weights > 0.1).sum(-1) % 3
    lifted = torch.full((n,), 0.5) + torch.full_like(a, 0.25) + torch.zeros(n) + torch.ones((n, 1))[:, 0]
    line = torch.arange(3, dtype=torch.float32) + torch.linspace(0.0, 1.0, 3)
    scaled = (goal * line).sum(-1) + (goal * torch.tensor([[1.0, 2.0, 3.0]])).norm(p=1, dim=-1)
    spread = weights.var(dim=-1) + weights.std(dim=-1, unbiased=False) + goal.norm(p=float("inf"), dim=-1)
    first = points[0, 0, 0] + weights[-1, 1]
    reward = near + dots.sum(dim=-1) + crossed.sum(-1) + rows + table.sum(1) + soft + unit[:, 0]
    reward = reward + similar + picks + everything + counted + lifted + scaled + spread + first
    reward = reward + halves[0].sum(-1) - halves[1].sum(-1) + parts[0][:, 1] + torch.flip(weights, [1])[:, 0]
    reward = reward + torch.lerp(a, b, 0.3) + np.pi + e * c - torch.pi
    return reward
