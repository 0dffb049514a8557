#!/usr/bin/env bash
# run.sh NAME PYTHONPATH FILE...: pytest of the files in .venv-NAME, with the built package in
# PYTHONPATH; 77 (skipped) without the environment of ./setup.sh --NAME.
set -euo pipefail
name=$1 package=$2
shift 2
environment=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)/.venv-$name
if [ ! -f "$environment/requirements.txt" ]; then
  echo "no environment at $environment: ./setup.sh --$name makes it"
  exit 77
fi
export PYTHONPATH=$package PYTHONDONTWRITEBYTECODE=1
exec "$environment/bin/python" -X faulthandler -m pytest -q -ra -p no:cacheprovider "$@"
