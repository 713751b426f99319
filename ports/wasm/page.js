'use strict';

const $ = (id) => document.getElementById(id);
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);
const picture = $('picture'), march = $('march'), divider = $('divider'), stage = $('stage');

// ---- what is shown; the address's fragment holds what differs from this ---------------------------------------------------

const SLICES = [64, 96, 128, 192, 256, 384, 512, 768, 1024, 1536, 2048];
const cores = Math.min(navigator.hardwareConcurrency || 1, 16);
const shared = typeof SharedArrayBuffer === 'function' && self.crossOriginIsolated === true;
const start = {
    yaw: 340, pitch: 3.5, distance: 29, sunYaw: 149, sunPitch: 10, fog: 55, slices: 8, method: 0,
    build: 'simd', threads: shared ? Math.min(cores, 8) : 1, compare: false, split: 50,
    size: '', // WIDTHxHEIGHT: every frame at this size, for tests
};
const state = {...start};
for (const [name, value] of new URLSearchParams(location.hash.slice(1))) {
    if (name in start) {
        state[name] = typeof start[name] === 'number' ? Number(value) || 0 : typeof start[name] === 'boolean' ? value === 'true' : value;
    }
}

function remember() {
    const changed = Object.entries(state).filter(([name, value]) => value !== start[name]);
    const text = new URLSearchParams(changed);
    try {
        history.replaceState(null, '', changed.length ? `#${text}` : location.pathname + location.search);
    } catch { /* a page that was opened as a file may not */ }
}

const visibility = () => (state.fog === 0 ? 0 : Math.round(1500 * (40 / 1500) ** (state.fog / 100)));

// ---- the workers: one that draws, and its helpers -------------------------------------------------------------------------

const script = URL.createObjectURL(new Blob([`(${tyndallWorker})()`], {type: 'text/javascript'}));
const modules = {}; // compiled, by kind
let workers = [], ready = false, busy = false, generation = 0;

function bytesOf(kind) {
    return Uint8Array.from(atob(tyndallModules[kind]), (c) => c.charCodeAt(0));
}

function complain(text) {
    $('message').textContent = text;
    $('message').hidden = !text;
}

async function restart() {
    const mine = ++generation, kind = state.build + (state.threads > 1 ? '-shared' : '');
    ready = busy = false;
    workers.forEach((worker) => worker.terminate());
    workers = [];
    try {
        modules[kind] ??= await WebAssembly.compile(bytesOf(kind));
        if (mine !== generation) {
            return;
        }
        const memory = state.threads > 1 ? new WebAssembly.Memory({initial: 64, maximum: 4096, shared: true}) : undefined;
        for (let i = 0; i < state.threads; i++) {
            const worker = new Worker(script);
            worker.onmessage = ({data}) => mine === generation && answered(data);
            worker.onerror = (event) => complain(`A worker failed: ${event.message}`);
            worker.postMessage({call: 'start', module: modules[kind], shared: memory, origin: performance.timeOrigin, helper: i > 0 ? i - 1 : undefined});
            workers.push(worker);
        }
    } catch (error) {
        if (state.threads === 1) {
            return complain(`This browser can't run it: ${error}`);
        }
        state.threads = 1; // memory that could grow as far was not to be had
        showControls();
        restart();
    }
}

function ask(message) {
    busy = true;
    workers[0].postMessage(message);
}

// ---- what to draw next: small frames in motion, a full one at rest, then the march strip by strip --------------------------

const SCALES = [1, 0.75, 0.5, 0.375, 0.25];
const REST = 140, TOO_SLOW = 40, FAST = 17; // ms
let scale = 2, drifting = false, drifted = 0, dirty = true, moving = false, sharp = false, checked = false, changed = 0, timer = 0;
let marched = null; // columns of the sharp frame from .x to .end, and the time that they took
let last = null; // the frame that is shown

function fullSize() {
    const fixed = /^(\d{1,4})x(\d{1,4})$/.exec(state.size);
    if (fixed) {
        return [clamp(+fixed[1], 1, 4096), clamp(+fixed[2], 1, 4096)];
    }
    const {width, height} = stage.getBoundingClientRect();
    const ratio = Math.min(window.devicePixelRatio || 1, 2, Math.sqrt(2.1e6 / Math.max(width * height, 1)));
    return [Math.max(Math.round(width * ratio), 1), Math.max(Math.round(height * ratio), 1)];
}

function draw(part) {
    const [width, height] = fullSize().map((n) => Math.max(Math.round(n * part), 1));
    const slices = clamp(Math.round(SLICES[state.slices] * part), 8, 2048), map = width * height > 6e5 ? 2048 : 1024;
    sharp = part === 1;
    checked = false;
    marched = null;
    ask({call: 'draw', view: [state.yaw, state.pitch, state.distance, state.sunYaw, state.sunPitch, visibility(), width, height, slices,
        state.method, 0, 0, 1, map, 0, state.threads]});
}

