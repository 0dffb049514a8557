# Whole batches: means, extremes and spreads over all environments.
import torch


def normalised(x: torch.Tensor) -> torch.Tensor:
    return (x - x.mean()) / (x.std() + 1e-6)


def speed_reward(velocity, target: float = 0.6):
    error = torch.square(velocity[:, 0] - target)
    return torch.exp(-error / 0.25), error


def compute_reward(root_vel: torch.Tensor, dof_pos: torch.Tensor, dof_vel: torch.Tensor,
                   heading_vec: torch.Tensor, up_vec: torch.Tensor, dt: float):
    forward, error = speed_reward(root_vel)
    slow, _ = speed_reward(root_vel, target=0.1)
    bent = dof_pos.abs().max(dim=1).values - torch.min(dof_pos.abs(), dim=-1)[0]
    centred = normalised(bent)
    lowest, highest = torch.min(error), error.max()
    up = up_vec[:, 2].clamp(min=0.0) + heading_vec[:, 0].clamp(min=-0.5, max=0.5)
    limit = torch.tensor(0.3, device=root_vel.device)
    power = torch.sum(torch.abs(dof_vel * dof_pos), dim=1, keepdim=True).squeeze(-1) * dt
    fast = (root_vel.norm(dim=-1) > limit).float()
    share = fast.mean()
    total = fast.sum() / fast.shape[0]
    reward = forward + 0.5 * slow + 0.1 * centred + up - 0.02 * power
    reward = reward + (highest - lowest) * share * total
    reward[fast > 0.5] += 0.25
    reward[error > 1.2] = -1.0
    return reward, {"forward": forward, "centred": centred, "share": share, "power": power}
