#!/bin/sh
#SBATCH --job-name=psplat
#SBATCH --requeue
# slurm-array.sh: passes of one picture as a Slurm job array; each task keeps a film of its own.
#
#     sbatch --array=0-7 --cpus-per-task=16 slurm-array.sh SCENE PASSES FOLDER [OPTION...]
#
# Task i renders passes i * PASSES to before (i + 1) * PASSES, with the options, and keeps their film in
# FOLDER/film-i.exr. A task that is preempted, or killed, goes on from there when it is started again. Afterwards:
#
#     psplat merge FOLDER/film-*.exr -o FOLDER/film.exr
#     psplat resolve FOLDER/film.exr -o picture.exr -o picture.png
#
# Nodes must have the same instruction set, or all tasks --isa avx2, say. PSPLAT names another psplat than that of the
# path.

scene=$1 passes=$2 folder=$3
shift 3
first=$((SLURM_ARRAY_TASK_ID * passes))
exec "${PSPLAT:-psplat}" render "$scene" --passes $first:$((first + passes)) \
    --checkpoint "$folder/film-$SLURM_ARRAY_TASK_ID.exr" --resume \
    --threads "${SLURM_CPUS_PER_TASK:-1}" --progress plain "$@"
