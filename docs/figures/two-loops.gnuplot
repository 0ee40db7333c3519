# The figure of README.md. In a folder with mpmbench in PATH:
#   mpmbench run wood-berry --experiments 40 --methods mpmbench --store all -o loops.h5
#   for i in 22 31; do mpmbench export loops.h5 --table loops --index $i -o loop-$i.csv; done
#   gnuplot two-loops.gnuplot | tr "\n" " " > two-loops.svg
# What is said below the panels stands in `mpmbench export loops.h5 --table mpmbench`.
set terminal svg size 900,330 font 'Helvetica,13' background '#ffffff' linewidth 1
set datafile separator ','
set multiplot layout 1,2 margins 0.075,0.985,0.27,0.78 spacing 0.08
set key off
set border 3 lc rgb '#5f6b7a'
set tics nomirror scale 0.5 textcolor rgb '#3c4654'
set grid lc rgb '#e6e8eb' lt 1
set xlabel 'time (min)' offset 0,0.5 textcolor rgb '#3c4654'
set xrange [0:400]
set label 1 'what the plant does (measured)' at screen 0.12,0.955 textcolor rgb '#000000'
set arrow 1 from screen 0.075,0.957 to screen 0.112,0.957 nohead lc rgb '#000000' lw 1.5
set label 2 'what the controller''s model says' at screen 0.46,0.955 textcolor rgb '#0072b2'
set arrow 2 from screen 0.415,0.957 to screen 0.452,0.957 nohead lc rgb '#56b4e9' lw 4
set title 'Truth: the gain from steam to xB is 0.68 of the model''s' offset 0,-0.4
set label 3 'Verdict: model wrong, gain of xB/S x 0.682 (0.682 to 0.683)' at graph 0.5,-0.36 center textcolor rgb '#b34700' font ',14'
set ylabel 'xB, bottom product (wt%)' offset 1.5,0 textcolor rgb '#3c4654'
plot 'loop-22.csv' using (column('time')):(column('y_sim.xB')) with lines lw 4 lc rgb '#56b4e9', \
     '' using (column('time')):(column('y.xB')) with lines lw 1.2 lc rgb '#000000'
unset label 1; unset label 2; unset arrow 1; unset arrow 2; unset ylabel
set title 'Truth: the model is right, a disturbance acts on xB' offset 0,-0.4
set label 3 'Verdict: unmeasured disturbance on xB' at graph 0.5,-0.36 center textcolor rgb '#b34700' font ',14'
plot 'loop-31.csv' using (column('time')):(column('y_sim.xB')) with lines lw 4 lc rgb '#56b4e9', \
     '' using (column('time')):(column('y.xB')) with lines lw 1.2 lc rgb '#000000'
