#!/bin/sh
# faults.sh - the tool where its surroundings fail: strange names, pipes without an end, full disks, signals, no memory, hostile files.
# Each time a message that names the file, the right status, and no half file.
. tests/shell.sh

case $B in /*) ;; *) B=$(pwd)/$B ;; esac
work=$B/faults tyndall=$B/tyndall tests=$(pwd)/tests
rm -rf "$work"
mkdir -p "$work"
cd "$work" || exit 1
mkdir o

cat >good.scene <<'SCENE'
tyndall-scene 1
image 32 24
camera position 0 2 8 target 0 1 0 fov_y 50 near 0.1 far 60
background 0.2 0.3 0.5
medium scatter 0.03 0.03 0.03 phase hg 0.5
light directional direction 1 -1 -0.3 irradiance 10 9 8
quad a -20 0 20 b 20 0 20 c -20 0 -20 albedo 0.5 0.5 0.5
box min -1 0 -1 max 1 3 1 albedo 0.6 0.5 0.4
SCENE
small='--shadow-size 64 --threads 2'

render() {
    # shellcheck disable=SC2086
    "$tyndall" render "$@" $small
}

# none NAME: nothing is left in the folder `o`.
none() {
    left=$(ls -A o)
    empty "$1" "$left"
    rm -rf o
    mkdir o
}

repeated() { # TEXT COUNT
    awk -v text="$1" -v count="$2" 'BEGIN { while (count--) printf "%s", text }'
}

# ---- names ----

escape=$(printf '\033[31m\233\302\233\007')
plain() { # NAME: no control characters in the last message.
    empty "$1: a message without control characters" "$(tr -d '\n' <err.txt | tr -dc '\000-\037\177\233' | od -c | sed '$d')"
}
expect 'a scene with escapes in its name' 1 render "no$escape.scene" -o o/a.png
says 'what of it can be shown' "no?[31m"
plain 'scene'
expect 'an option with escapes' 2 render good.scene -o "o/a$escape"
plain 'option'
expect 'a command with escapes' 2 "$tyndall" "x$escape"
plain 'command'
expect 'compare with escapes' 1 "$tyndall" compare "$escape.pfm" b.pfm
plain 'compare'
printf 'tyndall-scene 1\nmesh no%s.obj\n' "$escape" >escape.scene
expect 'a mesh with escapes' 1 render escape.scene -o o/a.png
plain 'mesh'
expect 'a name in UTF-8' 1 render 'nö ☀ 𝄞.scene' -o o/a.png
says 'is shown as it is' 'nö ☀ 𝄞.scene: '
for arguments in "render '' -o o/a.png" "post '' -o o/a.png" "compare '' ''"; do
    expect "an empty name: $arguments" 1 eval "\"\$tyndall\" $arguments"
    says "shown as '': $arguments" "'': can't be read: No such file"
done
for arguments in "render good.scene -o ''" "render good.scene -o o/a.png --depth ''" "render good.scene -o o/a.png --frame ''" \
    "showcase ''" "''"; do
    expect "an empty name: $arguments" 2 eval "\"\$tyndall\" $arguments"
done
long=$(repeated a 250)
expect 'a long path' 1 render "$long/$long/$long/none.scene" -o o/a.png
says 'its end is shown' "$long/none.scene: can't be read: "
printf 'tyndall-scene 1\nmesh m.obj\n' >long.scene
printf 'mtllib %s/m.mtl\n' "$(repeated ./ 300)" >m.obj
printf 'newmtl m\nmap_Kd %s/none.ppm\n' "$(repeated ./ 600)" >m.mtl
expect 'long paths through three files' 1 render "$(repeated ./ 600)long.scene" -o o/a.png
says 'what is wrong is told' "none.ppm: can't be read: No such file"
none 'bad names write nothing'

cd "$tests/.." || exit 1
rm -rf "$work"
total
