# Draws roofline.svg from roofline.txt.
set terminal svg size 800,480 font "sans,13" background "white"
set output "roofline.svg"
figure(name) = real(system("awk '$1 == \"".name."\" { print $2 }' roofline.txt"))
least(a, b) = a < b ? a : b
set logscale xy
set grid
set xrange [0.02:10]
set yrange [0.5:60]
set xlabel "operations a byte read or written [flop/B]"
set ylabel "sums and products [Gflop/s]"
set key bottom right
plot least(figure("first") * x, figure("lanes8")) lw 2 title "first cache, 8 lanes", \
     least(figure("first") * x, figure("lanes4")) lw 2 title "first cache, 4 lanes", \
     least(figure("first") * x, figure("lanes1")) lw 2 title "first cache, 1 lane", \
     least(figure("second") * x, figure("lanes4")) dt 2 lw 2 title "second cache, 4 lanes", \
     least(figure("memory") * x, figure("lanes4")) dt 3 lw 2 title "memory, 4 lanes", \
     "< tail -n 3 roofline.txt" using 2:3 with points pt 7 ps 1 lc "black" notitle, \
     "" using 2:3:1 with labels left offset 1,0 notitle
