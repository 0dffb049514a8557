import torch
from typing import Dict, Optional, Tuple

UPRIGHT_TEMPERATURE: float = 2.0
SCALES = {"speed": 1.5, "upright": 0.5, "effort": 0.01}
EPS = 1e-6


def compute_reward(root_states: torch.Tensor, actions: torch.Tensor, up_vec: torch.Tensor,
                   prev_actions: Optional[torch.Tensor], dt: float = 0.0166,
                   ) -> Tuple[torch.Tensor, Dict[str, torch.Tensor]]:
    assert root_states.shape[1] == 13, "root states are 13 numbers"
    device = root_states.device
    num_envs = root_states.shape[0]
    up_axis = torch.tensor([0.0, 0.0, 1.0], device=device).repeat((num_envs, 1))

    def squash(x: torch.Tensor, temperature: float = UPRIGHT_TEMPERATURE) -> torch.Tensor:
        """One at zero, less away from it."""
        return torch.exp(-temperature * x.abs())

    def weighted(name, value):
        return SCALES[name] * value

    def length(v):
        # a helper of a helper
        def squares(w):
            return (w * w).sum(dim=-1)
        return torch.sqrt(squares(v) + EPS)

    velocity = root_states[:, 7:10]
    tilt = 1.0 - (up_vec * up_axis).sum(dim=-1)
    speed = weighted("speed", velocity[:, 0].clamp(-1.0, 2.0))
    upright = weighted("upright", squash(tilt))
    smooth = squash(length(actions - prev_actions), temperature=0.1)
    effort = weighted(value=length(actions), name="effort")
    reward = speed + upright + smooth - effort
    components: Dict[str, torch.Tensor] = {}
    for name, value in zip(["speed", "upright", "smooth"], [speed, upright, smooth]):
        components["{}_reward".format(name)] = value
    components["effort"] = -effort
    del effort
    return reward, components
