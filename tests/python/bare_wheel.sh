#!/usr/bin/env bash
# Installs a wheel of python/make_wheel.sh in a bare Debian 12 that debootstrap makes, and uses it there:
# bare_wheel.sh WHEEL. Needs root and a network.
set -euo pipefail
wheel=$(realpath "${1:?usage: bare_wheel.sh WHEEL}")
root=$(mktemp -d)
trap 'umount "$root/proc" 2>/dev/null || true; rm -rf "$root"' EXIT
debootstrap --variant=minbase --include=python3,python3-venv bookworm "$root" >/dev/null
mkdir "$root/wheels"
cp "$wheel" "$root/wheels"
/usr/bin/python3 -m venv "$root/download"
"$root/download/bin/pip" download --quiet --disable-pip-version-check --dest "$root/wheels" \
  'numpy>=1.23' 'gymnasium>=1.1' tqdm
cat >"$root/use.py" <<'PROGRAM'
import time

start = time.monotonic()
import simwright as sw

print(f"import {time.monotonic() - start:.1f} s")
import gymnasium

corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
solid = sw.geometry.mesh(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
assert abs(sw.geometry.mass_properties(solid, 6.0).mass - 1.0) < 1e-12
measured = sw.skills.evaluate("open_drawer", 20, progress=False)
print("open_drawer", measured["successes"], "of 20")
assert measured["successes"] >= 15
env = gymnasium.make("simwright/OpenDrawer-v0", cameras=["front"], image_size=32)
observation, _ = env.reset(seed=1)
assert observation["front"].shape == (32, 32, 3) and observation["front"].std() > 5
mug, = sw.assets.library("mug", "mug", progress=False)
print("mug", mug["grade"])
scenes = sw.scenes.generate("pantry_shelf", "scenes", count=2, progress=False)
lifted = sw.assets.lift(sw.assets.__file__.replace("assets.py", "data/coffee.png"), "mug", "lifted",
                        fast=True, progress=False)
print("lifted", lifted["silhouette_iou"])
assert lifted["silhouette_iou"] > 0.9
PROGRAM
mount -t proc proc "$root/proc"
chroot "$root" bash -ec 'python3 -m venv /venv
  /venv/bin/pip install --quiet --no-index --find-links /wheels simwright gymnasium tqdm
  mkdir /use && cd /use && /venv/bin/python /use.py'
