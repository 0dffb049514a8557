# Strings, keys and containers.
import torch
from typing import Dict

NAMES = ("reach", "lift", "place")
GAINS = dict(reach=1.0, lift=2.0)
GAINS["place"] = 0.5


def gain_of(name: str, default: float = 0.25, *, scale=1.0) -> float:
    return GAINS.get(name, default) * scale


def compute_reward(object_pos: torch.Tensor, hand_pos: torch.Tensor):
    values = [torch.norm(hand_pos - object_pos, dim=-1), object_pos[..., 2], object_pos[..., 0]]
    parts: Dict[str, torch.Tensor] = {}
    for i, (name, value) in enumerate(zip(NAMES, values)):
        key = f"{i:02d}_{name.capitalize()}" if i % 2 == 0 else "{0}/{1:.2f}".format(name, gain_of(name))
        parts[key] = gain_of(name, scale=0.5) * value
    parts.update({"late": values[0] * 0.5})
    order = sorted(parts.keys(), reverse=True)
    first, *middle, last = order
    merged = {**parts, f"{first.lower()}!": parts[first] + 1}
    popped = merged.pop("late")
    merged["_".join([last, "x"]).replace("0", "o")] = popped
    assert len(merged) == 5, f"five parts, not {len(merged)}"
    merged["missing"] = merged.get("none", torch.zeros_like(popped))
    label = f"{1e-5} {0.1 + 0.2} {1e22} {3.0} {True} {-2:+d} {1234567.891:,.1f} {0.256:.0%} {'ab':>4}|{7:<3}|"
    merged[label] = popped if isinstance(label, str) and label.startswith("1e-05") else -popped
    merged[f"{2.5e-7:e} {0.00012:g} {12:05.1f} {-3:^7} {'x'!r}"] = popped
    if "late" in merged or not all(isinstance(v, torch.Tensor) for v in merged.values()):
        merged["wrong"] = popped
    reward = sum(merged.values()) / len(merged)
    words = "reach, lift".split(", ")
    del merged["missing"], values
    for word in reversed(words):
        reward = reward + gain_of(**{"name": word, "default": 0.5}) * 0.1
    numbers = [*range(3), *(4, 5)][::-1]
    return reward + 0.01 * numbers[0] + 0.1 * max(numbers), merged
