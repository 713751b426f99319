#!/bin/sh
# tool.sh - the program as users and scripts meet it: exit statuses, messages, files that are whole or not there.
. tests/shell.sh

case $B in /*) work=$B/tool ;; *) work=$(pwd)/$B/tool ;; esac
case $B in /*) tyndall=$B/tyndall ;; *) tyndall=$(pwd)/$B/tyndall ;; esac
rm -rf "$work"
mkdir -p "$work"
cd "$work" || exit 1

cat >good.scene <<'SCENE'
tyndall-scene 1
image 64 48
camera position 0 2 8 target 0 1 0 fov_y 50 near 0.1 far 60
background 0.2 0.3 0.5
ambient 0.2 0.2 0.2
medium scatter 0.03 0.03 0.03 phase hg 0.5
light directional direction 1 -1 -0.3 irradiance 10 9 8
quad a -20 0 20 b 20 0 20 c -20 0 -20 albedo 0.5 0.5 0.5
box min -1 0 -1 max 1 3 1 albedo 0.6 0.5 0.4
SCENE

mkdir o

# Usage: status 2.
expect 'no command' 2 "$tyndall"
expect 'unknown command' 2 "$tyndall" paint
expect 'no scene' 2 "$tyndall" render -o o/a.png
expect 'no -o' 2 "$tyndall" render good.scene
says '-o is required' '-o'
expect 'two scenes' 2 "$tyndall" render good.scene good.scene -o o/a.png
expect 'no value' 2 "$tyndall" render good.scene -o
expect 'ending' 2 "$tyndall" render good.scene -o o/a.jpg
expect 'ending of --depth' 2 "$tyndall" render good.scene -o o/a.png --depth o/d.png
expect 'one name twice' 2 "$tyndall" render good.scene -o o/a.pfm --scatter o/a.pfm
for bad in '--size 0x9' '--size 10' '--size 10x' '--size 10x10x10' '--size 32769x1' '--size -1x1' '--method tree' \
    '--rays trees' '--steps 0' '--steps 4097' '--steps 1e2' '--slices 7' '--slices 65537' '--samples 1' \
    '--initial-step 3' '--initial-step 128' '--break 0' '--break 1.5' '--break x' '--break nan' '--shadow-size 0' \
    '--shadow-size 16385' '--preset best' '--threads 0' '--threads 65' '--threads two' '--exposure 0' '--exposure -1' \
    '--exposure inf' '--debug trees' '--gather ed' '--taps 2' '--taps 6' '--kernel box' '--downscale 3' \
    '--downscale 16' '--tolerance 0' '--tolerance 2' '--budget 0' '--at 3' '--at 3,' '--at -1,2' \
    '--bases 6' '--bases 132' '--weights none' '--columns 3' '--references 5' '--rectify none' '--splits 7' \
    '--isa mmx' '--frames 1-2' '--unknown' '-x'; do
    # shellcheck disable=SC2086
    expect "$bad" 2 "$tyndall" render good.scene -o o/a.png $bad && says "$bad is named" "${bad%% *}"
done
expect 'post' 2 "$tyndall" post -o o/a.png
says 'post is named' post
expect 'compare with one file' 2 "$tyndall" compare a.pfm
none 'bad usage writes nothing'

# Right usage.
expect '--help' 0 "$tyndall" --help
expect 'render --help' 0 "$tyndall" render --help
expect '--version' 0 "$tyndall" --version
expect 'info' 0 "$tyndall" info
empty 'info has the version and a memory line' "$(grep -q '^version ' out.txt && grep -q '^memory_handheld_320x240_bytes [0-9]' out.txt || cat out.txt)"
for ending in png ppm pfm rgb565 rgba; do
    expect "render to .$ending" 0 "$tyndall" render good.scene -o "o/a.$ending"
done
size() { wc -c <"$1" | tr -d ' '; }
empty 'sizes of raw pictures' "$([ "$(size o/a.rgba)" = 12288 ] && [ "$(size o/a.rgb565)" = 6144 ] && [ "$(size o/a.ppm)" = 9229 ] &&
    [ "$(size o/a.pfm)" = 36878 ] || ls -l o)"
expect 'all outputs and options' 0 "$tyndall" render good.scene -o o/b.pfm --scatter o/s.pfm --surface o/f.pfm --depth o/d.pfm \
    --size 40x30 --method epipolar --rays words --steps 50 --slices 128 --samples 100 --initial-step 8 --break 0.1 --tolerance 0.02 \
    --gather ed10 --taps 4 --kernel shepard --downscale 2 --budget 100 \
    --shadow-size 256 --preset balanced --threads 3 --exposure 2 --stats
for value in pixels slices culled samples breaks initial rays rays_percent walks columns looked looked_per_ray rejected corrected \
    memory_bytes shadow_ms surface_ms slice_ms gather_ms stage_sample_ms stage_row_ms stage_ray_ms stage_line_ms stage_unwarp_ms \
    stage_upscale_ms stage_correct_ms stage_composite_ms total_ms; do
    empty "--stats has $value" "$(grep -q "^$value [0-9.e+-]*\$" out.txt || cat out.txt)"
done
for method in march subsample none prefiltered hybrid; do
    expect "--method $method" 0 "$tyndall" render good.scene -o "o/$method.pfm" --method "$method" --rays steps
done
for debug in lines samples breaks sources scatter row tree rejected outside basis; do
    expect "--debug $debug" 0 "$tyndall" render good.scene -o "o/$debug.png" --debug "$debug"
done
expect '--rectify projective' 0 "$tyndall" render good.scene -o o/rect.png --method prefiltered --bases 16 --columns 64 \
    --references 2 --weights average --rectify projective --splits 2
expect '--debug row --at' 0 "$tyndall" render good.scene -o o/row2.png --debug row --at 3,40
empty 'another row' "$(cmp -s o/row.png o/row2.png && echo the same)"
for gather in shear ivb ed10; do
    for rays in words tree sweep columns; do
        expect "--gather $gather --rays $rays" 0 "$tyndall" render good.scene -o "o/$gather.$rays.pfm" --gather $gather --rays $rays
        quiet "--gather $gather --rays $rays: the bytes of words" cmp "o/$gather.words.pfm" "o/$gather.$rays.pfm"
    done
done
expect 'bench' 0 "$tyndall" bench --brief --bench-scene simple-on --size 96x54 --repeats 1 --shadow-size 128 --slices 64
for value in floor_ms march_500_ms shafts_ms shafts_2_threads_ms stage_row_ms stage_ray_ms stage_unwarp_ms rays_percent psnr_db max_8bit \
    memory_bytes raster_ms shadow_ms prefiltered_ms prefiltered_mean_l1; do
    empty "bench --brief has $value" "$(grep -q "^$value [0-9.e+-]*\$" out.txt || cat out.txt)"
done
expect 'threads 1' 0 "$tyndall" render good.scene -o o/t1.pfm --threads 1
expect 'threads 5' 0 "$tyndall" render good.scene -o o/t5.pfm --threads 5
quiet 'any number of threads gives the same bytes' cmp o/t1.pfm o/t5.pfm
quiet '.pfm is the same again' cmp o/a.pfm o/t1.pfm
expect 'exposure 1' 0 "$tyndall" render good.scene -o o/e1.pfm --exposure 1
quiet '.pfm has exposure 1 unless one is given' cmp o/a.pfm o/e1.pfm
cp good.scene 'a scene with blänks.scene'
expect 'names with blanks and UTF-8' 0 "$tyndall" render 'a scene with blänks.scene' -o 'o/a picture, ünïcödé.png'
empty 'that file is there' "$([ -s 'o/a picture, ünïcödé.png' ] || ls o)"
cp good.scene ./-dash.scene
expect 'a name that starts with a dash' 0 "$tyndall" render -o o/dash.png -- -dash.scene
cp o/a.png o/behind.png
ln -s behind.png o/link.png
expect 'through a link' 0 "$tyndall" render good.scene -o o/link.png --exposure 3
empty 'the link is still one' "$([ -h o/link.png ] || ls -l o)"
if [ -p /dev/stdin ] || [ -e /dev/stdin ]; then
    # shellcheck disable=SC2002
    empty 'a scene from a pipe' "$(cat good.scene | "$tyndall" render /dev/stdin -o o/pipe.png 2>&1)"
fi
empty 'no temporary files' "$(ls -A o | grep part)"
if have python3; then
    if said=$(python3 - o/a.png o/a.ppm <<'PYTHON' 2>&1
import struct, sys, zlib
data = open(sys.argv[1], 'rb').read()
assert data[:8] == b'\x89PNG\r\n\x1a\n'
at, idat = 8, b''
while at < len(data):
    n, name = struct.unpack('>I4s', data[at:at + 8])
    body = data[at + 8:at + 8 + n]
    assert struct.unpack('>I', data[at + 8 + n:at + 12 + n])[0] == zlib.crc32(name + body)
    if name == b'IHDR':
        w, h, depth, kind = struct.unpack('>IIBB', body[:10])
        assert (depth, kind) == (8, 2)
    idat += body if name == b'IDAT' else b''
    at += 12 + n
raw, row = zlib.decompress(idat), 3 * w
assert len(raw) == (row + 1) * h
above, rows = bytes(row), b''
for y in range(h):
    line = bytearray(raw[y * (row + 1):(y + 1) * (row + 1)])
    kind, line = line[0], line[1:]
    for x in range(row):
        a, b, c = line[x - 3] if x > 2 else 0, above[x], above[x - 3] if x > 2 else 0
        p = a + b - c
        best = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
        line[x] = (line[x] + (0, a, b, (a + b) // 2, best)[kind]) & 255
    above, rows = line, rows + bytes(line)
assert open(sys.argv[2], 'rb').read() == b'P6\n%d %d\n255\n' % (w, h) + rows
PYTHON
    ); then pass; else fail 'another decoder reads the PNG, and finds the PPM' "$said"; fi
else
    skip 'no python3 to read the PNG'
fi

# compare
expect 'compare' 0 "$tyndall" compare o/a.pfm o/a.pfm
empty 'equal pictures' "$(grep -q '^relative_l1 0$' out.txt && grep -q '^psnr_db inf$' out.txt || cat out.txt)"
expect 'compare two sizes' 1 "$tyndall" compare o/a.pfm o/b.pfm
expect 'compare colour and depth' 1 "$tyndall" compare o/b.pfm o/d.pfm
expect 'compare with no such file' 1 "$tyndall" compare o/a.pfm none.pfm
printf 'Pf\n2 1\n-1.0\n\000\000\200\077\000\000\300\177' >nan.pfm
printf 'Pf\n2 2\n-1.0\n\000\000\200\077\000\000\000\100\000\000\200\077\000\000\200\077' >one.pfm
printf 'Pf\n2 2\n1.0\n\077\200\000\000\100\100\000\000\077\200\000\000\077\200\000\000' >two.pfm
expect 'compare with NaN' 1 "$tyndall" compare nan.pfm nan.pfm
expect 'compare both byte orders' 0 "$tyndall" compare two.pfm one.pfm
printf 'relative_l1 0.2\nrmse 0.5\npsnr_db 12.0412\nmax_error 1\nmax_at 1 1 0\n' >want.txt
quiet 'compare gives the right figures' diff want.txt out.txt
rm -rf o
mkdir o

# Bad input: status 1, a message, no file.
expect 'no such scene' 1 "$tyndall" render none.scene -o o/a.png
says 'the missing scene is named' none.scene
expect 'a folder as scene' 1 "$tyndall" render . -o o/a.png
sed 's/^box.*/box min 0 0 0 max 1 1 nan albedo 1 1 1/' good.scene >bad.scene
expect 'a bad scene' 1 "$tyndall" render bad.scene -o o/a.png --depth o/d.pfm
says 'file, line and token' "bad.scene:9: 'nan'"
{ cat good.scene; echo 'light point position 0 1 0 intensity 1 1 1'; } >point.scene
expect 'a point light' 0 "$tyndall" render point.scene -o point.png --shadow-size 128
expect 'no such folder' 1 "$tyndall" render good.scene -o o/no/a.png
says 'the output is named' o/no/a.png
expect 'one of two outputs fails' 1 "$tyndall" render good.scene -o o/a.png --depth o/no/d.pfm
none 'bad input writes nothing'
mkdir o/dir.png
expect 'a folder with a picture'"'"'s name' 1 "$tyndall" render good.scene -o o/dir.png
rmdir o/dir.png
echo precious >o/a.png
expect 'a failed run' 1 "$tyndall" render bad.scene -o o/a.png
empty 'a failed run keeps the old file' "$([ "$(cat o/a.png)" = precious ] || ls -l o)"
rm o/a.png
if [ -e /dev/full ]; then
    ln -s /dev/full o/full.png
    expect 'a full disk' 1 "$tyndall" render good.scene -o o/full.png --depth o/d.pfm
    says 'the full disk is named' 'No space left'
    rm o/full.png
    none 'a full disk leaves nothing'
    "$tyndall" --help >/dev/full 2>err.txt
    empty 'a full stdout is an error' "$([ $? -ne 0 ] && [ -s err.txt ] || echo 'status 0')"
