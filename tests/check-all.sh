#!/bin/sh
# check-all.sh - the tests again under other compilers, optimisers, sanitizers and valgrind; the formatting; static analysers; fuzzing; a
# fresh clone as the README has it; renders of the shared data; the ports and the page; and other machines. About 50 minutes on 2
# cores. What a machine lacks is SKIPPED.
#     sh tests/check-all.sh [PART...]      parts: format analysis compilers sanitizers valgrind coverage fuzz instructions ports clone
#                                          shared wasm sameness
. tests/shell.sh
export MAKE
mkdir -p "$B"
B=$B/check
mkdir -p "$B"
top=$(pwd)
began=$(date +%s)
shared=${TYN_SHARED:-../shared}
case $shared in /*) ;; *) shared=$top/$shared ;; esac
TYN_SHARED=$shared
export TYN_SHARED

wanted() {
    [ -z "$parts" ] && return 0
    case " $parts " in *" $1 "*) return 0 ;; esac
    return 1
}
parts=$*

# variant NAME CC CFLAGS ARGUMENTS...: the unit tests, built in a folder of their own.
variant() {
    name=$1 cc=$2 flags=$3
    shift 3
    if ! have "${cc%% *}"; then
        skip "$name: no $cc"
        return
    fi
    echo "-- $name: $cc $flags"
    flags="$flags -Wno-error" # optimisers and sanitizers warn of other things each; the plain builds are without warnings
    if quiet "$name: builds" "$MAKE" -s -j2 B="$B/$name" CC="$cc" CFLAGS="$flags" "$B/$name/tests" "$B/$name/tyndall"; then
        part "$B/$name/tests" "$@"
    fi
}

# Can this compiler build and run with these flags?
can() {
    have "$1" && echo 'int main(void) { return 0; }' >"$B/can.c" && "$@" -o "$B/can" "$B/can.c" 2>/dev/null && "$B/can"
}

check_format() {
    if have clang-format; then quiet 'clang-format' "$MAKE" format-check; else skip 'no clang-format'; fi
}

check_analysis() {
    part env B="$B" sh tests/analysis.sh
}

check_compilers() {
    quiet 'builds' "$MAKE" -s -j2 B="$B/main" CC=gcc all && part env B="$B/main" CC=gcc CFLAGS=-O2 MAKE="$MAKE" sh tests/proofs_install.sh
    quiet 'benchmarks build' "$MAKE" -s -j2 B="$B/bench" CC=gcc "$B/bench/bench" "$B/bench/bench-frame" \
        "$B/bench/bench-growth" "$B/bench/bench-papers" "$B/bench/bench-prefiltered" \
        "$B/bench/bench-stability"
    if have clang; then
        if quiet 'clang: builds' "$MAKE" -s -j2 B="$B/clang" CC=clang all "$B/clang/tests"; then
            part env B="$B/clang" CC=clang CFLAGS=-O2 MAKE="$MAKE" sh tests/run.sh
        fi
    else
        skip 'no clang'
    fi
    for flags in -O1 -O3 -Os; do
        quiet "gcc $flags: builds without warnings" "$MAKE" -s -j2 B="$B/plain$flags" CC=gcc CFLAGS="$flags" all
    done
    variant O0 gcc '-O0 -g' golden isa lanes raster_isa api encode render ray sample # the rest takes a quarter of an hour without an optimiser
    variant O3 gcc '-O3 -march=native'
    variant clang-O3 clang '-O3 -march=native' -accuracy -oracle
    variant plain gcc '-O2 -DTYN_PLAIN_C' golden render workers
}

check_sanitizers() {
    cc=clang
    have clang || cc=gcc
    ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1
    UBSAN_OPTIONS=print_stacktrace=1
    export ASAN_OPTIONS UBSAN_OPTIONS
    if can $cc -fsanitize=address,undefined; then
        more=
        case $cc in clang) more=,float-cast-overflow,implicit-integer-sign-change ;; esac
        flags="-O1 -g -fsanitize=address,undefined$more -fno-sanitize-recover=all"
        variant asan $cc "$flags" -oracle
        for script in tool faults; do
            [ ! -x "$B/asan/tyndall" ] || part env B="$B/asan" CC=$cc CFLAGS="$flags" MAKE="$MAKE" sh tests/$script.sh
        done
    else
        skip "no address sanitizer in $cc"
    fi
    if can $cc -fsanitize=thread; then
        variant tsan $cc '-O1 -g -fsanitize=thread' workers pool raster_door
    else
        skip "no thread sanitizer in $cc"
    fi
    if can clang -fsanitize=memory; then # scalar: it takes what vectors mask out for used
        variant msan clang '-O1 -g -DTYN_PLAIN_C -fsanitize=memory -fno-sanitize-recover=all' -oracle -accuracy -art -fences -path -rectify
    else
        skip 'no memory sanitizer'
    fi
}

check_valgrind() {
    if ! have valgrind; then
        skip 'no valgrind'
        return
    fi
    if quiet 'valgrind: builds' "$MAKE" -s -j2 B="$B/valgrind" CFLAGS='-O1 -g' "$B/valgrind/tests"; then
        part valgrind -q --error-exitcode=9 --leak-check=full "$B/valgrind/tests" api encode render golden
    fi
}

# Of src/: goals 95 % of lines, 85 % of branches. build/check/coverage.txt lists what was not run, tests/coverage.txt says why.
check_coverage() {
    if ! have gcovr; then
        skip 'no gcovr'
        return
    fi
    if quiet 'coverage: builds' "$MAKE" -s -j2 B="$B/coverage" CC=gcc CFLAGS='-O1 -g --coverage -fprofile-update=atomic -Wno-error' "$B/coverage/tests" \
        "$B/coverage/tyndall"; then
        part "$B/coverage/tests" -oracle
        quiet 'coverage: 95 % of lines, 85 % of branches' gcovr -r . --object-directory "$B/coverage" -f 'src/.*' \
            --exclude-throw-branches --gcov-ignore-parse-errors --fail-under-line 95 --fail-under-branch 85 -o "$B/coverage.txt"
        sed -n 's/^TOTAL  */   coverage of lines: /p' "$B/coverage.txt"
    fi
}

