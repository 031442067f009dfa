# Every strategy of every kind, as `psplat plugins` lists them, is found by name, and its picture is the
# same to the last bit for any number of threads and any batches.
. "$PSPLAT_SOURCE/tests/cli/lib.sh"

"$PSPLAT" plugins | awk '/^[a-z]/ { kind = $1 } /^  [a-z]/ { print kind "=" $1 }' >strategies
[ "$(wc -l <strategies)" -ge 27 ] || fail "not all strategies are listed"

while read -r strategy; do
    choice=$(small_choice "$strategy")
    case $strategy in
    injection=*) scene="--size 60x34 --passes 2 $cornell" ;;
    *) scene="--size 60x34 --passes 2 -p injection=photon:count=5000 $cornell" ;;
    esac
    run 0 $scene -p $choice --threads 1 --layers all,display -o one.exr
    run 0 $scene -p $choice --threads 3 --batch 100 --layers all,display -o three.exr
    expect_same one.exr three.exr
    run 0 info one.exr
    expect_match out "^psplat.${strategy%%=*}: ${strategy#*=}(:|\$)"
done <strategies

finish
