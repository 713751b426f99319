#!/bin/sh
# sameness.sh - one picture on every machine: the hashes of tests/golden.txt and unit tests by gcc and clang, unoptimised to -O3,
# with vectors and in plain C, on machines of both byte orders and both sizes of pointers, most of them by qemu. One table.
#     sh tests/sameness.sh [MACHINE...]      two rows at a time; about 20 minutes on 2 cores. TYN_UNTIL: seconds since 1970 after
#                                            which no row begins
. tests/shell.sh
export B MAKE
work=$B/sameness
TYN_SHARED=/nowhere # the shared data are for the machine itself
export TYN_SHARED

# ---- what there is ----

all='x86-64 i386 AArch64 ARMv7 MIPS-BE PowerPC64-BE RISC-V-64 wasm32'

# Sets, of a machine: prefix of Debian's cross compilers and clang's target, flags, what runs its programs, its vectors.
# PowerPC has 64 bits as 32-bit glibc's cos needs an instruction that qemu-ppc lacks.
machine() {
    run='' flags='' clang_flags='' vectors='' vector_flags='' threads=-pthread link=-static
    case $1 in
    x86-64) prefix=x86_64-linux-gnu run=qemu-x86_64 vectors=sse2,avx2,avx512 ;;
    i386) prefix=i686-linux-gnu run=qemu-i386 flags='-msse2 -mfpmath=sse' vectors=sse2,avx2 ;;
    AArch64) prefix=aarch64-linux-gnu run=qemu-aarch64 vectors=neon ;;
    ARMv7) prefix=arm-linux-gnueabihf run=qemu-arm ;;
    MIPS-BE) prefix=mips-linux-gnu run=qemu-mips ;;
    PowerPC64-BE) prefix=powerpc64-linux-gnu run=qemu-ppc64 ;;
    RISC-V-64)
        prefix=riscv64-linux-gnu run=qemu-riscv64
        # clang 14 does not find this one's files by itself
        gcc_files=$(riscv64-linux-gnu-gcc -print-file-name=. 2>/dev/null)
        clang_flags="-idirafter /usr/$prefix/include -B$gcc_files -L$gcc_files -B/usr/$prefix/lib -L/usr/$prefix/lib"
        clang_flags="$clang_flags -fuse-ld=/usr/bin/$prefix-ld -Wno-unused-command-line-argument"
        ;;
    wasm32)
        prefix=wasm32-wasi run='node --no-warnings --experimental-wasi-unstable-preview1 tests/wasi.mjs' vectors=wasm
        vector_flags=-msimd128 threads=''
        link='-D_WASI_EMULATED_PROCESS_CLOCKS -lwasi-emulated-process-clocks -Wl,-z,stack-size=1048576'
        clang_flags=-Wno-unused-command-line-argument
        ;;
    *) echo "sameness.sh: no machine $1; there are: $all" >&2 && exit 1 ;;
    esac
    case $(uname -m):$1 in x86_64:x86-64 | x86_64:i386) run='' ;; esac
}

# Sets cc and ar, of the machine that was set.
compiler() {
    case $1 in
    gcc) cc=$prefix-gcc ar=$prefix-ar ;;
    clang) cc="clang --target=$prefix $clang_flags" ar=$prefix-ar ;;
    esac
    [ "$prefix" != wasm32-wasi ] || ar=llvm-ar
    cflags="$flags $link -Wno-error"
}

# Can it compile, link and run?
can() {
    # shellcheck disable=SC2086
    printf '#include <math.h>\nint main(int n, char **v) { return cos(n) > 1 || !v; }\n' >"$work/can.c" &&
        $cc $cflags -o "$work/can" "$work/can.c" -lm >/dev/null 2>&1 && $run "$work/can" >/dev/null 2>&1 && have "$ar"
}

# ---- the rows: MACHINE COMPILER FLAGS LANES ROOMS ----

# i386 runs all rooms, as make test does on x86-64. The others, which qemu makes 25 to 100 times slower, run what reads and writes
# files or packs bits, and one to three slow rooms each: accuracy, art, the doors, fourier, gather, oracle, path, rectify and workers
# are on x86 alone.
few=api,border,debug,edges,encode,golden,helpers,lanes,obj,pictures,pool,raster_door,raster_isa,raster_map,raster_slide,sample,scene
rooms() {
    case $1 in
    x86-64) echo $few,isa ;;
    i386) echo all ;;
    AArch64) echo $few,isa,query ;;
    ARMv7) echo $few,raster ;;
    MIPS-BE) echo $few,raster,ray,render ;;
    PowerPC64-BE) echo $few ;;
    RISC-V-64) echo $few,raster_light,raster_shadow,showcase ;;
    wasm32) echo golden,isa,lanes,query,raster,raster_isa,raster_map,ray,render,sample ;; # no files, no threads
    esac
}