check_instructions() {
    part env B="$B/main" CC=gcc CFLAGS=-O2 MAKE="$MAKE" sh tests/instructions.sh
}

# More random scenes, and some minutes of what `make fuzz` does for as long as one likes.
check_fuzz() {
    if quiet 'builds' "$MAKE" -s -j2 B="$B/main" "$B/main/tests"; then
        part env TYN_ROUNDS=10 "$B/main/tests" properties moved fences fences_raster
    fi
    part env B="$B" MAKE="$MAKE" sh tests/fuzz.sh libfuzzer 30 frame raster fit scene post
    part env B="$B" MAKE="$MAKE" sh tests/fuzz.sh libfuzzer 8 obj mtl ppm pfm
}

check_ports() {
    part env B="$B/main" CC=gcc CFLAGS=-O2 MAKE="$MAKE" sh tests/ports.sh bare
    part sh tests/size.sh
}

# The commands that stand in the README, in a clone of what is committed.
check_clone() {
    clone=$top/$B/clone
    rm -rf "$clone"
    if have git && git rev-parse --git-dir >/dev/null 2>&1; then
        quiet 'a fresh clone' git clone -q --depth 1 "file://$top" "$clone" || return
    else
        mkdir -p "$clone"
        tar -cf - --exclude=./build . | (cd "$clone" && tar -xf -)
    fi
    commands=$(sed -n -e 's/^[ $]*\(make run\)\( .*\)*$/\1/p' -e 's/^[ $]*\(make test\)\( .*\)*$/\1/p' README.md | sort -u)
    empty 'the README has its two commands' "$([ "$(echo "$commands" | wc -l)" -eq 2 ] || echo "$commands")"
    while read -r command; do
        start=$(date +%s)
        # shellcheck disable=SC2086
        if quiet "README: $command" sh -c "cd '$clone' && TYN_SHARED=/nowhere $command </dev/null"; then
            echo "   $command took $(($(date +%s) - start)) s in a fresh clone, without the shared data"
        fi
    done <<END
$commands
END
    empty 'make run leaves PNGs' "$([ "$(find "$clone/build" -maxdepth 1 -name '*.png' -size +1k | wc -l)" -ge 3 ] || ls "$clone/build")"
    empty 'nothing but build/ is written' "$(cd "$clone" && git status --short 2>/dev/null)"
}

# relative_l1 of two PFMs.
l1() {
    "$B/main/tyndall" compare "$1" "$2" | sed -n 's/^relative_l1 //p'
}

less() { # A B
    awk -v a="$1" -v b="$2" 'BEGIN { exit !(a != "" && a == a + 0 && a < b) }'
}

check_reference() {
    sum=0 count=0
    for scene in "$shared"/reference/*.scene; do
        name=${scene##*/}
        name=${name%.scene}
        said=$("$B/main/tyndall" render "$scene" -o "$B/$name.pfm" --scatter "$B/$name.scatter.pfm" 2>&1)
        status=$?
        if [ $status -ne 0 ]; then
            fail "reference $name" "$said"
            continue
        fi
        l1=$(l1 "$B/$name.scatter.pfm" "${scene%.scene}.scatter.pfm")
        echo "   $name: relative L1 of L_scat $l1"
        if less "$l1" 0.03; then pass; else fail "reference $name: 3 %" "$l1"; fi
        whole=$(l1 "$B/$name.pfm" "${scene%.scene}.radiance.pfm")
        echo "   $name: relative L1 of the picture $whole"
        if less "$whole" 0.02; then pass; else fail "reference $name: 2 % of the picture" "$whole"; fi
        sum=$(awk -v s="$sum" -v l="$l1" 'BEGIN { print s + l }')
        count=$((count + 1))
    done
    if [ $count -gt 0 ]; then
        mean=$(awk -v s="$sum" -v n=$count 'BEGIN { print s / n }')
        echo "   mean over $count scenes: $mean"
        if less "$mean" 0.01; then pass; else fail 'references: 1 % in the mean' "$mean"; fi
    fi
}

