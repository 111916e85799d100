# Figure 6 of the paper. In: points (x y z), lines (x y z dx dy dz) of the positions tried, best_file
# the one gone to, box (the workspace's edges), heading, terminal_options, out.
eval terminal_options
set output out
set multiplot layout 1,2 title heading font ",14" noenhanced
set view equal xyz
set view 62,28,1.48
set xyplane relative 0
set border 0
unset tics
unset key
set title "points of the range image, where the search begins" font ",11"
splot box with lines lc rgb "#b0b0b0" lw 0.6, \
      points with points pt 7 ps 0.18 lc rgb "#2b5d9b", \
      from_file with points pt 6 ps 1.2 lw 1.6 lc rgb "#c03020"
set title "positions tried, a line along the best direction, its length the fitness" font ",11"
splot box with lines lc rgb "#b0b0b0" lw 0.6, \
      lines using 1:2:3:4:5:6 with vectors nohead lc rgb "#303030" lw 0.9, \
      lines using 1:2:3 with points pt 7 ps 0.45 lc rgb "#2b5d9b", \
      best_file using 1:2:3:4:5:6 with vectors head size 0.06,20 filled lc rgb "#c03020" lw 2.2, \
      from_file with points pt 6 ps 1.2 lw 1.6 lc rgb "#c03020"
unset multiplot
