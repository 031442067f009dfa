# Error over seconds, the thesis's metric to the left and relative RMSE to the right. Set before: output, the file to
# write, and files, names of data files without .dat.
set terminal svg size 980,400 font 'sans-serif,12' background 'white'
set output output
set logscale xy
set grid linecolor '#dddddd'
set xlabel 'seconds without the G-buffer'
set format x '%g'
set format y '%g'
set key outside below horizontal autotitle columnhead samplen 2 maxrows 3
set style data linespoints
set pointsize 0.6
set multiplot layout 1,2
set ylabel 'error of the thesis (0 to 765)'
plot for [name in files] name.'.dat' using 1:2
set ylabel 'relative RMSE (%)'
plot for [name in files] name.'.dat' using 1:3
