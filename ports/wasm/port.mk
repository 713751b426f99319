# The page: `make wasm` builds it into build/wasm. One module each without and with SIMD128, with memory of its own or shared.

WASM_CC ?= clang
WASM_NOISE = ports/posix/noise.c
WASM_C = ports/wasm/page.c ports/wasm/demo.c ports/wasm/scene.c $(WASM_NOISE)
WASM_KINDS = scalar simd scalar-shared simd-shared
WASM_FLAGS = --target=wasm32 -nostdlib -nostdlibinc -Iports/wasm/include -Iports/wasm -Iports/posix -std=c99 $(WARNINGS) \
    -ffp-contract=off -fno-math-errno -O2 -mbulk-memory -Iinclude -Isrc
# No stack beyond what is here: below it there is nothing, so that one too deep ends the program.
WASM_LINK = -Wl,--no-entry -Wl,--stack-first -Wl,-z,stack-size=65536
WASM_simd = -msimd128
WASM_shared = -matomics -mmutable-globals -Wl,--import-memory -Wl,--shared-memory -Wl,--max-memory=268435456 \
    -Wl,--export=__stack_pointer
WASM_PAGE = $(addprefix $(B)/wasm/,index.html style.css page.js worker.js modules.js serve.mjs)

.PHONY: wasm
wasm: $(WASM_PAGE) $(B)/wasm/native

$(B)/wasm/%.wasm: $(LIB_SRC) $(WASM_C) $(wildcard include/*.h src/*.h src/*/*.h ports/wasm/*.h ports/wasm/include/*.h) ports/wasm/port.mk
	@mkdir -p $(@D)
	$(WASM_CC) $(WASM_FLAGS) $(foreach k,simd shared,$(if $(findstring $(k),$*),$(WASM_$(k)))) $(WASM_LINK) -o $@ $(LIB_SRC) $(WASM_C)

# As text in a script: a page that is opened as a file may not fetch.
$(B)/wasm/modules.js: $(foreach k,$(WASM_KINDS),$(B)/wasm/$(k).wasm)
	{ echo 'const tyndallModules = {'; \
	for k in $(WASM_KINDS); do printf '"%s": "' $$k; base64 <$(B)/wasm/$$k.wasm | tr -d '\n'; echo '",'; done; \
	echo '};'; } >$@

$(B)/wasm/%: ports/wasm/%
	@mkdir -p $(@D)
	cp $< $@

# Draws the same views on this machine, for the tests.
$(B)/wasm/native: $(call OBJ,ports/wasm/native.c ports/wasm/demo.c ports/wasm/scene.c $(WASM_NOISE)) $(B)/libtyndall.a
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) -o $@ $^ -lm