// The columns to march next: those that the divider shows, then the rest, so that it can be moved.
function nextMarch() {
    const {width, height} = last, from = Math.floor(width * state.split / 100);
    marched ??= {x: from, end: from, ms: 0};
    const right = {x: marched.end, end: width}, left = {x: Math.max(marched.x - 16, 0), end: marched.x};
    const strip = from < marched.x || right.x >= width ? left : right;
    return strip.x >= strip.end ? null : {call: 'march', ...strip, width, height, budget: 30};
}

function pump() {
    clearTimeout(timer);
    if (!ready || busy || document.hidden) {
        return;
    }
    const rest = changed + REST - performance.now(), wanted = sharp && last && state.compare ? nextMarch() : null;
    stage.dataset.state = 'busy';
    if (dirty) {
        dirty = false;
        moving = !state.size;
        draw(moving ? SCALES[scale] : 1);
    } else if (!sharp && (rest > 0 || drifting)) {
        timer = drifting ? 0 : setTimeout(pump, rest);
    } else if (!sharp) {
        moving = false;
        draw(1);
    } else if (wanted) {
        checked = false;
        ask(wanted);
    } else if (!checked) {
        const x = Math.floor(last.width * state.split / 100);
        ask({call: 'check', x, width: state.compare ? last.width - x : 0});
    } else {
        stage.dataset.state = 'still';
        remember();
    }
}

function touch() {
    dirty = true;
    changed = performance.now();
    pump();
}

function paint(canvas, {pixels, x = 0, width, height}, full) {
    if (canvas.width !== full || canvas.height !== height) {
        canvas.width = full;
        canvas.height = height;
    }
    canvas.getContext('2d').putImageData(new ImageData(new Uint8ClampedArray(pixels), width, height), x, 0);
}

function answered(data) {
    if (data.call === 'failed' || data.status < 0) {
        busy = false;
        return complain(data.message ?? `The library says ${data.status}.`);
    }
    if (data.call === 'start' && !ready) {
        ready = true;
        $('build').title = data.isa & 32 ? 'tyn_isa: wasm' : 'tyn_isa: scalar';
        return touch();
    }
    busy = false;
    if (data.call === 'draw') {
        complain('');
        if (moving) { // the next in motion as large as the time allows
            changed = performance.now();
            scale = clamp(scale + (data.ms > TOO_SLOW) - (data.ms < FAST), 0, SCALES.length - 1);
        }
        paint(picture, data, data.width);
        march.getContext('2d').clearRect(0, 0, march.width, march.height);
        last = {width: data.width, height: data.height, ms: data.ms, figures: data.figures};
        showFigures();
        wander();
    } else if (data.call === 'march') {
        marched.x = Math.min(marched.x, data.x);
        marched.end = Math.max(marched.end, data.x + data.width);
        marched.ms += data.ms;
        paint(march, data, last.width);
    } else if (data.call === 'check') {
        checked = true;
        $('hash').textContent = data.hash;
        showVerdict(data);
    }
    showSplit();
    pump();
}

// ---- figures ----------------------------------------------------------------------------------------------------------------

const STAGES = [
    ['shadow', 'shadow map', '#5f6b7c'], ['surface', 'surface', '#8592a5'],
    ['sample', 'slices: depth samples', '#8a5a2b'], ['row', 'slices: shadow rows', '#b0742f'], ['ray', 'slices: rays', '#e8b871'],
    ['line', 'slices: lines', '#f3d9a8'], ['unwarp', 'pixels: from slices', '#4f8a83'], ['correct', 'pixels: own rays', '#76b5ab'],
    ['composite', 'pixels: composite', '#b7dcd3'],
];
const MEMORY = [['context', 'shafts'], ['map', 'shadow map'], ['raster', 'rasterizer'], ['pictures', 'pictures'], ['all', 'whole module']];
const cells = {};

function table(list, rows) {
    for (const [key, name, colour] of rows) {
        const dt = document.createElement('dt'), dd = document.createElement('dd');
        if (colour) {
            const piece = document.createElement('i'), patch = document.createElement('i');
            piece.style.background = patch.style.background = colour;
            $('bar').append(piece);
            dt.append(patch);
            dd.piece = piece;
        }
        dt.append(name);
        list.append(dt, dd);
        cells[key] = dd;
    }
}
table($('times'), STAGES);
table($('memory'), MEMORY);

