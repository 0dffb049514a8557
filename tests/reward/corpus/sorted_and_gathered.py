# Order along a dimension, and picking by number.
import torch
import numpy as np


def compute_reward(fingertip_pos: torch.Tensor, object_pos: torch.Tensor, dof_pos: torch.Tensor):
    d = (fingertip_pos - object_pos[:, None]).norm(dim=-1)
    ascending, _ = torch.sort(d, dim=1)
    descending = d.sort(dim=-1, descending=True).values
    two = torch.topk(d, 2, largest=False)[0].mean(dim=-1)
    middle = d.median(dim=1).values
    runs = torch.cumsum(dof_pos, dim=1)[:, -1] + dof_pos[:, :3].cumprod(dim=1)[:, 2]
    rolled = torch.roll(fingertip_pos, shifts=-1, dims=1) - fingertip_pos
    loop = rolled.norm(dim=-1).sum(dim=-1)
    place = d.argmin(dim=1, keepdim=True)
    nearest = d.gather(1, place).squeeze(1) + torch.gather(d, dim=1, index=place)[:, 0]
    hot = torch.nn.functional.one_hot(d.argmax(dim=-1), 4)
    weights = hot.float() @ torch.tensor([0.1, 0.2, 0.3, 0.4])
    chosen = torch.index_select(dof_pos, 1, torch.tensor([0, 2, 5])).sum(dim=1)
    filled = d.masked_fill(d > 1.0, 1.0).sum(dim=-1)
    both = torch.hstack([d[:, :1], object_pos]).sum(dim=1) + torch.vstack((middle, two)).sum(dim=0)
    table = object_pos.t()[0] + object_pos.new_tensor([0.5, 1.0])[1] + d.new_full((1,), 0.1)
    same = object_pos.reshape(-1, 3).view_as(object_pos)[:, 1]
    huber = torch.nn.functional.huber_loss(object_pos[:, 0], object_pos[:, 1], delta=0.5)
    reward = ascending[:, 0] - 0.1 * descending[:, 0] + two + middle + 0.1 * runs - 0.1 * loop
    reward = reward + nearest + weights + 0.1 * chosen + filled + 0.1 * both + table + same + huber
    reward.add_(0.5).mul_(0.1).neg_()
    reward.sub_(middle).clamp_(-2.0, 2.0)
    extra = torch.zeros_like(reward)
    extra.fill_(0.25)
    extra[d.amin(dim=1) < 0.4].zero_()
    return reward + extra + float(np.median(np.array([3.0, 1.0, 2.0, 4.0]))) + np.cumsum([1, 2, 3], 0)[-1]
