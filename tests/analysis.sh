#!/bin/sh
# analysis.sh - gcc's analyzer, clang-tidy (its checks: .clang-tidy) and cppcheck over all C of src/, ports/ and tests/. What they find is
# mended, or stands in tests/analysis.txt with the reason why it is false; what stands there and is not found any more fails too. Each
# analyser must first find bugs that are planted for it, by the same settings.
#     sh tests/analysis.sh [TOOL...]      tools: gcc tidy cppcheck
. tests/shell.sh

work=$B/analysis
top=$(pwd)

# flags FILE: what it is compiled with. One configuration, plain C: vectors only make work of more of it.
flags() {
    echo '-std=c99 -Iinclude -Isrc -DTYN_PLAIN_C'
    case $1 in
    src/*) ;;
    ports/arm-m/*) echo '--target=arm-none-eabi -mcpu=cortex-m4 -nostdlibinc -isystem ports/riscv/libc -Iports/null' ;;
    ports/riscv/main.c) echo '--target=riscv32 -nostdlibinc -isystem ports/riscv/libc -Iports/null' ;;
    ports/wasm/page.c) echo '--target=wasm32 -nostdlibinc -Iports/wasm/include -Iports/posix' ;;
    *) echo "-D_POSIX_C_SOURCE=200809L -pthread -Iports/posix -I$work" ;;
    esac
}

# look TOOL FILE...: one finding a line, FILE:LINE: MESSAGE [CHECK]. That it ended badly is one too. Several files only for cppcheck.
look() {
    tool=$1
    shift
    # shellcheck disable=SC2046
    case $tool in
    # Without the check for leaks: gcc 12 takes memory for lost that is put behind a pointer given from outside, 15 times here. The other
    # two have theirs.
    gcc) gcc $(flags "$1") -O1 -fanalyzer -Wno-analyzer-malloc-leak -fdiagnostics-plain-output -c -o /dev/null "$1" ;;
    # A quarter of the paths that clang follows by itself: it takes a third of the time and found the same.
    tidy) clang-tidy --quiet --config-file=.clang-tidy "$1" -- $(flags "$1") -Xclang -analyzer-config -Xclang max-nodes=60000 ;;
    cppcheck) cppcheck -q --std=c99 --max-configs=1 --enable=warning,performance,portability -DTYN_PLAIN_C -D__GNUC__=12 -Iinclude -Isrc \
        -Iports/posix -Iports/null "-I$work" --template='{file}:{line}:{column}: {severity}: {message} [{id}]' "$@" ;;
    esac >"$work/raw.$$" 2>&1
    status=$?
    sed -n -e "s|^$top/||; s|^[^:]*/\.\./||" \
        -e 's/^\([^ :]*:[0-9]*\):[0-9]*: \(fatal \)\{0,1\}\(warning\|error\|performance\|portability\): /\1: /p' "$work/raw.$$"
    [ $status -eq 0 ] || echo "$1:1: $tool ended with status $status: $(tail -n 1 "$work/raw.$$") [status]"
    rm "$work/raw.$$"
}

# files TOOL: the longest first, so that none is left over for one core alone.
files() {
    # shellcheck disable=SC2012
    ls -S src/*.c src/*/*.c ports/*/*.c ports/*/*/*.c tests/*.c tests/*/*.c | case $1 in
    gcc) grep -v -e '^ports/arm-m/main.c' -e '^ports/riscv/main.c' -e '^ports/wasm/page.c' ;; # assembly and built-ins of other machines
    *) cat ;;
    esac
}

# judge TOOL: stdin less what stands in the list. Lines of the list that it used go to $work/TOOL.used.
judge() {
    awk -F ' [|] ' -v tool="$1" -v used="$work/$1.used" '
        NR == FNR { if ($1 == tool) { n++; file[n] = $2; part[n] = $3 } next }
        {
            for (i = 1; i <= n; i++)
                if (index($0, file[i]) == 1 && index($0, part[i])) { print file[i] " | " part[i] >used; next }
            print
        }' tests/analysis.txt -
}

# planted TOOL NAME CHECK: the function on stdin has a bug of this name, and the tool says so by this check.
planted() {
    cat >"$work/$2.c"
    look "$1" "$work/$2.c" | judge "$1" >"$work/said"
    if grep -q "\[.*$3.*\]" "$work/said"; then pass; else fail "$1: finds a planted bug: $2" - <"$work/said"; fi
}

