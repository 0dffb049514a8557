"""Compares the training step of the scene diffusion model with PyTorch's, in updates per second.

    .venv-python/bin/python bench/peers/diffusion_training.py

The model of size "tiny" (2 double-stream and 4 single-stream blocks, width 128, 4 heads), written
here as one writes it for PyTorch: scaled_dot_product_attention, RMSNorm, fused AdamW and foreach
averages. An update adds noise to 32 scenes of 34 entries, computes the loss of poses and classes,
clips the gradient, steps AdamW and averages the weights, as bench_training_speed does. The numbers
of weights must agree. Ours uses as many threads as there are cores, PyTorch's the better of one and
of as many, and both run in turn.
"""

import os
import re
import statistics
import subprocess
import sys
import time

import numpy as np
import torch
from torch import nn
from torch.nn import functional

from comparison import Comparison, parser_of, report

WIDTH, HEADS, DOUBLE_BLOCKS, SINGLE_BLOCKS = 128, 4, 2, 4
STEPS, POSE, CLASSES, ENTRIES, BATCH = 1000, 12, 8, 34, 32
TIME_POWER, CLASS_WEIGHT, ENTROPY_SHARE, LEAST = 2.0, 100.0, 5e-4, 1e-30


def norm(x):
    return functional.layer_norm(x, x.shape[-1:], eps=1e-6)


def gelu(x):
    return functional.gelu(x, approximate="tanh")


class Modulation(nn.Module):
    """Computes shifts, scales and gates from the time's vector, zero at first."""

    def __init__(self, count):
        super().__init__()
        self.map = nn.Linear(WIDTH, count * WIDTH)
        nn.init.zeros_(self.map.weight)
        nn.init.zeros_(self.map.bias)
        self.count = count

    def forward(self, vector):
        return self.map(functional.silu(vector)).unsqueeze(1).chunk(self.count, -1)