# Error bounds of L_scat against the given truths: measured in all five scenes, plus a third. A coarse picture loses what is finer
# than its pixels: in white light little, of stained glass most. Fixed steps (150) add their own.
bound() { # SCENE RAYS DOWNSCALE
    case $1:$2:$3 in
    *stained*:*:1) echo 0.018 ;;
    *stained*:*:2) echo 0.078 ;;
    *stained*:*:4) echo 0.14 ;;
    *stained*:*:8) echo 0.26 ;;
    *:words:1) echo 0.0065 ;;
    *:words:2) echo 0.008 ;;
    *:words:4) echo 0.019 ;;
    *:words:8) echo 0.039 ;;
    *:steps:1) echo 0.016 ;;
    *:steps:2) echo 0.018 ;;
    *:steps:4) echo 0.032 ;;
    *:steps:8) echo 0.074 ;;
    esac
}

# Every combination of rays, lines and down-scaling on the reference scenes: within its bound, and words, tree, sweep and columns
# the same to the byte.
check_combinations() {
    for scene in "$shared"/reference/*.scene; do
        name=${scene##*/}
        name=${name%.scene}
        for gather in shear ivb ed10; do
            line="  "
            for scale in 1 2 4 8; do
                for rays in words tree sweep columns steps; do
                    case $name:$rays in *stained*:tree | *stained*:columns) continue ;; esac # slow, and coloured light is in the unit tests
                    said=$("$B/main/tyndall" render "$scene" -o "$B/combined.png" --scatter "$B/$rays.pfm" --gather $gather \
                        --rays $rays --downscale $scale 2>&1) || fail "$name $gather $rays /$scale" "$said"
                    case $rays in
                    words | steps)
                        l1=$(l1 "$B/$rays.pfm" "${scene%.scene}.scatter.pfm")
                        line="$line $l1"
                        if less "$l1" "$(bound "$name" $rays $scale)"; then pass; else fail "$name $gather $rays /$scale: error" "$l1"; fi
                        ;;
                    *) quiet "$name $gather /$scale: $rays are words" cmp "$B/words.pfm" "$B/$rays.pfm" ;;
                    esac
                done
            done
            echo "   $name $gather, words and steps at 1, 2, 4, 8: $line"
        done
    done
}

# Every model of the shared data, the sun over it, seen from outside its box: epipolar against the march of the same shadow map.
check_models() {
    for model in "$shared"/data/*/*.obj; do
        name=${model##*/}
        name=${name%.obj}
        scene=$top/$B/$name.scene
        awk -v file="$model" '
        $1 == "v" { for (k = 0; k < 3; k++) { x = $(k + 2) + 0; if (!n || x < lo[k]) lo[k] = x; if (!n || x > hi[k]) hi[k] = x } n = 1 }
        END {
            size = 0
            for (k = 0; k < 3; k++) { mid[k] = (lo[k] + hi[k]) / 2; if (hi[k] - lo[k] > size) size = hi[k] - lo[k] }
            if (!n) exit 1
            print "tyndall-scene 1\nimage 480 270"
            printf "camera position %g %g %g target %g %g %g fov_y 50 near %g far %g\n", mid[0] + 0.9 * size, mid[1] + 0.35 * size,
                mid[2] + 0.8 * size, mid[0], mid[1], mid[2], 0.01 * size, 4 * size
            print "background 0.3 0.4 0.5\nambient 0.2 0.2 0.25"
            printf "medium scatter %g %g %g phase hg 0.5\n", 0.3 / size, 0.3 / size, 0.35 / size
            print "light directional direction 0.5 -0.7 0.6 irradiance 8 7 6"
            print "mesh " file
        }' "$model" >"$scene"
        said=$("$B/main/tyndall" render "$scene" -o "$B/model.png" --scatter "$B/model.pfm" 2>&1) &&
            said=$("$B/main/tyndall" render "$scene" -o "$B/march.png" --scatter "$B/march.pfm" --method march 2>&1)
        if [ $? -ne 0 ]; then
            fail "model $name" "$said"
            continue
        fi
        l1=$(l1 "$B/model.pfm" "$B/march.pfm")
        echo "   $name: relative L1 to the march $l1"
        if less "$l1" 0.02; then pass; else fail "model $name: 2 % to the march" "$l1"; fi
    done
}

check_shared() {
    quiet 'builds' "$MAKE" -s -j2 B="$B/main" "$B/main/tyndall" || return
    if [ -d "$shared/reference" ]; then
        check_reference
        check_combinations
    else
        skip "no $shared/reference"
    fi
    if [ -d "$shared/data" ]; then check_models; else skip "no $shared/data"; fi
}

check_wasm() {
    part env B="$B/main" MAKE="$MAKE" sh tests/wasm.sh
}

check_sameness() {
    part env TYN_UNTIL=$((began + 3900)) sh tests/sameness.sh # 65 minutes: a machine may be slow
}

for check in format analysis compilers sanitizers valgrind coverage fuzz instructions ports clone shared wasm sameness; do
    wanted $check || continue
    echo "==== $check"
    start=$(date +%s)
    check_$check
    echo "==== $check took $(($(date +%s) - start)) s"
done
total
