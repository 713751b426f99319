#!/bin/sh
# wasm.sh - ports/wasm: the page is built, its frames are drawn in node and in headless Chromium, and each must have the hash of
# the same frame drawn by the native library. What a machine lacks is SKIPPED.
. tests/shell.sh
out=$B/wasm
mkdir -p "$out"

echo 'int f(int x) { return x; }' >"$out/can.c"
if ! have clang || ! clang --target=wasm32 -nostdlib -Wl,--no-entry -o "$out/can.wasm" "$out/can.c" 2>/dev/null; then
    skip 'the page: no clang with --target=wasm32, or no wasm-ld (Debian: clang, lld)'
    total
    exit
fi
quiet 'the page builds' "$MAKE" -s -j2 B="$B" wasm || { total; exit; }

# shellcheck disable=SC2046 # numbers
if ! "$out/native" $(sed -n 's/^[a-z][^ ]* *//p' ports/wasm/views.txt) >"$out/hashes" 2>"$out/native.log"; then
    fail 'the native program draws' "$(cat "$out/native.log")"
fi
if ! have node; then
    skip 'frames of the modules: no node (Debian: nodejs)'
    total
    exit
fi
part sh -c "node ports/wasm/check_node.mjs ports/wasm/views.txt '$out' scalar simd <'$out/hashes'"

chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome)
playwright=$out/npm/node_modules/playwright-core
if [ -z "$chromium" ] || ! have npm; then
    skip 'the page in a browser: no chromium, or no npm (Debian: chromium, npm)'
elif [ ! -d "$playwright" ] && ! npm install --prefix "$out/npm" --no-save --no-fund --no-audit playwright-core@1 >"$out/npm.log" 2>&1; then
    skip "the page in a browser: npm did not give playwright-core ($(tail -n 1 "$out/npm.log"))"
else
    part node ports/wasm/check_browser.mjs "$out" "$chromium" "$playwright" "$(head -n 1 "$out/hashes")"
fi
total
