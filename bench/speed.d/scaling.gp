# scaling.gp: draws scaling.csv (given: csv, svg, all_threads): time against light paths and pixels, memory
# against passes and light paths. Columns: series, x, threads, photons, seconds of the indirect light, of the
# wall, of the processor, own bytes, peak bytes.
set terminal svg size 1000,760 font 'sans,13' background 'white'
set output svg
set datafile separator ','
set datafile missing NaN
set logscale xy
set key top left
set grid
cell(name, threads, number) = strcol(1) eq name && column(3) == threads ? column(number) : NaN
first_threads = int(word(all_threads, 1))
set multiplot layout 2,2
set ylabel 'indirect light (s)'
do for [name in 'paths pixels'] {
    set xlabel name eq 'paths' ? 'light paths' : 'pixels'
    plot for [threads in all_threads] csv skip 1 \
        using (cell(name, int(threads), 2)):(cell(name, int(threads), 5)) \
        with linespoints title sprintf('threads: %s', threads)
}
set ylabel 'memory (MB)'
set yrange [1:*]
do for [name in 'passes paths'] {
    set xlabel name eq 'paths' ? 'light paths' : 'passes'
    plot for [number in '8 9'] csv skip 1 \
        using (cell(name, first_threads, 2)):(cell(name, first_threads, int(number)) / 1e6) \
        with linespoints title number eq '8' ? 'photons, maps, bins' : 'whole process at most'
}
unset multiplot
