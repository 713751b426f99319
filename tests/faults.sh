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
good=$(cat good.scene)
small='--shadow-size 64 --threads 2'

render() {
    # shellcheck disable=SC2086
    "$tyndall" render "$@" $small
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
    *) printf '%s\n%s\n' "$good" "$line" >"$1.scene" && render "$1.scene" -o o/a.png ;;
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

silent() { # ROLE: nobody writes
    mkfifo fifo && as "$1" fifo
}

unread() {
    mkfifo fifo.png && render good.scene -o fifo.png --depth o/d.pfm
}

endless() {
    yes '#' 2>/dev/null | render /dev/stdin -o o/a.png
}

if have mkfifo; then
    for role in $texts $pictures; do
        apart "$role" silent "$role"
    done
    apart output unread
fi
[ -r /dev/stdin ] && have yes && apart endless endless

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

# ---- output ----

for longest in "$(repeated a 251).png" "$(repeated ä 125)a.png"; do
    expect "a name of 255 bytes: $longest" 0 render good.scene -o "o/$longest"
    empty 'that file is there, and no other' "$([ "$(ls -A o)" = "$longest" ] || ls -A o)"
    rm -f "o/$longest"
done
mode() {
    # shellcheck disable=SC2012
    ls -l "$1" | cut -c 1-10
}
(umask 027 && render good.scene -o o/new.png)
empty 'a new file has the mode of umask' "$([ "$(mode o/new.png)" = -rw-r----- ] || ls -l o)"
chmod 604 o/new.png
(umask 077 && render good.scene -o o/new.png)
empty 'an old one keeps its own' "$([ "$(mode o/new.png)" = -rw----r-- ] || ls -l o)"
mkdir o/far
ln -s far/there.png o/link.png
ln -s "$work/o/link.png" o/links.png
expect 'links to what is not there yet' 0 render good.scene -o o/links.png
empty 'the file is where they lead, and they stay' \
    "$([ -h o/links.png ] && [ -h o/link.png ] && cmp o/far/there.png o/new.png 2>&1 || ls -lR o)"
ln -s round.png o/round.png
expect 'a link to itself' 1 render good.scene -o o/round.png
says 'what is wrong with it' 'o/round.png: can'"'"'t be written: '

# Two outputs that are one file.
ln -s o other
ln o/new.png o/hard.png
cp o/new.png o/P.depth.pfm
ln -s new.pfm o/to.pfm
expect 'a hard link to the other output' 2 render good.scene -o o/new.png --depth o/hard.png
mv o/new.png o/old.pfm && mv o/hard.png o/hard.pfm
for pair in 'o/a.pfm ./o/a.pfm' 'o/a.pfm other/a.pfm' 'o/old.pfm o/hard.pfm' 'o/new.pfm o/to.pfm' 'o/to.pfm other/new.pfm'; do
    expect "outputs $pair" 2 render good.scene -o "${pair% *}" --depth "${pair#* }"
    says "outputs $pair: what is wrong" "'${pair#* }': is one file given twice"
done
expect 'an output that --frame writes too' 2 render good.scene -o o/P.depth.pfm --frame other/P
ln -s P.frame o/aside.pfm
expect 'so by a link' 1 render good.scene -o o/aside.pfm --frame o/P
says 'which one' 'P.frame: can'"'"'t be written: is another output too'
rm -rf o other
mkdir o
printf 'Pf\n2 1\n-1.0\n\000\000\200\077\000\000\000\100' >depth.pfm
printf 'P6\n2 1\n255\n\377\0\0\0\200\377' >o/colour.ppm
printf 'tyndall-frame 1\nimage 2 1\ncamera position 0 0 5 target 0 0 0 fov_y 50 near 0.1 far 10\ndepth depth.pfm\ncolour o/colour.ppm\n' >io.frame
expect 'another place' 0 "$tyndall" post io.frame -o io.ppm
expect 'an output in the place of an input' 0 "$tyndall" post io.frame -o o/colour.ppm
quiet 'is what it is in another place' cmp io.ppm o/colour.ppm
rm -f o/colour.ppm

# meanwhile COMMAND: starts the tool with a picture of 480 KB into a pipe, and runs COMMAND while that is being written, with the
# rest of the picture on file 3 and the tool's number in $pid. Sets $status.
if have mkfifo; then mkfifo pipe.pfm; fi
meanwhile() {
    during=$1
    shift
    (
        exec 3<pipe.pfm
        dd bs=1 count=1 <&3 >/dev/null 2>&1
        pid=$(cat pid)
        eval "$during"
    ) &
    # In front, as the shell makes programs behind ignore SIGINT.
    {
        sh -c 'echo $$ >pid && exec "$@" 2>err.txt' sh "$tyndall" render good.scene -o pipe.pfm --size 200x200 --shadow-size 64 "$@"
        status=$?
    } 2>/dev/null
    wait $!
}