# The single file as a user compiles it, with no flag that concerns rounding, where a * b + c can be fused.
single() { # MACHINE COMPILER
    case $1:$2 in
    x86-64:*) echo single,-O3,-march=native ;;
    ARMv7:*) echo single,-O2,-mfpu=neon-vfpv4 ;;
    AArch64:* | PowerPC64-BE:gcc | RISC-V-64:*) echo single,-O2 ;;
    esac
}

rows() { # MACHINE COMPILER
    lanes=${vectors:-scalar}
    case $1:$2 in
    *:gcc | wasm32:*) echo "$1 $2 -O2 $lanes $(rooms "$1")" ;;
    *) echo "$1 $2 -O2 $lanes golden,lanes${vectors:+,isa,raster_isa}" ;;
    esac
    # 32-bit x86 returns floats in x87 registers, which quieten signalling NaNs where nothing is inlined: no lanes.
    case $1 in
    i386) echo "$1 $2 -O0 $lanes golden,raster_isa" ;;
    *) echo "$1 $2 -O0 $lanes golden,lanes${vectors:+,raster_isa}" ;;
    esac
    echo "$1 $2 -O3 $lanes golden,lanes${vectors:+,raster_isa}"
    if [ "$vectors" ]; then
        echo "$1 $2 -O2 plain golden,lanes"
    fi
    alone=$(single "$1" "$2")
    if [ "$alone" ]; then
        echo "$1 $2 $alone $lanes golden"
    fi
}

# ---- one row, by xargs ----

# The tool comes along where the rooms of files are.
build_row() { # FLAGS LANES ROOMS
    rooms=$(echo "$3" | tr , ' ')
    case $2 in
    plain) level="$1 -DTYN_PLAIN_C" ;;
    *) level="$1 $vector_flags" ;;
    esac
    case $3 in
    all) set -- "$build/tyndall" ;;
    *pictures*) set -- "$build/tyndall" ROOMS="$rooms" ;;
    *) set -- PORT_SRC= ROOMS="$rooms" ;;
    esac
    "$MAKE" -s -j1 B="$build" CC="$cc" AR="$ar" CFLAGS="$level $cflags" THREADS="$threads" "$build/tests" "$@"
}

