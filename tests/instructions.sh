#!/bin/sh
# instructions.sh - instructions of a frame by the scalar build, counted by callgrind: what a handheld would have to do. They hang
# on neither load nor clock, so that a small band catches what a timing never would. tests/instructions.txt has what they were.
#     sh tests/instructions.sh [update]
. tests/shell.sh
band=2 # percent
list=tests/instructions.txt
compiler=$($CC --version 2>/dev/null | head -n 1)
mkdir -p "$B"

# count SCENE SIZE PRESET MAP: of one frame, without what sets it up.
count() {
    valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect=tyn_render "$B/bench-frame" "$1" "$2" "$3" "$4" 1 scalar \
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
    now=$(count "$scene" "$size" "$preset" "$map")
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
total
