#!/usr/bin/env bash
# Installs missing dependencies, builds, and runs all tests. Arguments are passed to ctest:
#   ./test.sh -L fast
set -euo pipefail
cd "$(dirname "$0")"
./setup.sh --tests
cmake --preset release -DSIMWRIGHT_TESTS=ON ${SIMWRIGHT_CMAKE_FLAGS:-} >/dev/null
cmake --build --preset release
built=$SECONDS
ctest --test-dir build --no-tests=error --output-on-failure -j "$(nproc)" "$@" | tee build/test.log
echo "test.sh: built in $built s, tested in $((SECONDS - built)) s"
# A test that lacks what it needs (a catalogue, python3-torch, peers) skips itself: never silently.
skipped=$(grep -E '\*\*\*Skipped' build/test.log | sed -E 's/^.*: ([^ ]+) .*/\1/' || true)
echo "skipped tests: $(grep -c . <<<"$skipped" || true) ${skipped//$'\n'/ }" | tee build/skipped.txt
