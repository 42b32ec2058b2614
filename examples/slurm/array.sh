#!/usr/bin/env bash
# A study as an array of jobs that share nothing but the folder:
#     jobs=$(sbatch --parsable examples/slurm/array.sh examples/salvo.yaml salvo)
#     sbatch --dependency=afterany:$jobs --wrap 'launchdyn study merge salvo'
#SBATCH --job-name=study
#SBATCH --array=1-64
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --time=02:00:00
#SBATCH --requeue
set -euo pipefail
file=$1
folder=$2

export OPENBLAS_NUM_THREADS=1
exec launchdyn study "$file" --out "$folder" --quiet \
    --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT"
