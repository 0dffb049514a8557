#!/usr/bin/env bash
# The main job in one command: a photo becomes an asset that holds in simulation.
set -euo pipefail
cd "$(dirname "$0")"
./setup.sh
cmake --preset release >/dev/null
cmake --build --preset release --target simwright
out=${1:-out/coffee_cup}
build/bin/simwright lift examples/coffee.png --mask examples/coffee_mask.png \
  --category "coffee cup" -o "$out" --force
build/bin/simwright check "$out"
echo
echo "Look at $out/preview.png: the cup from four sides, and its collision parts."
