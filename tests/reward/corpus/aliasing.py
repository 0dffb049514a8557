# What is a view and what is a copy, as torch has it.
import torch


def half(t):
    t *= 0.5
    return t


def compute_reward(pos: torch.Tensor, vel: torch.Tensor):
    a = pos
    a[:, 0] += 1.0
    view = pos[:, 1:3]
    view[:, 0] = vel[:, 0]
    copy = pos.clone()
    copy[:, 2] = 7.0
    part = vel[:, 2]
    part *= 2.0
    scaled = half(copy)
    total = torch.zeros(pos.shape[0])
    for name, column in zip(["x", "y", "z"], [0, 1, 2]):
        total += pos[:, column] * (column + 1)
    rows = [pos[:, i] for i in range(3) if i != 1]
    rows.append(vel[:, 1])
    components = {key: value for key, value in zip(("p", "q", "r"), rows)}
    components["total"] = total
    for key, value in components.items():
        total = total + 0.1 * value
    for i, value in enumerate(components.values()):
        total = total + i * value
    pos[total > 0.5, 2] = 0.25
    return total + scaled.sum(dim=-1) + vel.sum(-1) + pos.sum(dim=1), components
