#!/usr/bin/env bash
# usage: run.sh BUILD SOURCE. Installs BUILD into a fresh prefix, builds the outside project there,
# and lets it read an asset that the program made.
set -euo pipefail
build=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/prefix" >/dev/null
cmake -S "$source/tests/install" -B "$work/build" -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix" >/dev/null
cmake --build "$work/build"
"$work/prefix/bin/simwright" lift "$source/examples/orange.jpg" --category orange --quiet \
  -o "$work/orange"
"$work/build/outside" "$work/orange"