const amount = (ms) => (ms >= 1000 ? `${(ms / 1000).toFixed(1)} s` : `${ms.toFixed(ms < 9.95 ? 1 : 0)} ms`);
const size = (bytes) => (bytes < 1e6 ? `${(bytes / 1e3).toFixed(0)} KB` : `${(bytes / 1e6).toFixed(1)} MB`);

function showFigures() {
    const {ms, bytes} = last.figures, sum = STAGES.reduce((all, [key]) => all + ms[key], 0) || 1;
    for (const [key] of STAGES) {
        cells[key].textContent = amount(ms[key]);
        cells[key].piece.style.width = `${100 * ms[key] / sum}%`;
    }
    for (const [key] of MEMORY) {
        cells[key].textContent = size(bytes[key]);
    }
    $('summed').textContent = state.threads > 1 ? 'sum over threads' : '';
    $('ms').textContent = amount(last.ms);
    $('pulse-more').textContent = ` a frame, ${last.width}×${last.height}${sharp ? '' : ' in motion'}`;
    if (!sharp) {
        $('hash').textContent = '…';
        $('verdict').textContent = '';
    }
}

// Marching half the columns takes half the time: what all would take, beside what the method took for all.
function marchWhole() {
    return marched && marched.end > marched.x ? marched.ms * last.width / (marched.end - marched.x) : 0;
}

function showVerdict({compared, largest, squared}) {
    const whole = marchWhole(), method = last.figures.ms.shafts;
    $('verdict').textContent = !compared ? '' : `An exact ray for every pixel takes ${amount(whole)}, this method ${amount(method)}: ` +
        `${(whole / method).toFixed(0)} times less. Right of the divider they differ by ${largest} of 255 at most` +
        (squared > 0 ? `, PSNR ${(10 * Math.log10(65025 / squared)).toFixed(1)} dB.` : '.');
}

function showSplit() {
    const on = state.compare;
    divider.hidden = march.hidden = $('chip-method').hidden = $('chip-march').hidden = !on;
    divider.style.left = `${state.split}%`;
    divider.setAttribute('aria-valuenow', Math.round(state.split));
    march.style.clipPath = `inset(0 0 0 ${state.split}%)`;
    if (!on || !last) {
        return;
    }
    const whole = marchWhole(), from = last.width * state.split / 100;
    const part = marched ? clamp((marched.end - Math.max(marched.x, from)) / Math.max(last.width - from, 1), 0, 1) : 0;
    $('chip-method').innerHTML = `<b>${$('method').selectedOptions[0].text.split(':')[0]}</b> ${amount(last.figures.ms.shafts)}`;
    $('chip-march').innerHTML = !sharp ? '<b>march</b> at rest'
        : part < 1 ? `<b>march</b> ${Math.round(100 * part)} %` : `<b>march</b> ${amount(whole)}`;
}

// ---- controls -----------------------------------------------------------------------------------------------------------------

const SHOWN = {
    fog: () => (state.fog === 0 ? 'none' : `sight ${visibility()} m`),
    sunPitch: () => `${state.sunPitch.toFixed(0)}°`,
    sunYaw: () => `${state.sunYaw.toFixed(0)}°`,
    slices: () => SLICES[state.slices],
};

function showControls() {
    for (const name of Object.keys(SHOWN)) {
        const input = $(name);
        input.value = state[name];
        input.style.setProperty('--part', `${100 * (input.value - input.min) / (input.max - input.min)}%`);
        $(`${name}-value`).textContent = SHOWN[name]();
        input.setAttribute('aria-valuetext', SHOWN[name]());
    }
    for (const name of ['method', 'build', 'threads']) {
        $(name).value = state[name];
    }
    $('compare').setAttribute('aria-pressed', state.compare);
    $('drift').setAttribute('aria-pressed', drifting);
    showSplit();
}

function set(change) {
    Object.assign(state, change);
    state.pitch = clamp(state.pitch, 0.5, 60);
    state.distance = clamp(state.distance, 9, 34);
    state.sunPitch = clamp(state.sunPitch, 3, 60);
    state.yaw = (state.yaw % 360 + 360) % 360;
    state.sunYaw = (state.sunYaw % 360 + 360) % 360;
    state.fog = clamp(state.fog, 0, 100);
    state.slices = clamp(Math.round(state.slices), 0, SLICES.length - 1);
    state.split = clamp(state.split, 0, 100);
    for (const name of ['yaw', 'pitch', 'distance', 'sunYaw', 'sunPitch']) {
        state[name] = Math.round(100 * state[name]) / 100; // so that the address says it all
    }
    showControls();
    touch();
}

const turn = (dx, dy) => set({yaw: state.yaw - dx, pitch: state.pitch + dy});
const moveSun = (dx, dy) => set({sunYaw: state.sunYaw - dx, sunPitch: state.sunPitch - dy});

