#!/bin/sh
# ports.sh - the port to copy, and what ports/README.md says of memory.
#     sh tests/ports.sh          what `make test` runs
#     sh tests/ports.sh bare     the bare-metal ports in QEMU, and the library without its parts: each draws the picture of the native
#                                build, to the bit
. tests/shell.sh

work=$B/ports
mkdir -p "$work"

check_null() {
    quiet 'the port to copy builds' "$MAKE" -s B="$B" CC="$CC" CFLAGS="$CFLAGS" "$B/null" "$B/devices" || return
    quiet 'null runs' sh -c "'$B/null' >'$work/null'"
    cat "$work/null"
    empty 'null draws both pictures' "$([ "$(grep -c '^picture ' "$work/null")" -eq 2 ] || cat "$work/null")"
    awk '$1 == "memory" && !($2 > 0 && $4 > 0 && $4 <= $2 && $6 < $4)' "$work/null" >"$work/wrong"
    empty 'no more memory is touched than was given' "$(cat "$work/wrong")"
    for picture in colour:320x240:6:230400 dots:400x240:4:12000; do
        IFS=: read -r name size kind bytes <<END
$picture
END
        quiet "null $name" sh -c "'$B/null' $name >'$work/$name.pnm'"
        empty "null $name: a picture of $size" "$(head -c 14 "$work/$name.pnm" | tr '\n' ' ' | grep -q "^P$kind ${size%x*} ${size#*x} " ||
            echo 'its header differs')"
        # 16 values of bytes at the least: neither black nor white nor flat
        empty "null $name: something is to be seen" "$(tail -c "$bytes" "$work/$name.pnm" | od -An -v -tu1 -w1 | sort -u |
            awk 'END { if (NR < 16) print NR " values" }')"
    done
    # The table between the README's headline of it and the next empty line.
    "$B/devices" >"$work/devices" || fail 'devices'
    awk '/^\| picture \|/ { on = 1 } !/^\|/ { on = 0 } on' ports/README.md >"$work/table"
    empty 'the table of ports/README.md is what build/devices prints' "$(diff "$work/table" "$work/devices")"
}

# bare NAME COMMAND...: what the machine says, and whether it is right.
bare() {
    name=$1
    shift
    timeout 120 "$@" </dev/null >"$work/$name" 2>&1
    status=$?
    if [ $status -ne 0 ]; then
        fail "$name: status $status" - <"$work/$name"
        return
    fi
    pass
    sed "s/^/   $name: /" "$work/$name"
    empty "$name: the picture is the native one" "$([ "$(grep '^picture' "$work/$name")" = "$native" ] || echo "native: $native")"
    empty "$name: at most 4096 bytes of stack" "$(awk '/of stack/ { n++; if (!($4 > 500 && $4 <= 4096)) print } END { if (n != 2) print n " lines" }' "$work/$name")"
    empty "$name: instructions are counted" "$(awk '/instructions/ { n++; if (!($2 > 1e6)) print } END { if (n != 2) print n " lines" }' "$work/$name")"
}

# bare_port NAME COMPILER QEMU...: what it needs is here, and it builds.
bare_port() {
    for tool in "$2" "$3"; do
        if ! have "$tool"; then
            skip "$1: no $tool"
            return 1
        fi
    done
    quiet "$1 builds" "$MAKE" -s B="$B" CFLAGS=-O2 "$B/$1.elf"
}

# The library without its parts refuses them, and draws the same picture.
check_lean() {
    strict='-std=c99 -pedantic -Wall -Wextra -Wconversion -Wdouble-promotion -Wshadow -Werror -ffp-contract=off -Iinclude -Isrc'
    for mask in 1 2 4 8 16 32 64; do
        # shellcheck disable=SC2086
        quiet "TYN_LEAVE_OUT=$mask compiles" "$CC" $strict -O1 -DTYN_LEAVE_OUT=$mask -fsyntax-only src/*.c src/*/*.c
    done
    lean="-O1 -DTYN_PLAIN_C -DTYN_LEAVE_OUT=63"
    quiet 'lean: builds' "$MAKE" -s B="$work/lean" CC="$CC" CFLAGS="$lean" "$work/lean/null" || return
    # shellcheck disable=SC2086
    quiet 'lean: the test builds' "$CC" $strict $lean -o "$work/lean/test" tests/lean/lean.c "$work/lean/libtyndall.a" -lm || return
    part "$work/lean/test"
    empty 'lean: the picture is the native one' "$([ "$("$work/lean/null" | grep -m 1 '^picture')" = "$native" ] || echo 'it is not')"
}

check_bare() {
    quiet 'the native picture' "$MAKE" -s B="$B" CC="$CC" CFLAGS="$CFLAGS" "$B/null" || return
    native=$("$B/null" | grep -m 1 '^picture')
    check_lean
    for board in m4:mps2-an386 m7:mps2-an500; do
        bare_port arm-m/${board%:*} arm-none-eabi-gcc qemu-system-arm &&
            bare ${board%:*} qemu-system-arm -M ${board#*:} -icount shift=0 -semihosting -nographic -kernel "$B/arm-m/${board%:*}.elf"
    done
    for bits in 32 64; do
        bare_port riscv/rv$bits riscv64-unknown-elf-gcc qemu-system-riscv$bits &&
            bare rv$bits qemu-system-riscv$bits -M virt -bios none -icount shift=0 -nographic -kernel "$B/riscv/rv$bits.elf"
    done
}

case ${1-null} in
null) check_null ;;
bare) check_bare ;;
esac
total