gone() { # NUMBER: waits for the end of a process.
    while kill -0 "$1" 2>/dev/null; do sleep 0.02; done
}

if have mkfifo; then
    ulimit -c 0
    for signal in 1.HUP 2.INT 3.QUIT 15.TERM 24.XCPU; do
        # shellcheck disable=SC2016
        if { sh -c 'kill -$1 $$' sh ${signal#*.}; } 2>/dev/null; then
            skip "SIG${signal#*.}: whoever started this ignores it"
            continue
        fi
        meanwhile "kill -${signal#*.} \$pid; gone \$pid" --scatter o/s.pfm --depth o/d.pfm
        empty "SIG${signal#*.} while a file is written" "$([ $status -eq $((128 + ${signal%.*})) ] || echo "status $status")"
        none 'leaves nothing'
        (
            until ls o/a.png.part* >/dev/null 2>&1; do sleep 0.02; done
            kill -${signal#*.} "$(cat pid)"
        ) &
        {
            sh -c 'echo $$ >pid && exec "$@"' sh "$tyndall" render good.scene -o o/a.png --depth o/d.pfm --size 2000x2000 \
                --method march --rays steps --steps 4096
            status=$?
        } 2>/dev/null
        wait $!
        empty "SIG${signal#*.} while a picture is drawn" "$([ $status -eq $((128 + ${signal%.*})) ] || echo "status $status")"
        none 'leaves nothing'
    done
    meanwhile 'exec 3<&-' --scatter o/s.pfm --depth o/d.pfm
    empty 'SIGPIPE' "$([ $status -eq 141 ] || echo "status $status")"
    none 'leaves nothing'
    echo old >o/s.pfm
    meanwhile 'mkdir o/d.pfm; cat <&3 >/dev/null' --scatter o/s.pfm --surface o/f.pfm --depth o/d.pfm
    empty 'the last of four files has no place: status 1' "$([ $status -eq 1 ] || echo "status $status")"
    says 'which one' "o/d.pfm: can't be written: Is a directory"
    empty 'the others are as they were' "$([ "$(cat o/s.pfm)" = old ] || echo other)"
    rm -f o/s.pfm && rmdir o/d.pfm
    none 'and nothing is left'
    meanwhile 'mv o away; cat <&3 >/dev/null' --depth o/d.pfm
    empty 'a folder that goes: status 1' "$([ $status -eq 1 ] || echo "status $status")"
    says 'which file' "o/d.pfm: can't be written: No such file"
    rm -rf away
    mkdir -p o
else
    skip 'no mkfifo'
fi

# As somebody who may not do everything.
weak=
if [ "$(id -u)" -eq 0 ]; then weak='setpriv --reuid=65534 --regid=65534 --clear-groups'; fi
if $weak test -x "$tyndall" -a -r good.scene 2>/dev/null; then
    mkdir -m 555 shut
    mkdir -m 1777 sticky
    mkdir -m 777 free
    echo old >sticky/a.png
    echo old >free/a.png
    chmod 666 sticky/a.png
    chmod 444 free/a.png
    cp good.scene secret.scene
    chmod 0 secret.scene
    # shellcheck disable=SC2086
    {
        expect 'a file that may not be read' 1 $weak "$tyndall" render secret.scene -o free/b.png
        says 'which one' "secret.scene: can't be read: Permission denied"
        expect 'a folder that may not be written to' 1 $weak "$tyndall" render good.scene -o shut/a.png
        says 'which one' "shut/a.png: can't be written: Permission denied"
        expect 'a file that may not be written to' 1 $weak "$tyndall" render good.scene -o free/a.png
        says 'which one' "free/a.png: can't be written: Permission denied"
        if [ "$(id -u)" -eq 0 ]; then
            expect 'a file that may not be replaced' 1 $weak "$tyndall" render good.scene -o sticky/a.png --depth sticky/d.pfm
            says 'which one' "sticky/a.png: can't be written: Operation not permitted"
        fi
    }
    empty 'they are as they were' "$([ "$(cat sticky/a.png free/a.png && ls shut sticky free)" = "$(
        printf 'old\nold\nfree:\na.png\n\nshut:\n\nsticky:\na.png'
    )" ] || ls -l shut sticky free)"
    chmod 755 shut
else
    skip 'no setpriv, or not here: unreadable and unwritable files'
fi

# A disk of 32 KB.
cat >disk.sh <<'DISK'
mount -t tmpfs -o size=32k tyndall o || exit 99
echo old >o/a.pfm
"$1" render good.scene -o o/a.pfm --depth o/d.pfm --size 64x64 --shadow-size 64
echo $?
cat o/a.pfm
ls -A o
mount -o remount,ro o
"$1" render good.scene -o o/a.pfm
DISK
said=$(unshare -m sh disk.sh "$tyndall" 2>err.txt)
case $? in
99 | 126 | 127) skip 'no disk to fill' ;;
*)
    empty 'a full disk: status 1, the old file and no other' "$([ "$said" = "$(printf '1\nold\na.pfm')" ] || echo "$said")"
    says 'which file' "a.pfm: can't be written: No space left on device"
    says 'a read-only disk' "a.pfm: can't be written: Read-only file system"
    ;;
esac

# ---- files made to cost squares of their length ----

# brief NAME STATUS FILE: it takes a second of processor time at most.
brief() {
    (ulimit -t "$seconds" && as mesh "$3") >out.txt 2>err.txt
    status=$?
    empty "$1" "$([ $status -eq "$2" ] || { echo "status $status" && cat err.txt; })"
}

# shellcheck disable=SC2086
if quiet 'hostile.c builds' $CC -O2 -o hostile "$tests/faults/hostile.c" && quiet 'hostile files' ./hostile .; then
    seconds=1
    case $CFLAGS in *sanitize*) seconds=10 ;; esac
    brief 'pairs of one place in a hash table' 1 pairs.obj
    says 'what is wrong with them' 'pairs.obj:3: '
    brief 'names of one place in a hash table, one very long' 1 names.obj
    says 'what is wrong with them' 'usemtl of an unknown material'
    brief 'a library by 2000 names' 0 libraries.obj
    brief 'a picture by 2000 names' 0 pictures.obj
