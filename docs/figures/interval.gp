# Draws interval.svg from interval.txt; scripts/salvo-study makes both in out/salvo/.
if (!exists("data")) data = "interval.txt"
set terminal svg size 900,620 font "sans,13" background "white"
set output "interval.svg"
set multiplot layout 2,2
set grid
set xrange [0.2:1.05]
set yrange [0:*]
set xlabel "firing interval [s]"
set ytics format "%g"
array name[6] = ["0 km/h, side to side", "0 km/h, by columns", "15 km/h, side to side", \
                 "15 km/h, by columns", "30 km/h, side to side", "30 km/h, by columns"]
array what[4] = ["pitch [mrad]", "yaw [mrad]", "pitch rate [mrad/s]", "yaw rate [mrad/s]"]
do for [k = 1:4] {
    set ylabel "deviation of the ".what[k]
    if (k == 3) { set key bottom right samplen 2 spacing 0.9 } else { unset key }
    plot for [i = 0:5] data index i using 1:k+1 with linespoints lw 2 \
        lc 1 + i / 2 dt 1 + i % 2 pt 7 - i % 2 title name[i + 1]
}
unset multiplot
