#!/bin/sh
# proofs_install.sh - what a user does: installs, compiles the README's program against that, and against the two single files.
. tests/shell.sh

work=$(pwd)/$B/proofs_install
case $B in /*) work=$B/proofs_install ;; esac
stage=$work/stage
strict='-std=c99 -pedantic -Wall -Wextra -Wconversion -Wdouble-promotion -Wshadow -Werror'
version=$(sed -n 's/^#define TYN_VERSION "\(.*\)"/\1/p' include/tyndall.h)
rm -rf "$work"
mkdir -p "$work/single" "$work/installed"

parts=$(sed -n 's/^#define TYN_VERSION_\(MAJOR\|MINOR\|PATCH\) \([0-9]*\)$/\2/p' include/tyndall.h | tr '\n' . | sed 's/\.$//')
empty 'the version is the same in all macros' "$([ "$parts" = "$version" ] || echo "$parts and $version")"

quiet 'make install' "$MAKE" B="$B" CC="$CC" CFLAGS="$CFLAGS" DESTDIR="$stage" PREFIX=/usr/local install
for file in include/tyndall.h lib/libtyndall.a lib/pkgconfig/tyndall.pc bin/tyndall; do
    if [ -s "$stage/usr/local/$file" ]; then pass; else fail "installed: $file"; fi
done

# The first C block of the README.
awk '/^```c$/ { if (!done) inside = 1; next } /^```/ { if (inside) done = 1; inside = 0 } inside' README.md >"$work/program.c"
[ -s "$work/program.c" ] || fail 'README.md has a program'
if have pkg-config; then
    PKG_CONFIG_PATH=$stage/usr/local/lib/pkgconfig
    export PKG_CONFIG_PATH
    flags=$(pkg-config --define-variable=prefix="$stage/usr/local" --cflags --libs tyndall)
    empty 'pkg-config knows the version' "$([ "$(pkg-config --modversion tyndall)" = "$version" ] || pkg-config --modversion tyndall)"
else
    skip 'no pkg-config: its flags are written out'
    flags="-I$stage/usr/local/include -L$stage/usr/local/lib -ltyndall -lm"
fi
# shellcheck disable=SC2086
if quiet "the README's program compiles against what is installed" \
    $CC $strict $CFLAGS -o "$work/installed/program" "$work/program.c" $flags; then
    quiet "the README's program runs" sh -c "cd '$work/installed' && ./program >out"
fi

quiet 'make single' "$MAKE" B="$B" single
cp "$B/single/tyndall.h" "$B/single/tyndall.c" "$work/program.c" "$work/single/" 2>/dev/null
# Other compilers: check-all has a run of this script for each.
# shellcheck disable=SC2086
quiet 'the single file compiles' $CC $strict -O2 -c -o "$work/single/tyndall.o" "$work/single/tyndall.c"
# shellcheck disable=SC2086
if quiet "the README's program compiles with the two single files" sh -c \
    "cd '$work/single' && $CC $strict $CFLAGS -o program program.c tyndall.o -lm"; then
    quiet "the README's program runs with the two single files" sh -c "cd '$work/single' && ./program >out"
    for file in "$work"/installed/*; do
        [ "${file##*/}" = program ] && continue
        quiet "both programs write the same ${file##*/}" cmp "$file" "$work/single/${file##*/}"
    done
    empty "the README's program writes something" "$(find "$work/installed" -type f ! -name program -size +0 | grep -q . || echo nothing)"
fi

quiet 'make uninstall' "$MAKE" B="$B" DESTDIR="$stage" PREFIX=/usr/local uninstall
empty 'make uninstall leaves no file' "$(find "$stage" -type f)"
total
