# Error over seconds, the thesis's metric to the left and relative RMSE to the right. Set before: output, the file to
# write, and files, names of data files without .dat.
set terminal svg size 980,400 font 'sans-serif,12' background 'white'
set output output
set logscale xy
set grid linecolor '#dddddd'
set xlabel 'seconds without the G-buffer'
set format x '%g'
set format y '%g'
set key outside below horizontal autotitle columnhead samplen 3 maxrows 4
set style data linespoints
set pointsize 0.6
# Own methods have the same line in every graph.
line(name) = name eq 'path' ? 8 : name eq 'own' ? 7 : name eq 'pm' ? 4 : \
    name[1:5] eq 'small' ? 1 : name[1:5] eq 'large' ? 2 : 6
dashes(name) = strstrt(name, 'density') ? 2 : 1
set multiplot layout 1,2
set ylabel 'error of the thesis (0 to 765)'
plot for [name in files] name.'.dat' using 1:2 linetype line(name) dashtype dashes(name)
set ylabel 'relative RMSE (%)'
plot for [name in files] name.'.dat' using 1:3 linetype line(name) dashtype dashes(name)
