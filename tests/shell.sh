# shell.sh - what the shell tests share. To be sourced: . tests/shell.sh
: "${B:=build}" "${CC:=gcc}" "${CFLAGS:=-O2}" "${MAKE:=make}"
unset MAKEFLAGS MFLAGS MAKELEVEL
LC_ALL=C
export LC_ALL
passed=0 failed=0

pass() {
    passed=$((passed + 1))
}

# fail NAME [MORE]: MORE, or what stands on stdin if it is -, explains.
fail() {
    failed=$((failed + 1))
    echo "FAILED $1"
    case ${2-} in
    -) sed 's/^/    /' ;;
    ?*) printf '%s\n' "$2" | sed 's/^/    /' ;;
    esac
}

skip() {
    echo "SKIPPED: $1"
}

# empty NAME TEXT: passes where there is nothing to complain about.
empty() {
    if [ -z "$2" ]; then pass; else fail "$1" "$2"; fi
}

# quiet NAME COMMAND...: passes where the command succeeds; else shows what it said.
quiet() {
    quiet_name=$1
    shift
    if quiet_said=$("$@" 2>&1); then pass; else fail "$quiet_name" "$quiet_said"; return 1; fi
}

# expect NAME STATUS COMMAND...: the exit status, and a message where it is not 0. Leaves out.txt and err.txt.
expect() {
    name=$1 want=$2
    shift 2
    "$@" >out.txt 2>err.txt
    got=$?
    if [ "$got" -ne "$want" ]; then fail "$name: status $got, not $want" - <err.txt; return 1; fi
    if [ "$want" -eq 0 ] && [ -s err.txt ]; then fail "$name: stderr is not empty" - <err.txt; return 1; fi
    if [ "$want" -ne 0 ] && ! [ -s err.txt ]; then fail "$name: no message"; return 1; fi
    pass
}

# says NAME TEXT: the last message holds TEXT.
says() {
    while IFS= read -r said_line || [ -n "$said_line" ]; do
        case $said_line in *"$2"*) pass && return ;; esac
    done <err.txt
    fail "$1" - <err.txt
}

# none NAME: nothing is left in the folder `o`, which is made anew.
none() {
    left=$(ls -A o)
    empty "$1" "$left"
    rm -rf o
    mkdir o
}

have() {
    command -v "$1" >/dev/null 2>&1
}

# part COMMAND...: a script or program with a closing line of its own, which is added up and taken out of what is shown.
part() {
    echo "== $*"
    part_log=${part_logs:-$B}/part.log
    "$@" >"$part_log" 2>&1
    part_status=$?
    part_closing=$(tail -n 1 "$part_log" | sed -n 's/^\([0-9][0-9]*\) passed, \([0-9][0-9]*\) failed$/\1 \2/p')
    if [ -z "$part_closing" ]; then
        cat "$part_log"
        fail "$*: ended with status $part_status and no total"
        return
    fi
    sed '$d' "$part_log"
    passed=$((passed + ${part_closing% *}))
    failed=$((failed + ${part_closing#* }))
    if [ "$part_status" -ne 0 ] && [ "${part_closing#* }" -eq 0 ]; then
        fail "$*: status $part_status"
    fi
}

# The closing line; its status is the script's.
total() {
    echo "$passed passed, $failed failed"
    [ "$failed" -eq 0 ]
}
