#!/bin/sh
# proofs.sh - the rules of the house that a compiler does not know: what the library calls, keeps, includes and computes with.
. tests/shell.sh

# ---- the lists ----

# All that libtyndall.a may ask of the outside.
symbols='memcmp memcpy memmove memset sqrtf floorf ceilf'
# All that src/ may include in angle brackets; intrinsics only in lanes/.
system_headers='float.h stddef.h stdint.h string.h math.h'
intrinsics='emmintrin.h immintrin.h arm_neon.h wasm_simd128.h'
# The rooms in the order in which data flows: each may include those before it.
order='base num vec arena check lanes config door jobs slide view art fit helpers cascade rectify medium raster slice border course row tree sweep sample line
    meter walk ray query columns knot fourier lookup prefilter entry gather composite pass debug trace chart run unwarp picture shade pixel quads stray quad frame tyndall'

work=$B/proofs
sources=$(ls src/*.c src/*/*.c 2>/dev/null)
headers=$(ls src/*.h src/*/*.h 2>/dev/null)
rm -rf "$work"
mkdir -p "$work"

# ---- what it calls and keeps ----

allowed=$(echo "$symbols" | tr ' ' '\n')
nm "$B/libtyndall.a" >"$work/nm" 2>/dev/null
awk 'NF == 3 && $2 ~ /[A-TV-Z]/ { print $3 }' "$work/nm" | sort -u >"$work/defined"
awk 'NF == 2 && $1 == "U" { print $2 }' "$work/nm" | sort -u >"$work/undefined"
{ cat "$work/defined"; echo "$allowed"; echo _GLOBAL_OFFSET_TABLE_; } | sort -u >"$work/known"
[ -s "$work/defined" ] || fail 'nm shows no symbols of the library'
empty 'the library calls only what is on the list' "$(comm -23 "$work/undefined" "$work/known")"
empty 'no writable globals (data, bss, common)' "$(awk 'NF == 3 && $2 ~ /[BbCDdGgSs]/' "$work/nm")"
empty 'data and bss are 0' "$(size "$B/libtyndall.a" | awk 'NR > 1 && ($2 != 0 || $3 != 0)')"
empty 'public names start with tyn_, internal ones with tyni_' "$(grep -v '^tyni\{0,1\}_' "$work/defined")"

# Either level alone takes nothing of the other with it.
cat >"$work/post.c" <<'END'
#include "tyndall.h"
int main(void)
{
    size_t bytes = 0;
    tyn_context *context;
    return tyn_measure(NULL, &bytes) + tyn_init(&context, NULL, NULL, 0) + tyn_render(NULL, NULL) + tyn_encode(NULL, NULL, NULL);
}
END
cat >"$work/raster.c" <<'END'
#include "tyndall.h"
int main(void)
{
    size_t bytes = 0;
    tyn_raster *raster;
    return tyn_raster_measure(NULL, &bytes) + tyn_raster_init(&raster, NULL, NULL, 0) + tyn_raster_surface(NULL, NULL) +
           tyn_raster_shadow(NULL, NULL, NULL, NULL, 0, NULL, NULL, NULL, NULL) + tyn_shadow_fit(NULL, NULL, NULL, NULL);
}
END
level() { # NAME SYMBOLS
    # shellcheck disable=SC2086
    if quiet "$1.c links alone" $CC $CFLAGS -std=c99 -Iinclude -o "$work/$1" "$work/$1.c" "$B/libtyndall.a" -lm; then
        empty "$1.c links nothing of the other level" "$(nm "$work/$1" | grep -E "$2")"
    fi
}
level post 'tyni?_raster'
level raster 'tyn_render|tyni_(frame|pixel|unwarp|picture|quads|stray|quad|trace|chart|pass|slice|border|row|tree|sweep|sample|ray|walk|columns|fourier|prefilter|gather|composite)_'

# ---- what it includes ----

# shellcheck disable=SC2086
empty 'files include their own header, base.h, and rooms above them' "$(awk -v order="$(echo $order)" \
    -v system_headers=" $system_headers " -v intrinsics=" $intrinsics " '
