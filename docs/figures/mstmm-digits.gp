# Draws mstmm-digits.svg from the output of bench_mstmm_digits:
#   build/bench/bench_mstmm_digits > mstmm-digits.txt && gnuplot mstmm-digits.gp
set terminal svg size 720,440 font "sans,13" background "white"
set output "mstmm-digits.svg"
set logscale xy
set format y "10^{%T}"
set yrange [1e-17:3]
set xrange [1.8:120]
set xlabel "bodies in the chain"
set ylabel "difference from the reduced sweep"
set key bottom right
set grid
plot "mstmm-digits.txt" using 1:4 with linespoints pt 7 lw 2 title "paper's form, axes in turn", \
     "" using 1:2 with linespoints pt 5 lw 2 title "paper's form, axes nearly parallel", \
     "" using 1:3 with linespoints pt 9 lw 2 title "hinge accelerations kept, nearly parallel", \
     "" using 1:5 with linespoints pt 11 lw 2 title "hinge accelerations kept, in turn"
