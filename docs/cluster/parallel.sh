#!/bin/sh
# parallel.sh: passes of one picture by GNU parallel, on this machine or on others (parallel --sshlogin).
#
#     parallel.sh TASKS PASSES SCENE FOLDER [OPTION...]
#
# Each of so many tasks renders so many passes, with the options, and keeps a film in FOLDER; they are merged to
# FOLDER/film.exr. What was interrupted goes on when it is started again. PSPLAT names another psplat than that of
# the path; PARALLEL holds options of parallel.

set -eu
tasks=$1 passes=$2 scene=$3 folder=$4
shift 4
psplat=${PSPLAT:-psplat}
seq 0 $((tasks - 1)) | parallel --halt now,fail=1 --quote sh -c '
    first=$(($1 * $2))
    task=$1 passes=$2 psplat=$3 scene=$4 folder=$5
    shift 5
    exec "$psplat" render "$scene" --passes $first:$((first + passes)) \
        --checkpoint "$folder/film-$task.exr" --resume --quiet "$@"' \
    sh '{}' "$passes" "$psplat" "$scene" "$folder" "$@"
exec "$psplat" merge "$folder"/film-[0-9]*.exr -o "$folder/film.exr"
