# speed.gp: draws speed.csv (given: csv, svg, titles of the groups, methods), error against time, a panel for each
# group. Columns: number of the group, method, seconds, error in percent.
set datafile separator ','
groups = words(titles)
columns = groups < 3 ? groups : groups == 4 ? 2 : 3
rows = (groups + columns - 1) / columns
many = words(methods) > 6 # than colours; their names do not fit into the panels
set terminal svg size (many ? 600 : 420) * columns, 330 * rows font 'sans,11' noenhanced background 'white'
set output svg
set datafile missing NaN
set logscale xy
set grid
if (many) { set key outside right samplen 4 } else { set key top right samplen 2 }
set xlabel 'seconds'
set ylabel 'error (%)'
at(group, method, number) = column(1) == group && strcol(2) eq method ? column(number) : NaN
set multiplot layout rows, columns
do for [group = 0:groups - 1] {
    set title word(titles, group + 1)
    plot for [i = 1:words(methods)] csv skip 1 \
        using (at(group, word(methods, i), 3)):(at(group, word(methods, i), 4)) \
        with linespoints linetype i dashtype 1 + (i - 1) / 6 title word(methods, i)
}
unset multiplot
