#!/bin/sh
# test_vectors.sh: compilers make vectors of all loops of the splat kernel that are marked for it. Where they don't,
# nothing is wrong but the time: a pointer that might alias another once made the inner loop scalar, and it took
# twice as long.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

is_on PSPLAT_SANITIZE && skip "sanitizers change what compilers do"
source=$PSPLAT_SOURCE/src/splat/kernel_variant.c
command=$(sed -n 's/.*"command": "\(.* -DKERNEL_VARIANT=avx2 .*\)",*$/\1/p' "$PSPLAT_BUILD/compile_commands.json")
[ -n "$command" ] || skip "there is no kernel for AVX2"
case $command in *-O3*) ;; *) skip "not an optimized build" ;; esac

$CC --version | grep -q clang && remarks=-Rpass=loop-vectorize || remarks=-fopt-info-vec-optimized
# The last -o counts.
sh -c "$command $remarks -Wno-error -o $scratch/kernel.o" >out 2>err || fail "$command"
marks=$(grep -n '^#pragma omp simd' "$source" | cut -d: -f1)
[ "$(echo "$marks" | wc -l)" -ge 7 ] || fail "few loops of $source are marked"
for line in $marks; do # remarks name the mark, or the first lines of the loop
    grep -E "kernel_variant\.c:($line|$((line + 1))|$((line + 2))|$((line + 3))):" err | grep -q vectorized ||
        fail "the loop at kernel_variant.c:$line is scalar"
done
finish
