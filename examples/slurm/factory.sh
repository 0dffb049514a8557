#!/usr/bin/env bash
# Runs a factory by the tasks of a Slurm array, which share its folder:
#   sbatch --array=0-19 factory.sh /shared/plan.json /shared/factory [OPTION...]
# A task that is killed loses at most one asset for each of its threads; the same line again makes
# what is missing. FOLDER/index.html shows how far all are. OPTIONs are those of `simwright factory`;
# SIMWRIGHT names the program if it is not on the path.
#SBATCH --job-name=factory
#SBATCH --output=factory_%A_%a.log
#SBATCH --cpus-per-task=8
#SBATCH --mem-per-cpu=2G
#SBATCH --time=24:00:00
#SBATCH --requeue
#SBATCH --signal=B:TERM@120
set -euo pipefail
if [ $# -lt 2 ]; then
  echo "usage: sbatch --array=0-19 factory.sh PLAN FOLDER [OPTION...]" >&2
  exit 2
fi
plan=$1 folder=$2
shift 2
exec "${SIMWRIGHT:-simwright}" factory "$plan" -o "$folder" "$@"
