#!/usr/bin/env bash
# Installs missing dependencies, builds, and runs all tests. Arguments are passed to ctest:
#   ./test.sh -L fast
set -euo pipefail
cd "$(dirname "$0")"
./setup.sh --tests
cmake --preset release -DSIMWRIGHT_TESTS=ON ${SIMWRIGHT_CMAKE_FLAGS:-} >/dev/null
cmake --build --preset release
ctest --test-dir build --no-tests=error --output-on-failure -j "$(nproc)" "$@"
