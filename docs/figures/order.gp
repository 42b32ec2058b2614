# Draws order.svg from order-figure.txt; scripts/order-study makes both in out/order/.
set terminal svg size 900,640 font "sans,13" background "white"
set output "order.svg"
text = "order-figure.txt"
array speed[3] = ["0 km/h", "15 km/h", "30 km/h"]
set multiplot layout 2,2
set grid
set style data linespoints
set logscale x
set xrange [0.27:3.4]
set xtics (0.3, 0.65, 1.4, 3)
set xlabel "firing interval [s]"
array what[2] = ["pitch rate", "yaw rate"]
do for [k = 1:2] {
    set ylabel "deviation of ".what[k]." [mrad/s]"
    set yrange [0:*]
    if (k == 2) { set key bottom left samplen 2 spacing 0.9 } else { unset key }
    plot for [v = 0:2] text index 0 using 1:4 + 5 * v + k lw 2 lc v + 1 pt 7 ps 0.5 title speed[v + 1]
}
set ylabel "scatter of the tip-off rates, against 3 s"
set yrange [*:*]
unset key
plot for [v = 0:2] text index 0 using ($1 * (0.97 + 0.03 * v)):2 + 5 * v:3 + 5 * v:4 + 5 * v \
         with yerrorbars lw 2 lc v + 1 pt 7 ps 0.5 notitle, 1 lc "gray" lw 1 notitle
unset logscale x
unset grid
set grid ytics
set xrange [-0.5:4.5]
set xlabel "order, all intervals" offset 0,-1
set bmargin 5
set ylabel "scatter, against row by row"
set xtics rotate by 0 center ("column by\ncolumn" 0, "outside\nin" 1, "inside\nout" 2, "alternating\nsides" 3, "at\nrandom" 4)
plot for [v = 0:2] text index 1 using ($0 + 0.2 * (v - 1)):2 + 3 * v:3 + 3 * v:4 + 3 * v \
         with yerrorbars lw 2 lc v + 1 pt 7 ps 0.5 notitle, 1 lc "gray" lw 1 notitle
unset multiplot
