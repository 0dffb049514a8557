#!/usr/bin/env bash
# Trains a task on several machines, one training by the ranks of mpirun:
#   sbatch --nodes=2 --ntasks-per-node=4 train.sh /shared/tasks.json pick_up_cup_1 /shared/run [OPTION...]
# Tasks, assets and FOLDER must lie on a disk that all machines share. A job that is stopped loses what
# it learnt since the last checkpoint; the same line again resumes. OPTIONs are those of
# `simwright train`; SIMWRIGHT names the program if it is not on the path.
#SBATCH --job-name=train
#SBATCH --output=train_%j.log
#SBATCH --ntasks=4
#SBATCH --cpus-per-task=4
#SBATCH --mem-per-cpu=1G
#SBATCH --time=08:00:00
#SBATCH --requeue
set -euo pipefail
if [ $# -lt 3 ]; then
  echo "usage: sbatch --nodes=2 --ntasks-per-node=4 train.sh TASKS TASK FOLDER [OPTION...]" >&2
  exit 2
fi
tasks=$1 task=$2 folder=$3
shift 3
exec mpirun --map-by "slot:PE=${SLURM_CPUS_PER_TASK:-1}" "${SIMWRIGHT:-simwright}" train "$tasks" \
  --task "$task" -o "$folder" --resume "$@"
