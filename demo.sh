#!/usr/bin/env bash
# Runs the whole pipeline: a photo becomes an asset, a task, a trained robot skill and a trajectory
# for the robot. A short form of `simwright run` with at most two minutes of training.
set -euo pipefail
cd "$(dirname "$0")"
./setup.sh
cmake --preset release >/dev/null
cmake --build --preset release --target simwright
out=${1:-out/apple_run}
build/bin/simwright run examples/apple.jpg --category apple \
  --minutes 2 --episodes 100 -o "$out" --force
echo
echo "Open $out/index.html in a browser: every step with its images and figures."
echo "$out/rollout.png shows the robot at work; $out/trajectory.yaml is for a Franka Panda."
echo "More: --task 'put_*_and_close_it' for a longer task, docs/run.md for the rest."
