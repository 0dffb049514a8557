from typing import Dict, List, Tuple

import torch
from torch import Tensor


def tf_vector(q: Tensor, v: Tensor) -> Tensor:
    return quat_rotate(q, v)


def alignment(q1: Tensor, q2: Tensor, a: List[float], b: List[float]) -> Tensor:
    first = torch.tensor(a, dtype=torch.float32, device=q1.device).repeat(q1.shape[0], 1)
    second = torch.tensor(b, device=q2.device).unsqueeze(0).expand(q2.shape[0], -1)
    axis1 = tf_vector(q1, first)
    axis2 = tf_vector(q2, second)
    dot = torch.bmm(axis1.view(q1.shape[0], 1, 3), axis2.view(-1, 3, 1)).squeeze(-1).squeeze(-1)
    return torch.sign(dot) * dot ** 2


def compute_reward(franka_grasp_pos: Tensor, franka_grasp_rot: Tensor, drawer_grasp_pos: Tensor,
                   drawer_grasp_rot: Tensor, cabinet_dof_pos: Tensor, franka_lfinger_pos: Tensor,
                   franka_rfinger_pos: Tensor, actions: Tensor, finger_close_reward_scale: float = 10.0,
                   ) -> Tuple[Tensor, Dict[str, Tensor]]:
    d = torch.norm(franka_grasp_pos - drawer_grasp_pos, p=2, dim=-1)
    dist_reward = 1.0 / (1.0 + d ** 2)
    dist_reward *= dist_reward
    dist_reward = torch.where(d <= 0.02, dist_reward * 2, dist_reward)
    rot_reward = 0.5 * (alignment(franka_grasp_rot, drawer_grasp_rot, [0, 0, 1.0], [-1.0, 0, 0])
                        + alignment(franka_grasp_rot, drawer_grasp_rot, b=[0, 0, 1.0], a=[0.0, 1, 0]))
    around = torch.zeros_like(rot_reward)
    around = torch.where(franka_lfinger_pos[:, 2] > drawer_grasp_pos[:, 2],
                         torch.where(franka_rfinger_pos[:, 2] < drawer_grasp_pos[:, 2],
                                     around + 0.5, around), around)
    lfinger_dist = torch.abs(franka_lfinger_pos[:, 2] - drawer_grasp_pos[:, 2])
    rfinger_dist = torch.abs(franka_rfinger_pos[:, 2] - drawer_grasp_pos[:, 2])
    finger_dist_reward = torch.where(around > 0, (0.04 - lfinger_dist) + (0.04 - rfinger_dist),
                                     torch.zeros_like(rot_reward))
    open_reward = cabinet_dof_pos[:, 3] * around + cabinet_dof_pos[:, 3]
    action_penalty = (actions ** 2).sum(-1)
    rewards = [2.0 * dist_reward, 0.5 * rot_reward, 0.125 * around,
               finger_close_reward_scale * finger_dist_reward, 7.5 * open_reward]
    reward = torch.stack(rewards).sum(0) - 0.01 * action_penalty
    for threshold, bonus in ((0.01, 0.5), (0.2, 1.0), (0.39, 2.0)):
        reward = torch.where(cabinet_dof_pos[:, 3] > threshold, reward + bonus * around, reward)
    too_far = (franka_lfinger_pos[:, 0] < drawer_grasp_pos[:, 0] - 0.04) | \
              (franka_rfinger_pos[:, 0] < drawer_grasp_pos[:, 0] - 0.04)
    reward[too_far] = -1.0
    return reward, dict(dist=dist_reward, rot=rot_reward, open=open_reward)
