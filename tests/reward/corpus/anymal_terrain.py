import torch
from typing import Dict, Tuple, Optional


def compute_reward(root_states: torch.Tensor, commands: torch.Tensor, torques: torch.Tensor,
                   contact_forces: torch.Tensor, episode_lengths: torch.Tensor,
                   max_episode_length: int, rew_scales: Optional[Dict[str, float]] = None,
                   ) -> Tuple[torch.Tensor, Dict[str, torch.Tensor]]:
    if rew_scales is None:
        rew_scales = {"lin_vel_xy": 1.0, "ang_vel_z": 0.5, "torque": -0.0025}
    base_quat = root_states[:, 3:7]
    base_quat = base_quat / base_quat.norm(dim=-1, keepdim=True)
    base_lin_vel = quat_rotate_inverse(base_quat, root_states[:, 7:10])
    base_ang_vel = quat_rotate_inverse(base_quat, root_states[:, 10:13])
    lin_vel_error = torch.sum(torch.square(commands[:, :2] - base_lin_vel[:, :2]), dim=1)
    ang_vel_error = torch.square(commands[:, 2] - base_ang_vel[:, 2])
    rew_lin_vel_xy = torch.exp(-lin_vel_error / 0.25) * rew_scales["lin_vel_xy"]
    rew_ang_vel_z = torch.exp(-ang_vel_error / 0.25) * rew_scales["ang_vel_z"]
    rew_torque = torch.sum(torch.square(torques), dim=1) * rew_scales["torque"]
    feet = torch.norm(contact_forces[:, [0, 2], :], dim=2)
    touching = (feet > 1.0).sum(dim=1)
    knees = torch.any(torch.norm(contact_forces[:, 1:4:2, :], dim=2) > 1.2, dim=1)
    total_reward = rew_lin_vel_xy + rew_ang_vel_z + rew_torque
    total_reward = torch.clip(total_reward, 0., None) + 0.1 * touching / 2
    reset = torch.zeros_like(knees)
    reset |= knees
    reset = reset | (episode_lengths >= max_episode_length - 1)
    total_reward *= ~reset
    print(f"{total_reward.shape}", end="")
    return total_reward.detach(), {"xy": rew_lin_vel_xy, "z": rew_ang_vel_z,
                                   "reset": reset.to(torch.float), "touching": touching.float()}
