#!/bin/sh
# fuzz.sh - so many seconds of each fuzz target, or of those that are named, from its seeds and what build/fuzz/corpus has of
# earlier runs. An input that breaks something is left in build/fuzz/found, and is a failure.
#     sh tests/fuzz.sh libfuzzer|afl SECONDS [TARGET...]
. tests/shell.sh
top=$(pwd)
kind=$1 seconds=$2
shift 2
case $B in /*) ;; *) B=$top/$B ;; esac
where=$B/fuzz
UBSAN_OPTIONS=print_stacktrace=1
export UBSAN_OPTIONS

case $kind in
libfuzzer)
    compiler=clang
    flags='-O2 -g -fsanitize=fuzzer-no-link,address,undefined,float-cast-overflow -fno-sanitize-recover=all -Wno-error'
    ;;
afl)
    compiler=afl-clang-fast
    flags='-O2 -g -Wno-error'
    ;;
*)
    echo "usage: sh tests/fuzz.sh libfuzzer|afl SECONDS [TARGET...]"
    exit 2
    ;;
esac

mkdir -p "$where/$kind"
echo '#include <stdint.h>
#include <stddef.h>
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) { return data && size > 9999; }' >"$where/can.c"
if ! have $compiler || ! $compiler -fsanitize=fuzzer -o "$where/can" "$where/can.c" >/dev/null 2>&1; then
    skip "no $kind: $compiler -fsanitize=fuzzer"
    total
    exit
fi
AFL_QUIET=1
export AFL_QUIET
quiet "$kind: builds" "$MAKE" -s -j2 B="$where/$kind" CC=$compiler CFLAGS="$flags" "$where/$kind/fuzzer" || { total; exit; }

# Files that targets write are written where that costs little.
memory=/dev/shm
[ -w $memory ] || memory=${TMPDIR:-/tmp}
scratch=$memory/tyndall-fuzz.$$
mkdir -p "$scratch" "$where/found"
trap 'rm -rf "$scratch"' EXIT
trap 'exit 1' INT TERM
cd "$scratch" || exit 1

# Inputs found so far.
found() {
    find "$where/found" -name "$1-*" | sort
}

run_libfuzzer() {
    "$where/$kind/fuzzer" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=3000 -max_len=4096 \
        -artifact_prefix="$where/found/$1-" "$where/corpus/$1" "$top/tests/seeds/$1" >"$where/$1.log" 2>&1
}

run_afl() {
    AFL_NO_UI=1 AFL_SKIP_CPUFREQ=1 AFL_I_DONT_CARE_ABOUT_MISSING_CRASHES=1 AFL_NO_AFFINITY=1 AFL_IGNORE_SEED_PROBLEMS=1 \
        afl-fuzz -V "$seconds" -t 10000 -i "$top/tests/seeds/$1" -o "$scratch/out-$1" -- "$where/$kind/fuzzer" >"$where/$1.log" 2>&1
    status=$?
    for file in "$scratch/out-$1"/default/crashes/id* "$scratch/out-$1"/default/hangs/id*; do
        if [ -f "$file" ]; then
            cp "$file" "$where/found/$1-afl-$(cksum <"$file" | cut -d ' ' -f 1)"
            status=1
        fi
    done
    rm -rf "$scratch/out-$1"
    return $status
}

for target in "${@:-all}"; do
    [ "$target" = all ] && target=$(ls "$top/tests/seeds")
    for name in $target; do
        mkdir -p "$where/corpus/$name"
        before=$(found "$name")
        TYN_FUZZ=$name
        export TYN_FUZZ
        if run_"$kind" "$name" && [ "$(found "$name")" = "$before" ]; then
            pass
        else
            tail -n 40 "$where/$name.log" | fail "fuzz $name: see $where/found" -
        fi
        grep -o -e 'Done [0-9]* runs.*' -e 'cov: [0-9]* ft: [0-9]*' -e '[0-9]* new corpus items found' "$where/$name.log" | tail -n 2 | tr '\n' ' ' | sed "s/^/   $name: /"
        echo
    done
done
total