for (const name of Object.keys(SHOWN)) {
    $(name).addEventListener('input', (event) => set({[name]: Number(event.target.value)}));
}
$('method').addEventListener('change', (event) => set({method: Number(event.target.value)}));
$('build').addEventListener('change', (event) => { state.build = event.target.value; restart(); });
$('threads').addEventListener('change', (event) => { state.threads = Number(event.target.value); restart(); });

function wander() {
    if (drifting) {
        const now = performance.now(), step = Math.min(now - drifted, 100) / 1000;
        drifted = now;
        requestAnimationFrame(() => drifting && set({sunYaw: state.sunYaw + 9 * step, sunPitch: 13 + 7 * Math.sin(now / 6000)}));
    }
}
function toggleDrift() {
    drifting = !drifting;
    drifted = performance.now();
    showControls();
    wander();
    pump();
}
function toggleCompare() {
    state.compare = !state.compare;
    checked = false;
    showControls();
    pump();
}
$('drift').addEventListener('click', toggleDrift);
$('compare').addEventListener('click', toggleCompare);

// Pointers on the picture: one turns the camera (or, as chosen or with Shift or the other button, moves the sun), two zoom.
const pointers = new Map();
let pinch = 0;
const spread = () => {
    const [a, b] = [...pointers.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
};
picture.addEventListener('pointerdown', (event) => {
    picture.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    pinch = pointers.size === 2 ? spread() : 0;
});
picture.addEventListener('pointermove', (event) => {
    const at = pointers.get(event.pointerId);
    if (!at) {
        return;
    }
    const dx = event.clientX - at.x, dy = event.clientY - at.y, degrees = 0.28;
    pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    if (pointers.size === 2) {
        const now = spread();
        if (pinch > 0 && now > 0) {
            set({distance: state.distance * pinch / now});
        }
        pinch = now;
    } else if (pointers.size === 1) {
        const sun = event.shiftKey || event.buttons & 2 || document.querySelector('#drag input:checked').value === 'sun';
        (sun ? moveSun : turn)(dx * degrees, dy * degrees);
    }
});
const lift = (event) => pointers.delete(event.pointerId);
picture.addEventListener('pointerup', lift);
picture.addEventListener('pointercancel', lift);
picture.addEventListener('contextmenu', (event) => event.preventDefault());
picture.addEventListener('wheel', (event) => {
    event.preventDefault();
    set({distance: state.distance * Math.exp(clamp(event.deltaY, -200, 200) * 0.001)});
}, {passive: false});

picture.addEventListener('keydown', (event) => {
    const way = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
    if (way && !event.ctrlKey && !event.altKey && !event.metaKey) {
        event.preventDefault();
        (event.shiftKey ? moveSun : turn)(3 * way[0], 2 * way[1]);
    } else if (event.key === '+' || event.key === '=' || event.key === '-') {
        set({distance: state.distance * (event.key === '-' ? 1.06 : 1 / 1.06)});
    }
});
document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || event.target.matches('select')) {
        return;
    }
    if (event.key === 'c' || event.key === 'C') {
        toggleCompare();
    } else if (event.key === 'w' || event.key === 'W') {
        toggleDrift();
    }
});

function split(percent) {
    state.split = clamp(percent, 0, 100);
    checked = false;
    showSplit();
    pump();
}
divider.addEventListener('pointerdown', (event) => divider.setPointerCapture(event.pointerId));
divider.addEventListener('pointermove', (event) => {
    if (divider.hasPointerCapture(event.pointerId)) {
        const box = stage.getBoundingClientRect();
        split(100 * (event.clientX - box.left) / box.width);
    }
});
divider.addEventListener('keydown', (event) => {
    const step = {ArrowLeft: -2, ArrowDown: -2, ArrowRight: 2, ArrowUp: 2, PageDown: -10, PageUp: 10, Home: -100, End: 100}[event.key];
    if (step) {
        event.preventDefault();
        split(state.split + step);
    }
});

// ---- start --------------------------------------------------------------------------------------------------------------------

for (let i = 1; i <= (shared ? cores : 1); i++) {
    $('threads').add(new Option(shared ? `${i} of ${cores}` : '1: memory is not shared', i));
}
$('threads').disabled = !shared;
$('threads').title = shared ? '' : 'Only pages that are cross-origin isolated share memory between workers.';
state.threads = clamp(Math.round(state.threads), 1, shared ? cores : 1);
$('build').options[0].disabled = !WebAssembly.validate(bytesOf('simd'));
if ($('build').options[0].disabled || state.build !== 'simd') {
    state.build = 'scalar';
}
new ResizeObserver(touch).observe(stage);
document.addEventListener('visibilitychange', pump);
set({});
restart();
