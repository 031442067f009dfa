#!/bin/sh
# test_compare.sh: psplat compare, diff and view as they are called: exit statuses, what they print
# and write, and their messages.
set -u

folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failures=0

# expect STATUS PATTERN WORDS...: runs psplat; some line it prints must match the pattern, if any.
expect() {
    status=$1 pattern=$2
    shift 2
    "$PSPLAT" "$@" >printed 2>&1
    got=$?
    if [ "$got" -ne "$status" ] || { [ "$pattern" ] && ! grep -q -e "$pattern" printed; }; then
        echo "FAILED: psplat $*: status $got, wanted $status and '$pattern'; printed:"
        cat printed
        failures=$((failures + 1))
    fi
}

# expect_file FILE: it must be there and not empty.
expect_file() {
    if [ ! -s "$1" ]; then
        echo "FAILED: $1 was not written"
        failures=$((failures + 1))
    fi
}

# expect_lines NUMBER: the last command printed so many.
expect_lines() {
    if [ "$(wc -l <printed)" -ne "$1" ]; then
        echo "FAILED: wanted $1 lines:"
        cat printed
        failures=$((failures + 1))
    fi
}

render() {
    "$PSPLAT" render "$PSPLAT_SOURCE/scenes/cornell.psd" --quiet -p injection=photon:count=2000 \
        "$@" || exit 1
}

render --size 40x30 -o a.exr
render --size 40x30 --seed 1 -o b.exr
render --size 20x30 -o narrow.exr

# What is printed.
expect 0 '^psnr inf$' compare a.exr a.exr
expect_lines 9
expect 0 '^bias 1 1 1$' compare a.exr a.exr
expect 0 '^flip 0$' compare --metric flip a.exr a.exr
expect_lines 1
expect 0 '^rel_rmse 0\.[0-9]*$' compare a.exr b.exr
expect 0 '^bias [0-9.]* [0-9.]* [0-9.]*$' compare a.exr b.exr --layer indirect
expect 0 '^bias 1$' compare a.exr a.exr --layer Z --crop 10,10,8,8
expect 0 '^ssim 1$' compare a.exr a.exr --crop 20,15,1,1
expect 0 '^max 0$' compare a.exr a.exr --layer N.Z

# Bounds.
expect 0 '^psnr' compare a.exr b.exr --metric psnr --fail 'rel_rmse>10' --fail 'bias<0.1'
expect_lines 1
expect 1 'failed: rel_rmse>=0: rel_rmse 0' compare a.exr a.exr --fail 'rel_rmse>=0' --metric max
expect 1 'failed: bias<=1: bias 1 1 1' compare a.exr a.exr --fail 'bias<=1' --fail 'flip>0.5'

# Wrong use.
expect 2 'expected two pictures' compare a.exr
expect 2 'expected two pictures' compare a.exr a.exr a.exr
expect 2 "did you mean 'psnr'" compare a.exr a.exr --metric pnsr
expect 2 'there are: thesis_rmse' compare a.exr a.exr --metric somethingelse
expect 2 'expected METRIC>NUMBER' compare a.exr a.exr --fail psnr
expect 2 'expected a number' compare a.exr a.exr --fail 'psnr<x'
expect 2 "did you mean 'flip'" compare a.exr a.exr --fail 'filp>1'
expect 2 'expected X,Y,W,H' compare a.exr a.exr --crop 1,2,3
expect 2 'expected X,Y,W,H' compare a.exr a.exr --crop 1,2,3,4,5
expect 2 'expected X,Y,W,H' compare a.exr a.exr --crop 1,2,-3,4
expect 2 'reaches beyond' compare a.exr a.exr --crop 30,0,11,5
expect 2 'empty' compare a.exr a.exr --crop 0,0,0,5

# Without the bright pixels: what is left is a smaller sum, and nothing is an error.
expect 2 'expected a number' compare a.exr a.exr --below bright
expect 1 'no pixel is left: all reach 0' compare a.exr a.exr --below 0
expect 0 '^bias 1 1 1$' compare a.exr a.exr --below 0.2
"$PSPLAT" compare a.exr b.exr --metric max >all
"$PSPLAT" compare a.exr b.exr --metric max --below 1e9 | cmp -s - all ||
    { echo "FAILED: --below 1e9 left something out"; failures=$((failures + 1)); }