build_single() { # FLAGS
    mkdir -p "$build"
    echo 'ROOM(golden)' >"$build/rooms.h"
    # shellcheck disable=SC2046,SC2086,SC2010
    $cc $flags $(echo "${1#single}" | tr , ' ') -w -c -o "$build/single.o" "$work/single/tyndall.c" &&
        $cc $cflags -std=c99 -D_POSIX_C_SOURCE=200809L -O1 -w -Iinclude -Isrc -I"$build" -o "$build/tests" tests/test_golden.c \
            $(ls tests/*.c | grep -v 'tests/\(test\|fuzz\)_') "$build/single.o" $threads -lm
}

# Files that the tool writes and reads, as checksums.
tool_files() {
    out=$build/files
    mkdir -p "$out"
    cat >"$out/scene" <<'END'
tyndall-scene 1
image 96 64
camera position 0.3 2 8 target 0 1.1 0 fov_y 50 near 0.1 far 60
background 0.2 0.3 0.5
ambient 0.2 0.2 0.2
medium scatter 0.03 0.03 0.04 phase hg 0.5
light directional direction -0.4 -1 -0.35 irradiance 3 3 2
light spot position 3 4 2 target 0.1 0 0.3 angle 61 intensity 50 80 90
quad a -20 0 20 b 20 0 20 c -20 0 -20 albedo 0.5 0.5 0.5
box min -1 0 -1 max 1 3 1 albedo 0.6 0.5 0.4
END
    # shellcheck disable=SC2086
    $run "$build/tyndall" render "$out/scene" -o "$out/a.pfm" --scatter "$out/as.pfm" --frame "$out/F" &&
        $run "$build/tyndall" render "$out/scene" -o "$out/a.png" &&
        $run "$build/tyndall" post "$out/F.frame" -o "$out/b.ppm" && (cd "$out" && cksum ./*)
}

# Of what ran below the shell that wrote `times`: clocks would measure what else the machine does.
cpu_seconds() {
    awk 'NR == 2 { split($1 "s" $2, t, /[ms]+/); printf "%d", t[1] * 60 + t[2] + t[3] * 60 + t[4] + 0.5 }' "$row.times"
}

# Leaves the row's line of the table, NUMBER, and what was said, NUMBER.log.
one_row() { # NUMBER MACHINE COMPILER FLAGS LANES ROOMS
    row=$work/rows/$1
    if [ "${TYN_UNTIL:-0}" -gt 0 ] && [ "$(date +%s)" -gt "$TYN_UNTIL" ]; then
        echo late >"$row"
        return
    fi
    machine "$2"
    compiler "$3"
    build=$work/$2-$3$4-$5
    case $4 in
    single*) build_single "$4" ;;
    *) build_row "$4" "$5" "$6" ;;
    esac >"$row.log" 2>&1 || echo 'does not build' >>"$row.log"
    times >"$row.times"
    built=$(cpu_seconds)
    # shellcheck disable=SC2086
    if [ -x "$build/tests" ]; then TYN_EMULATED=${run:+1} $run "$build/tests" >>"$row.log" 2>&1; fi
    if [ -x "$build/tyndall" ]; then tool_files >"$work/files/$2" 2>&1; fi
    times >"$row.times"
    all=$(cpu_seconds)
    awk -v head="$2 $3 $4 $5" -v built="$built" -v all="$all" '
        $1 == "golden" && $3 == "passed," { golden = $2 }
        { last = $0 }
        END {
            split(last, n, " ")
            if (last !~ /^[0-9]+ passed, [0-9]+ failed$/) { n[1] = 0; n[3] = "none-ran" }
            print head, golden + 0, n[1], n[3], built, all - built
        }' "$row.log" >"$row"
    rm -rf "$build"
}

if [ "${1-}" = --row ]; then
    shift
    one_row "$@"
    exit
fi

# ---- all rows, two at a time ----

rm -rf "$work"
mkdir -p "$work/rows" "$work/files"
quiet 'make single' "$MAKE" -s B="$work" single
[ $# -gt 0 ] || eval "set -- $all"
for name in "$@"; do
    for with in gcc clang; do
        machine "$name"
        compiler $with
        if can; then
            rows "$name" $with
        elif [ "$name $with" != 'wasm32 gcc' ]; then # there is none
            skip "$name by $with: it does not compile and run here ($cc $cflags)" >&2
        fi
    done
done | awk '{ print NR, $0 }' >"$work/list"
if [ -s "$work/list" ]; then
    xargs -P 2 -L 1 sh tests/sameness.sh --row <"$work/list"
fi

pictures=$(grep -vc '^#' tests/golden.txt)
format='%-13s %-6s %-27s %-17s %-9s %6s %6s %7s %7s\n'
# shellcheck disable=SC2059
printf "$format" machine by flags lanes hashes passed failed 'build s' 'run s'
while read -r number rest; do
    # shellcheck disable=SC2046
    set -- "$number" $(cat "$work/rows/$number" 2>/dev/null)
    if [ "${2-}" = late ]; then
        skip "$rest: no time is left"
        continue
    fi
    # shellcheck disable=SC2059
    printf "$format" "$2" "$3" "$4" "$5" "$6 of $pictures" "$7" "$8" "$9" "${10}"
    if [ "$6 $8" = "$pictures 0" ]; then
        pass
    else
        fail "$rest" "$(grep -v '^SKIPPED' "$work/rows/$number.log" | tail -n 30)"
    fi
done <"$work/list"

# x86 has other flags for what it must not do.
machine i386
compiler gcc
if have "$cc"; then
    said=$($cc -Iinclude -Isrc -fsyntax-only src/num.c 2>&1)
    empty 'x87 is refused, and says what helps' "$(echo "$said" | grep -q 'msse2 -mfpmath=sse' || echo "$said")"
fi
for name in "$work"/files/*; do
    if [ -f "$work/files/x86-64" ]; then
        quiet "${name##*/}: the tool's files are x86-64's" diff "$work/files/x86-64" "$name"
    fi
done
total