plant() { # TOOL
    case $1 in
    gcc) leak='' null=analyzer-null-dereference garbage=analyzer-use-of-uninitialized-value bounds='' twice=analyzer-double-free ;;
    tidy) leak=unix.Malloc null=core.NullDereference garbage=core.UndefinedBinaryOperatorResult bounds=core.uninitialized.UndefReturn twice=unix.Malloc ;;
    cppcheck) leak=memleak null=nullPointer garbage=uninitvar bounds=arrayIndexOutOfBounds twice=doubleFree ;;
    esac
    [ -z "$leak" ] || planted "$1" leak "$leak" <<'END'
#include <stdlib.h>
int leak(int n);
int leak(int n)
{
    int *p = malloc(sizeof *p), m;
    if (!p)
        return -1;
    if (n < 0)
        return 0;
    *p = n;
    m = 2 * *p;
    free(p);
    return m;
}
END
    planted "$1" null "$null" <<'END'
int null(const int *from, int n);
int null(const int *from, int n)
{
    const int *p = 0;
    if (n > 3)
        p = from;
    return *p;
}
END
    planted "$1" garbage "$garbage" <<'END'
int garbage(int n);
int garbage(int n)
{
    int m;
    if (n > 3)
        m = n;
    return m + 1;
}
END
    [ -z "$bounds" ] || planted "$1" bounds "$bounds" <<'END'
int bounds(int n);
int bounds(int n)
{
    int a[4] = {1, 2, 3, 4};
    if (n == 4)
        return a[n];
    return a[0];
}
END
    planted "$1" twice "$twice" <<'END'
#include <stdlib.h>
void twice(char *p, int n);
void twice(char *p, int n)
{
    if (n > 3)
        free(p);
    free(p);
}
END
}

# analyse TOOL COMMAND VERSION: by a version whose findings nobody judged, they are shown and not counted.
analyse() {
    if ! have "$2"; then
        skip "$1: no $2"
        return
    fi
    start=$(date +%s)
    rm -rf "${work:?}/$1" "$work/$1.used"
    mkdir -p "$work/$1"
    : >"$work/$1.used"
    plant "$1"
    : >"$work/$1.used"
    files "$1" >"$work/$1.files"
    sort "$work/$1.files" >"$work/$1.sorted"
    batch=1
    [ "$1" != cppcheck ] || batch=20 # it starts more slowly than it reads
    xargs -P 2 -n $batch env B="$B" sh tests/analysis.sh one "$1" <"$work/$1.files"
    empty "$1: looks at every file" "$(cat "$work/$1"/*.looked | sort | diff - "$work/$1.sorted")"
    cat "$work/$1"/*.found | sort -u >"$work/$1.found"
    judge "$1" <"$work/$1.found" >"$work/$1.new"
    if "$2" --version | grep -q "$3"; then
        while read -r finding; do
            fail "$1: $finding"
        done <"$work/$1.new"
        [ -s "$work/$1.new" ] || pass
        empty "$1: finds all that tests/analysis.txt has" "$(sed -n "s/^$1 | \(.* | .*\) | .*/\1/p" tests/analysis.txt | sort -u | grep -v -x -F -f "$work/$1.used")"
    elif [ -s "$work/$1.new" ]; then
        cat "$work/$1.new"
        skip "$1: another version than the one whose findings were judged; $(wc -l <"$work/$1.new") shown, not counted"
    fi
    echo "   $1: $(wc -l <"$work/$1.files") files, $(wc -l <"$work/$1.found") findings, of which $(wc -l <"$work/$1.new") are not in the list; $(($(date +%s) - start)) s"
}

if [ "${1-}" = one ]; then
    shift
    look "$@" >"$work/$1/$$.found"
    shift
    printf '%s\n' "$@" >"$work/$tool/$$.looked"
    exit 0
fi

mkdir -p "$work"
# as the makefile writes them, for tests/main.c and others
for file in tests/test_*.c; do echo "$file"; done | sed 's/.*test_\(.*\)\.c/ROOM(\1)/' >"$work/rooms.h"
for file in tests/fuzz_*.c; do echo "$file"; done | sed -e /fuzz_main/d -e 's/.*fuzz_\(.*\)\.c/TARGET(\1)/' >"$work/targets.h"
empty 'every line of tests/analysis.txt has a reason' "$(grep -v -e '^#' -e '^$' -e '^\(gcc\|tidy\|cppcheck\) | [^ ][^|]* | [^|]*[^ |] | [^|]*[^ |]$' tests/analysis.txt)"
[ $# -gt 0 ] || set -- gcc tidy cppcheck
for tool in "$@"; do
    case $tool in
    gcc) analyse gcc gcc ' 12\.' ;;
    tidy) analyse tidy clang-tidy ' 14\.' ;;
    cppcheck) analyse cppcheck cppcheck ' 2\.10' ;;
    esac
done
total
