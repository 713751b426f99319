#!/bin/sh
# proofs_calls.sh - the call graph as gcc sees it: no recursion, and how much stack a public call takes at most.
# Leaves the figure of each in $B/proofs_calls/stack. $OPTIMISE: flags in place of -O2.
# A job runs below the executor, so its stack is counted on top of the call that starts it; the executor's own is not ours.
. tests/shell.sh

limit=4096 # bytes, any public call
# Who calls through a pointer, besides the executor and its jobs: these call the caller's clock.
pointers='tyn_raster_surface tyn_raster_shadow tyni_pass_now'
work=$B/proofs_calls
gcc=
for try in "$CC" gcc; do
    case $($try --version 2>/dev/null | head -n 1) in *[cC]lang* | '') ;; *) gcc=${gcc:-$try} ;; esac
done
mkdir -p "$work"
echo 'int f(void); int f(void) { return 0; }' >"$work/probe.c"
if [ -z "$gcc" ] || ! $gcc -fcallgraph-info=su -c -o "$work/probe.o" "$work/probe.c" 2>/dev/null; then
    skip 'recursion and stack: no gcc with -fcallgraph-info'
    total
    exit
fi
rm -f "$work"/probe.*
# In a build folder of its own, where only what changed is compiled again.
objects=$(printf '%s\n' src/*.c src/*/*.c | sed "s|\(.*\)\.c\$|$work/obj/\1.o|")
flags='-fno-optimize-sibling-calls -fcallgraph-info=su -Wno-error -Werror=unsuffixed-float-constants'
# shellcheck disable=SC2086
quiet 'the library compiles, without double constants' "$MAKE" -s -j2 B="$work" CC="$gcc" CFLAGS="${OPTIMISE:--O2} $flags" $objects ||
    { total; exit; }
# Each job, as the call graph names it, and a file that starts jobs and knows this one.
starters=$(grep -l 'tyni_jobs_run(' src/*.c src/*/*.c /dev/null | grep -v '^src/jobs.c$')
grep -n '(void \*[a-z_]*, int32_t [a-z_]*, int32_t [a-z_]*)$' src/*.c src/*/*.c /dev/null | grep -v '^src/jobs.c:' |
    while IFS=: read -r file line text; do
        name=$(echo "$text" | sed 's/^.*void \([a-z_0-9]*\)(.*/\1/')
        title=$name
        case $text in static*) title=$file:$name ;; esac
        # shellcheck disable=SC2086
        by=$(grep -lw "$name" $starters /dev/null)
        for starter in ${by:-nobody}; do
            echo "$title $starter"
        done
    done >"$work/jobs"

# shellcheck disable=SC2046
awk -v limit="$limit" -v pointers="$pointers" '
function field(line, name,    at) {
    at = index(line, name ": \"")
    if (!at) return ""
    line = substr(line, at + length(name) + 3)
    return substr(line, 1, index(line, "\"") - 1)
}
function complain(text) { if (!(text in said)) { said[text] = 1; print text } }

# Deepest stack below and with f; `next_of` remembers the way. The graph is walked once: a function met again on the way down
# is recursion.
function depth(f,    n, list, i, d, most) {
    if (f in total) return total[f]
    if (f in open) { complain("recursion through " f); return 0 }
    open[f] = 1
    most = 0
    n = split(calls[f], list, "\n")
    for (i = 1; i <= n; i++) {
        if (list[i] == "") continue
        d = depth(list[i])
        if (d > most) { most = d; next_of[f] = list[i] }
    }
    delete open[f]
    return total[f] = most + frame[f]
}

FILENAME == jobs_file {
    if ($2 == "nobody") complain($1 ": a job that no file starts")
    job[++jobs] = $1
    starter[jobs] = $2
    next
}
/^node:/ {
    title = field($0, "title")
    label = field($0, "label")
    if (match(label, /[0-9]+ bytes/)) {
        frame[title] = substr(label, RSTART, RLENGTH) + 0
        if (label ~ /dynamic/ && label !~ /dynamic,bounded/) complain(title ": dynamic stack")
        home[title] = label
        sub(/^[^\\]*\\n/, "", home[title])
        sub(/:.*/, "", home[title])
        if (title ~ /^tyn_/) public[++publics] = title
    }
}
/^edge:/ {
    from = field($0, "sourcename")
    to = field($0, "targetname")
    if (to == "__indirect_call") indirect[from] = 1
    else calls[from] = calls[from] "\n" to
    if (to == "tyni_jobs_run") starts[from] = 1
}
END {
    # Who starts jobs runs, below tyni_jobs_run and its counter, the jobs that its file knows.
    runner = frame["tyni_jobs_run"] + frame["src/jobs.c:counted"]
    for (f in starts) {
        for (i = 1; i <= jobs; i++) {
            if (starter[i] != home[f]) continue
            calls[f] = calls[f] "\n" "run " job[i]
            frame["run " job[i]] = runner
            calls["run " job[i]] = job[i]
        }
    }
    # Calls through pointers that leave the library or are known: the executor, its jobs, the clock.
    for (f in indirect)
        if (f !~ /^(tyni_jobs_run|src\/jobs.c:counted)$/ && index(" " pointers " ", " " f " ") == 0)
            complain(f ": a call through a pointer that tests/proofs_calls.sh does not know")
    for (i = 1; i <= publics; i++) depth(public[i])
    for (f in frame) depth(f)
    for (i = 1; i <= publics; i++) {
        f = public[i]
        print f, total[f] > stack_file
        if (total[f] > limit) complain(f ": " total[f] " bytes of stack")
        if (total[f] > total[worst]) worst = f
    }
    chain = worst " " frame[worst]
    for (f = worst; f in next_of; f = next_of[f])
        chain = chain " > " next_of[f] " " frame[next_of[f]]
    print "stack, without libc and the executor: " total[worst] " bytes at most: " chain > "/dev/stderr"
    print publics > count_file
}' jobs_file="$work/jobs" count_file="$work/count" stack_file="$work/stack" "$work/jobs" \
    $(echo "$objects" | sed 's/o$/ci/') >"$work/complaints" 2>"$work/summary"
cat "$work/summary"
empty 'no recursion, no dynamic stack, no unknown pointers' "$(grep -v 'bytes of stack' "$work/complaints")"
empty "no public call takes more than $limit bytes of stack" "$(grep 'bytes of stack' "$work/complaints")"
if [ "$(cat "$work/count" 2>/dev/null || echo 0)" -ge 5 ]; then pass; else fail 'the call graph has the public functions'; fi
total
