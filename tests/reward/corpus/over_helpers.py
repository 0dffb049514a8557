import torch
from torch import Tensor
from typing import Dict, Tuple, Optional, Union


def scaled_exponential(x: Tensor, temperature: Union[float, Tensor] = 1.0, offset: float = 0.0) -> Tensor:
    return torch.exp(temperature * (x - offset))


def tolerance(x, bounds=(0.0, 0.0), margin: float = 0.0, value_at_margin=0.1):
    lower, upper = bounds
    in_bounds = torch.logical_and(lower <= x, x <= upper)
    if margin == 0:
        return torch.where(in_bounds, 1.0, 0.0)
    d = torch.where(x < lower, lower - x, x - upper) / margin
    scale = (-2 * torch.log(torch.tensor(value_at_margin))).sqrt()
    return torch.where(in_bounds, torch.ones_like(x), torch.exp(-0.5 * (d * scale) ** 2))


def pick(flag: Tensor, yes: Tensor, no: Optional[Tensor] = None) -> Tensor:
    if no is None:
        no = torch.zeros_like(yes)
    elif isinstance(no, (int, float)):
        no = torch.full_like(yes, no)
    if not isinstance(yes, torch.Tensor):
        yes = torch.tensor(yes)
    return torch.where(flag, yes, no)


def compute_reward(hand_pos: Tensor, object_pos: Tensor, object_vel: Tensor, target_pos: Tensor,
                   gripper: Tensor) -> Tuple[Tensor, Dict[str, Tensor]]:
    args = (hand_pos, object_pos)
    reach = torch.dist(*[a[0] for a in args]) * 0.0 + torch.sub(*args).norm(dim=-1)
    place = torch.cdist(object_pos.unsqueeze(1), target_pos.unsqueeze(1)).squeeze(2).squeeze(1)
    in_reach = tolerance(reach, bounds=(0.0, 0.05), margin=0.3)
    in_place = tolerance(x=place, margin=0.5)
    plain = tolerance(place, (0, 0.2))
    closed = pick(gripper < 0.1, in_reach)
    lifted = pick(object_pos[:, 2] > 0.3, in_place, 0.1)
    still = scaled_exponential(torch.linalg.norm(object_vel, dim=-1), temperature=-2.0)
    parts = {"reach": in_reach, "place": in_place, "closed": closed, "lifted": lifted, "still": still}
    weights = {"reach": 1.0, "place": 2.0, "closed": 0.5, "lifted": 0.5}
    reward = plain
    for key in parts:
        if key in weights:
            reward = reward + weights[key] * parts[key]
        elif key.startswith("st") and not key.endswith("x"):
            reward = reward + 0.25 * parts[key]
    named = {k.upper(): v for k, v in parts.items() if k != "still"}
    named.update({"sum": sum(parts.values()), f"{'mean'!s}_{len(parts):02d}": sum(named.values()) / len(named)})
    return reward, named
