#!/bin/bash
# A study in parts, one a job of an array:
#     job=$(sbatch --parsable slurm.sh STUDY.toml)
#     sbatch --dependency=afterany:$job --wrap "asperity merge STUDY.*-of-*.zarr"
# Sent again after a failure or a time limit, it goes on where it ended. Some of the parts again:
#     sbatch --array=3,7 slurm.sh STUDY.toml 16

#SBATCH --job-name=asperity
#SBATCH --array=1-16
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=4
#SBATCH --mem-per-cpu=1500M
#SBATCH --time=04:00:00
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=%x-%A_%a.out

set -euo pipefail

study=${1:?"usage: sbatch slurm.sh STUDY.toml [PARTS]"}
parts=${2:-$SLURM_ARRAY_TASK_MAX}

# Compiled code is for the processor of this node; a home that nodes share may be seen by others.
export XDG_CACHE_HOME="${TMPDIR:-$PWD}/.cache-$(hostname)"

exec asperity sweep "$study" --resume --yes \
    --shard "$SLURM_ARRAY_TASK_ID/$parts" --workers "$SLURM_CPUS_PER_TASK"
