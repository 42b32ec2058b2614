# Draws stabilisers.svg from the runs in `out`; scripts/stabiliser-figures makes them.
set terminal svg size 900,900 font "sans,13" background "white"
set output "docs/figures/stabilisers.svg"
set datafile separator comma
set datafile columnheaders
set multiplot layout 3,2
set grid
set key top right samplen 2 spacing 0.9
set xlabel "time [s]"
file(name) = out."/".name."/history.csv"
set title "feedforward: much viscous friction"
set ylabel "pitch error [mrad]"
set xrange [-1.5:-0.5]
set yrange [-0.15:0.25]
plot file("drag") using (column("t [s]")):(1e3*column("elevation.error [rad]")) with lines title "0", \
    file("drag-cancelled") using (column("t [s]")):(1e3*column("elevation.error [rad]")) with lines title "0.05 = viscous/kd", \
    file("drag-overdone") using (column("t [s]")):(1e3*column("elevation.error [rad]")) with lines title "0.2"
set title "cascade: a ramp of 5 deg/s"
set xrange [-2.6:-1]
set yrange [-0.3:0.7]
plot file("ramp") using (column("t [s]")):(1e3*column("elevation.error [rad]")) with lines title "PID", \
    file("cascade") using (column("t [s]")):(1e3*column("elevation.error [rad]")) with lines title "cascade"
set title "bandwidth and slew: the ramp's first corner"
set ylabel "torque [kN m]"
set xrange [-2.52:-2.32]
set yrange [0:60]
plot file("ramp") using (column("t [s]")):(1e-3*column("elevation.torque [N.m]")) with lines title "at once", \
    file("lag") using (column("t [s]")):(1e-3*column("elevation.torque [N.m]")) with lines title "10 Hz", \
    file("slew") using (column("t [s]")):(1e-3*column("elevation.torque [N.m]")) with lines title "50 Hz, 1 MN m/s"
set title "sample and delay: the same corner"
plot file("ramp") using (column("t [s]")):(1e-3*column("elevation.torque [N.m]")) with lines title "continuous", \
    file("sampled") using (column("t [s]")):(1e-3*column("elevation.torque [N.m]")) with steps title "each 5 ms", \
    file("late") using (column("t [s]")):(1e-3*column("elevation.torque [N.m]")) with steps title "and 5 ms late"
set title "noise: 10 urad and 2 mrad/s each 1 ms"
set xrange [-1.15:-1]
set yrange [10:22]
plot file("noise") using (column("t [s]")):(1e-3*column("elevation.torque [N.m]")) with lines title "noise", \
    file("ramp") using (column("t [s]")):(1e-3*column("elevation.torque [N.m]")) with lines title "none"
set title "gear and backlash: azimuth"
set xrange [0:0.17]
set yrange [-25:35]
plot file("backlash") using (column("t [s]")):(1e-3*column("azimuth.torque [N.m]")) with lines title "0.3 mrad", \
    file("gear") using (column("t [s]")):(1e-3*column("azimuth.torque [N.m]")) with lines title "none"
unset multiplot
