# stability.gp - plots of the tables that bench-stability wrote: gnuplot -e "folder='build/stability'" tests/bench/stability.gp
set datafile separator ','
set datafile missing 'NaN'
files(part) = system(sprintf("cd %s && for f in %s-*.csv; do test -s $f && echo ${f%%.csv}; done", folder, part))
at(name) = sprintf("%s/%s.csv", folder, name)
set key autotitle columnhead
set grid

# The camera by quarter pixels: change of a frame as a part of the march's.
list = files('camera')
if (words(list) > 0) {
    set terminal png size 1800,1200
    set output folder.'/camera.png'
    set multiplot layout (words(list) + 3) / 4,4
    set yrange [0.9:1.6]
    do for [name in list] {
        set title name noenhanced
        plot for [i=2:6] at(name) using 1:i with lines, 1.1 with lines dashtype 2 linecolor 'black' title 'goal'
    }
    unset multiplot
}

# A light on paths, one after the other: relative L1 in percent above, the largest difference of 8 bits below.
do for [name in files('light')] {
    set terminal png size 1600,1000
    set output folder.'/'.name.'.png'
    set multiplot layout 2,1 title name noenhanced
    set autoscale
    unset title
    set xtics 16
    set logscale y
    set ylabel 'relative L1, %'
    plot for [i=2:6] at(name) using 1:i with lines
    set ylabel 'of 255'
    plot for [i=9:13] at(name) using 1:(column(i) + 0.5) with lines
    unset logscale
    unset ylabel
    set xtics autofreq
    unset multiplot
}

# A light everywhere: the screen is the frame in the middle. L1 above, 8 bits below; grey: the light is below the ground.
do for [name in files('map')] {
    set terminal png size 2000,700
    set output folder.'/'.name.'.png'
    set multiplot layout 2,5 title name noenhanced
    set autoscale
    set xrange [-1.07:2.07]
    set yrange [2.1:-1.1]
    set object 1 rectangle from graph 0,0 to graph 1,1 fillcolor 'grey' behind
    set object 2 rectangle from 0,0 to 1,1 fillstyle empty border linecolor 'white' front
    set palette rgbformulae 33,13,10
    unset key
    do for [i in '3 4 5 6 7 9 10 11 12 13'] {
        set title sprintf('%s, %s', system(sprintf("head -n 1 %s | cut -d, -f%s", at(name), i)), i > 7 ? '/255' : '%')
        plot at(name) using 1:2:int(i) with points pointtype 5 pointsize 2.8 palette
    }
    unset object 1
    unset object 2
    set key
    unset multiplot
}
