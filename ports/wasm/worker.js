'use strict';

// The source of every worker: the one that draws, and its helpers where memory is shared. It stands in a function because a page
// that was opened as a file may start workers from text alone. What a message asks for has one answer with the same name.
function tyndallWorker() {
    const VIEW_REALS = 6, VIEW_WORDS = 16; // demo_view in demo.h
    const TIMES = ['shadow', 'surface', 'shafts', 'sample', 'row', 'ray', 'line', 'unwarp', 'correct', 'upscale', 'composite'];
    const BYTES = ['context', 'map', 'raster', 'pictures', 'all']; // page_figures in page.c
    let wasm, memory;

    async function start({module, shared, helper, origin}) {
        const now = () => (performance.timeOrigin - origin + performance.now()) * 1e6;
        const instance = await WebAssembly.instantiate(module, {page: {now}, env: {memory: shared}});
        wasm = instance.exports;
        memory = shared || wasm.memory;
        if (helper !== undefined) {
            wasm.__stack_pointer.value = wasm.stack(helper);
            wasm.help(helper); // never returns
        }
        return {status: wasm.open(), isa: wasm.isa()};
    }

    // Out of memory that may be shared, and that moves when it grows.
    function copy(at, row, x, width, height) {
        const out = new Uint8ClampedArray(4 * width * height);
        for (let y = 0; y < height; y++) {
            out.set(new Uint8Array(memory.buffer, at + 4 * (y * row + x), 4 * width), 4 * width * y);
        }
        return out.buffer;
    }

    function figures() {
        const from = new Float64Array(memory.buffer, wasm.figures(), TIMES.length + BYTES.length + 1);
        const out = {ms: {}, bytes: {}, rays: from[from.length - 1]};
        TIMES.forEach((name, i) => { out.ms[name] = from[i] / 1e6; });
        BYTES.forEach((name, i) => { out.bytes[name] = from[TIMES.length + i]; });
        return out;
    }

    function draw({view}) {
        const at = wasm.view(), width = view[VIEW_REALS], height = view[VIEW_REALS + 1];
        new Float32Array(memory.buffer, at, VIEW_REALS).set(view.slice(0, VIEW_REALS));
        new Int32Array(memory.buffer, at + 4 * VIEW_REALS, VIEW_WORDS - VIEW_REALS).set(view.slice(VIEW_REALS));
        const begin = performance.now(), status = wasm.draw();
        const ms = performance.now() - begin;
        return status < 0 ? {status} : {status, ms, width, height, figures: figures(), pixels: copy(wasm.target(), width, 0, width, height)};
    }

    // Strips of columns from x on, until the budget is spent.
    function march({x, end, width, height, budget}) {
        const begin = performance.now();
        let at = x, ms = 0, status = 0;
        do {
            const columns = Math.min(8, end - at);
            status = wasm.march(at, 0, columns, height);
            at += columns;
            ms = performance.now() - begin;
        } while (status === 0 && at < end && ms < budget);
        return {status, x, width: at - x, height, ms, pixels: copy(wasm.truth(), width, x, at - x, height)};
    }

    function check({x, width}) {
        const hash = BigInt.asUintN(64, wasm.hash()).toString(16).padStart(16, '0');
        const [largest, squared] = width > 0 ? new Float64Array(memory.buffer, wasm.gap(x, width), 2) : [0, 0];
        return {hash, compared: width > 0, largest, squared};
    }

    const calls = {start, draw, march, check};
    onmessage = async ({data}) => {
        try {
            const answer = await calls[data.call](data);
            postMessage({call: data.call, ...answer}, answer.pixels ? [answer.pixels] : []);
        } catch (error) {
            postMessage({call: 'failed', message: String(error)});
        }
    };
}
