# Draws order.svg from order-figure.txt and order-weather-figure.txt; scripts/order-study makes all three in out/order/.
set terminal svg size 900,640 font "sans,13" background "white"
set output "order.svg"
held = "order-figure.txt"
free = "order-weather-figure.txt"
array speed[3] = ["0 km/h", "15 km/h", "30 km/h"]
set multiplot layout 2,2
set grid
set style data linespoints
set logscale x
set xrange [0.27:3.4]
set xtics (0.3, 0.4, 0.5, 0.65, 0.85, 1.1, 1.4, 1.8, 2.3, 3)
set xtics rotate by 45 right
set xlabel "firing interval [s]"
array what[2] = ["downrange", "drift"]
do for [k = 1:2] {
    set ylabel "deviation of ".what[k]." in a salvo [m]"
    set yrange [0:k == 1 ? 180 : 80]
    if (k == 1) { set key bottom left samplen 2 spacing 0.9 } else { unset key }
    plot for [v = 0:2] held index 0 using 1:4 + 5 * v + k lw 2 lc v + 1 pt 7 ps 0.5 title speed[v + 1].", weather held", \
         for [v = 0:2] free index 0 using 1:4 + 5 * v + k dt 2 lw 2 lc v + 1 pt 6 ps 0.6 title speed[v + 1].", free"
}
set ylabel "area in a salvo, against 3 s"
set yrange [0.5:1.8]
unset key
plot for [v = 0:2] held index 0 using ($1 * (0.97 + 0.03 * v)):2 + 5 * v:3 + 5 * v:4 + 5 * v \
         with yerrorbars lw 2 lc v + 1 pt 7 ps 0.5 notitle, 1 lc "gray" lw 1 notitle
unset logscale x
unset grid
set grid ytics
set xrange [-0.5:4.5]
set xlabel "order, all intervals; dashed: weather free" offset 0,-1
set bmargin 5
set ylabel "area in a salvo, against row by row"
set yrange [0.88:1.12]
set xtics rotate by 0 center ("column by\ncolumn" 0, "outside\nin" 1, "inside\nout" 2, "alternating\nsides" 3, "at\nrandom" 4)
plot for [v = 0:2] held index 1 using ($0 + 0.2 * (v - 1)):2 + 3 * v:3 + 3 * v:4 + 3 * v \
         with yerrorbars lw 2 lc v + 1 pt 7 ps 0.5 notitle, \
     for [v = 0:2] free index 1 using ($0 + 0.2 * (v - 1) + 0.08):2 + 3 * v:3 + 3 * v:4 + 3 * v \
         with yerrorbars lw 1 dt 2 lc v + 1 pt 6 ps 0.6 notitle, 1 lc "gray" lw 1 notitle
unset multiplot
