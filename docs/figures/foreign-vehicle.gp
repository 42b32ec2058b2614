# Draws foreign-vehicle.svg from the histories of two runs, as docs/foreign-vehicle.md says.
set terminal svg size 1000,700 font "sans,13" background "white"
set output "docs/figures/foreign-vehicle.svg"
set datafile separator ","
own = "out/own-vehicle/history.csv"
its = "out/mujoco/history.csv"
columns = int(system("head -n 1 ".own." | tr , '\n' | wc -l"))
both = "< paste -d, ".own." ".its
array name[6] = ["x", "y", "z", "yaw", "pitch", "roll"] # columns 3 to 8
set multiplot layout 2,2 columnsfirst margins 0.08,0.98,0.09,0.94 spacing 0.1,0.11
set grid
set xrange [-20:160]
ms(c) = 1e3 * column(c)
since(c) = (first = ($0 == 0 ? column(c) : first), 1e3 * (column(c) - first))
do for [k = 0:1] {
    set title k == 0 ? "undeformed tube's rear end [mm]" : "vehicle [mrad]"
    unset xlabel
    if (k == 0) { set key left top Left reverse samplen 1.5 } else { set key left bottom Left reverse samplen 1.5 }
    plot for [i = 1:3] own every 4::1 using (ms(1)):(since(2 + 3 * k + i)) with lines lw 2 lc i title name[3 * k + i], \
        for [i = 1:3] its every 40::1 using (ms(1)):(since(2 + 3 * k + i)) with points pt 6 ps 0.6 lc i notitle, \
        keyentry with lines lw 2 lc "black" title "our vehicle", keyentry with points pt 6 ps 0.6 lc "black" title "MuJoCo's"
    set title k == 0 ? "difference [10^{-6} mm]" : "difference [10^{-6} mrad]"
    if (k == 0) { set key left bottom } else { set key left top }
    set xlabel "time after ignition [ms]"
    plot for [i = 1:3] both every 4::1 using (ms(1)):(1e9 * (column(columns + 2 + 3 * k + i) - column(2 + 3 * k + i))) \
        with lines lc i title name[3 * k + i]
}
unset multiplot
