#!/usr/bin/env bash
# Builds the Debian package build/simwright_VERSION_ARCHITECTURE.deb, which installs the program, the
# libraries with their headers, the weights and the Python module on any Debian 12:
#   ./package.sh && sudo apt install ./build/simwright_*.deb
set -euo pipefail
cd "$(dirname "$0")"
./setup.sh --package
python=.venv-python
[ -x $python/bin/python ] || python=.venv-package
cmake --preset release -DSIMWRIGHT_PYTHON=ON -DPython_EXECUTABLE="$PWD/$python/bin/python" >/dev/null
cmake --build --preset release
cmake --build --preset release --target simwright_package_files
rm -f build/simwright_*.deb
(cd build && cpack)
ls -l build/simwright_*.deb
