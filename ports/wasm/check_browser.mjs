// Opens the built page in headless Chromium and uses it: served with shared memory, served plainly, and as a file.
//     node check_browser.mjs BUILD CHROMIUM PLAYWRIGHT HASH      PLAYWRIGHT: playwright-core's folder; HASH: native, of the view `page`
// Screenshots are left in BUILD/shots.
import {spawn} from 'node:child_process';
import {mkdirSync} from 'node:fs';
import {createRequire} from 'node:module';
import {resolve} from 'node:path';
import {pathToFileURL} from 'node:url';

const [build, executablePath, playwright, native] = process.argv.slice(2);
const {chromium} = createRequire(import.meta.url)(resolve(playwright));
const VIEW = 'yaw=20&pitch=6&distance=31&sunYaw=215&sunPitch=12&fog=53&slices=6&size=640x360'; // `page` of views.txt
let passed = 0, failed = 0;

function check(name, good, said = '') {
    if (good) {
        passed++;
    } else {
        failed++;
        console.log(`FAILED ${name}\n    ${said}`);
    }
}

mkdirSync(`${build}/shots`, {recursive: true});
const server = spawn(process.execPath, [`${build}/serve.mjs`, '0'], {stdio: ['ignore', 'pipe', 'inherit']});
const served = await new Promise((done, fail) => {
    server.stdout.once('data', (line) => done(String(line).trim()));
    server.once('exit', (status) => fail(new Error(`serve.mjs ended with ${status}`)));
});
const file = pathToFileURL(resolve(build, 'index.html')).href;
const browser = await chromium.launch({executablePath, args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run',
    '--disable-background-networking', '--disable-component-update', '--disable-sync']});

// A page that is to stay without complaints.
async function open(name, url, options = {}) {
    const context = await browser.newContext({viewport: {width: 1440, height: 900}, ...options});
    const page = await context.newPage(), said = [];
    page.setDefaultTimeout(60000);
    page.on('console', (message) => ['error', 'warning'].includes(message.type()) && said.push(message.text()));
    page.on('pageerror', (error) => said.push(error.message));
    if (options.plain) { // as a server has it that knows nothing of shared memory
        await page.route('**', async (route) => {
            const response = await route.fetch();
            await route.fulfill({response, headers: {'content-type': response.headers()['content-type']}});
        });
    }
    await page.goto(url);
    await still(page);
    return {page, close: async () => {
        const shown = await page.locator('#message').isVisible();
        check(`${name}: no complaints`, said.length === 0 && !shown, said.join('\n') || await page.textContent('#message'));
        await context.close();
    }};
}

const still = (page) => page.waitForSelector('#stage[data-state=still]');
const hash = (page) => page.textContent('#hash');

// The picture after an action; '' if it stays as it was.
async function after(page, action) {
    const old = await hash(page);
    await action();
    try {
        await page.waitForFunction((was) => ![was, '…'].includes(document.getElementById('hash').textContent), old, {timeout: 20000});
    } catch {
        return '';
    }
    await still(page);
    return hash(page);
}

async function changes(name, page, action) {
    check(`${name} changes the picture`, await after(page, action) !== '');
}

// Mean and deviation of a canvas' luminance over a part of its width, and the part of it that is opaque.
const look = (page, id, from = 0) => page.evaluate(([id, from]) => {
    const canvas = document.getElementById(id), x = Math.ceil(from * canvas.width), {data} = canvas.getContext('2d').getImageData(x, 0, canvas.width - x, canvas.height);
    let sum = 0, squares = 0, opaque = 0;
    for (let i = 0; i < data.length; i += 4) {
        const y = 0.3 * data[i] + 0.6 * data[i + 1] + 0.1 * data[i + 2];
        sum += y;
        squares += y * y;
        opaque += data[i + 3] === 255;
    }
    const n = data.length / 4;
    return {mean: sum / n, deviation: Math.sqrt(squares / n - (sum / n) ** 2), opaque: opaque / n};
}, [id, from]);

async function everyBuild() {
    const {page, close} = await open('served', `${served}#${VIEW}&threads=1`);
    const light = await look(page, 'picture');
    check('the picture is not black, nor even', light.mean > 30 && light.deviation > 15 && light.opaque === 1, JSON.stringify(light));
    check('memory is shared', await page.evaluate(() => crossOriginIsolated));
    check('simd, 1 thread: the native picture', await hash(page) === native, `${await hash(page)}, native ${native}`);
    const threads = await page.locator('#threads option').count();
    for (const [kind, count] of [['scalar', 1], ['scalar', Math.min(2, threads)], ['simd', threads]]) {
        await page.goto('about:blank');
        await page.goto(`${served}#${VIEW}&build=${kind}&threads=${count}`);
        await still(page);
        const shown = await page.locator('#build').inputValue() + await page.locator('#threads').inputValue();
        check(`${kind}, ${count} threads: the native picture`, await hash(page) === native && shown === `${kind}${count}`, `${await hash(page)}, native ${native}, ${shown}`);
    }
    await close();
}

async function withoutSharing() {
    for (const [name, url, options] of [['a plain server', served, {plain: true}], ['a file', file, {}]]) {
        const {page, close} = await open(name, `${url}#${VIEW}`, options);
        check(`${name}: the native picture`, await hash(page) === native, `${await hash(page)}, native ${native}`);
        check(`${name}: one thread`, await page.locator('#threads').isDisabled() && !await page.evaluate(() => crossOriginIsolated));
        await changes(`${name}: a slider`, page, () => page.locator('#fog').press('ArrowRight'));
        await close();
    }
}

