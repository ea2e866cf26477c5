# Error against time, from the curves that `efficiency --figures DIR` leaves in DIR:
#   gnuplot -e "folder='DIR'; scene='paper-12150'" bench/efficiency/figures.gp
# A block for every method; columns: seconds, relative RMS, lines.

if (!exists("folder")) folder = "."
if (!exists("scene")) scene = "paper-12150"
file = folder."/".scene.".dat"
set terminal pngcairo size 900,620 font "sans,11"
set output folder."/".scene.".png"
set title scene font ",13"
set logscale xy
set grid lc rgb "#dddddd"
set border 3
set tics nomirror out
set xlabel "seconds"
set ylabel "relative RMS error, %"
set key outside right samplen 2
stats file using 1 nooutput
plot for [k=0:STATS_blocks-1] file index k using 1:(100*$2) with linespoints \
    lw 1.5 pt (k < 8 ? 7 : 6) ps 0.8 lc (k % 8 + 1) title columnheader(1)
