#!/bin/sh
# single.sh - writes the library as one C file to stdout: the internal headers once, in the order they are included, then the
# sources. What is private to a source (statics, its types, constants and macros) gets a longer name where another source uses
# the same word, so that the files may be written without a thought of one another.
# Usage: sh tests/single.sh >tyndall.c, in the top folder; tyndall.h goes beside it.

# The sources in the order of flow: rooms before those that call them is not needed, but reads better.
sources=$(ls src/*.c src/*/*.c 2>/dev/null)

version=$(sed -n 's/^#define TYN_VERSION "\(.*\)"/\1/p' include/tyndall.h)
echo "/* tyndall $version, the whole library in one file. Made by \`make single\`; the sources to read are in src/."
echo ' *'
echo ' * SPDX-License-Identifier: MIT'
echo ' *'
sed -e 's/^/ * /' -e 's/ *$//' LICENSE
echo ' */'

# shellcheck disable=SC2086
awk '
# The next word, blank or sign of `text` from `at`, in `token`; comments and strings come whole. Keeps `comment` over lines.
function next_token(text, at,    rest, c) {
    rest = substr(text, at)
    if (comment) {
        c = index(rest, "*/")
        if (!c) { token = rest; return }
        comment = 0
        token = substr(rest, 1, c + 1)
        return
    }
    if (match(rest, /^[A-Za-z_][A-Za-z_0-9]*/)) { token = substr(rest, 1, RLENGTH); return }
    if (match(rest, /^[0-9.][A-Za-z_0-9.]*/) && rest !~ /^\.[A-Za-z_]/) { token = substr(rest, 1, RLENGTH); return }
    if (match(rest, /^"([^"\\]|\\.)*"/) || match(rest, /^\047([^\047\\]|\\.)*\047/)) { token = substr(rest, 1, RLENGTH); return }
    if (substr(rest, 1, 2) == "/*") {
        comment = 1
        c = index(substr(rest, 3), "*/")
        if (!c) { token = rest; return }
        comment = 0
        token = substr(rest, 1, c + 3)
        return
    }
    if (substr(rest, 1, 2) == "->") { token = "->"; return }
    token = substr(rest, 1, 1)
}

function is_word(t) { return t ~ /^[A-Za-z_]/ }

