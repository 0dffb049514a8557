#!/usr/bin/env bash
# run.sh PYTHON PROGRAM: peers.py on assets and scenes that PROGRAM makes; 77 (skipped) without the
# environment of ./setup.sh --peers.
set -euo pipefail
python=$1 program=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if [ ! -f "$(dirname "$python")/../requirements.txt" ]; then
  echo "no environment at $python: ./setup.sh --peers makes it"
  exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
PYTHONDONTWRITEBYTECODE=1 "$python" "$here/peers.py" "$program" "$folder/things"
