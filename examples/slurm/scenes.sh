#!/usr/bin/env bash
# Generates a dataset of scenes by the tasks of a Slurm array, which share its folder:
#   sbatch --array=0-99 scenes.sh dimsum 13000000 /shared/dimsum --part 4096
# A task that is killed loses at most the shard that it was writing; the same line again, with any
# array, makes what is missing. The last task to end prints the report of the whole. What follows the
# folder are options of `simwright scene generate`; SIMWRIGHT names the program if it is not on the path.
#SBATCH --job-name=scenes
#SBATCH --output=scenes_%A_%a.log
#SBATCH --cpus-per-task=8
#SBATCH --mem-per-cpu=1G
#SBATCH --time=24:00:00
#SBATCH --requeue
#SBATCH --signal=B:TERM@120
set -euo pipefail
if [ $# -lt 3 ]; then
  echo "usage: sbatch --array=0-99 scenes.sh TYPE COUNT FOLDER [OPTION...]" >&2
  exit 2
fi
type=$1 count=$2 folder=$3
shift 3
# exec: Slurm's signal before the time limit reaches the program, which then keeps finished scenes.
exec "${SIMWRIGHT:-simwright}" scene generate --type "$type" --count "$count" \
  -o "$folder" "$@"
