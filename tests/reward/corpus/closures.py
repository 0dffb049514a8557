# Functions inside functions: what they read, and when.
import torch

scale = 0.5


def outer_default(x, factor=scale):
    scale = 4.0
    return x * factor * scale


def compute_reward(object_pos: torch.Tensor, goal_pos: torch.Tensor):
    import math as m
    scale = m.floor(2.5)

    def late(x):
        return x * scale + shift

    def fixed(x, factor=scale):
        return x * factor

    shift = 0.25
    scale = 3.0
    steps = []
    for axis in range(3):
        def along(x):
            return x[:, axis]
        steps.append(along(object_pos) - along(goal_pos))

    def norm(parts):
        def squares():
            return [part ** 2 for part in parts]
        total = 0.0
        for square in squares():
            total = total + square
        return torch.sqrt(total)

    total = object_pos[:, 0]
    if object_pos.shape[-1] == 3:
        def sign(x):
            return torch.sign(x)
    else:
        def sign(x):
            return x

    def apply(function, *, to):
        return function(to)

    reward = late(total) + fixed(total) + norm(steps) + sign(total) + apply(norm, to=steps)
    return reward + outer_default(total) + apply(to=total, function=late)
