# Figure 9 of the paper: pictures side by side. In: pictures and names (lists of count), columns, rows,
# heading, terminal_options, out.
eval terminal_options
set output out
set multiplot layout rows,columns title heading font (count == 1 ? ",11" : ",14") noenhanced margins 0.01,0.99,0.01,0.88 spacing 0.01,0.05
set size ratio -1
unset border
unset tics
unset key
set autoscale fix
do for [i=1:count] {
  set title word(names, i) noenhanced font ",11" offset 0,-0.6
  plot word(pictures, i) binary filetype=png with rgbimage
}
unset multiplot