function room_of(path) {
    path = substr(path, 5)
    if (sub(/\/.*/, "", path)) return path
    sub(/\..*/, "", path)
    sub(/_kernel$/, "", path)
    return path
}
function resolve(name, from) {
    sub(/[^\/]*$/, "", from)
    from = from name
    sub(/[a-z0-9_]*\/\.\.\//, "", from)
    return from in known ? from : "src/" name
}
function base(path) { sub(/.*\//, "", path); return path }
function includes_base(file) { return index(list[file], " src/base.h ") }
function source(file, room,    header) {
    header = file
    sub(/c$/, "h", header)
    if (header in known && first[file] != base(header)) print file ": its own header is not the first include"
    # A file of a room with a folder has the header of the room, and base.h from that.
    if (!includes_base(file) && !includes_base("src/" room "/" room ".h")) print file ": does not include base.h"
}
BEGIN {
    n = split(order, rooms, " ")
    for (i = 1; i <= n; i++) rank[rooms[i]] = i
    for (i = 1; i < ARGC; i++) { known[ARGV[i]] = 1; list[ARGV[i]] = " " }
}
/^#include/ && !(FILENAME in first) { split($0, part, /[<>"]/); first[FILENAME] = base(part[2]) }
/^[ \t]*#[ \t]*include[ \t]*"/ || /^#define TYNI_KERNEL "/ {
    split($0, part, "\"")
    if (part[2] != "tyndall.h") list[FILENAME] = list[FILENAME] resolve(part[2], FILENAME) " "
}
/^[ \t]*#[ \t]*include[ \t]*</ {
    split($0, part, /[<>]/)
    if (!index(system_headers, " " part[2] " ") && !(FILENAME ~ /^src\/lanes\// && index(intrinsics, " " part[2] " ")))
        print FILENAME " includes <" part[2] ">"
}
END {
    for (f = 1; f < ARGC; f++) {
        file = ARGV[f]
        own = room_of(file)
        if (!(own in rank)) print file ": no room of this name in the order of flow (tests/proofs.sh)"
        if (file ~ /c$/) source(file, own)
        n = split(list[file], path, " ")
        for (i = 1; i <= n; i++) {
            room = room_of(path[i])
            if (rank[room] > rank[own]) print file " includes " path[i] ", which comes after it"
            if (room == "raster" && own != "raster") print file " includes " path[i] ": the levels do not know each other"
            if (room == "frame" && own != "frame" && own != "tyndall") print file " includes " path[i]
        }
    }
}' $sources $headers)"

# ---- what it computes with ----
# (Warnings tell of a VLA and of double constants: the Makefile's, and those of proofs_calls.sh.)

# Of the code without comments and strings.
# shellcheck disable=SC2086
empty 'no double, no heap, no output in the sources' "$(awk '
FNR == 1 { inside = 0 }
{
    gsub(/"[^"]*"/, "\"\"")
    out = ""
    while (length($0)) {
        if (inside) { i = index($0, "*/"); if (!i) break; $0 = substr($0, i + 2); inside = 0; continue }
        i = index($0, "/*")
        if (!i) { out = out $0; break }
        out = out substr($0, 1, i - 1); $0 = substr($0, i + 2); inside = 1
    }
    if (out ~ /(^|[^A-Za-z_0-9])(double|malloc|calloc|realloc|free|alloca|printf|pthread_[a-z]*)([^A-Za-z_0-9]|$)/)
        print FILENAME ":" FNR ":" out
}' $sources $headers include/tyndall.h)"

case $(uname -m) in
x86_64 | i?86)
    empty 'no double arithmetic in the machine code' "$(objdump -d "$B/libtyndall.a" |
        grep -E '[[:space:]]v?(cvt[a-z0-9]*sd[a-z0-9]*|cvt[a-z0-9]*pd[a-z0-9]*|(add|sub|mul|div|sqrt)[sp]d)[[:space:]]' | head -n 5)"
    ;;
*) skip 'double arithmetic is looked for in x86 code only' ;;
esac

# ---- the header alone ----

echo '#include "tyndall.h"' >"$work/header.c"
cp "$work/header.c" "$work/header.cc"
strict='-pedantic -Wall -Wextra -Wconversion -Wshadow -Werror -Iinclude -fsyntax-only'
for std in c99 c11; do
    # shellcheck disable=SC2086
    quiet "the header as $std" $CC -std=$std $strict "$work/header.c"
done
cxx=
for try in "${CXX:-}" g++ clang++ c++; do
    if [ -n "$try" ] && have "$try"; then
        cxx=$try
        break
    fi
done
if [ -n "$cxx" ]; then
    for std in c++98 c++17; do
        # shellcheck disable=SC2086
        quiet "the header as $std" "$cxx" -std=$std $strict "$work/header.cc"
    done
else
    skip 'no C++ compiler for the header as C++98 and C++17'
fi

total
