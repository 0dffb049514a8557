import torch
from torch import Tensor
from typing import Dict, List, Tuple


def compute_reward(kettle_handle_pos: Tensor, bucket_handle_pos: Tensor, left_hand_ff_pos: Tensor,
                   left_hand_mf_pos: Tensor, left_hand_th_pos: Tensor, right_hand_ff_pos: Tensor,
                   right_hand_th_pos: Tensor, left_hand_dof_pos: Tensor, actions: Tensor,
                   ) -> Tuple[Tensor, Dict[str, Tensor]]:
    """Two hands bring the kettle's spout over the bucket."""
    def finger_distance(tips: List[Tensor], handle: Tensor) -> Tensor:
        total = torch.zeros(handle.shape[0], device=handle.device)
        for tip in tips:
            total = total + torch.norm(tip - handle, p=2, dim=-1)
        return total

    left = [left_hand_ff_pos, left_hand_mf_pos, left_hand_th_pos]
    left_dist = finger_distance(left, bucket_handle_pos)
    right_dist = finger_distance([right_hand_ff_pos, right_hand_th_pos], handle=kettle_handle_pos)
    gap = torch.norm(kettle_handle_pos - bucket_handle_pos, dim=-1)
    closed = left_dist < 4.5
    closed = torch.logical_and(closed, right_dist < 3.5)
    up_rew = torch.zeros_like(right_dist)
    up_rew = torch.where(right_dist < 3.7,
                         torch.where(left_dist < 4.7, 3 * (0.985 - gap), up_rew), up_rew)
    limits = torch.tensor([0.5, 0.5, 0.8, 1.0, 0.25, 0.25], device=actions.device)
    stretch = ((left_hand_dof_pos - limits).abs() / limits).mean(dim=-1)
    effort = torch.linalg.vector_norm(actions, dim=-1)
    reward = torch.exp(-left_dist) + 0.5 - right_dist * 2 + up_rew - 0.05 * stretch - 0.01 * effort
    reward[closed] += 1.0
    reward_dict = {f"{side}_{'dist'}": value
                   for side, value in [("left", left_dist), ("right", right_dist)]}
    return reward, {**reward_dict, "up": up_rew}