fi

# ---- no memory ----

rm -rf o && mkdir o
# An allocation fails, and all after it.
cat >all.scene <<'SCENE'
tyndall-scene 1
image 8 6
camera position 0 2 8 target 0 1 0 fov_y 50 near 0.1 far 60
background 0.2 0.3 0.5
medium scatter 0.03 0.03 0.03 phase hg 0.5
light directional direction 1 -1 -0.3 irradiance 10 9 8 texture gobo.ppm extent 3 3 up 0 1 0
light point position 0 3 2 intensity 1 1 1
quad a -20 0 20 b 20 0 20 c -20 0 -20 albedo 0.5 0.5 0.5
mesh all.obj
SCENE
printf 'P3\n1 1\n9\n1 5 9\n' >gobo.ppm
printf 'P2\n1 1\n9\n5\n' >mask.pgm
printf 'newmtl m 1\nKd 1 1 1\nmap_Kd gobo.ppm\nmap_d mask.pgm\nnewmtl n\nd 0\n' >'all 1.mtl'
printf 'mtllib all 1.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m 1\nf 1/1 2/1 3/1\nusemtl n\nf 1 2 3\n' >all.obj
# shellcheck disable=SC2086
if ! $CC $CFLAGS -Wl,--wrap=malloc -o wraps "$tests/faults/hostile.c" 2>/dev/null; then
    skip 'no linker that wraps functions'
elif quiet 'no_memory.c builds' $CC $CFLAGS -Wl,--wrap=main,--wrap=malloc,--wrap=calloc,--wrap=realloc -o no_memory \
    "$tests/faults/no_memory.c" "$B/libport.a" "$B/libtyndall.a" -pthread -lm; then
    step=5
    case $CFLAGS in *sanitize*) step=1 ;; esac # and no leak
    quiet 'render without memory' ./no_memory $step o render all.scene -o o/a.png --scatter o/s.pfm --surface o/u.pfm --depth o/d.pfm \
        --frame o/P --shadow-size 8 --threads 2 --rectify projective --debug lines
    rm -rf o && mkdir o
    render all.scene -o in.pfm --frame in
    quiet 'post without memory' ./no_memory $step o post in.frame -o o/a.rgb565 --scatter o/s.pfm --threads 2
    rm -rf o && mkdir o
fi
if { (ulimit -v 2000000 && "$tyndall" --version); } >/dev/null 2>&1; then
    (ulimit -v 2000000 && render good.scene -o o/a.png --size 32768x32768) 2>err.txt
    empty 'a picture larger than memory: status 1' "$([ $? -eq 1 ] || echo "status $?")"
    says 'a message' 'good.scene: out of memory'
    none 'and no file'
else
    skip 'no limit of memory'
fi

# ---- what took seconds ----

wait
if have mkfifo; then
    for role in $texts $pictures; do
        ended "$role" 1 'fifo: can'"'"'t be read: is a pipe with nobody at its other end'
    done
    ended output 1 'fifo.png: can'"'"'t be written: is a pipe with nobody at its other end'
fi
if [ -d apart/endless ]; then
    ended endless 1 '/dev/stdin: can'"'"'t be read: is a pipe that goes on'
fi

cd "$tests/.." || exit 1
rm -rf "$work"
total
