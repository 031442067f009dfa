#!/bin/sh
# test_golden.sh: small pictures must stay what they are, layer by layer.
#
# Tolerances allow for another instruction set (rays that tie, sums in another order), not for another
# method. When a picture is meant to change: tests/golden/update, look at the new ones, and say why in the commit.
set -u
. "$PSPLAT_SOURCE/tests/golden/lib.sh"

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failed=0

check() {
    render_golden "$2" "$3" "$folder/$1.exr" || { echo "$1: did not render"; failed=1; return 0; }
    for layer in direct indirect albedo N; do
        "$PSPLAT" compare "$golden_folder/$1.exr" "$folder/$1.exr" --layer $layer \
            --metric rel_rmse --metric max --metric p99 --metric bias \
            --fail 'rel_rmse>0.01' --fail 'max>0.2' --fail 'bias>1.002' --fail 'bias<0.998' >"$folder/log" 2>&1 || {
            echo "$1: layer $layer differs:"
            cat "$folder/log"
            failed=1
        }
    done
}

for_each_golden check || failed=1
exit $failed
