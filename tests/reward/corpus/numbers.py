# Elementwise functions and how types combine.
import torch
import numpy as np
import math

LIMITS = [0.5, -0.5]
GAIN = 2 * LIMITS[0]


def compute_reward(values: torch.Tensor, angle: torch.Tensor, steps: int):
    x = values[:, 0]
    y = values[:, 1]
    z = values[:, 2]
    r = torch.sin(angle * 3) + torch.cos(angle) + torch.tan(0.5 * angle) + torch.tanh(x * 2)
    r = r + torch.asin(x * 0.9) + torch.atan(y * 4) + torch.arccos(z * 0.9) + torch.atan2(x, y)
    r = r + torch.floor(x * 5) + torch.ceil(y * 5) + torch.round(z * 5) + torch.trunc(x * 7)
    r = r + torch.sign(y) + torch.fmod(x * 5, 2.0) + torch.remainder(y * 5, 2.0) + (z * 7) % 3
    r = r + (x * 9) // 2 + torch.log(x.abs() + 0.1) + torch.log2(y.abs() + 1) + torch.log1p(z.abs())
    r = r + torch.exp(x) + torch.expm1(y) + torch.sqrt(z.abs()) + torch.rsqrt(x.abs() + 1.0)
    r = r + torch.abs(x) ** 1.5 + y ** 2 + z ** 3 + 2.0 ** x + torch.pow(x.abs() + 0.1, -0.5)
    r = r + torch.hypot(x, y) + torch.sinh(x) + torch.cosh(y) + torch.deg2rad(angle) - torch.rad2deg(z)
    flags = x > 0
    more = flags + (y > 0)
    both = flags * (z > 0)
    whole = flags.int() + (y > 0).long() * 2 - steps
    r = r + more + both * 3 + whole / 2 + whole * 0.5 + (whole ** 2) + whole // 2 + (-whole).float()
    r = r + (flags & (y < 0.5)) + (flags | ~(y < 0.5)) + (flags ^ (z < 0)).float()
    r = r + torch.logical_or(flags, y > 0) + torch.logical_xor(flags, y > 0) + torch.logical_not(flags)
    r = r + (-0.5 < x).float() + (x != y) + (x >= y) + torch.isnan(x).float()
    r = r + torch.clamp(x, -0.3, 0.3) + x.clip(min=-0.1) + torch.maximum(x, y) + torch.min(x, z)
    r = r + torch.nan_to_num(torch.log(x)) + torch.where(x > 0, 1.0, y) + torch.where(flags, 2, 3)
    r = r + GAIN * LIMITS[1] + math.sin(0.5) + math.pi + np.inf * 0 if False else r + GAIN + np.sqrt(2)
    r = r + math.atan2(1.0, 2.0) + abs(-3) + max(1, 2.5) + min(4, 3) + round(2.6) + 7 // 2 + 7 % 3 + 2 ** 5
    r = r + int(3.7) + float("0.5") + len(LIMITS) + sum([1, 2, 3]) + 0x10 + 1_000 * 1e-3 - 5.0
    r = r + torch.exp(torch.tensor(1)) + torch.sigmoid(x * 40) + torch.exp(-80 * x.abs()) + torch.sin(x * 1e5)
    return r
