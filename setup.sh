#!/usr/bin/env bash
# Installs the build and runtime dependencies of Simwright from Debian 12's packages, if they are
# missing. --tests adds the dependencies of tests and benchmarks (with python3-torch, against which
# reward programs are compared, and Chromium, in which the viewer is tested), --catalogue the
# furniture of the catalogue tests (120 MB), --fuzz the compiler of the fuzz targets, the formatter,
# the linter, and what the fast tests link, --bench the libraries that only benchmarks compare with.
#
# --package adds what makes and tests the Debian package, with .venv-package to build the Python
# module for it.
#
# Other options create Python environments from PyPI: --python .venv-python, with what the Python
# module is built with and its tests run (PyTorch and Stable-Baselines3, 5 GB); --peers .venv-peers
# with Drake, MuJoCo, PyBullet and yourdfpy (700 MB), and .venv-bench (2 GB) with the libraries that
# bench/peers compares with, for which it also takes --python; --usd .venv-usd with usd-core and
# Newton (1 GB), which judge exported USD; --lerobot .venv-lerobot (6 GB), --robomimic
# .venv-robomimic (6 GB) and --mcap .venv-mcap (200 MB), in which the tests of label `peers` load
# Simwright's files. Options add up. With environments alone, no Debian package is installed.
set -euo pipefail

packages=(
  build-essential g++ cmake ninja-build ccache pkg-config git
  libeigen3-dev libassimp-dev libdraco-dev libcgal-dev libembree-dev libopencv-dev libopencv-contrib-dev
  libceres-dev libbullet-dev liburdfdom-dev libmujoco-dev nlohmann-json3-dev
  libcli11-dev libcurl4-openssl-dev libtinyxml2-dev libzip-dev libexif-dev libgif-dev libwebp-dev
  libconsole-bridge-dev libhdf5-dev libspdlog-dev libcpp-httplib-dev
  wordnet-base libtorch-dev libopenblas0-pthread
  libopenmpi-dev openmpi-bin
  python3-dev python3-venv
)
test_libraries=(libgtest-dev libsdformat-dev)
environments=()
install_packages=$([ $# -gt 0 ] || echo yes)
for wanted in "$@"; do
  case $wanted in
    --tests | --catalogue | --fuzz | --bench | --package) install_packages=yes ;;
  esac
  case $wanted in
    --tests)
      packages+=("${test_libraries[@]}" libbenchmark-dev libbullet-extras-dev
        python3-torch python3-numpy python3-h5py python3-yaml poppler-utils chromium)
      ;;
    --catalogue) packages+=(sweethome3d-furniture python3-skimage) ;;
    --fuzz)
      packages+=("${test_libraries[@]}" clang-14 clang-format-14 clang-tidy-14 libclang-rt-14-dev)
      ;;
    --bench) packages+=(libqhull-dev libfcl-dev libccd-dev libmeshoptimizer-dev) ;;
    --package)
      packages+=(dpkg-dev help2man debootstrap)
      environments+=(package)
      ;;
    --peers) environments+=(peers bench) ;;
    --python | --usd | --lerobot | --robomimic | --mcap) environments+=("${wanted#--}") ;;
    *)
      echo "error: unknown option $wanted (use --tests, --catalogue, --fuzz, --bench, --package, --python, --peers, --usd, --lerobot, --robomimic or --mcap)" >&2
      exit 2
      ;;
  esac
done

install_missing_packages() {
  local missing=() run=() package
  for package in "${packages[@]}"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q '^install ok installed' ||
      missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || {
      echo "error: ${#missing[@]} packages are missing and there is no sudo (run as root: apt-get install ${missing[*]})" >&2
      exit 1
    }
    run=(sudo)
  fi
  echo "Installing ${#missing[@]} packages"
  log=$(mktemp)
  trap 'rm -f "$log"' EXIT
  install() {
    "${run[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq update >"$log" 2>&1 &&
      "${run[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends \
        "${missing[@]}" >>"$log" 2>&1
  }
  # Retries once: a mirror can fail during an update.
  install || { sleep 5; install; } || { tail -20 "$log" >&2; exit 1; }
}

# create_environment NAME: creates .venv-NAME unless it has what its requirements file states.
# Versions are pinned to those that the tests were measured with.
create_environment() {
  local requirements folder=.venv-$1 python=${PYTHON:-/usr/bin/python3}
  local options=(--only-binary :all:)
  case $1 in
    python | peers | usd) requirements=tests/$1/requirements.txt ;;
    package) requirements=packaging/requirements.txt ;;
    bench) requirements=bench/peers/requirements.txt ;;
    *) requirements=tests/python/peers/requirements-$1.txt ;;
  esac
  cmp -s "$requirements" "$folder/requirements.txt" && return 0
  "$python" -c 'import ensurepip' 2>/dev/null || {
    echo "error: $python cannot create virtual environments (apt-get install python3-venv, or PYTHON=...)" >&2
    exit 1
  }
  echo "Installing $(grep -c == "$requirements") Python packages into $folder"
  rm -rf "$folder"
  "$python" -m venv "$folder"
  "$folder/bin/pip" install --quiet --disable-pip-version-check "${options[@]}" -r "$requirements"
  cp "$requirements" "$folder/requirements.txt"  # last: an incomplete environment is rebuilt
}

cd "$(dirname "$0")"
[ -z "$install_packages" ] || install_missing_packages
for name in "${environments[@]}"; do
  create_environment "$name"
done
