#!/bin/sh
# test_vectors.sh: compilers make vectors of all loops that are marked for it, clang of those of the kernel (it unrolls
# some of the others). Where they don't, nothing is wrong but the time: a pointer that might alias another once made
# the inner loop scalar, and it took twice as long.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

is_on PSPLAT_SANITIZE && skip "sanitizers change what compilers do"
kernel=src/splat/kernel_variant.c
remarks=-fopt-info-vec-optimized
marked=$(cd "$PSPLAT_SOURCE" && grep -rl '^#pragma omp simd' src plugins)
[ "$(echo "$marked" | wc -l)" -ge 5 ] || fail "few files have marked loops"
[ "$(grep -c '^#pragma omp simd' "$PSPLAT_SOURCE/$kernel")" -ge 9 ] || fail "few loops of $kernel are marked"
if $CC --version | grep -q clang; then
    remarks=-Rpass=loop-vectorize
    marked=$kernel
fi

# command_of FILE: how it is compiled; the kernel, which is compiled several times, for AVX2, or not at all.
command_of() {
    sed -n "s|.*\"command\": \"\(.* -c [^ ]*/$1\)\",*\$|\1|p" "$PSPLAT_BUILD/compile_commands.json" |
        grep -v -e "-DKERNEL_VARIANT=[^ ]*[^2] " | sed 's/\\\(["\\]\)/\1/g' | head -n 1
}

# source_of FILE: what it is compiled with: of a header, the first source beside it that includes it.
source_of() {
    case $1 in
    *.h) (cd "$PSPLAT_SOURCE" && grep -l "^#include \"\(.*/\)*$(basename "$1")\"" "$(dirname "$1")"/*.c | head -n 1) ;;
    *) echo "$1" ;;
    esac
}

# expect_vectors FILE
expect_vectors() {
    command=$(command_of "$(source_of "$1")")
    if [ -z "$command" ]; then
        [ "$1" = "$kernel" ] || fail "$1 is not compiled, or no source beside it includes it"
        return # another kind of processor
    fi
    case $command in *-O3*) ;; *) skip "not an optimized build" ;; esac
    # The last -o counts.
    sh -c "$command $remarks -Wno-error -o $scratch/object.o" >out 2>err || fail "$command"
    for line in $(grep -n '^#pragma omp simd' "$PSPLAT_SOURCE/$1" | cut -d: -f1); do
        name=$(basename "$1"):$line # remarks name the mark, or the first lines of the loop
        grep -E "$(basename "$1"):($line|$((line + 1))|$((line + 2))|$((line + 3))):" err |
            grep -q vectorized || fail "the loop at $name is scalar"
    done
}

for file in $marked; do
    expect_vectors "$file"
done
finish
