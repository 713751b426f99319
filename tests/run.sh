#!/bin/sh
# run.sh - what `make test` runs: the unit tests, the proofs and the shell tests, and one total on the last line.
# Each part closes with a line `N passed, N failed` of its own; a part that ends without one has failed.
# Usage: B=build CC=gcc CFLAGS=-O2 MAKE=make sh tests/run.sh
. tests/shell.sh
export B CC CFLAGS MAKE

# Rooms and scripts, those that take seconds first, the longest before others; `others` are all other rooms.
rooms='rectify accuracy art path fourier door_maps query gather workers isa ray door_windows oracle showcase'
parts="proofs_calls.sh post.sh tool.sh $rooms others proofs.sh ports.sh"
run=$B/run
rm -rf "$run"
mkdir -p "$run"

# work WORKER PART...: does those parts that nobody has taken yet, and shows each when it has ended.
work() {
    part_logs=$run/$1
    mkdir "$part_logs"
    shift
    for name; do
        mkdir "$run/taken.$name" 2>/dev/null || continue
        # shellcheck disable=SC2046,SC2086
        case $name in
        *.sh) set -- sh "tests/$name" ;;
        others) set -- "$B/tests" $(printf -- '-%s ' $rooms) ;;
        *) set -- "$B/tests" "$name" ;;
        esac
        part "$@" >"$part_logs/shown" 2>&1 </dev/null
        cat "$part_logs/shown"
    done
    echo "$passed $failed" >"$part_logs/count"
}

# A worker for each processor, this shell the last of them. It begins with faults.sh, which sends signals: whatever a shell starts
# behind ignores some.
workers=$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2)
worker=1
while [ $worker -lt "$workers" ]; do
    # shellcheck disable=SC2086
    work $worker $parts &
    worker=$((worker + 1))
done
# shellcheck disable=SC2086
work 0 faults.sh $parts
wait
while [ $worker -gt 1 ]; do
    worker=$((worker - 1))
    read -r more_passed more_failed <"$run/$worker/count" || fail "worker $worker ended early"
    passed=$((passed + ${more_passed:-0})) failed=$((failed + ${more_failed:-0}))
done
total
