# shellcheck shell=bash disable=SC2154 # variables are those of bench/study
# page.sh: the page, of page.md and the CSV files alone. Sourced by bench/study.
#
# In the template:
#     {{FILE:ID:COLUMN}}          a field of FILE.csv
#     {{FILE:ID:COLUMN:FORMAT}}   as percent (0.123 -> 12.3 %), fine (12.34 %), seconds, times or MB
#     {{picture:NAME}}            the file of a picture
#     {{table:FILE}}              a whole CSV file as a table
#     {{run:NAME}}                version, size or machine of this run
#     {{if CONDITION}}, {{end}}   lines of their own; what is between counts under that condition only

# picture_names: name and file of each picture.
picture_names() {
    find "$out" -maxdepth 1 \( -name '*.jpg' -o -name '*.png' \) -printf '%f\n'
}

describe_machine() {
    local cpu
    cpu=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo 2>/dev/null | head -n 1)
    echo "$(nproc 2>/dev/null || echo some) threads of ${cpu:-a processor that does not tell its name}"
}

write_page() {
    picture_names >"$work/pictures.txt"
    awk -v folder="$out" -v conditions=" $conditions " -v pictures="$work/pictures.txt" -v size="$size" \
        -v version="$("$psplat" --version | head -n 1)" -v machine="$(describe_machine)" \
        -f "$parts/page.awk" "$parts/page.md" >"$work/part.md"
    mv "$work/part.md" "$out/README.md"
}
