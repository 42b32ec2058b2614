# Draws stabiliser-study.svg from the ratios in `out`; scripts/stabiliser-study makes them.
set terminal svg size 1000,1000 font "sans,13" background "white"
set output "docs/figures/stabiliser-study.svg"
set multiplot
set grid x
set logscale x
set xrange [0.55:35]
set yrange [20.6:0.4]
set xtics (0.7, 1, 1.5, 2, 3, 5, 10, 20)
set ytics scale 0
set arrow from 1,0.4 to 1,20.6 nohead lc "black" back
do for [i = 1:4] { set arrow from 0.55,4 * i + 0.5 to 35,4 * i + 0.5 nohead lc "gray" dt 2 back }
array file[3] = ["rough", "slewing", "slewed"]
array what[3] = ["class C, 30 km/h", "class A, 15 km/h, in a slew", "0.2 s behind the slews"]
array first[2] = [2, 14]
array name[4] = ["pitch rate", "yaw rate", "downrange", "drift"]
array where[2] = ["deviation at the exit", "deviation of the impact"]
do for [k = 3:1:-1] { # from the right: white names lie below the page to their left
    do for [j = 1:2] {
        set lmargin at screen 0.17 + 0.275 * (k - 1)
        set rmargin at screen 0.43 + 0.275 * (k - 1)
        set tmargin at screen 0.97 - 0.5 * (j - 1)
        set bmargin at screen 0.55 - 0.5 * (j - 1)
        set title what[k] offset 0,-0.5
        set xlabel where[j].", ratio" offset 0,0.5
        set ytics textcolor rgb (k == 1 ? "black" : "white")
        if (k == 3) { set key bottom right samplen 1 } else { unset key }
        text = out."/".file[k].".txt"
        ratio(i) = first[j] + 3 * i
        plot text using (1):($0 + 1):ytic(1) with dots lc "white" notitle, \
            for [i = 0:1] "" using (column(ratio(i))):($0 + 0.85 + 0.3 * i):(column(ratio(i) + 1)):(column(ratio(i) + 2)) \
            with xerrorbars lw 2 pt 7 ps 0.4 lc 1 + i title name[2 * j - 1 + i]
    }
}
unset multiplot
