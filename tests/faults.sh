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

# repeated TEXT COUNT
repeated() {
    awk -v text="$1" -v count="$2" 'BEGIN { while (count--) printf "%s", text }'
}

# ---- the tool with a file in some role ----

texts='scene frame mesh library' pictures='texture mask slide depth colour compare'

# as ROLE FILE: runs the tool with the file in that role.
as() {
    case $1 in
    mesh) line="mesh $2" ;;
    slide) line="light spot position 0 9 0 target 0 0 1 angle 20 intensity 1 1 1 texture $2" ;;
    library) line='mesh library.obj' && echo "mtllib $2" >library.obj ;;
    texture | mask)
        line="mesh $1.obj" && echo "mtllib $1.mtl" >"$1.obj"
        case $1 in texture) printf 'newmtl m\nmap_Kd %s\n' "$2" ;; *) printf 'newmtl m\nmap_d %s\n' "$2" ;; esac >"$1.mtl"
        ;;
    depth | colour) printf 'tyndall-frame 1\nimage 2 1\n%s %s\n' "$1" "$2" >"$1.frame" ;;
    esac
    case $1 in
    scene) render "$2" -o o/a.png ;;
    frame) "$tyndall" post "$2" -o o/a.png ;;
    compare) "$tyndall" compare "$2" "$2" ;;
    depth | colour) "$tyndall" post "$1.frame" -o o/a.png ;;
    *) { cat good.scene && echo "$line"; } >"$1.scene" && render "$1.scene" -o o/a.png ;;
    esac
}

fed() {
    cat /dev/zero 2>/dev/null | as "$@"
}

# refused FILE TEXT ROLE...: in each role (by fed, if $by says so) a message that names the file and says TEXT.
refused() {
    file=$1 text=$2
    shift 2
    for role; do
        expect "$file as $role" 1 "${by:-as}" "$role" "$file" && says "$file as $role is named" "$file" &&
            says "$file as $role: '$text'" "$text"
    done
}

# ---- what takes seconds, while the rest goes on ----

# apart NAME COMMAND...: in a folder of its own, in the background.
apart() {
    mkdir -p "apart/$1/o"
    cp good.scene "apart/$1"
    (
        cd "apart/$1" || exit
        shift
        "$@" >out.txt 2>err.txt
        echo $? >status
    ) &
}

# ended NAME STATUS TEXT: how that went.
ended() {
    cp "apart/$1/err.txt" err.txt
    empty "$1: status $2" "$([ "$(cat "apart/$1/status")" = "$2" ] || cat "apart/$1/status" err.txt)"
    says "$1: '$3'" "$3"
    empty "$1: leaves nothing" "$(ls -A "apart/$1/o")"
}

silent() { # ROLE
    mkfifo fifo && as "$1" fifo
}

unread() {
    mkfifo fifo.png && render good.scene -o fifo.png --depth o/d.pfm
}

endless() { # TEXT ROLE
    yes "$1" 2>/dev/null | as "$2" /dev/stdin
}

if have mkfifo; then
    for role in $texts $pictures; do
        apart "$role" silent "$role"
    done
    apart output unread
fi
[ -r /dev/stdin ] && have yes && apart text endless '#' scene && apart picture endless P6 compare

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

# ---- input ----

mkdir folder
: >empty
printf 'P6\n9 9\n255\nshort' >short.ppm
printf 'P5\n9 9\n255\nshort' >short.pgm
printf 'PF\n9 9\n-1\nshort' >short.pfm
printf 'P6\n32768 32768\n65535\nshort' >claims.ppm # 6 GB
printf 'P5\n32768 32768\n65535\nshort' >claims.pgm
printf 'PF\n32768 32768\n-1\nshort' >claims.pfm
# shellcheck disable=SC2086
{
    refused none "can't be read: No such file" $texts $pictures
    refused folder 'is a folder' $texts $pictures
    refused empty missing scene frame
    refused empty 'is not a P' $pictures
    for input in short claims; do
        refused $input.ppm 'shorter than its header says' texture slide colour
        refused $input.pgm 'shorter than its header says' mask depth
        refused $input.pfm 'shorter than its header says' depth colour compare
    done
    if [ -c /dev/zero ] && [ -r /dev/stdin ]; then
        refused /dev/zero 'is not a file' $texts $pictures
        by=fed refused /dev/stdin 'a NUL byte: this is not a text file' $texts
        by=fed refused /dev/stdin 'is not a P' $pictures
    else
        skip 'no /dev/zero'
    fi
    if dd if=empty of=holes bs=1 count=0 seek=68719476736 2>/dev/null && [ -s holes ]; then # 64 GB, and nobody reads them
        refused holes 'a NUL byte: this is not a text file' $texts
        refused holes 'is not a P' $pictures
    else
        skip 'no files with holes'
    fi
    chmod 0 empty
    if [ -r empty ]; then skip 'this user reads everything'; else refused empty 'Permission denied' $texts $pictures; fi
    chmod 644 empty
}
expect 'an empty mesh' 0 as mesh empty
expect 'an empty library' 0 as library empty
for face in '2000000000 1 2' '4294967297 1 2' '-4 1 2' '1 2 99999999999999999999' '1/2147483646 2/1 3/1'; do
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf %s\n' "$face" >huge.obj
    refused huge.obj 'index out of range' mesh
done
printf 'PF\0\1\2 3\n' >nul.pfm
refused nul.pfm 'is not a PFM' compare
rm -f o/a.png
none 'bad input writes nothing'

# ---- what took seconds ----

wait
if have mkfifo; then
    for role in $texts $pictures; do
        ended "$role" 1 'fifo: can'"'"'t be read: is a pipe with nobody at its other end'
    done
    ended output 1 'fifo.png: can'"'"'t be written: is a pipe with nobody at its other end'
fi
if [ -d apart/text ]; then
    ended text 1 '/dev/stdin: can'"'"'t be read: is a pipe that goes on'
    ended picture 1 '/dev/stdin: can'"'"'t be read: is a pipe that goes on'
fi

cd "$tests/.." || exit 1
rm -rf "$work"
total
