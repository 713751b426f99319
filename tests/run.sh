#!/bin/sh
# run.sh - what `make test` runs: the unit tests, the proofs and the shell tests, and one total on the last line.
# Each part closes with a line `N passed, N failed` of its own; a part that ends without one has failed.
# Usage: B=build CC=gcc CFLAGS=-O2 MAKE=make sh tests/run.sh
: "${B:=build}"
export B
passed=0 failed=0
log=$B/part.log

part() {
    echo "== $*"
    "$@" >"$log" 2>&1
    status=$?
    closing=$(tail -n 1 "$log" | sed -n 's/^\([0-9][0-9]*\) passed, \([0-9][0-9]*\) failed$/\1 \2/p')
    # The parts' totals stay out of sight: the one at the end is the only line of that form.
    if [ -n "$closing" ]; then sed '$d' "$log"; else cat "$log"; fi
    set -- ${closing:-0 1} "$@"
    if [ -z "$closing" ]; then echo "FAILED $3 $4: ended with status $status and no total"; fi
    if [ -n "$closing" ] && [ "$status" -ne 0 ] && [ "$2" -eq 0 ]; then
        echo "FAILED $3 $4: status $status"
        set -- "$1" 1
    fi
    passed=$((passed + $1))
    failed=$((failed + $2))
}

part "$B/tests"
for script in tests/proofs*.sh tests/tool*.sh; do
    [ -f "$script" ] && part sh "$script"
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
