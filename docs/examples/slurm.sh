#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A track on a cluster with Slurm, longer than the queue lets a job run: the job asks for a signal ten minutes before
# its end, the run writes a checkpoint and ends with status 5, and the job puts itself in the queue again.
#
#   sbatch docs/examples/slurm.sh solver/cases/track_1wt.toml powder.h5 run_1wt --set spacing='2 um'
#
# What follows the folder goes to meltproof-solve as it is. The numbers do not depend on --ntasks and --cpus-per-task, nor
# on how often the run was stopped: they may be changed from one job to the next, on the command line of sbatch.
#SBATCH --job-name=meltproof
#SBATCH --ntasks=64
#SBATCH --cpus-per-task=1
#SBATCH --time=12:00:00
#SBATCH --signal=TERM@600
#SBATCH --open-mode=append
set -uo pipefail

if [ $# -lt 3 ]; then
  echo "usage: sbatch slurm.sh TRACK.toml POWDER.h5 OUTPUT_FOLDER [OPTIONS of meltproof-solve]" >&2
  exit 2
fi
track=$1 powder=$2 output=$3
shift 3
solve=${MELTPROOF_SOLVE:-build/release/bin/meltproof-solve}

export OMP_NUM_THREADS=$SLURM_CPUS_PER_TASK OMP_PROC_BIND=close OMP_PLACES=cores
# --restart begins where there is no checkpoint, and goes on from the newest good one where there is.
srun --mpi=pmix --cpus-per-task="$SLURM_CPUS_PER_TASK" "$solve" "$track" --powder "$powder" --output "$output" \
  --threads "$SLURM_CPUS_PER_TASK" --restart "$@"
status=$?

# srun passes on the status of the program: 5 is "stopped by a signal, with a checkpoint". The next job has the ranks,
# threads, time and log of this one, whatever was typed.
if [ $status -eq 5 ]; then
  limit=$(squeue --noheader --jobs="$SLURM_JOB_ID" --format=%l)
  log=$(scontrol show job "$SLURM_JOB_ID" | sed -n 's/^ *StdOut=//p')
  sbatch --dependency=afterany:"$SLURM_JOB_ID" --ntasks="$SLURM_NTASKS" --cpus-per-task="$SLURM_CPUS_PER_TASK" \
    --time="$limit" --output="$log" "$0" "$track" "$powder" "$output" "$@"
  exit 0
fi
exit $status
