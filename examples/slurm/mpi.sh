#!/usr/bin/env bash
# A study on the processes of one job: sbatch examples/slurm/mpi.sh examples/salvo.yaml salvo
#SBATCH --job-name=study
#SBATCH --ntasks=64
#SBATCH --cpus-per-task=1
#SBATCH --time=02:00:00
#SBATCH --requeue
set -euo pipefail
file=$1
folder=$2

# A core a process, also where the BLAS would take more. Killed or out of time, the same job goes on where it was.
export OPENBLAS_NUM_THREADS=1
exec mpirun launchdyn-mpi study "$file" --out "$folder" --quiet
