# Fills the placeholders of page.md; page.sh tells which there are. Stops at one that it cannot fill.

function fail(message) {
    print "study: error: page.md:" NR ": " message > "/dev/stderr"
    failed = 1
    exit 1
}

# Reads FILE.csv into cells[file, id, column].
function load(file,    path, line, fields, n, i) {
    if (file in loaded) return
    loaded[file] = 1
    path = folder "/" file ".csv"
    while ((getline line < path) > 0) {
        n = split(line, fields, ",")
        rows[file]++
        columns[file] = n
        for (i = 1; i <= n; i++) {
            if (rows[file] == 1) names[file, i] = fields[i]
            else cells[file, fields[1], names[file, i]] = fields[i]
            grid[file, rows[file], i] = fields[i]
        }
    }
    close(path)
    if (!rows[file]) fail("no " path)
}

# Three significant digits.
function short(x) {
    if (x == 0) return "0"
    if (x >= 100) return sprintf("%.0f", x)
    if (x >= 10) return sprintf("%.1f", x)
    if (x >= 1) return sprintf("%.2f", x)
    return sprintf("%.2g", x)
}

function formatted(x, format) {
    if (format == "") return x
    if (format == "percent") return sprintf("%.1f %%", 100 * x)
    if (format == "fine") return sprintf("%.2f %%", 100 * x)
    if (format == "seconds") return short(x) " s"
    if (format == "times") return sprintf("%.2f", x)
    if (format == "MB") return short(x) " MB"
    fail("no format '" format "'")
}

function table(file,    text, r, i) {
    load(file)
    for (r = 1; r <= rows[file]; r++) {
        text = text "|"
        for (i = 2; i <= columns[file]; i++) text = text " " grid[file, r, i] " |"
        text = text "\n"
        if (r == 1) {
            text = text "|"
            for (i = 2; i <= columns[file]; i++) text = text "---|"
            text = text "\n"
        }
    }
    return substr(text, 1, length(text) - 1)
}

function filled(what,    part, n) {
    n = split(what, part, ":")
    if (part[1] == "picture") {
        if (!(part[2] in picture)) fail("no picture '" part[2] "'")
        return picture[part[2]]
    }
    if (part[1] == "table") return table(part[2])
    if (part[1] == "run") {
        if (!(part[2] in run)) fail("no '" what "'")
        return run[part[2]]
    }
    load(part[1])
    if (n < 3 || !((part[1], part[2], part[3]) in cells)) fail("no '" what "'")
    return formatted(cells[part[1], part[2], part[3]], part[4])
}

BEGIN {
    while ((getline line < pictures) > 0) picture[substr(line, 1, length(line) - 4)] = line
    run["size"] = size
    run["version"] = version
    run["machine"] = machine
    shown = 1
}

/^\{\{if / {
    name = substr($2, 1, length($2) - 2)
    shown = index(conditions, " " name " ") > 0
    next
}
/^\{\{end\}\}$/ { shown = 1; next }
!shown { next }

{
    text = ""
    rest = $0
    while ((start = index(rest, "{{")) > 0) {
        stop = index(rest, "}}")
        if (stop < start) fail("a placeholder does not end")
        text = text substr(rest, 1, start - 1) filled(substr(rest, start + 2, stop - start - 2))
        rest = substr(rest, stop + 2)
    }
    print text rest
}

END { exit failed }
