#!/usr/bin/env bash
# Installs the package by pip into a fresh virtual environment, away from the source, and runs the
# lines of README there, with fewer steps of training: install.sh PYTHON BUILD SOURCE. PYTHON is that
# of .venv-python, whose packages stand in for those that pip would fetch.
set -euo pipefail
python=$1 build=$2 source=$3
work=$build/pip_test
rm -rf "$work"
mkdir -p "$work"
/usr/bin/python3 -m venv "$work/venv"
# In the build folder, as for a user who has built before: only the bindings are compiled again, for
# the nanobind of pip's own environment. No other test runs meanwhile.
# The settings of the build folder: with others, CMake would delete the test programs.
defines=()
for name in WERROR TESTS BENCH; do
  defines+=("SIMWRIGHT_$name=$(sed -n "s/^SIMWRIGHT_$name:[A-Z]*=//p" "$build/CMakeCache.txt")")
done
restore() {
  cd "$source"
  rm -f "$build/.skbuild-info.json"
  cmake -S "$source" -B "$build" "${defines[@]/#/-D}" -DSIMWRIGHT_PYTHON=ON \
    -DPython_EXECUTABLE="$python" -Dnanobind_DIR= >/dev/null
  cmake --build "$build" --target simwright_python simwright_python_stub >/dev/null
}
trap restore EXIT
rm -f "$build/.skbuild-info.json"  # with it, scikit-build-core would start from an empty cache
"$work/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps \
  "${defines[@]/#/--config-settings=cmake.define.}" "$source"
"$python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))' \
  >"$work/venv/lib/$("$python" -c 'import sys; print("python%d.%d" % sys.version_info[:2])')/site-packages/tests.pth"
cd "$work"
export SIMWRIGHT_CACHE=$work/cache
unset PYTHONPATH
sed -n '/^    import gymnasium, simwright$/,/^$/p' "$source/README.md" | sed 's/^    //' |
  sed 's/400_000/8192/; s/easy_starts=True/easy_starts=True, instances=4/' >lines.py
[ "$(wc -l <lines.py)" -ge 8 ]
"$work/venv/bin/python" lines.py | tee printed.txt
grep -Eq "'success': (0\.[89]|1\.0)" printed.txt
"$work/venv/bin/python" - "$work" <<'CHECK'
import os
import sys

import simwright

assert simwright.__file__.startswith(sys.argv[1]), simwright.__file__
folder = os.path.dirname(simwright.__file__)
assert os.path.exists(os.path.join(folder, "_core.pyi")) and os.path.exists(os.path.join(folder, "py.typed"))
assert "def act(" in open(os.path.join(folder, "_core.pyi")).read()
print("installed", simwright.__version__)
CHECK
# A module for another Python says so.
mv "$work"/venv/lib/python*/site-packages/simwright/_core.cpython-3*.so \
  "$(ls -d "$work"/venv/lib/python*/site-packages/simwright)/_core.cpython-27-x86_64-linux-gnu.so"
if "$work/venv/bin/python" -c 'import simwright' 2>message.txt; then exit 1; fi
tail -1 message.txt
tail -1 message.txt | grep -q 'ImportError: simwright: _core.cpython-27.* is for another Python than this one'
cd "$source"
rm -rf "$work"
