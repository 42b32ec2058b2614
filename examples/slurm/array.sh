#!/usr/bin/env bash
# A study as an array of jobs that share nothing but the folder. Jobs may begin late, end early or be killed; more of
# them may be added while it runs:
#     sbatch examples/slurm/array.sh examples/salvo.yaml salvo
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
exec launchdyn study "$file" --out "$folder" --quiet --join
