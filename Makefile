# tyndall. `make` builds the library and the tool; `make help` lists the rest. Needs a C compiler and make, nothing else.

ifeq ($(origin CC),default)
CC = gcc
endif
ifeq ($(filter -j% --jobs%,$(MAKEFLAGS)),)
MAKEFLAGS += -j2
endif
CFLAGS ?= -O2
B ?= build
PREFIX ?= /usr/local
DESTDIR ?=

# No contraction: a fused multiply-add rounds once where others round twice, and the pictures must be the same everywhere.
WARNINGS = -pedantic -Wall -Wextra -Wconversion -Wdouble-promotion -Wshadow -Wvla -Werror
FLAGS = -std=c99 $(WARNINGS) -ffp-contract=off -fno-math-errno -Iinclude -Isrc $(CFLAGS)
THREADS = -pthread
POSIX = -D_POSIX_C_SOURCE=200809L $(THREADS) -Iports/posix
VERSION := $(shell sed -n 's/^.define TYN_VERSION "\(.*\)"/\1/p' include/tyndall.h)

LIB_SRC := $(wildcard src/*.c src/*/*.c)
PORT_SRC := $(wildcard ports/posix/*.c)
# The rooms with tests; check-all builds some with fewer.
ROOMS := $(patsubst tests/test_%.c,%,$(wildcard tests/test_*.c))
FUZZ_SRC := $(filter-out tests/fuzz_main.c,$(wildcard tests/fuzz_*.c))
# fence.c wants mmap and signals, which WASI lacks.
TEST_SRC := $(filter-out tests/fence.c tests/fuzz_%.c tests/test_%.c,$(wildcard tests/*.c)) $(ROOMS:%=tests/test_%.c) \
    $(if $(filter seeds,$(ROOMS)),$(FUZZ_SRC)) $(if $(filter fences%,$(ROOMS)),tests/fence.c)
OBJ = $(patsubst %.c,$(B)/obj/%.o,$(1))
C_FILES = $(wildcard include/*.h src/*.[ch] src/*/*.[ch] ports/*/*.[ch] tests/*.[ch] tests/*/*.[ch])

.PHONY: all run test check-all bench bench-raster bench-prefiltered stability size golden fuzz install uninstall single format format-check clean help FORCE
.DELETE_ON_ERROR:
.SUFFIXES:

all: $(B)/libtyndall.a $(B)/tyndall

run: all
	$(B)/tyndall showcase $(B)

test: all $(B)/tests
	@B=$(B) CC="$(CC)" CFLAGS="$(CFLAGS)" MAKE="$(MAKE)" sh tests/run.sh

check-all:
	@MAKE="$(MAKE)" sh tests/check-all.sh

bench: $(B)/bench $(B)/bench-growth $(B)/bench-papers
	$(B)/bench all
	$(B)/bench-growth
	$(B)/bench-papers

# The rasterizer against Mesa's llvmpipe, where pkg-config finds EGL and GL.
bench-raster: $(B)/bench-raster
	$(B)/bench-raster

# Tables on stdout, pictures in build/prefiltered.
bench-prefiltered: $(B)/bench-prefiltered
	@mkdir -p $(B)/prefiltered
	$(B)/bench-prefiltered $(B)/prefiltered

# Tables on stdout and, with the worst frames, in build/stability; plots of them where there is gnuplot.
stability: $(B)/bench-stability
	@mkdir -p $(B)/stability
	$(B)/bench-stability $(B)/stability
	@if command -v gnuplot >/dev/null; then gnuplot -e "folder='$(B)/stability'" tests/bench/stability.gp; else echo 'SKIPPED: plots, no gnuplot'; fi

# Text, data, bss and stack by configuration and part.
size:
	@B=$(B) sh tests/size.sh

# Rewrites tests/golden.txt and puts the pictures where one can look at them.
golden: $(B)/tests
	mkdir -p $(B)/golden
	TYN_GOLDEN=$(B)/golden $(B)/tests golden

