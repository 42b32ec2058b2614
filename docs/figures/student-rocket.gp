# Draws student-rocket.svg from the root of the tree, after
#   launchdyn run examples/student-rocket/student-rocket.yaml --csv --out out/student-rocket
if (!exists("data")) data = "out/student-rocket/flights.csv"
measured = "examples/student-rocket/measured.csv"
set datafile separator comma
set terminal svg size 900,420 font "sans,13" background "white"
set output "docs/figures/student-rocket.svg"
heading = 181 * pi / 180
east(x, z) = x * sin(heading) + z * cos(heading)
north(x, z) = x * cos(heading) - z * sin(heading)
set multiplot layout 1,2
set grid
set xlabel "time from ignition [s]"
set ylabel "height above the ground [m]"
set key top right samplen 2
plot measured using 1:2 with points pt 7 ps 0.35 lc 7 title "altimeter", \
     data using "t [s]":(column("altitude [m]") - 206) with lines lw 2 lc 1 title "launchdyn"
set xlabel "east [m]"
set ylabel "north [m]"
set size ratio -1
set xrange [*:*]
set key top left
plot data using (east(column("center.x [m]"), column("center.z [m]"))):(north(column("center.x [m]"), column("center.z [m]"))) \
         with lines lw 2 lc 1 title "over the ground", \
     data using (east(column("center.x [m]"), column("center.z [m]"))):(column("drag_area [m2]") > 0 ? north(column("center.x [m]"), column("center.z [m]")) : NaN) \
         with lines lw 2 lc 2 title "below parachutes"
unset multiplot
