import torch
from typing import Dict, Tuple


@torch.jit.script
def compute_reward(ball_pos: torch.Tensor, ball_vel: torch.Tensor, done: torch.Tensor,
                   contact: torch.Tensor, progress_buf: torch.Tensor, max_episode_length: float,
                   ) -> Tuple[torch.Tensor, Dict[str, torch.Tensor]]:
    ball_dist = torch.sqrt(ball_pos[..., 0] * ball_pos[..., 0]
                           + (ball_pos[..., 2] - 0.7) * (ball_pos[..., 2] - 0.7)
                           + (ball_pos[..., 1]) * ball_pos[..., 1])
    ball_speed = torch.linalg.norm(ball_vel, dim=-1)
    pos_reward = 1.0 / (1.0 + ball_dist)
    speed_reward = 1.0 / (1.0 + ball_speed)
    alive = ~done
    held = alive & contact
    timeout = progress_buf >= max_episode_length - 1
    reward = pos_reward * speed_reward
    reward = reward + torch.where(contact, 0.1, 0.0) + alive.float() * 0.5
    reward += 0.2 * held.to(reward.dtype)
    reward = torch.where(timeout, torch.zeros_like(reward), reward)
    reward[done] = -1.0
    return reward, {"pos": pos_reward, "speed": speed_reward, "alive": alive.float(), "held": held}
