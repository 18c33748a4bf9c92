// Measures what README.md states: sizes, first paint, frame times, and the method in WebAssembly against that of the
// command, in seconds of computation on one thread.
//
//   node test/browser/measure.mjs [MESH...]
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { basename, join, resolve } from 'node:path';
import { gzipSync } from 'node:zlib';
import { folder, launch, open, root, run } from './browser.mjs';
import { host, program } from './places.mjs';
import { ball, done, drop, makeMap } from './steps.mjs';

const pkg = join(root, 'web/dist/pkg');
/** The method of the page for this machine: `cargo build --release --manifest-path crates/wasm/Cargo.toml --example task`. */
const native = resolve(process.env.CARGO_TARGET_DIR ?? join(root, 'target'), 'wasm/release/examples/task');
const say = (name, value) => { console.log(`${name.padEnd(44)} ${value}`); };

/** Milliseconds until something is seen, from a server on this machine: the median of five. */
async function firstPaint(browser, place) {
    const { address, stop } = await place();
    const times = [];
    for (let k = 0; k < 5; k++) {
        const page = await open(browser, address);
        const entry = () => performance.getEntriesByName('first-contentful-paint')[0]?.startTime;
        times.push(await (await page.waitForFunction(entry)).jsonValue());
        await page.context().close();
    }
    stop();
    return `${times.sort((a, b) => a - b)[2].toFixed(0)} ms`;
}

/** A frame of 200 thousand triangles with their edges, and what draws it. */
async function frame(browser) {
    writeFileSync(join(folder, 'ball.obj'), ball(400, 250));
    run('check', 'ball.obj', '--report', 'ball.html');
    const page = await open(browser, `file://${join(folder, 'ball.html')}`);
    await page.waitForFunction(() => window.panels !== undefined);
    const { triangles, time, renderer } = await page.evaluate(() => {
        const [panel] = window.panels;
        panel.set({ edges: true });
        const gl = panel.element.querySelector('canvas').getContext('webgl2');
        const { UNMASKED_RENDERER_WEBGL } = gl.getExtension('WEBGL_debug_renderer_info');
        const triangles = panel.model.scene.corners.length / 3;
        return { triangles, time: panel.frameTime(), renderer: gl.getParameter(UNMASKED_RENDERER_WEBGL) };
    });
    await page.context().close();
    return `${time.toFixed(0)} ms: ${triangles} triangles, 1200 by 800, ${renderer}`;
}

/** Seconds that the first map of a page takes, and the next: when it starts at once, and after the page had time to warm up. */
async function firstMaps(browser) {
    const of = [];
    for (const pause of [0, 5000]) {
        const { address, stop } = await host();
        const page = await open(browser, address);
        await page.waitForTimeout(pause);
        await drop(page, 'spot.obj', readFileSync(join(root, 'samples/spot.obj')));
        await done(page);
        for (const k of [0, 1]) {
            await makeMap(page);
            of.push(`${(await page.locator('.status').textContent()).match(/[\d.]+ s/)[0]} ${['the first', 'the next'][k]}`);
        }
        await page.context().close();
        stop();
    }
    return `at once ${of[0]}, ${of[1]}; after five seconds ${of[2]}, ${of[3]}`;
}

/** Seconds of computation that some work takes. */
function cost(work) {
    const before = process.cpuUsage();
    const made = work();
    const { user, system } = process.cpuUsage(before);
    return [(user + system) / 1e6, made];
}

/** A map in WebAssembly: for the first time, when it is compiled as well, again, and by the command; and its bits. */
async function compare(mesh) {
    const { initSync, run: make } = await import(`${join(pkg, 'seamstress_wasm.js')}?${mesh}`);
    const task = '{"make":{"map":{}}}';
    const content = readFileSync(mesh);
    const bytes = readFileSync(join(pkg, 'seamstress_wasm_bg.wasm'));
    const once = () => make(task, content, mesh, () => undefined);
    const [first] = cost(() => { initSync({ module: bytes }); once(); });
    const [again, outcome] = cost(once);
    run('map', mesh, '-o', 'map.obj', '--threads', '1', '--report', 'map.json');
    const of_command = JSON.parse(readFileSync(join(folder, 'map.json'), 'utf8')).cost.cpu_seconds;
    say(basename(mesh), `${first.toFixed(2)} s at first, ${again.toFixed(2)} s again, ${of_command.toFixed(2)} s by the command: ${(again / of_command).toFixed(2)} times`);
    const map = join(folder, 'browser.obj');
    writeFileSync(map, outcome.file('map.obj'));
    run('check', mesh, map);
    if (!existsSync(native)) return;
    writeFileSync(join(folder, 'task.json'), task);
    execFileSync(native, [join(folder, 'task.json'), mesh, join(folder, 'native.obj')]);
    say('', bits(map, join(folder, 'native.obj')));
}

/** How far two files of the same map are apart. */
function bits(...paths) {
    const [a, b] = paths.map((path) => [...readFileSync(path, 'utf8').matchAll(/^vt (\S+) (\S+)/gm)].flatMap(([, u, v]) => [Number(u), Number(v)]));
    if (a.length !== b.length) return `other seams than the same crates on this machine: ${a.length / 2} and ${b.length / 2} UVs`;
    const size = Math.max(...[a, b].map((all) => all.reduce((most, x) => Math.max(most, Math.abs(x)), 0)));
    const apart = a.reduce((most, x, k) => Math.max(most, Math.abs(x - b[k])), 0);
    return apart === 0 ? 'the same bits as those of the same crates on this machine' : `apart from the same crates on this machine by ${(apart / size).toExponential(1)} of its size`;
}

const browser = await launch();
say('Page of the program, first paint', await firstPaint(browser, program));
say('Page of a host, first paint', await firstPaint(browser, host));
say('Frame', await frame(browser));
say('Maps of spot in a page of a host', await firstMaps(browser));
await browser.close();
const method = readFileSync(join(pkg, 'seamstress_wasm_bg.wasm'));
say('WebAssembly', `${method.length} bytes, ${gzipSync(method, { level: 9 }).length} compressed`);
const meshes = process.argv.slice(2);
for (const mesh of meshes.length > 0 ? meshes : [join(root, 'samples/spot.obj')]) await compare(resolve(mesh));
rmSync(folder, { recursive: true });
