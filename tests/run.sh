#!/bin/sh
# run.sh - what `make test` runs: the unit tests, the proofs and the shell tests, and one total on the last line.
# Each part closes with a line `N passed, N failed` of its own; a part that ends without one has failed.
# Usage: B=build CC=gcc CFLAGS=-O2 MAKE=make sh tests/run.sh
. tests/shell.sh
export B CC CFLAGS MAKE

# The longest of them beside all others: there are two cores.
{
    "$B/tests" accuracy art workers fourier door door_maps door_windows rectify path >"$B/long.log" 2>&1
    echo $? >"$B/long.status"
    sh tests/proofs.sh >"$B/proofs.log" 2>&1
    echo $? >"$B/proofs.status"
} &
part "$B/tests" -accuracy -art -workers -fourier -door -door_maps -door_windows -rectify -path
for script in proofs_calls tool faults post ports; do
    part sh tests/$script.sh
done
wait
for log in long proofs; do
    part sh -c "cat '$B/$log.log'; exit \$(cat '$B/$log.status')"
done
total
