// Draws the frames of views.txt with the modules named on the command line, here in node, and holds each against the hash that
// the native program printed (on stdin, a line a view).
//     node check_node.mjs VIEWS BUILD KIND... <HASHES
import {readFileSync} from 'node:fs';
import {performance} from 'node:perf_hooks';

const [views, build, ...kinds] = process.argv.slice(2);
const lines = readFileSync(views, 'utf8').split('\n').filter((line) => line && !line.startsWith('#'));
const hashes = readFileSync(0, 'utf8').split('\n').filter(Boolean);
let passed = 0, failed = 0;

for (const kind of kinds) {
    const {module, instance} = await WebAssembly.instantiate(readFileSync(`${build}/${kind}.wasm`), {page: {now: () => performance.now() * 1e6}});
    const imports = WebAssembly.Module.imports(module).map(({module: from, name}) => `${from}.${name}`).join(' ');
    const call = instance.exports;
    const isa = kind === 'simd' ? 33 : 1;
    let ms = 0;
    const verdict = (name, good, said) => {
        if (good) return void passed++;
        failed++;
        console.log(`FAILED ${kind}: ${name}\n    ${said}`);
    };
    verdict('asks for a clock and nothing else', imports === 'page.now', imports);
    verdict('opens', call.open() === 0, 'no memory');
    verdict('has its instruction set', call.isa() === isa, `tyn_isa_available is ${call.isa()}`);
    [...lines, lines[0]].forEach((line, i) => { // the first again: nothing of a frame is kept
        const [name, ...numbers] = line.trim().split(/\s+/);
        new Float32Array(call.memory.buffer, call.view(), 6).set(numbers.slice(0, 6).map(Number));
        new Int32Array(call.memory.buffer, call.view() + 24, 10).set(numbers.slice(6).map(Number));
        const start = performance.now();
        const status = call.draw();
        ms += performance.now() - start;
        const hash = status === 0 ? BigInt.asUintN(64, call.hash()).toString(16).padStart(16, '0') : `status ${status}`;
        verdict(name, hash === hashes[i % lines.length], `${hash}, native ${hashes[i % lines.length]}`);
    });
    console.log(`   ${kind}: ${lines.length + 1} frames in ${ms.toFixed(0)} ms, the native hashes`);
}
console.log(`${passed} passed, ${failed} failed`);
process.exitCode = failed ? 1 : 0;