async function controls() {
    const {page, close} = await open('controls', `${served}#${VIEW}`);
    const drag = async (button = 'left') => {
        await page.mouse.move(400, 400);
        await page.mouse.down({button});
        await page.mouse.move(450, 410, {steps: 4});
        await page.mouse.up({button});
    };
    const first = await hash(page);
    await changes('a drag', page, () => drag());
    await changes('a drag with the other button', page, () => drag('right'));
    await changes('the wheel', page, () => page.mouse.wheel(0, 100));
    await page.check('#drag input[value=sun]', {force: true});
    const sun = await page.textContent('#sunYaw-value');
    await changes('a drag of the sun', page, () => drag());
    check('a drag of the sun moves it', await page.textContent('#sunYaw-value') !== sun);
    for (const slider of ['fog', 'sunPitch', 'sunYaw', 'slices']) {
        await changes(`the slider ${slider}`, page, () => page.locator(`#${slider}`).press('ArrowRight'));
    }
    for (const key of ['ArrowLeft', 'Shift+ArrowUp', '+']) {
        await changes(`the key ${key}`, page, () => page.locator('#picture').press(key));
    }
    for (const method of ['5', '4', '2', '3', '0']) {
        await changes(`method ${method}`, page, () => page.selectOption('#method', method));
    }
    const one = await hash(page);
    await page.selectOption('#build', 'scalar');
    await page.waitForTimeout(300);
    await still(page);
    check('scalar code, switched to, draws the same', await hash(page) === one && one !== first);
    await page.reload();
    await still(page);
    check('the address holds what is shown', await hash(page) === one, page.url());
    await page.click('#drift');
    await page.waitForTimeout(1500);
    await changes('the wandering sun', page, () => page.click('#drift'));
    await close();
}

async function comparison() {
    const {page, close} = await open('compare', `${served}#${VIEW}`);
    await page.locator('#picture').press('c');
    await page.waitForFunction(() => document.getElementById('verdict').textContent !== '');
    await still(page);
    const said = await page.textContent('#verdict'), [, db] = /PSNR ([\d.]+) dB/.exec(said) ?? [0, 0], [, times] = /: (\d+) times less/.exec(said) ?? [0, 0];
    console.log(`   ${said}`);
    check('the march agrees with the method', Number(db) > 48, said);
    check('and takes longer', Number(times) >= 3, said);
    const right = await look(page, 'march', 0.5);
    check('it covers what is right of the divider', right.opaque === 1 && right.mean > 30, JSON.stringify(right));
    await page.locator('#divider').press('Home');
    await still(page);
    check('the divider goes by keys', await page.getAttribute('#divider', 'aria-valuenow') === '0');
    const box = await page.locator('#divider').boundingBox();
    await page.mouse.move(box.x + box.width / 2, 300);
    await page.mouse.down();
    await page.mouse.move(500, 300, {steps: 3});
    await page.mouse.up();
    await still(page);
    const now = Number(await page.getAttribute('#divider', 'aria-valuenow'));
    check('and by the mouse', now > 40 && now < 50, now);
    await close();
}

// What people see: a desk's window and a phone's, each also with the comparison.
async function windows() {
    for (const [name, width, height, phone] of [['wide', 1440, 900, false], ['narrow', 390, 844, true]]) {
        const {page, close} = await open(name, served, {viewport: {width, height}, isMobile: phone, hasTouch: phone});
        const stage = await page.locator('#stage').boundingBox();
        const part = stage.width * stage.height / (width * height);
        check(`${name}: the picture has most of the window`, part > 0.55, part);
        check(`${name}: nothing is wider than the window`, await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth && document.getElementById('panel').scrollWidth <= document.getElementById('panel').clientWidth));
        check(`${name}: the picture is as fine as the window`, await page.evaluate(() => {
            const canvas = document.getElementById('picture');
            return canvas.width >= canvas.clientWidth && canvas.height >= canvas.clientHeight;
        }));
        await page.screenshot({path: `${build}/shots/${name}.png`});
        if (phone) {
            await changes('a tap and a drag of a finger', page, async () => {
                const touch = await page.context().newCDPSession(page);
                for (const [type, x] of [['touchStart', 150], ['touchMove', 190], ['touchMove', 230], ['touchEnd', 0]]) {
                    await touch.send('Input.dispatchTouchEvent', {type, touchPoints: type === 'touchEnd' ? [] : [{x, y: 200}]});
                }
            });
        }
        await close();
    }
}

// Not judged: what the stages take here.
async function times() {
    for (const kind of ['simd', 'scalar']) {
        const {page, close} = await open(`times of ${kind}`, `${served}#yaw=340&size=1280x720&threads=1&build=${kind}`);
        let best = null;
        for (let i = 0; i < 8; i++) {
            await after(page, () => page.locator('#picture').press(i % 2 ? 'ArrowLeft' : 'ArrowRight'));
            const now = await page.evaluate(() => ({total: last.ms, ...last.figures.ms}));
            best = best ? Object.fromEntries(Object.keys(now).map((key) => [key, Math.min(best[key], now[key])])) : now;
        }
        console.log(`   ${kind}, 1280x720, 1 thread, ms: ${Object.entries(best).map(([key, ms]) => `${key} ${ms.toFixed(1)}`).join(', ')}`);
        await close();
    }
}

try {
    for (const part of [everyBuild, withoutSharing, controls, comparison, windows, times]) {
        try {
            await part();
        } catch (error) {
            check(part.name, false, error.message);
        }
    }
} finally {
    await browser.close();
    server.kill();
}
console.log(`${passed} passed, ${failed} failed`);
process.exitCode = failed ? 1 : 0;
