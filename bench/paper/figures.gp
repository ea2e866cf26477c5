# Figures 3 and 4 from the histograms that `paper --figures DIR` leaves in DIR:
#   gnuplot -e "folder='DIR'" bench/paper/figures.gp
# Columns: error, runs, runs expected of the fitted chi-square, runs expected of the theory's.

if (!exists("folder")) folder = "."
set terminal pngcairo size 1000,420 font "sans,11"
set style fill solid 0.35 border rgb "#446688"
set grid ytics lc rgb "#dddddd"
set border 3
set tics nomirror out
set ylabel "runs"
set yrange [0:*]
set xrange [0:*]
set offsets graph 0, 0, 0.06, 0
set key top right samplen 2

do for [figure in "3 4"] {
    set output folder."/figure".figure.".png"
    set multiplot layout 1,2
    lines = figure eq "3" ? "10000 100000" : "100000 1000000"
    patches = figure eq "3" ? 6 : 54
    do for [n in lines] {
        file = folder."/figure".figure."_".n.".dat"
        stats file using 1 nooutput
        unit = n eq "10000" ? 1e-5 : n eq "100000" && patches == 54 ? 1e-5 : 1e-6
        set title sprintf("%d patches, %s lines", patches, n) font ",12"
        set xlabel sprintf("quadratic error of a run, %.0e (W/m²)²", unit)
        set boxwidth (STATS_max - STATS_min) / (STATS_records - 1) / unit
        plot file using ($1/unit):2 with boxes lc rgb "#88aacc" title "runs", \
             file using ($1/unit):3 smooth csplines lw 2 lc rgb "#bb3322" title "fitted χ²", \
             file using ($1/unit):4 smooth csplines lw 2 dt 2 lc rgb "#222222" title "theory's χ²"
    }
    unset multiplot
}
