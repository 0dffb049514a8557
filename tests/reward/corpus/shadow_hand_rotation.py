import torch
from typing import Tuple, Dict


def quat_inverse(q):
    # type: (torch.Tensor) -> torch.Tensor
    return torch.cat([-q[..., :3], q[..., 3:]], dim=-1)


def hamilton(a: torch.Tensor, b: torch.Tensor) -> torch.Tensor:
    x1, y1, z1, w1 = a[:, 0], a[:, 1], a[:, 2], a[:, 3]
    x2, y2, z2, w2 = torch.unbind(b, dim=-1)
    return torch.stack([
        w1 * x2 + x1 * w2 + y1 * z2 - z1 * y2,
        w1 * y2 - x1 * z2 + y1 * w2 + z1 * x2,
        w1 * z2 + x1 * y2 - y1 * x2 + z1 * w2,
        w1 * w2 - x1 * x2 - y1 * y2 - z1 * z2,
    ], dim=-1)


@torch.jit.script
def compute_reward(object_pos: torch.Tensor, object_rot: torch.Tensor, goal_pos: torch.Tensor,
                   goal_rot: torch.Tensor, fingertip_pos: torch.Tensor, object_angvel: torch.Tensor,
                   actions: torch.Tensor, successes: torch.Tensor, success_tolerance: float,
                   ) -> Tuple[torch.Tensor, Dict[str, torch.Tensor]]:
    num_fingers = fingertip_pos.shape[1]
    goal_dist = torch.norm(object_pos - goal_pos, dim=-1)
    diff = hamilton(object_rot, quat_inverse(goal_rot))
    vector_part = torch.norm(diff[:, 0:3], p=2, dim=-1).clamp(max=1.0)
    rot_dist = 2.0 * torch.asin(vector_part * 0.999)
    rot_rew = 1.0 / (torch.abs(rot_dist) + 0.1)
    tip_dists = [torch.norm(fingertip_pos[:, i] - object_pos, dim=-1) for i in range(num_fingers)]
    nearest = torch.stack(tip_dists, dim=1).min(dim=1)[0]
    mean_dist = sum(tip_dists) / len(tip_dists)
    worst = torch.stack(tip_dists).max(dim=0).values
    finger_reward = torch.exp(-nearest * 10.0) + torch.exp(-mean_dist) - 0.1 * worst
    action_penalty = -0.0002 * torch.sum(actions.pow(2), dim=-1)
    spin = object_angvel.norm(p=2, dim=-1)
    spin_rew = torch.tanh(spin) * (1 - torch.exp(-torch.mul(spin, 2.0)))
    goal_resets = torch.where(torch.abs(rot_dist) <= success_tolerance,
                              torch.ones_like(rot_dist), torch.zeros_like(rot_dist))
    reward = rot_rew - goal_dist + finger_reward + action_penalty + 0.1 * spin_rew
    reward = torch.where(goal_resets == 1, reward + 250.0, reward)
    cons = torch.where(successes > 0, successes * 0.1 + 0.9 * successes.mean(), successes.mean())
    return reward, {"rot": rot_rew, "finger": finger_reward, "cons": cons, "action": action_penalty}