# SECONDS of each of TARGETS (all), by FUZZER (libfuzzer, afl); what it finds is in build/fuzz.
SECONDS = 60
FUZZER = libfuzzer
fuzz:
	@MAKE="$(MAKE)" B=$(B) sh tests/fuzz.sh $(FUZZER) $(SECONDS) $(TARGETS)

# ---- build ---------------------------------------------------------------------------------------------------------------

# qcs, not rcs: two rooms may have files of the same name.

$(B)/libtyndall.a: $(call OBJ,$(LIB_SRC)) $(B)/sources
	rm -f $@
	$(AR) qcs $@ $(filter %.o,$^)

# The port as an archive: the tests take from it what they use, but not its main.
$(B)/libport.a: $(call OBJ,$(PORT_SRC)) $(B)/sources
	rm -f $@
	$(AR) qcs $@ $(filter %.o,$^)

$(B)/tyndall: $(call OBJ,$(PORT_SRC)) $(B)/libtyndall.a
	$(CC) $(CFLAGS) $(THREADS) -o $@ $^ -lm

$(B)/tests: $(call OBJ,$(TEST_SRC)) $(B)/libport.a $(B)/libtyndall.a
	$(CC) $(CFLAGS) $(THREADS) -o $@ $^ -lm

# By tests/fuzz.sh, with a fuzzer's compiler.
$(B)/fuzzer: $(call OBJ,tests/fuzz_main.c tests/fuzz.c tests/files.c $(FUZZ_SRC)) $(B)/libport.a $(B)/libtyndall.a
	$(CC) $(CFLAGS) -fsanitize=fuzzer -pthread -o $@ $^ -lm

# One program each.
$(B)/bench: $(call OBJ,tests/bench/bench.c) $(B)/libport.a $(B)/libtyndall.a
	$(CC) $(CFLAGS) $(THREADS) -o $@ $^ -lm

$(addprefix $(B)/bench-,frame growth papers stability): $(B)/bench-%: $(B)/obj/tests/bench/%.o $(B)/libport.a $(B)/libtyndall.a
	$(CC) $(CFLAGS) $(THREADS) -o $@ $^ -lm

$(B)/bench-raster: tests/bench/raster.c tests/bench/llvmpipe.c tests/bench/raster.h $(B)/libport.a $(B)/libtyndall.a
	@gl=$$(pkg-config --cflags --libs egl gl 2>/dev/null) && gl="-DBENCH_EGL $$gl"; set -x; \
	$(CC) $(FLAGS) $(POSIX) -o $@ $(filter %.c,$^) $(filter %.a,$^) $$gl -lm

$(B)/bench-prefiltered: $(call OBJ,tests/bench/prefiltered.c tests/bench/gallery.c) $(B)/libport.a $(B)/libtyndall.a
	$(CC) $(CFLAGS) $(THREADS) -o $@ $^ -lm

$(B)/obj/src/%.o: src/%.c $(B)/flags
	@mkdir -p $(@D)
	$(CC) $(FLAGS) -MMD -MP -c -o $@ $<

$(B)/obj/%.o: %.c $(B)/flags
	@mkdir -p $(@D)
	$(CC) $(FLAGS) $(POSIX) -I$(B) -MMD -MP -c -o $@ $<

# Each tests/test_ROOM.c has a test_ROOM(); tests/main.c runs those listed here.
$(B)/rooms.h: $(B)/sources
	printf 'ROOM(%s)\n' $(ROOMS) >$@
$(B)/obj/tests/main.o: $(B)/rooms.h
# Each tests/fuzz_TARGET.c has a fuzz_TARGET().
$(B)/targets.h: $(B)/sources
	printf 'TARGET(%s)\n' $(patsubst tests/fuzz_%.c,%,$(FUZZ_SRC)) >$@
$(B)/obj/tests/fuzz_main.o $(B)/obj/tests/test_seeds.o: $(B)/targets.h

