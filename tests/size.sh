#!/bin/sh
# size.sh - what `make size` prints: bytes of text, data, bss and stack, of the whole library and of what links of it. Fails where
# data or bss are not 0, or a stack is above the goal.
#     post: tyn_measure, tyn_init and tyn_render; raster: its four calls
. tests/shell.sh

work=$B/size
post='tyn_measure tyn_init tyn_render'
raster='tyn_raster_measure tyn_raster_init tyn_raster_surface tyn_raster_shadow'
rm -rf "$work"
mkdir -p "$work"

# linked NAME SYMBOL...: what these need of the objects, as one object.
linked() {
    name=$1
    shift
    roots=
    for symbol in "$@"; do
        roots="$roots -u $symbol"
    done
    # shellcheck disable=SC2086
    ${tools}ld -r --gc-sections -e "$1" $roots -o "$work/$name.o" "$work"/objects/*.o
}

# row PART SYMBOL...: a line of the table; the stack is that of the deepest of the symbols.
row() {
    part=$1
    shift
    if ! linked "$part" "$@" >"$work/log" 2>&1; then
        fail "$title: $part links" - <"$work/log"
        return
    fi
    stack=$(echo "$@" | tr ' ' '\n' | awk 'NR == FNR { want[$1] = 1; next } $1 in want && $2 > most { most = $2 } END { print most + 0 }' \
        - "$work/proofs_calls/stack")
    # shellcheck disable=SC2046
    set -- $(${tools}size "$work/$part.o" | tail -n 1)
    printf '| %s | %s | %s | %s | %s | %s |\n' "$title" "$part" "$1" "$2" "$3" "$stack"
    empty "$title, $part: data and bss are 0" "$([ "$2$3" = 00 ] || echo "$2 $3")"
    empty "$title, $part: at most 4096 bytes of stack" "$([ "$stack" -le 4096 ] && [ "$stack" -gt 0 ] || echo "$stack")"
}

# config TITLE TOOLS FLAGS PART...: TOOLS is the prefix of the compiler's and its tools' names.
config() {
    title=$1 tools=$2 flags=$3
    shift 3
    if ! have "${tools}gcc"; then
        skip "$title: no ${tools}gcc"
        return
    fi
    mkdir -p "$work/objects"
    rm -f "$work"/objects/*
    for file in src/*.c src/*/*.c; do
        name=$(echo "${file#src/}" | tr / _)
        # shellcheck disable=SC2086
        ${tools}gcc -std=c99 -ffp-contract=off -fno-math-errno -ffunction-sections -fdata-sections $flags -Iinclude -Isrc -c \
            -o "$work/objects/${name%.c}.o" "$file" || fail "$title: $file compiles"
    done
    B=$work CC=${tools}gcc OPTIMISE=$flags sh tests/proofs_calls.sh >"$work/log" 2>&1 || fail "$title: its calls" - <"$work/log"
    for wanted in "$@"; do
        # shellcheck disable=SC2046,SC2086
        case $wanted in
        whole) row whole $(awk '{ print $1 }' "$work/proofs_calls/stack") ;;
        post) row post $post ;;
        raster) row raster $raster ;;
        esac
    done
}

echo '| configuration | part | text | data | bss | stack |'
echo '|---|---|---|---|---|---|'
case $(uname -m) in
x86_64)
    config 'x86-64 -O2' '' -O2 whole post raster
    config 'x86-64 -Os' '' -Os whole post raster
    config 'x86-64 -Os, plain C' '' '-Os -DTYN_PLAIN_C' whole post raster
    ;;
*) config "$(uname -m) -O2" '' -O2 whole post raster ;;
esac
thumb='-Os -mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16'
config 'Thumb-2 -Os' arm-none-eabi- "$thumb" whole post raster
config 'Thumb-2 -Os, one method, suns' arm-none-eabi- "$thumb -DTYN_LEAVE_OUT=63" post
config 'the same without quads' arm-none-eabi- "$thumb -DTYN_LEAVE_OUT=127" post
echo 'goals: text of shafts alone, Thumb-2 -Os, one method 24576; stack 4096; data and bss 0'
total
