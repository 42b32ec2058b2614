# Draws docs/figures/sea.svg from a run of examples/ship-sea.yaml with a lead-in of two minutes; docs/sea.md says how.
set terminal svg size 900,560 font "sans,13" background "white"
set output "docs/figures/sea.svg"
set datafile separator ","
set grid
set xrange [-120:0]
history = out."/history.csv"
degrees = 57.29577951308232
set lmargin 9
set multiplot layout 2,1
set ylabel "height of the tube's rear end [m]"
plot history using "t [s]":"base.y [m]" with lines lc 1 notitle
set xlabel "time before the ignition [s]"
set ylabel "attitude of the deck [deg]"
set key top left horizontal
plot history using "t [s]":(degrees*column("base.roll [rad]")) with lines lc 2 title "roll", \
     history using "t [s]":(degrees*column("base.pitch [rad]")) with lines lc 4 title "pitch", \
     history using "t [s]":(degrees*column("base.yaw [rad]")) with lines lc 7 title "yaw"
unset multiplot