else
    skip 'no /dev/full'
fi
if (ulimit -f 8) 2>/dev/null; then
    (ulimit -f 8 && "$tyndall" render good.scene -o o/a.png --size 400x300 2>err.txt)
    empty 'a file too large for its limit is an error' "$([ $? -eq 1 ] && grep -q "can't be written" err.txt || cat err.txt)"
    none 'that leaves nothing'
fi
"$tyndall" render good.scene -o o/a.ppm --stats >&- 2>&-
empty 'closed streams: a status, and no statistics in the picture' "$([ $? -eq 1 ] && [ "$(wc -c <o/a.ppm)" -eq 9229 ] || echo "$?")"
rm -f o/a.ppm
chmod 555 o
if touch o/probe 2>/dev/null; then
    rm -f o/probe
    skip 'this user writes everywhere: no unwritable folder'
else
    expect 'an unwritable folder' 1 "$tyndall" render good.scene -o o/a.png
    says 'permission' 'Permission denied'
fi
chmod 755 o
"$tyndall" render good.scene -o o/a.png --size 2000x2000 --method march --rays steps --steps 4096 --threads 1 &
job=$!
sleep 0.5
kill -TERM $job 2>/dev/null
wait $job 2>/dev/null
none 'a killed run leaves nothing'

cd - >/dev/null || exit 1
rm -rf "$work"
total
