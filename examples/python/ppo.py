"""Proximal policy optimisation in one file, in the manner of CleanRL, on a native vector environment.

    python ppo.py --env simwright/OpenDrawer-v0 --steps 400000

Schulman et al. 2017, "Proximal policy optimization algorithms". The environment restarts an episode
in the step that ends it: the value of an episode that ran out of time is that of its `final_obs`.
"""

import argparse
import time

import gymnasium
import numpy as np
import torch
from torch import nn

import simwright  # noqa: F401  registers the environments


class Agent(nn.Module):
    """A Gaussian policy and a value function, with normalised observations."""

    def __init__(self, observations, actions, width=128):
        super().__init__()
        self.register_buffer("mean", torch.zeros(observations))
        self.register_buffer("variance", torch.ones(observations))
        self.register_buffer("count", torch.tensor(1e-4))

        def network(outputs, gain):
            layers = [nn.Linear(observations, width), nn.ELU(), nn.Linear(width, width), nn.ELU(),
                      nn.Linear(width, outputs)]
            for layer in layers[::2]:
                nn.init.orthogonal_(layer.weight, np.sqrt(2))
                nn.init.zeros_(layer.bias)
            nn.init.orthogonal_(layers[-1].weight, gain)
            return nn.Sequential(*layers)

        self.actor, self.critic = network(actions, 0.01), network(1, 1.0)
        self.log_std = nn.Parameter(torch.full((actions,), -1.0))

    def observe(self, batch):
        """Updates the moments of the observations (n, O)."""
        mean, variance, count = batch.mean(0), batch.var(0, unbiased=False), len(batch)
        shift, total = mean - self.mean, self.count + count
        self.variance += ((variance - self.variance) * count
                          + shift**2 * self.count * count / total) / total
        self.mean += shift * count / total
        self.count += count

    def normalised(self, observations):
        return ((observations - self.mean) / (self.variance + 1e-8).sqrt()).clamp(-5, 5)

    def distribution(self, observations):
        return torch.distributions.Normal(self.actor(self.normalised(observations)),
                                          self.log_std.exp())

    def value(self, observations):
        return self.critic(self.normalised(observations)).squeeze(-1)


def advantages_of(rewards, values, next_values, ends, discount, trace):
    """Returns generalised advantages (T, N); `next_values` is 0 where the task ended an episode."""
    advantages, running = torch.zeros_like(rewards), 0.0
    for t in reversed(range(len(rewards))):
        delta = rewards[t] + discount * next_values[t] - values[t]
        running = delta + discount * trace * (1.0 - ends[t]) * running
        advantages[t] = running
    return advantages


def train(flags, report=print):
    """Trains an agent; returns it and the success rates of the rollouts' ended episodes."""
    torch.manual_seed(flags.seed)
    env = gymnasium.make_vec(flags.env, num_envs=flags.num_envs, easy_starts=True,
                             **({"instances": flags.instances} if flags.instances else {}))
    agent = Agent(env.single_observation_space.shape[0], env.single_action_space.shape[0])
    optimizer = torch.optim.Adam(agent.parameters(), lr=flags.rate, eps=1e-5)
    observation = torch.from_numpy(env.reset(seed=flags.seed)[0])
    agent.observe(observation)
    rates, start, scale = [], time.time(), 0.05
    for update in range(max(1, flags.steps // (flags.num_envs * flags.rollout))):
        rows, successes = [], []
        for _ in range(flags.rollout):
            with torch.no_grad():
                distribution = agent.distribution(observation)
                action = distribution.sample()
                likelihood = distribution.log_prob(action).sum(-1)
                value = agent.value(observation)
                following, reward, terminated, truncated, infos = env.step(action.numpy())
                following = torch.from_numpy(following)
                next_value = agent.value(following)
                for i in np.flatnonzero(terminated | truncated):
                    last = torch.from_numpy(infos["final_obs"][i])
                    next_value[i] = 0.0 if terminated[i] else agent.value(last[None])[0]
                    successes.append(infos["final_info"]["is_success"][i])
            ends = torch.from_numpy((terminated | truncated).astype(np.float32))
            rows.append((observation, action, likelihood, value, next_value, ends,
                         scale * torch.from_numpy(reward)))
            observation = following
        states, actions, likelihoods, values, next_values, ends, rewards = map(
            torch.stack, zip(*rows))
        advantages = advantages_of(rewards, values, next_values, ends, flags.discount, 0.95)
        returns = advantages + values
        agent.observe(states.flatten(0, 1))
        flat = [part.flatten(0, 1) for part in (states, actions, likelihoods, advantages, returns)]
        for _ in range(flags.epochs):
            for chosen in torch.randperm(len(flat[0])).split(flags.batch):
                state, action, old, advantage, target = (part[chosen] for part in flat)
                advantage = (advantage - advantage.mean()) / (advantage.std() + 1e-8)
                ratio = (agent.distribution(state).log_prob(action).sum(-1) - old).exp()
                policy = -torch.min(ratio * advantage, ratio.clamp(0.8, 1.2) * advantage).mean()
                loss = policy + 0.5 * (agent.value(state) - target).square().mean()
                optimizer.zero_grad()
                loss.backward()
                nn.utils.clip_grad_norm_(agent.parameters(), 0.5)
                optimizer.step()
        if successes:
            rates.append(float(np.mean(successes)))
            report(f"{(update + 1) * flags.num_envs * flags.rollout} decisions, "
                   f"{time.time() - start:.0f} s, success {rates[-1]:.2f}")
    env.close()
    return agent, rates


def arguments():
    parser = argparse.ArgumentParser(description="Trains PPO on a Simwright environment.")
    parser.add_argument("--env", default="simwright/OpenDrawer-v0")
    parser.add_argument("--steps", type=int, default=400_000)
    parser.add_argument("--num-envs", type=int, default=64)
    parser.add_argument("--instances", type=int, default=0, help="objects; 0: all of the cell")
    parser.add_argument("--rollout", type=int, default=64, help="decisions between updates")
    parser.add_argument("--epochs", type=int, default=8)
    parser.add_argument("--batch", type=int, default=512)
    parser.add_argument("--rate", type=float, default=5e-4)
    parser.add_argument("--discount", type=float, default=0.98)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("-o", "--output", help="a file for the agent's weights")
    return parser


if __name__ == "__main__":
    chosen_flags = arguments().parse_args()
    trained, _ = train(chosen_flags)
    if chosen_flags.output:
        torch.save(trained.state_dict(), chosen_flags.output)
