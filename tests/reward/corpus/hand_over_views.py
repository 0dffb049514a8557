import torch
from typing import Dict, List, Tuple


def compute_reward(fingertip_pos: torch.Tensor, fingertip_vel: torch.Tensor, object_pos: torch.Tensor,
                   object_rot: torch.Tensor, dof_pos: torch.Tensor):
    # type: (...) -> Tuple[torch.Tensor, Dict[str, torch.Tensor]]
    batch_size = fingertip_pos.size(0)
    flat = fingertip_pos.view(batch_size, -1)
    tips = flat.reshape(flat.shape[0], 4, 3) if flat.dim() == 2 else fingertip_pos
    thumb, *others = [tips[:, i, :] for i in range(4)]
    rest = torch.stack(others, dim=1)
    centre = rest.mean(dim=1)
    opposing = 1 - torch.cosine_similarity(thumb - object_pos, centre - object_pos, dim=-1)
    reverse = fingertip_pos.permute(0, 2, 1).transpose(1, 2)[:, -1]
    xs, ys, zs = object_pos.T
    x, y, z = object_pos.chunk(3, dim=-1)
    w = object_rot[:, -1:]
    last_two = dof_pos[:, -2:]
    every_other = dof_pos[:, ::2]
    backwards = torch.flip(dof_pos, dims=[-1])
    evens = every_other.sum(dim=-1) + backwards[:, 0] + last_two.prod(dim=-1)
    speed, which = torch.max(fingertip_vel.norm(dim=-1), dim=-1)
    nearest = torch.argmin((tips - object_pos.unsqueeze(1)).norm(dim=-1), dim=-1)
    one_hot = torch.nn.functional.one_hot(nearest, num_classes=4).float()
    gathered = torch.gather(fingertip_vel[:, :, 2], 1, nearest.unsqueeze(-1)).squeeze(-1)
    weights = torch.linspace(0.0, 1.0, steps=4, device=object_pos.device)
    staged = (one_hot * weights).sum(dim=-1) + torch.matmul(one_hot, weights)
    offset = torch.full((batch_size,), 0.5) + torch.full_like(speed, fill_value=0.25)
    reward = xs + ys * zs + (x * y * z).squeeze() + w.squeeze(-1) + opposing + 0.1 * evens
    reward = reward - 0.1 * speed + 0.1 * staged + offset + reverse[:, 0] + 0.1 * gathered
    reward = reward + torch.tensor([0.5, 0.25], device=object_pos.device)[0] + (which == 2).float()
    reward = reward.view(-1, 1).expand(-1, 3).mean(dim=1).reshape(batch_size)
    return reward, {"tips": opposing, "which": which.float(), "speed": speed}