function resolve(name, from,    dir, n, list, i, try) {
    dir = from
    sub(/[^\/]*$/, "", dir)
    n = split(dir name " src/" name " include/" name, list, " ")
    for (i = 1; i <= n; i++) {
        try = list[i]
        while (sub(/[A-Za-z0-9_]+\/\.\.\//, "", try)) ;
        if ((getline line < try) >= 0) { close(try); return try }
    }
    print "single.sh: " from " includes " name ", which is not there" > "/dev/stderr"
    failed = 1
    return ""
}

# A header with a guard comes once; one without is a template and comes each time.
function guarded(file,    text, found) {
    found = 0
    while ((getline text < file) > 0)
        if (text ~ /^#/) { found = text ~ /^#ifndef TYN/; break }
    close(file)
    return found
}

# The lines of a file with its headers in place, appended to unit u (0: the headers).
# #include TYNI_KERNEL brings what TYNI_KERNEL was defined as last.
function take(file, u,    text, name, path) {
    while ((getline text < file) > 0) {
        if (text ~ /^#define TYNI_KERNEL "/) kernel = text
        if (text ~ /^[ \t]*#[ \t]*include[ \t]*("|TYNI_KERNEL)/) {
            name = text ~ /TYNI_KERNEL/ ? kernel : text
            sub(/^[^"]*"/, "", name)
            sub(/".*/, "", name)
            path = resolve(name, file)
            if (path == "include/tyndall.h") continue
            if (path == "") continue
            if (!guarded(path)) { take(path, u); continue }
            if (path in taken) continue
            taken[path] = 1
            take(path, 0)
            continue
        }
        lines[u, ++count[u]] = text
    }
    close(file)
}

function private(u, word) {
    if (word ~ /^(tyn|TYN)/) return
    if (word ~ /^(const|static|inline|int|float|void|char|unsigned|struct|union|enum|typedef|if|else|endif|ifdef|ifndef|defined)$/) return
    own[u, word] = 1
}

# Finds the words a unit declares at file scope; the sources are formatted, so that column 0 tells.
function declarations(u,    i, text, name, enumerating) {
    for (i = 1; i <= count[u]; i++) {
        text = lines[u, i]
        if (text ~ /^#[ \t]*define[ \t]/) {
            name = text
            sub(/^#[ \t]*define[ \t]+/, "", name)
            match(name, /^[A-Za-z_0-9]+/)
            private(u, substr(name, 1, RLENGTH))
        }
        if (text ~ /^(typedef )?enum/) enumerating = 1
        if (text ~ /^(typedef )?(struct|union|enum) [a-z_0-9]+ \{/ ) {
            name = text
            sub(/^(typedef )?(struct|union|enum) /, "", name)
            sub(/ .*/, "", name)
            private(u, name)
        }
        if (enumerating && text ~ /[{ ,][A-Z_0-9]+( =[^,}]*)?[,} ]|^[ ]+[A-Z_0-9]+/) {
            name = text
            gsub(/\/\*.*\*\//, "", name)
            while (match(name, /[A-Z][A-Z_0-9]+/)) {
                private(u, substr(name, RSTART, RLENGTH))
                name = substr(name, RSTART + RLENGTH)
            }
        }
        if (text ~ /^\} [a-z_0-9]+;/) { name = text; sub(/^\} /, "", name); sub(/;.*/, "", name); private(u, name) }
        if (text ~ /\}/) enumerating = 0
        if (text ~ /^typedef [^{]*;/) {
            name = text
            if (match(name, /\(\*[a-z_0-9]+\)/)) name = substr(name, RSTART + 2, RLENGTH - 3)
            else { sub(/(\[.*)?;.*/, "", name); sub(/.*[ *]/, "", name) }
            private(u, name)
        }
        if (text ~ /^static /) {
            name = text
            gsub(/__attribute__\(\([^)]*\)*\)\)/, "", name)
            gsub(/"[^"]*"/, "", name)
            sub(/ *=.*/, "", name)
            if (name ~ /\(/) sub(/ *\(.*/, "", name)
            else sub(/(\[.*)?[;{]?[ ]*$/, "", name)
            sub(/\[.*/, "", name)
            sub(/.*[ *]/, "", name)
            private(u, name)
        }
    }
}

# Which words each unit uses other than as members.
function words(u,    i, at, text, before) {
    comment = 0
    before = ""
    for (i = 1; i <= count[u]; i++) {
        text = lines[u, i]
        for (at = 1; at <= length(text); at += length(token)) {
            next_token(text, at)
            if (is_word(token) && before != "." && before != "->" && !((u, token) in uses)) {
                uses[u, token] = 1
                users[token]++
            }
            if (token !~ /^[ \t]/) before = token
        }
    }
}

function emit(u, tag,    i, at, text, before, out, member, rest, here) {
    comment = 0
    before = ""
    for (i = 1; i <= count[u]; i++) {
        text = lines[u, i]
        out = ""
        if (text ~ /^(typedef )?(struct|union)[^;()]*\{$/) member = 1
        if (text ~ /^\}/) member = 0
        for (at = 1; at <= length(text); at += length(here)) {
            next_token(text, at)
            here = token
            rest = substr(text, at + length(here))
            if (is_word(here) && (u, here) in own && users[here] > 1 && before != "." && before != "->" &&
                !(member && text ~ /^ / && rest ~ /^(\[[^\]]*\])*[;,:]/))
                out = out tag "_" here
            else
                out = out here
            if (here !~ /^[ \t]/) before = here
        }
        print out
    }
}

BEGIN {
    for (f = 1; f < ARGC; f++)
        take(ARGV[f], f)
    for (u = 0; u < ARGC; u++) {
        if (u) declarations(u)
        words(u)
    }
    print ""
    print "#include \"tyndall.h\""
    # In headers clang never minds a helper that a program does not use; here all is one file.
    print "#if defined(__clang__)"
    print "#pragma clang diagnostic ignored \"-Wunused-function\""
    print "#endif"
    emit(0, "")
    for (f = 1; f < ARGC; f++) {
        tag = ARGV[f]
        sub(/^src\//, "", tag)
        sub(/\.c$/, "", tag)
        gsub(/[^A-Za-z0-9]/, "_", tag)
        print ""
        print "/* ==== " ARGV[f] " ==== */"
        emit(f, "tyni_" tag)
    }
    exit failed
}' $sources
