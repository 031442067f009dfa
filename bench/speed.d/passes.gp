# passes.gp: draws passes.csv (given: csv, svg, titles of the scenes), true and estimated error against passes, a panel for
# each scene. Columns: number of the scene, denoiser, passes, true error and estimate in percent.
set datafile separator ','
set datafile missing NaN
scenes = words(titles)
set terminal svg size 480 * scenes, 380 font 'sans,12' noenhanced background 'white'
set output svg
set logscale xy
set grid
set xlabel 'passes'
set ylabel 'error (%)'
at(scene, denoiser, number) = column(1) == scene && strcol(2) eq denoiser ? column(number) : NaN
set multiplot layout 1, scenes
do for [scene = 0:scenes - 1] {
    set title word(titles, scene + 1)
    stats csv skip 1 using (at(scene, 'none', 3)):(at(scene, 'none', 4) * sqrt(column(3))) nooutput
    plot csv skip 1 using (at(scene, 'none', 3)):(at(scene, 'none', 4)) with linespoints lc 1 pt 7 title 'not denoised', \
        csv skip 1 using (at(scene, 'none', 3)):(at(scene, 'none', 5)) with points lc 1 pt 8 ps 1.5 title 'estimate', \
        csv skip 1 using (at(scene, 'regression', 3)):(at(scene, 'regression', 4)) with linespoints lc 2 pt 7 title 'denoised', \
        csv skip 1 using (at(scene, 'regression', 3)):(at(scene, 'regression', 5)) with points lc 2 pt 8 ps 1.5 title 'estimate', \
        STATS_mean_y / sqrt(x) with lines lc 'grey' dt 2 title 'one over square root'
}
unset multiplot
