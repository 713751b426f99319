#!/bin/sh
# post.sh - tyndall post: the same picture as render from its parts, other people's conventions, errors, frames of real cameras.
. tests/shell.sh

top=$(pwd)
case $B in /*) work=$B/post ;; *) work=$top/$B/post ;; esac
case $B in /*) tyndall=$B/tyndall ;; *) tyndall=$top/$B/tyndall ;; esac
: "${TYN_SHARED:=$top/../shared}"
rm -rf "$work"
mkdir -p "$work"
cd "$work" || exit 1
mkdir o

# same NAME SCENE [OPTION...]: what post makes of a rendered frame is what render made of the scene.
same() {
    name=$1 scene=$2
    shift 2
    rm -rf o
    mkdir o
    expect "$name: render" 0 "$tyndall" render "$scene" -o o/a.pfm --scatter o/as.pfm --frame o/P "$@" || return
    for ending in pfm png; do
        expect "$name: post to .$ending" 0 "$tyndall" post o/P.frame -o "o/b.$ending" --scatter o/bs.pfm
    done
    "$tyndall" render "$scene" -o o/a.png "$@"
    quiet "$name: the same .pfm" cmp o/a.pfm o/b.pfm
    quiet "$name: the same scattered light" cmp o/as.pfm o/bs.pfm
    quiet "$name: the same .png" cmp o/a.png o/b.png
}

# One light of each kind, textures and several media.
printf 'P3\n2 2\n255\n255 0 0  0 255 0  0 0 255  255 255 255\n' >slide.ppm
printf 'P3\n3 1\n1000\n1000 500 0  20 1000 0  0 7 999\n' >gobo.ppm
cat >all.scene <<'SCENE'
tyndall-scene 1
image 96 64
camera position 0.3 2 8 target 0 1.1 0 fov_y 50 near 0.1 far 60
background 0.2 0.3 0.5
ambient 0.2 0.2 0.2
medium scatter 0.03 0.03 0.04 phase hg 0.5
medium scatter 0.01 0.01 0.01 absorb 0.002 0.001 0 phase rayleigh
light directional direction 1 -1 -0.3 irradiance 10 9 8 texture gobo.ppm extent 7 9 up 0 1 0.1
light directional direction -0.4 -1 -0.35 irradiance 3 3 2
light spot position -3 4 1 target 0.1 0 0.3 angle 47.3 intensity 90 80 50
light spot position 3 4 2 target 0.1 0 0.3 angle 61 intensity 50 80 90 texture slide.ppm up 0.1 1 0
light point position 0.2 2.2 3 intensity 12 10 8
quad a -20 0 20 b 20 0 20 c -20 0 -20 albedo 0.5 0.5 0.5
box min -1 0 -1 max 1 3 1 albedo 0.6 0.5 0.4
box min -2.2 0 1 max -1.9 1.5 2 albedo 0.6 0.5 0.4
SCENE
same 'all lights' all.scene --shadow-size 128
quiet 'any number of threads' "$tyndall" post o/P.frame -o o/c.pfm --threads 3
quiet 'any number of threads: the same' cmp o/b.pfm o/c.pfm
same 'one light, another size' all.scene --shadow-size 100 --size 70x81
{ sed '/^light/d' all.scene; echo 'light directional direction -0.4 -1 -0.35 irradiance 3 3 2'; } >sun.scene
same 'one light' sun.scene --shadow-size 256

# A frame is files and text: without its folder, from elsewhere, with an exposure.
expect 'a frame in this folder' 0 "$tyndall" render sun.scene -o a.pfm --frame sun --shadow-size 64
expect 'that frame' 0 "$tyndall" post -o b.pfm -- sun.frame
quiet 'the same again' cmp a.pfm b.pfm
for method in epipolar march subsample none; do
    expect "$method: render" 0 "$tyndall" render sun.scene -o o/m.pfm --method "$method" --shadow-size 64 --exposure 3 --rays steps
    expect "$method: post" 0 "$tyndall" post sun.frame -o o/n.pfm --method "$method" --exposure 3 --rays steps --stats
    quiet "$method: the same" cmp o/m.pfm o/n.pfm
done
empty '--stats' "$(grep -q '^rays ' out.txt || cat out.txt)"
if [ -r "$TYN_SHARED/reference/05_stained.scene" ]; then
    for scene in 01_pillars 02_grating 05_stained 07_cage 08_terrain; do
        same "$scene" "$TYN_SHARED/reference/$scene.scene" --size 120x68 --shadow-size 256
    done
else
    skip 'no reference scenes'
fi

# Other people's conventions: the same frame in other formats gives the same picture, but for their rounding.
cat >variants.py <<'PYTHON'
import struct, sys

def load(name):
    with open(name, 'rb') as f:
        kind, size, _ = f.readline(), f.readline(), f.readline()
        w, h = map(int, size.split())
        n = 3 if kind[1:2] == b'F' else 1
        v = struct.unpack('<%df' % (w * h * n), f.read())
    return w, h, [v[w * n * (h - 1 - y) + x] for y in range(h) for x in range(w * n)]

def pfm(name, w, h, values, order='<'):
    with open(name, 'wb') as f:
        f.write(b'%s\n%d %d\n%s\n' % (b'Pf' if len(values) == w * h else b'PF', w, h, b'-1.0' if order == '<' else b'1.0'))
        n = len(values) // h
        for y in reversed(range(h)):
            f.write(struct.pack('%s%df' % (order, n), *values[n * y:n * y + n]))

def pnm(name, w, h, values):
    with open(name, 'wb') as f:
        f.write(b'%s\n%d %d\n65535\n' % (b'P5' if len(values) == w * h else b'P6', w, h))
        f.write(struct.pack('>%dH' % len(values), *[max(0, min(65535, int(v + 0.5))) for v in values]))

lines = open('sun.frame').read().split('\n')
def take(word):
    return [l for l in lines if l.startswith(word)][0].split()
def write(name, **changed):
    with open(name + '.frame', 'w') as f:
        for l in lines:
            f.write(changed.get(l.split(' ')[0], l) + '\n')

camera = take('camera')
def key(name, n):
    i = camera.index(name) + 1
    return [float(x) for x in camera[i:i + n]]
pos, right, up, forward, (l, r, b, t), (near,), (far,) = (key(*k) for k in (
    ('position', 3), ('right', 3), ('up', 3), ('forward', 3), ('window', 4), ('near', 1), ('far', 1)))
rows = [right, up, [-x for x in forward]]
view = [x for q in rows for x in q + [-sum(a * c for a, c in zip(q, pos))]] + [0, 0, 0, 1]
proj = [2 / (r - l), 0, (r + l) / (r - l), 0, 0, 2 / (t - b), (t + b) / (t - b), 0,
        0, 0, -(far + near) / (far - near), -2 * far * near / (far - near), 0, 0, -1, 0]
nine = lambda v: ' '.join('%.9g' % x for x in v)
write('matrices', camera='camera view %s projection %s near %.9g far %.9g' % (nine(view), nine(proj), near, far))
w, h, z = load('sun.depth.pfm')
fx, fy = w / (r - l), h / (t - b)
write('pinhole', camera=' '.join(camera[:camera.index('window')]) + ' pinhole %.9g %.9g %.9g %.9g near %.9g far %.9g'
      % (fx, fy, -l * fx, t * fy, near, far))
pfm('z_mm.pfm', w, h, [1000 * v for v in z], '>')
write('millimetres', depth='depth z_mm.pfm scale 0.001 coding view')
pnm('z.pgm', w, h, [1000 * v if v < far * 0.999 else 0 for v in z])
write('counts', depth='depth z.pgm scale 0.001 sky 0')
ray = [(1 + (l + (x + .5) / w * (r - l)) ** 2 + (t + (y + .5) / h * (b - t)) ** 2) ** .5 for y in range(h) for x in range(w)]
pfm('distance.pfm', w, h, [v * k for v, k in zip(z, ray)])
write('distance', depth='depth distance.pfm coding distance')
gl = [(1 / near - 1 / v) / (1 / near - 1 / far) * 2 - 1 for v in z]
pfm('gl.pfm', w, h, gl)
write('gl', depth='depth gl.pfm coding projected at -1 1')
pfm('inf.pfm', w, h, [0.25 / v for v in z])
write('reversed', depth='depth inf.pfm coding projected at 1 0 planes 0.25 0')
pnm('reversed.pgm', w, h, [65535 * 0.25 / v for v in z])
write('reversed16', depth='depth reversed.pgm coding projected at 1 0 planes 0.25 0')
for v, c in (('fill_gl', 'gl.pfm coding projected at -1 1'), ('fill_distance', 'distance.pfm coding distance'),
             ('fill_reversed', 'inf.pfm coding projected at 1 0 planes 0.25 0')):
    write(v, depth='depth %s unknown 12345' % c)
_, _, c = load('sun.colour.pfm')
top = max(c)
pnm('c.ppm', w, h, [65535 * v / top for v in c])
pnm('srgb.ppm', w, h, [65535 * (1.055 * (v / top) ** (1 / 2.4) - 0.055 if v / top > 0.0031308 else 12.92 * v / top)
                       for v in c])
pfm('c.pfm', w, h, [v / top for v in c])
write('linear', colour='colour c.ppm linear')
write('srgb', colour='colour srgb.ppm')
write('one', colour='colour c.pfm')
shadow = take('shadow')
n, _, map = load(shadow[1])
matrix = [float(x) for x in shadow[3:19]]
pnm('map.pgm', n, n, [65535 * v for v in map])
write('map16', shadow='shadow map.pgm matrix ' + nine(matrix))
turned = matrix[:8] + [d - c for c, d in zip(matrix[8:12], matrix[12:])] + matrix[12:]
pfm('map.pfm', n, n, [1 - v for v in map])
write('map_forward', shadow='shadow map.pfm coding projected at 0 1 matrix ' + nine(turned))
write('map_linear', shadow='shadow map.pfm coding linear at 0 1 matrix ' + nine(turned))
PYTHON
# near NAME FRAME TRUTH LIMIT: post's picture of FRAME is within a relative L1 of TRUTH.
near() {
    if expect "$1" 0 "$tyndall" post "$2" -o o/v.pfm --scatter o/vs.pfm; then
        empty "$1: the same picture" "$("$tyndall" compare o/v.pfm "$3" | awk -v limit="$4" '$1 == "relative_l1" && !($2 <= limit)')"
    fi
}
if have python3; then
    quiet 'variants' python3 variants.py
    "$tyndall" post sun.frame -o o/truth.pfm
    "$tyndall" post one.frame -o o/one.pfm
    for v in matrices pinhole millimetres distance gl reversed map_forward map_linear fill_gl fill_distance fill_reversed; do
        near "$v" $v.frame o/truth.pfm 0.0005
    done
    for v in counts reversed16 map16; do
        near "$v" $v.frame o/truth.pfm 0.004
    done
    near linear linear.frame o/one.pfm 0.0002
    near srgb srgb.frame o/one.pfm 0.0002
else
    skip 'no python3 to write other formats'
fi

# Art, and holes: an unknown pixel in a smooth floor gets the depth around it.
printf 'Pf\n8 8\n-1.0\n' >flat.pfm
printf 'Pf\n8 8\n-1.0\n' >holes.pfm
i=0
while [ $i -lt 64 ]; do
    printf '\000\000\200\100' >>flat.pfm
    case $i in 9 | 10 | 18 | 27 | 28 | 36 | 63) printf '\000\000\000\000' >>holes.pfm ;; *) printf '\000\000\200\100' >>holes.pfm ;; esac
    i=$((i + 1))
done
cat >flat.frame <<'FRAME'
tyndall-frame 1
image 8 8
depth flat.pfm
camera position 0 0 0 target 0 0 -1 fov_y 60 near 0.1 far 20
medium scatter 0.1 0.1 0.1 phase isotropic
light point position 0 1 -2 intensity 5 5 5
FRAME
sed 's/flat.pfm/holes.pfm zero-unknown/' flat.frame >holes.frame
expect 'flat' 0 "$tyndall" post flat.frame -o o/flat.pfm
expect 'holes' 0 "$tyndall" post holes.frame -o o/holes.pfm
near 'unknown depth leaves no mark' holes.frame o/flat.pfm 0.00001
{ cat flat.frame; echo 'shadow depth size 64 thickness 0.1'; } >own.frame
near 'a flat wall has nothing behind it to shade' own.frame o/flat.pfm 0.02
sed 's/intensity 5 5 5/& scale 0/' flat.frame >dark.frame
expect 'scale 0' 0 "$tyndall" post dark.frame -o o/dark.pfm
expect 'no method' 0 "$tyndall" post flat.frame -o o/none.pfm --method none
quiet 'scale 0 is no light' cmp o/dark.pfm o/none.pfm
{ cat flat.frame; echo 'art shaft_contrast 0 fog_scale 0 max_distance 3'; } >art.frame
expect 'art' 0 "$tyndall" post art.frame -o o/art.pfm

# Bad usage.
rm -rf o
mkdir o
for bad in '' 'flat.frame flat.frame' 'flat.frame --size 8x8' 'flat.frame --surface o/s.pfm' 'flat.frame --depth o/d.pfm' \
    'flat.frame --frame o/f' 'flat.frame --gather ed'; do
    # shellcheck disable=SC2086
    expect "post $bad" 2 "$tyndall" post -o o/a.png $bad
done
for bad in o/ 'o/a b' 'o/#'; do
    expect "--frame '$bad'" 2 "$tyndall" render sun.scene -o o/a.png --frame "$bad"
done
expect '--frame over -o' 2 "$tyndall" render sun.scene -o o/a.depth.pfm --frame o/a
expect 'post --help' 0 "$tyndall" post --help
empty 'post --help knows the directives' "$(grep -q 'shadow depth' out.txt || cat out.txt)"

# Bad input: status 1, file, line and token, no file. A line of a good frame is replaced, or one is added.
# blame TEXT NAME: bad.frame fails, and the message holds TEXT.
blame() {
    expect "bad: $2" 1 "$tyndall" post bad.frame -o o/a.png --scatter o/s.pfm
    if grep -F -q -- "$1" err.txt; then pass; else fail "the message of $2" - <err.txt; fi
}
# bad TEXT SED
bad() {
    sed "$2" flat.frame >bad.frame
    blame "$1" "$2"
}
# more TEXT LINES: after the last one.
more() {
    { cat flat.frame; printf '%b\n' "$2"; } >bad.frame
    blame "$1" "$2"
}
printf 'P5\n8 8\n255\n' >eight.pgm
i=0
while [ $i -lt 64 ]; do printf 'A' >>eight.pgm; i=$((i + 1)); done
bad "bad.frame:1: 'tyndall-scene'" 's/tyndall-frame/tyndall-scene/'
bad "bad.frame:1: '2'" 's/frame 1/frame 2/'
bad "'image': missing" '/^image/d'
bad "'depth': missing" '/^depth/d'
bad "'camera': missing" '/^camera/d'
more "bad.frame:7: 'quad': unknown directive" 'quad a 0 0 0'
more "bad.frame:7: 'tyndall-frame': given twice" 'tyndall-frame 1'
more "bad.frame:7: 'depth': given twice" 'depth flat.pfm'
bad "bad.frame:2: 'image'" 's/^image 8 8/image 8/'
bad "'flat.pfm': is 8 x 8 pixels" 's/^image 8 8/image 8 9/'
bad "none.pfm" 's/flat.pfm/none.pfm/'
bad "bad.frame:3: 'flat.pfm'" '3s/$/ /;s/depth flat/colour flat/'
bad "'nan'" 's/flat.pfm/flat.pfm scale nan/'
bad "'depths'" 's/flat.pfm/flat.pfm coding depths/'
bad "'scale': does not go with" 's/flat.pfm/flat.pfm coding projected scale 2/'
bad "'at': does not go with" 's/flat.pfm/flat.pfm at 0 1/'
bad "'at': must be two" 's/flat.pfm/flat.pfm coding projected at 1 1/'
bad "'planes': the near" 's/flat.pfm/flat.pfm coding projected planes 2 1/'
bad "'zero-unknown'" 's/flat.pfm/flat.pfm unknown 0 zero-unknown/'
bad "maxval of 255" 's/flat.pfm/eight.pgm coding projected/'
bad "'fov_y': does not go with 'right'" 's/fov_y/right 1 0 0 up 0 1 0 forward 0 0 -1 fov_y/;s/target 0 0 -1//'
bad "missing key 'forward'" 's/target.*/right 1 0 0 up 0 1 0 window -1 1 -1 1 near 1 far 2/'
bad "'window' or 'pinhole'" 's/target.*/right 1 0 0 up 0 1 0 forward 0 0 -1 near 1 far 2/'
bad "focal lengths" 's/target.*/right 1 0 0 up 0 1 0 forward 0 0 -1 near 1 far 2 pinhole 0 1 2 2/'
bad "TYN_E_CAMERA" 's/target.*/right 1 0 0 up 1 1 0 forward 0 0 -1 near 1 far 2 pinhole 1 1 2 2/'
bad "missing key 'projection'" 's/position.*target.*/view 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 near 1 far 2/'
bad "no camera's" 's/position.*target.*/view 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 projection 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 0 near 1 far 2/'
bad "'far'" 's/far 20/far 0.1/'
bad "'target' or 'direction'" 's/light point/light spot angle 40/'
bad "'maybe'" 's/intensity 5 5 5/& outside maybe/'
bad "'shadow': comes before" 's/^light.*/shadow flat.pfm/'
more "missing key 'matrix'" 'shadow flat.pfm'
more "'size'" 'shadow depth size 1.5'
more "'shadow': this light" 'shadow depth\nshadow depth'
more "'bias'" 'shadow flat.pfm matrix 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 bias 65'
more "'matrix': is not invertible" 'shadow flat.pfm matrix 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 0'
more "'-1'" 'art fog_scale -1'
empty 'bad input writes nothing' "$(ls -A o)"

# Frames of depth cameras.
for frame in "$top"/ports/posix/examples/*.frame; do
    name=$(basename "$frame" .frame)
    sed "s|\.\./\.\./\.\./\.\./shared|$TYN_SHARED|" "$frame" >"$name.frame"
    if [ -r "$(awk '$1 == "depth" { print $2 }' "$name.frame")" ]; then
        expect "$name" 0 "$tyndall" post "$name.frame" -o "o/$name.png" --preset handheld --shadow-size 256
    else
        skip "no data for $name"
    fi
done

cd "$top" || exit 1
rm -rf "$work"
total