# Wrong pictures.
expect 1 'missing.exr' compare a.exr missing.exr
expect 1 'differ in size.*40x30.*20x30' compare a.exr narrow.exr
expect 1 "no layer 'indirekt': there are: .*R,G,B (without --layer), .*indirect, weight" \
    compare a.exr a.exr --layer indirekt

# Differences.
expect 2 'where to' diff a.exr b.exr
expect 2 'expected two pictures' diff a.exr -o d.exr
expect 1 'differ in size' diff a.exr narrow.exr -o d.exr
expect 0 '' diff a.exr b.exr -o d.exr --layer indirect
expect 0 '^channels: indirect.B indirect.G indirect.R$' info d.exr
expect 1 'has no channels R, G, B: choose with --layer from: indirect$' view d.exr
expect 0 '' diff a.exr a.exr -o zero.exr
expect 1 'zero everywhere: rel_rmse' compare zero.exr a.exr
expect 0 '^relmse' compare zero.exr a.exr --metric relmse
expect 1 'zero everywhere' compare zero.exr a.exr --metric max --heatmap none.png

# Pictures of pictures.
expect 0 '^max' compare a.exr b.exr --heatmap heat.png --metric max
expect_file heat.png
expect 0 '' view a.exr
expect_file a.png
for layer in indirect N Z weight P.X; do
    expect 0 '' view a.exr --layer $layer -o $layer.png --exposure -0.5 -p tonemap=clip
    expect_file $layer.png
done
expect 2 "no tonemap 'linear'" view a.exr -p tonemap=linear
expect 2 'expected bloom=NAME or tonemap=NAME' view a.exr -p denoiser=none
expect 2 'expected a number' view a.exr --exposure bright
expect 2 'expected one picture' view
expect 1 'missing.exr' view missing.exr
expect 1 "no layer 'Q'" view a.exr --layer Q

# Parts, and large pixels.
# expect_size WxH FILE.png: as its header says.
expect_size() {
    found=$(od -An -tu1 -j16 -N8 "$2" |
        awk '{ print $1 * 16777216 + $2 * 65536 + $3 * 256 + $4 "x" $5 * 16777216 + $6 * 65536 + $7 * 256 + $8 }')
    if [ "$found" != "$1" ]; then
        echo "FAILED: $2 is $found, wanted $1"
        failures=$((failures + 1))
    fi
}
expect 0 '' view a.exr -o whole.png --crop 0,0,40,30 --zoom 1
cmp -s whole.png a.png || { echo "FAILED: all of the picture is another"; failures=$((failures + 1)); }
expect 0 '' view a.exr -o part.png --crop 20,10,6,4
expect_size 6x4 part.png
expect 0 '' view a.exr -o large.png --crop 20,10,6,4 --zoom 8
expect_size 48x32 large.png
expect 0 '' view a.exr -o zoomed.png --layer Z --zoom 3
expect_size 120x90 zoomed.png
rm -f none.png
expect 2 'expected X,Y,W,H' view a.exr -o none.png --crop 1,2,3
expect 2 'reaches beyond' view a.exr -o none.png --crop 30,0,11,5
expect 2 'empty' view a.exr -o none.png --crop 0,0,0,5
expect 2 '--zoom: expected a whole number 1..64' view a.exr -o none.png --zoom 65
expect 2 '--zoom: expected a whole number 1..64' view a.exr -o none.png --zoom 0.5
[ ! -e none.png ] || { echo "FAILED: a picture in spite of errors"; failures=$((failures + 1)); }

# A picture of fewer bounces is darker.
render --size 40x30 -o all.exr --bounces all
expect 0 '^bias 0\.[0-9]* 0\.[0-9]* 0\.[0-9]*$' compare all.exr a.exr --layer indirect
expect 1 'failed: bias<0.99' compare all.exr a.exr --layer indirect --fail 'bias<0.99'

[ "$failures" -eq 0 ]
