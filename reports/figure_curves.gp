# Figures 7 and 8 of the paper. In: data_off, data_on, files with a block for each of the four
# quantities (view mean least most), "" where there is none; label_off, label_on; views_off, views_on,
# positions_most, area_most, heading, terminal_options, out.
eval terminal_options
set output out
columns = (data_off ne "") + (data_on ne "")
set multiplot layout 4,columns columnsfirst title heading font ",14" noenhanced margins (columns == 1 ? 0.14 : 0.09),0.975,0.055,0.925 spacing 0.09,0.055
set style fill solid 0.25 noborder
set grid ytics lc rgb "#e0e0e0"
set border 3 lc rgb "#606060"
set tics nomirror out scale 0.5
set key top right samplen 2 spacing 1 font ",9"
array name[4] = ["positions tried", "fitness of the view chosen", "mean quality", "Occupied area, m^2"]
array low[4] = [0, 0, 0.6, 0]
array high[4] = [positions_most, 2, 1, area_most]
do for [column in "off on"] {
  data = column eq "off" ? data_off : data_on
  if (data ne "") {
    views = column eq "off" ? views_off : views_on
    set xrange [0:views]
    do for [i=1:4] {
      set yrange [low[i]:high[i]]
      if (i == 1) { set label 1 (column eq "off" ? label_off : label_on) at graph 0,1.16 font ",11" } else { unset label 1 }
      if (i == 4) { set xlabel "view" offset 0,0.6 } else { unset xlabel }
      set ylabel name[i] offset 1.2,0 font ",10"
      plot data index (i-1) using 1:3:4 with filledcurves lc rgb "#2b5d9b" notitle, \
           data index (i-1) using 1:2 with lines lc rgb "#2b5d9b" lw 1.4 notitle
    }
  }
}
unset multiplot
