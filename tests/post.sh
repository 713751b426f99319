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

# expect NAME STATUS COMMAND...: the exit status, and a message where it is not 0.
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
        same "$scene" "$TYN_SHARED/reference/$scene.scene" --shadow-size 512
    done
else
    skip 'no reference scenes'
fi

cd "$top" || exit 1
rm -rf "$work"
total
