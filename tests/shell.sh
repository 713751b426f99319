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

have() {
    command -v "$1" >/dev/null 2>&1
}

# The closing line; its status is the script's.
total() {
    echo "$passed passed, $failed failed"
    [ "$failed" -eq 0 ]
}