class Attention(nn.Module):
    """Attends with normalised queries and keys."""

    def __init__(self):
        super().__init__()
        self.q_norm = nn.RMSNorm(WIDTH // HEADS, eps=1e-6)
        self.k_norm = nn.RMSNorm(WIDTH // HEADS, eps=1e-6)

    def forward(self, q, k, v):
        q, k, v = [x.unflatten(-1, (HEADS, -1)).transpose(1, 2) for x in (q, k, v)]
        mixed = functional.scaled_dot_product_attention(self.q_norm(q), self.k_norm(k), v)
        return mixed.transpose(1, 2).flatten(-2)


class DoubleBlock(nn.Module):
    """Gated attention, then a gated MLP on each token."""

    def __init__(self):
        super().__init__()
        self.modulation = Modulation(6)
        self.qkv, self.out = nn.Linear(WIDTH, 3 * WIDTH), nn.Linear(WIDTH, WIDTH)
        self.rise, self.fall = nn.Linear(WIDTH, 4 * WIDTH), nn.Linear(4 * WIDTH, WIDTH)
        self.attention = Attention()

    def forward(self, x, vector):
        m = self.modulation(vector)
        attended = self.attention(*self.qkv(norm(x) * (1 + m[1]) + m[0]).chunk(3, -1))
        x = x + m[2] * self.out(attended)
        return x + m[5] * self.fall(gelu(self.rise(norm(x) * (1 + m[4]) + m[3])))


class SingleBlock(nn.Module):
    """Attention and an MLP in parallel."""

    def __init__(self):
        super().__init__()
        self.modulation = Modulation(3)
        self.enter, self.out = nn.Linear(WIDTH, 7 * WIDTH), nn.Linear(5 * WIDTH, WIDTH)
        self.attention = Attention()

    def forward(self, x, vector):
        m = self.modulation(vector)
        q, k, v, inner = self.enter(norm(x) * (1 + m[1]) + m[0]).split(
            [WIDTH, WIDTH, WIDTH, 4 * WIDTH], -1)
        return x + m[2] * self.out(torch.cat([self.attention(q, k, v), gelu(inner)], -1))


class Denoiser(nn.Module):
    """Predicts the noise of poses and the clean classes of scenes."""

    def __init__(self, schedule):
        super().__init__()
        half = WIDTH // 2
        self.schedule = schedule
        self.pose = nn.Sequential(nn.Linear(POSE, half), nn.SiLU(), nn.Linear(half, half))
        self.classes = nn.Embedding(CLASSES + 1, half)
        self.join = nn.Linear(2 * half, WIDTH)
        self.time = nn.Sequential(nn.Linear(256, WIDTH), nn.SiLU(), nn.Linear(WIDTH, WIDTH))
        self.blocks = nn.ModuleList([DoubleBlock() for _ in range(DOUBLE_BLOCKS)] +
                                    [SingleBlock() for _ in range(SINGLE_BLOCKS)])
        self.last = Modulation(2)
        self.narrow = nn.Linear(WIDTH, half)
        self.pose_exit = nn.Sequential(nn.Linear(half, half), nn.SiLU(), nn.Linear(half, 3 * POSE))
        self.class_exit = nn.Sequential(nn.LayerNorm(half, eps=1e-6), nn.Linear(half, CLASSES))
        rates = torch.exp(torch.arange(128) * (-torch.log(torch.tensor(10000.0)) / 127))
        self.register_buffer("rates", rates)

    def forward(self, poses, classes, time):
        angles = time[:, None] * self.rates
        vector = self.time(torch.cat([angles.sin(), angles.cos()], 1))
        x = self.join(torch.cat([self.pose(poses), self.classes(classes)], -1))
        for block in self.blocks:
            x = block(x, vector)
        m = self.last(vector)
        x = self.narrow(norm(x) * (1 + m[1]) + m[0])
        noise, clean, gate = self.pose_exit(x).chunk(3, -1)
        signal, deviation = self.schedule.poses_at(time)
        noise = noise + torch.sigmoid(gate - 4.0) * (poses - signal * clean) / deviation
        return noise, self.class_exit(x)


class Schedule:
    """The noise of poses (linear betas) and of classes (mask and replace)."""

    def __init__(self):
        kept = torch.cumprod(1.0 - torch.linspace(1e-4, 0.02, STEPS, dtype=torch.double), 0)
        self.signal, self.deviation = kept.sqrt().float(), (1.0 - kept).sqrt().float()
        one = torch.ones(1, dtype=torch.double)
        fall = torch.linspace(0.99999, 9e-6, STEPS, dtype=torch.double)
        self.kept, self.masked = torch.cat([one, fall]), torch.cat([1.0 - one, fall.flip(0)])
        self.replaced = (1.0 - self.kept - self.masked).clamp_min(0.0) / CLASSES

    def poses_at(self, time):
        return self.signal[time][:, None, None], self.deviation[time][:, None, None]

    def classes_at(self, time):
        return [table[time + 1][:, None, None] for table in
                (self.kept, self.replaced, self.masked)]

    def add_noise(self, poses, classes):
        """Returns noisy poses and classes, the poses' noise, the time and the classes' weight."""
        u = torch.rand(len(poses))
        time = (STEPS * u**TIME_POWER).long().clamp_max(STEPS - 1)
        signal, deviation = self.poses_at(time)
        noise = torch.randn_like(poses)
        kept, replaced, masked = [x.float() for x in self.classes_at(time)]
        probabilities = torch.cat([kept * functional.one_hot(classes, CLASSES) + replaced,
                                   masked.expand(*classes.shape, 1)], -1)
        gumbel = -torch.log(-torch.log(torch.rand_like(probabilities).clamp_min(1e-20)))
        noisy_classes = (probabilities.clamp_min(LEAST).log() + gumbel).argmax(-1)
        weight = CLASS_WEIGHT * TIME_POWER * u ** (TIME_POWER - 1.0)
        return signal * poses + deviation * noise, noisy_classes, noise, time, weight

    def posterior(self, noisy, clean, time):
        """Returns the distribution of the classes one step earlier."""
        (kept_t, replaced_t, masked_t), (kept_s, replaced_s, masked_s) = (
            self.classes_at(time), self.classes_at(time - 1))
        kept, stays = kept_t / kept_s, (1.0 - masked_t) / (1.0 - masked_s)
        a, b, c = kept.float(), ((stays - kept).clamp_min(0.0) / CLASSES).float(), \
            (1.0 - stays).float()
        here = functional.one_hot(noisy, CLASSES + 1).float()
        mask = here[..., CLASSES:]
        classes, unmasked = here[..., :CLASSES], 1.0 - mask
        evidence = unmasked * (kept_t.float() * classes + replaced_t.float()) + \
            mask * masked_t.float()
        r = clean / evidence.clamp_min(LEAST)
        total = r.sum(-1, keepdim=True)
        step = unmasked * (a * classes + b) + mask * c
        posterior = torch.cat([step * (kept_s.float() * r + replaced_s.float() * total),
                               mask * masked_s.float() * total], -1)
        return posterior / posterior.sum(-1, keepdim=True).clamp_min(LEAST)

    def class_loss(self, classes, noisy, logits, time, weight):
        log_clean = functional.log_softmax(logits, -1)
        truth = self.posterior(noisy, functional.one_hot(classes, CLASSES).float(), time)
        guess = self.posterior(noisy, log_clean.exp(), time)
        divergence = (truth * (truth.clamp_min(LEAST).log() - guess.clamp_min(LEAST).log())).sum(-1)
        entropy = -log_clean.gather(-1, classes[..., None])[..., 0]
        share = ENTROPY_SHARE * (2.0 - (time + 1.0) / STEPS)
        return (weight * (divergence.mean(-1) + share * entropy.mean(-1))).mean()


class Training:
    """PyTorch's updates of the same model."""

    def __init__(self, compiled):
        torch.manual_seed(1)
        self.schedule = Schedule()
        self.denoiser = Denoiser(self.schedule)
        self.weights = list(self.denoiser.parameters())
        self.optimizer = torch.optim.AdamW(self.weights, 1e-3, weight_decay=0.01, fused=True)
        self.average = [weight.detach().clone() for weight in self.weights]
        self.poses = torch.rand(BATCH, ENTRIES, POSE) * 2.0 - 1.0
        self.classes = torch.randint(CLASSES, (BATCH, ENTRIES))
        self.loss = torch.compile(self.eager_loss) if compiled else self.eager_loss

    def count(self):
        return sum(weight.numel() for weight in self.weights)

    def eager_loss(self, poses, classes, noise, time, weight):
        guess, logits = self.denoiser(poses, classes, time)
        off = (guess - noise).square()
        return 0.5 * (off[..., :3].mean() + off[..., 3:].mean()) + self.schedule.class_loss(
            self.classes, classes, logits, time, weight)

    def update(self):
        loss = self.loss(*self.schedule.add_noise(self.poses, self.classes))
        self.optimizer.zero_grad()
        loss.backward()
        nn.utils.clip_grad_norm_(self.weights, 1.0)
        self.optimizer.step()
        with torch.no_grad():
            torch._foreach_lerp_(self.average, self.weights, 0.002)
        return loss.item()

    def rate(self, updates, threads):
        """Returns updates per second, and per second of a core."""
        torch.set_num_threads(threads)
        for _ in range(3):
            self.update()
        start, processor = time.perf_counter(), time.process_time()
        for _ in range(updates):
            self.update()
        return (updates / (time.perf_counter() - start),
                updates / (time.process_time() - processor))


def ours(program, updates):
    """Returns the number of weights and the updates per second, also of a core."""
    printed = subprocess.run([program, "--denoiser", "ours", "--updates", str(updates)],
                             check=True, stdout=subprocess.PIPE, text=True).stdout
    found = re.search(r"^ours +(\d+) +([\d.]+).* ([\d.]+)$", printed, re.MULTILINE)
    return int(found[1]), (float(found[2]), 1e3 / float(found[3]))


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--compile", action="store_true", help="compile PyTorch's loss first")
    options = parser.parse_args()
    threads = len(os.sched_getaffinity(0))
    peer = Training(options.compile)
    updates, rounds = (60, 7) if options.full else (25, 3)
    program = options.bin / "bench_training_speed"
    mine, theirs = [], []
    for _ in range(rounds):
        weights, rates = ours(program, updates)
        mine.append(rates)
        theirs.append(np.max([peer.rate(updates, count) for count in (1, threads)], axis=0))
    if weights != peer.count():
        sys.exit(f"error: the models differ: {weights} weights, PyTorch's {peer.count()}")
    ratio, of_processor = [statistics.median(own[kind] / other[kind] for own, other in
                                             zip(mine, theirs)) for kind in (0, 1)]
    name = f"PyTorch {torch.__version__.split('+')[0]}" + ", compiled" * options.compile
    report(options, [Comparison(
        "training", name, f"updates/s of the scene model, {BATCH} scenes of {ENTRIES}",
        statistics.median(rate for rate, _ in mine), statistics.median(rate for rate, _ in theirs),
        ratio, f"of processor time {of_processor:.1f}; the same {weights} weights, loss and AdamW; "
        f"{threads} threads, theirs the better of 1 and {threads}")])


if __name__ == "__main__":
    main()
