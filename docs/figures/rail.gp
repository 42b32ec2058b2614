# Draws rail-*.svg from the texts and histories in `out`; scripts/rail-study makes them.
set terminal svg size 900,640 font "sans,13" background "white"
set grid
array name[3] = ["pad.yaml", "no gaps", "no gaps, stiff rail"]

# ---- along the travel ----
set output "docs/figures/rail-travel.svg"
set datafile separator ","
pad = out."/pad/history.csv"
stiff = out."/stiff/history.csv"
travel = "rocket.s [m]"
set multiplot layout 2,1
set xrange [0.4:5]
set arrow from 3.4, graph 0 to 3.4, graph 1 nohead lc "gray"
set xlabel "rear shoe's place on the rail [m]"
set yrange [0:350]
set key at 3.3,340 samplen 2
set ylabel "normal force [N]"
plot pad every 2 using travel:"contact.front.normal [N]" with lines lc 1 title "front shoe", \
     pad every 2 using travel:"contact.rear.normal [N]" with lines lc 2 title "rear shoe", \
     stiff every 2 using travel:"contact.front.normal [N]" with lines dt 2 lc 1 title "front, no gaps, stiff rail", \
     stiff every 2 using travel:"contact.rear.normal [N]" with lines dt 2 lc 2 title "rear, no gaps, stiff rail"
set yrange [-480:100]
set key default bottom left samplen 2
set ylabel "bending moment about z [N m]"
array place[4] = ["1.2", "2.21", "3", "4"]
plot for [i = 1:4] pad every 2 using travel:"station.".i.".bending_z [N.m]" with lines lw 1.5 lc i title place[i]." m", \
     stiff every 2 using travel:"station.2.bending_z [N.m]" with lines dt 2 lc 2 title "2.21 m, no gaps, stiff rail"
unset multiplot
unset arrow
set datafile separator whitespace
set yrange [*:*]

# ---- stiffness ----
set output "docs/figures/rail-stiffness.svg"
set terminal svg size 900,420
set multiplot layout 1,2
set logscale x
set xrange [0.25:120]
set xlabel "rail's stiffness over that of pad.yaml"
array plane[2] = ["pitch", "yaw"]
array rigid[2] = [-64.71, -1.41]
do for [j = 1:2] {
    set ylabel plane[j]." rate at the exit [mrad/s]"
    if (j == 1) { set key default bottom right } else { unset key }
    plot out."/stiffness.txt" using 1:1 + j with points pt 7 ps 0.3 lc 1 title name[1], \
         out."/stiffness-tight.txt" using 1:1 + j with linespoints pt 6 ps 0.5 lc 2 title name[2], \
         rigid[j] lc "black" dt 2 title "closed form"
}
unset multiplot
unset logscale x

# ---- gaps and distance of the shoes ----
set output "docs/figures/rail-shoes.svg"
set terminal svg size 900,640
set multiplot layout 2,2
set xrange [0:*]
set key default bottom left
set xlabel "gap over and under the lips [mm]"
set ylabel "pitch rate at the exit [mrad/s]"
set yrange [-75:-55]
plot out."/gap.txt" using 1:2 with linespoints pt 7 ps 0.4 lc 1 title name[1], \
     out."/gap-stiff.txt" using 1:2 with linespoints pt 7 ps 0.4 lc 3 title "stiff rail", \
     -64.71 lc "black" dt 2 title "closed form, no gap"
set yrange [*:0]
set key default top right
set xlabel "gap at the sides [mm]"
set ylabel "yaw rate at the exit [mrad/s]"
plot out."/side.txt" using 1:3 with linespoints pt 7 ps 0.4 lc 1 title name[1], \
     out."/side-stiff.txt" using 1:3 with linespoints pt 7 ps 0.4 lc 3 title "stiff rail", \
     out."/rigid-side.txt" using 1:3 with lines lc "black" dt 2 title "closed form with start angle"
set xrange [0.5:3.1]
set key default bottom left
set xlabel "distance of the shoes [m]"
do for [j = 1:2] {
    set ylabel plane[j]." rate at the exit [mrad/s]"
    if (j == 2) { unset key }
    plot out."/distance.txt" using 1:1 + j with points pt 7 ps 0.4 lc 1 title name[1], \
         out."/distance-tight.txt" using 1:1 + j with linespoints pt 6 ps 0.5 lc 2 title name[2], \
         out."/distance-stiff.txt" using 1:1 + j with linespoints pt 7 ps 0.4 lc 3 title name[3], \
         out."/rigid-distance.txt" using 1:1 + j with lines lc "black" dt 2 title "closed form"
}
unset multiplot

# ---- step ----
set output "docs/figures/rail-step.svg"
set terminal svg size 900,380
set multiplot layout 1,2
set xrange [3.35:5.05]
set yrange [*:*]
set key default top right
set xlabel "station at which the rear shoe's contact ends [m]"
do for [j = 1:2] {
    set ylabel plane[j]." rate at the exit [mrad/s]"
    if (j == 2) { unset key }
    plot out."/step.txt" using 1:1 + j with points pt 7 ps 0.4 lc 1 title name[1], \
         out."/step-tight.txt" using 1:1 + j with linespoints pt 6 ps 0.5 lc 2 title name[2], \
         out."/step-stiff.txt" using 1:1 + j with linespoints pt 7 ps 0.4 lc 3 title name[3], \
         out."/rigid-step.txt" using 1:1 + j with lines lc "black" dt 2 title "closed form"
}
unset multiplot

