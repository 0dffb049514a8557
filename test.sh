#!/usr/bin/env bash
# Installs missing dependencies, builds, and runs all tests. Arguments are passed to ctest:
#   ./test.sh -L fast
# The Python package is built and tested too, which needs 5 GB of packages from PyPI once;
# SIMWRIGHT_PYTHON=OFF leaves it out.
set -euo pipefail
cd "$(dirname "$0")"
./setup.sh --tests
build() {
  # shellcheck disable=SC2086  # several flags
  cmake --preset release -DSIMWRIGHT_TESTS=ON ${SIMWRIGHT_CMAKE_FLAGS:-} "$@" >/dev/null
  cmake --build --preset release
}
if [ "${SIMWRIGHT_PYTHON:-ON}" = OFF ]; then
  build -DSIMWRIGHT_PYTHON=OFF
else
  if ! cmp -s tests/python/requirements.txt .venv-python/requirements.txt; then
    # The C++ code compiles while pip fetches.
    ./setup.sh --python &
    fetching=$!
    trap 'kill "$fetching" 2>/dev/null || true' EXIT
    build -DSIMWRIGHT_PYTHON=OFF
    wait "$fetching"
    trap - EXIT
  fi
  build -DSIMWRIGHT_PYTHON=ON -DPython_EXECUTABLE="$PWD/.venv-python/bin/python"
fi
built=$SECONDS
ctest --test-dir build --no-tests=error --output-on-failure -j "$(nproc)" "$@" | tee build/test.log
echo "test.sh: built in $built s, tested in $((SECONDS - built)) s"
# A test that lacks what it needs (a catalogue, python3-torch, peers) skips itself: never silently.
skipped=$(grep -E '\*\*\*Skipped' build/test.log | sed -E 's/^.*: ([^ ]+) .*/\1/' || true)
echo "skipped tests: $(grep -c . <<<"$skipped" || true) ${skipped//$'\n'/ }" | tee build/skipped.txt
