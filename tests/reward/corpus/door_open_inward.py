import torch
from typing import Dict, Tuple


@torch.jit.script
def compute_reward(
    door_left_handle_pos: torch.Tensor, door_right_handle_pos: torch.Tensor,
    left_hand_pos: torch.Tensor, right_hand_pos: torch.Tensor,
    left_hand_rot: torch.Tensor, actions: torch.Tensor,
    open_flag: torch.BoolTensor, reset_buf: torch.Tensor, progress_buf: torch.Tensor,
) -> Tuple[torch.Tensor, Dict[str, torch.Tensor]]:
    # Temperatures of the transformations
    reach_temp, open_temp = 0.25, torch.tensor(0.5)
    inverse = torch.cat((-left_hand_rot[:, :3], left_hand_rot[:, 3:4]), dim=1)
    forward = quat_rotate(inverse, door_left_handle_pos - left_hand_pos)
    dist_l = (door_left_handle_pos - left_hand_pos).pow(2).sum(dim=1).sqrt()
    dist_r = torch.sqrt(torch.sum((door_right_handle_pos - right_hand_pos) ** 2, axis=-1))
    apart = torch.abs(door_left_handle_pos[:, 1] - door_right_handle_pos[:, 1])
    reach = torch.exp(-(dist_l + dist_r) / reach_temp / 8)
    opening = torch.exp(apart / open_temp) - 1
    not_done = ~(reset_buf | open_flag)
    both = torch.stack((dist_l < 1.0, dist_r < 1.0, not_done), dim=-1)
    enough = torch.all(both, dim=-1) | torch.any(both[:, :2], dim=-1) & open_flag
    bonus = enough.float() * 2.0
    penalty = 1e-3 * torch.einsum("ij,ij->i", actions, actions)
    axis = torch.einsum("ni,ni->n", forward, forward.clone().detach()).clamp_min(1e-3).log()
    reward = (reach + opening + bonus - penalty + 0.01 * axis) * not_done
    resets = torch.where(apart > 1.5, torch.ones_like(reset_buf), reset_buf)
    resets = torch.where(progress_buf >= 0.5, torch.ones_like(resets), resets)
    reward = torch.where(resets, reward - 1, reward)
    return reward, {"reach": reach, "open": opening, "resets": resets.float(), "not_done": not_done}