# ---- a rail that is not straight ----
set output "docs/figures/rail-bends.svg"
set terminal svg size 1000,380
set multiplot layout 1,3
set yrange [*:*]
array shape[2] = ["kink", "height"]
array of_joint[2] = ["kink of a joint at 4 m, upwards [mrad]", "step of a joint at 4 m, upwards [mm]"]
set xrange [-1.05:1.05]
set ylabel "pitch rate at the exit [mrad/s]"
set key default top left samplen 2
do for [k = 1:2] {
    set xlabel of_joint[k]
    plot out."/".shape[k].".txt" using 1:2 with points pt 7 ps 0.4 lc 1 title name[1], \
         out."/".shape[k]."-stiff.txt" using 1:2 with linespoints pt 7 ps 0.4 lc 3 title name[3], \
         out."/rigid-".shape[k].".txt" using 1:2 with lines lc "black" dt 2 title "closed form"
    unset key
}
set xrange [-0.2:5.2]
set xlabel "deviation of random bends [mm]"
set key default top left samplen 2
plot out."/bend.txt" using 1:2 with points pt 7 ps 0.4 lc 1 title name[1], \
     out."/bend-stiff.txt" using ($1 + 0.12):2 with points pt 7 ps 0.4 lc 3 title name[3]
unset multiplot

# ---- mass centre and wind ----
set output "docs/figures/rail-offset.svg"
set terminal svg size 1000,380
set multiplot layout 1,3
set yrange [*:*]
array file[3] = ["up", "right", "wind"]
array what[3] = ["mass centre above the axis [mm]", "mass centre right of the axis [mm]", "wind to the right [m/s]"]
do for [k = 1:3] {
    j = k == 1 ? 2 : 3
    set xrange [k == 3 ? 0 : -3.1:k == 3 ? 12.5 : 3.1]
    set xlabel what[k]
    set ylabel plane[j - 1]." rate at the exit [mrad/s]"
    if (k == 1) { set key default bottom right samplen 2 } else { unset key }
    plot out."/".file[k].".txt" using 1:j with linespoints pt 7 ps 0.4 lc 1 title name[1], \
         out."/".file[k]."-stiff.txt" using 1:j with linespoints pt 7 ps 0.4 lc 3 title name[3], \
         out."/rigid-".file[k].".txt" using 1:j with lines lc "black" dt 2 title "closed form"
}
unset multiplot

# ---- drag of the guide ----
set output "docs/figures/rail-drag.svg"
set terminal svg size 900,380
set multiplot layout 1,2
set xrange [0.4:5]
set yrange [0:320]
set key default top right samplen 2
set xlabel "rear shoe's place on the rail [m]"
set ylabel "force against sliding [N]"
set arrow from 3.4, graph 0 to 3.4, graph 1 nohead lc "gray"
array taken[3] = ["none", "travel", "speed"]
array meant[3] = ["friction alone", "drag over the travel", "drag over the speed"]
plot for [k = 1:3] out."/drag-".taken[k].".txt" using 1:2 with lines lw 1.5 lc k title meant[k]
unset arrow
set xrange [0:200]
set yrange [*:*]
set xlabel "drag of the guide, constant [N]"
set ylabel "pitch rate at the exit [mrad/s]"
plot out."/drag.txt" using 1:2 with linespoints pt 7 ps 0.4 lc 1 title name[1], \
     out."/drag-stiff.txt" using 1:2 with linespoints pt 7 ps 0.4 lc 3 title name[3], \
     out."/rigid-drag.txt" using 1:2 with lines lc "black" dt 2 title "closed form"
unset multiplot

# ---- wind and jet on the guide ----
set output "docs/figures/rail-loads.svg"
set terminal svg size 1300,420
set multiplot layout 1,3
set datafile separator ","
set xrange [0:0.8]
set xlabel "time from ignition [s]"
set ylabel "bending moment about y at 2.21 m [N m]"
set key default bottom right samplen 2
array air[3] = ["free", "wind", "gusts"]
array blown[3] = ["9 m/s on the rocket alone", "and on the rail", "and with gusts"]
plot for [k = 1:3] out."/load-".air[k]."/history.csv" every 5 using "t [s]":"station.1.bending_y [N.m]" with lines lw 1.5 lc k title blown[k]
set ylabel "axial force at 2.21 m [N]"
set key default bottom right samplen 2
plot out."/load-calm/history.csv" every 5 using "t [s]":"station.1.axial [N]" with lines lw 1.5 lc 1 title "no jet on the rail", \
     out."/load-jet/history.csv" every 5 using "t [s]":"station.1.axial [N]" with lines lw 1.5 lc 2 title "jet on the rail"
set ylabel "force on the lower support [kN]"
set key default top right samplen 2
plot out."/load-flat/history.csv" every 5 using "t [s]":(column("support.1.force_x [N]")/1e3) with lines lw 1.5 lc 2 title "flat deflector, along", \
     out."/load-side/history.csv" every 5 using "t [s]":(column("support.1.force_x [N]")/1e3) with lines lw 1.5 lc 3 title "45 deg to the side, along", \
     out."/load-side/history.csv" every 5 using "t [s]":(column("support.1.force_z [N]")/1e3) with lines lw 1.5 dt 2 lc 3 title "across"
unset multiplot
