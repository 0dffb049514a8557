"""The command ``python -m simwright.demonstrations``, which `simwright export` runs too."""

from __future__ import annotations

import argparse
import json
import sys
from typing import TYPE_CHECKING, Any, Callable, Sequence

from . import _arguments as checked
from . import _core, demonstrations, skills
from ._output import need

if TYPE_CHECKING:
    from ._types import WrittenTotals

# By format: the module that it needs, its extra, its writer.
_FORMATS: dict[str, tuple[str, str, Callable[..., WrittenTotals]]] = {
    "lerobot": ("lerobot.datasets.lerobot_dataset", "lerobot", demonstrations.write_lerobot),
    "mcap": ("mcap_ros2.writer", "mcap", demonstrations.write_mcap),
    "robomimic": ("h5py", "robomimic", demonstrations.write_robomimic)}


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m simwright.demonstrations", description="Records demonstrations of a skill "
        "with camera images, for imitation learning (docs/demonstrations.md).",
        formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    add = parser.add_argument
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--skill", help="such as open_drawer, or a long task: apple_into_drawer ...")
    source.add_argument("--run", help="a folder written by `simwright train`, with its policies")
    add("--episodes", type=int, default=50, help="number of episodes to keep")
    add("--format", required=True, choices=list(_FORMATS), help="of the data set")
    add("-o", "--output", required=True, help="folder (lerobot) or file (mcap, robomimic)")
    add("--cameras", default="front,wrist", help="front, wrist, shoulder, several with commas, or none")
    add("--image-size", type=int, default=128, help="pixels a side")
    add("--look", choices=["none", "wide"], default="none", help="randomised look")
    add("--policy", choices=["expert", "shipped"], default=None,
        help="what acts; default: the run's policies, else expert")
    add("--split", choices=["train", "unseen"], default="train", help="instances of a skill's objects")
    add("--instances", type=int, default=None, help="number of instances; default: the skill's")
    add("--keep", choices=["successes", "all"], default="successes", help="episodes to keep")
    add("--actions", choices=["joint_targets", "policy"], default="joint_targets",
        help="commanded joints, or the policy's actions relative to the object")
    add("--seed", type=int, default=1, help="of the episodes and their looks")
    add("--threads", type=int, default=0, help="number of threads; 0: all")
    add("--quiet", action="store_true", help="shows no progress")
    add("--json", action="store_true", help="prints the report as JSON")
    return parser


def _write(told: argparse.Namespace) -> WrittenTotals:
    """Records and writes what the command tells; returns the writer's report."""
    settings: dict[str, Any] = {} if told.instances is None else {"instances": told.instances}
    if told.skill in skills.names():
        settings["split"] = told.split
    _core.set_threads(checked.integer("threads", told.threads, 0))
    module, extra, write = _FORMATS[told.format]
    need(module, extra)
    episodes = demonstrations.record(
        told.skill, told.episodes, policy=told.policy, run=told.run, image_size=told.image_size,
        cameras=[] if told.cameras == "none" else told.cameras.split(","),
        look=None if told.look == "none" else told.look, seed=told.seed, keep=told.keep,
        progress=False if told.quiet or told.json else None, **settings)
    return write(told.output, episodes,
                 **({} if told.format == "mcap" else {"actions": told.actions}))


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command; returns its exit code."""
    told = _parser().parse_args(arguments)
    try:
        report = _write(told)
    except (_core.Error, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("error: interrupted (run the command again)", file=sys.stderr)
        return 130
    if told.json:
        print(json.dumps(report, indent=2))
        return 0
    print(f"{told.output}: {report['episodes']} episodes, {report['steps']} steps, "
          f"{report['successes']} successes")
    return 0
