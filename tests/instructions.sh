#!/bin/sh
# instructions.sh - instructions of a frame by the scalar build, counted by callgrind: what a handheld would have to do. They hang
# on neither load nor clock, so that a small band catches what a timing never would. tests/instructions.txt has what they were.
#     sh tests/instructions.sh [update]
. tests/shell.sh
band=2 # percent
list=tests/instructions.txt
compiler=$($CC --version 2>/dev/null | head -n 1)
mkdir -p "$B"

# count FUNCTION SCENE SIZE PRESET MAP METHOD: of one frame, inside the function.
count() {
    valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect="$1" "$B/bench-frame" "$2" "$3" "$4" "$5" 1 scalar "$6" \
        2>&1 | sed -n 's/^==[0-9]*== Collected : \([0-9]*\)$/\1/p'
}

have valgrind || { skip 'instructions: no valgrind'; total; exit; }
quiet 'instructions: builds' "$MAKE" -s -j2 B="$B" CC="$CC" CFLAGS="$CFLAGS" "$B/bench-frame" || { total; exit; }
if [ "${1-}" = update ]; then
    { sed -n '/^#/p' $list; echo "compiler $compiler"; } >"$B/instructions.txt"
elif [ "$(sed -n 's/^compiler //p' $list)" != "$compiler" ]; then
    skip "instructions: counted for another compiler than $compiler"
    total
    exit
fi
while read -r scene size preset map was; do
    case $scene in '#'* | compiler | '') continue ;; esac
    now=$(count tyn_render "$scene" "$size" "$preset" "$map" epipolar)
    off=$(awk -v a="${now:-0}" -v b="$was" 'BEGIN { printf "%.1f", b ? 100 * (a / b - 1) : 100 }')
    printf '   %-10s %8s %-9s %4s %12s instructions, %s %%\n' "$scene" "$size" "$preset" "$map" "$now" "$off"
    if [ "${1-}" = update ]; then
        echo "$scene $size $preset $map $now" >>"$B/instructions.txt"
    elif awk -v o="$off" -v band=$band 'BEGIN { exit !(o <= band && o >= -band) }'; then
        pass
    else
        fail "instructions of $scene $size: $now, they were $was" "if that is meant: sh tests/instructions.sh update"
    fi
done <$list
[ "${1-}" != update ] || mv "$B/instructions.txt" $list

# What a pixel of the prefiltered method costs beside its rows does not hang on what casts the shadows. It does on the light and
# the air, by 13 %: with the sun in view, or air of one extinction, the channels share reference rays.
for sun in on off; do
    simple=$(count tyni_pixel_band simple-$sun 320x240 quality 1024 prefiltered)
    leafy=$(count tyni_pixel_band leafy-$sun 320x240 quality 1024 prefiltered)
    off=$(awk -v a="${leafy:-0}" -v b="${simple:-0}" 'BEGIN { printf "%.2f", (b > 0) ? 100 * (a / b - 1) : 100 }')
    echo "   prefiltered, sun $sun: $((simple / 76800)) instructions a pixel, leafy $off % more"
    if awk -v o="$off" -v band=$band 'BEGIN { exit !(o <= band && o >= -band) }'; then
        pass
    else
        fail "instructions of a prefiltered pixel, sun $sun: simple $simple, leafy $leafy"
    fi
done
total
