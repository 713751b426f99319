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
    meter walk ray query columns knot fourier lookup prefilter entry gather composite pass debug trace chart shade pixel quad frame tyndall'

FLAGS="-std=c99 -pedantic -Wall -Wextra -Wconversion -Wdouble-promotion -Wshadow -Werror -ffp-contract=off -Iinclude -Isrc"
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
level raster 'tyn_render|tyni_(frame|pixel|quad|trace|chart|pass|slice|border|row|tree|sweep|sample|ray|walk|columns|fourier|prefilter|gather|composite)_'

# ---- what it includes ----

rank() { # of a file below src/
    room=${1#src/}
    case $room in
    */*) room=${room%%/*} ;;
    *) room=${room%.*} room=${room%_kernel} ;;
    esac
    rank=0
    for r in $order; do
        rank=$((rank + 1))
        [ "$r" = "$room" ] && return
    done
    rank=0
}

includes() { # of a file, resolved to src/...
    sed -n -e 's/^[ \t]*#[ \t]*include[ \t]*"\([^"]*\)".*/\1/p' -e 's/^#define TYNI_KERNEL "\([^"]*\)".*/\1/p' "$1" | while read -r name; do
        [ "$name" = tyndall.h ] && continue
        dir=${1%/*}
        path=$(echo "$dir/$name" | sed -e 's|[a-z0-9_]*/\.\./||')
        [ -f "$path" ] || path=src/$name
        echo "$path"
    done
}

complaints=
for file in $sources $headers; do
    rank "$file"
    own=$rank own_room=$room
    [ "$own" -gt 0 ] || complaints="$complaints$file: no room of this name in the order of flow (tests/proofs.sh)
"
    list=$(includes "$file")
    case $file in
    *.c)
        header=${file%.c}.h
        first=$(grep -m 1 '^#include' "$file" | sed 's/^#include [<"]\(.*\)[>"].*/\1/')
        if [ -f "$header" ] && [ "${first##*/}" != "${header##*/}" ]; then
            complaints="$complaints$file: its own header is not the first include
"
        fi
        # A file of a room with a folder has the room's header, and base.h from that.
        case $file in src/*/*) list="$list $(includes "src/$room/$room.h" 2>/dev/null)" ;; esac
        echo "$list" | tr ' ' '\n' | grep -qx 'src/base.h' || complaints="$complaints$file: does not include base.h
"
        ;;
    esac
    for path in $list; do
        rank "$path"
        if [ "$rank" -gt "$own" ]; then
            complaints="$complaints$file includes $path, which comes after it
"
        fi
        if [ "$room" = raster ] && [ "$own_room" != raster ]; then
            complaints="$complaints$file includes $path: the levels do not know each other
"
        fi
        if [ "$room" = frame ] && [ "$own_room" != frame ] && [ "$own_room" != tyndall ]; then
            complaints="$complaints$file includes $path
"
        fi
    done
    for name in $(sed -n 's/^[ \t]*#[ \t]*include[ \t]*<\([^>]*\)>.*/\1/p' "$file"); do
        case " $system_headers " in *" $name "*) continue ;; esac
        case "$file $intrinsics" in src/lanes/*" $name"*) continue ;; esac
        complaints="$complaints$file includes <$name>
"
    done
done
empty 'files include their own header, base.h, and rooms above them' "$complaints"

# ---- what it computes with ----

# The code without comments and strings.
bare() {
    sed -e 's/"[^"]*"/""/g' "$1" | awk '{
        out = ""
        while (length($0)) {
            if (inside) { i = index($0, "*/"); if (!i) { $0 = ""; break } $0 = substr($0, i + 2); inside = 0; continue }
            i = index($0, "/*")
            if (!i) { out = out $0; break }
            out = out substr($0, 1, i - 1); $0 = substr($0, i + 2); inside = 1
        }
        print out
    }'
}
found=
for file in $sources $headers include/tyndall.h; do
    lines=$(bare "$file" | grep -nwE 'double|long double|malloc|calloc|realloc|free|alloca|printf|pthread_[a-z]*' | sed "s|^|$file:|")
    [ -z "$lines" ] || found="$found$lines
"
done
empty 'no double, no heap, no output in the sources' "$found"

is_gcc=
case $($CC --version 2>/dev/null | head -n 1) in *[cC]lang*) ;; *) is_gcc=1 ;; esac
strict="-Wvla -Walloca -Wfloat-conversion"
[ -z "$is_gcc" ] || strict="$strict -Wunsuffixed-float-constants"
# shellcheck disable=SC2086
quiet 'no VLA, no alloca, no double constants' $CC $FLAGS -O2 $strict -fsyntax-only $sources
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