# Written only when they change, so that other flags, or a file that came or went, rebuild what they must.
$(B)/flags: FORCE
	@mkdir -p $(B); echo '$(CC) $(FLAGS)' | cmp -s - $@ || echo '$(CC) $(FLAGS)' >$@
$(B)/sources: FORCE
	@mkdir -p $(B); echo '$(LIB_SRC) $(PORT_SRC) $(TEST_SRC)' | cmp -s - $@ || echo '$(LIB_SRC) $(PORT_SRC) $(TEST_SRC)' >$@

# What each port adds.
include $(wildcard ports/*/port.mk)

-include $(patsubst %.o,%.d,$(call OBJ,$(LIB_SRC) $(PORT_SRC) $(TEST_SRC) tests/fuzz_main.c $(wildcard tests/bench/*.c)))

# ---- deliver -------------------------------------------------------------------------------------------------------------

# The whole library as two files to drop into a project.
single:
	@mkdir -p $(B)/single
	cp include/tyndall.h $(B)/single/tyndall.h
	sh tests/single.sh >$(B)/single/tyndall.c

install: all
	mkdir -p $(DESTDIR)$(PREFIX)/include $(DESTDIR)$(PREFIX)/lib/pkgconfig $(DESTDIR)$(PREFIX)/bin
	cp include/tyndall.h $(DESTDIR)$(PREFIX)/include/tyndall.h
	cp $(B)/libtyndall.a $(DESTDIR)$(PREFIX)/lib/libtyndall.a
	cp $(B)/tyndall $(DESTDIR)$(PREFIX)/bin/tyndall
	printf '%s\n' 'prefix=$(PREFIX)' 'Name: tyndall' 'Description: Light shafts on CPUs' 'Version: $(VERSION)' \
	    'Cflags: -I$${prefix}/include' 'Libs: -L$${prefix}/lib -ltyndall -lm' >$(DESTDIR)$(PREFIX)/lib/pkgconfig/tyndall.pc

uninstall:
	rm -f $(DESTDIR)$(PREFIX)/include/tyndall.h $(DESTDIR)$(PREFIX)/lib/libtyndall.a $(DESTDIR)$(PREFIX)/bin/tyndall \
	    $(DESTDIR)$(PREFIX)/lib/pkgconfig/tyndall.pc

format:
	clang-format -i $(C_FILES)
format-check:
	clang-format --dry-run -Werror $(C_FILES)

clean:
	rm -rf $(B)

help:
	@echo 'make            the library build/libtyndall.a and the tool build/tyndall'
	@echo 'make run        renders the built-in scenes as PNGs under build/'
	@echo 'make test       all tests, under a minute'
	@echo 'make check-all  the tests under other compilers, optimisers and sanitizers, on other machines too, about 40 minutes'
	@echo 'make bench      times against a plain pass over the pixels'
	@echo 'make bench-raster  the rasterizer, every ISA, and against llvmpipe where EGL and GL are installed'
	@echo 'make bench-prefiltered  tables and pictures of prefiltered rows'
	@echo 'make stability  a creeping camera and a light at every place against the march: tables, plots, the worst frames; 10 minutes'
	@echo 'make size       text, data, bss and stack of the library and its parts'
	@echo 'make golden     rewrites tests/golden.txt, pictures in build/golden'
	@echo 'make fuzz       a minute of each fuzz target; SECONDS=, TARGETS=, FUZZER=afl'
	@echo 'make single     the library as two files, build/single/tyndall.[ch]'
	@echo 'make wasm       the page build/wasm/index.html, with clang and lld'
	@echo 'make install    to PREFIX=/usr/local, below DESTDIR; make uninstall takes it away again'
	@echo 'make format     clang-format on every file; make clean'
	@echo 'CC, CFLAGS and B (the build folder) can be given: make CC=clang CFLAGS=-O3 B=build/clang'
