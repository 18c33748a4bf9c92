// The app: served by the program, and from files with the method in WebAssembly.
import { spawn } from 'node:child_process';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { createServer, request } from 'node:http';
import { extname, join } from 'node:path';
import { command, expect, folder, open, root, run } from './browser.mjs';
import { expectAccessible } from './access.mjs';

const dist = join(root, 'web/dist');
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm' };

/** The program, as `seamstress app` starts it. */
async function program() {
    const child = spawn(command, ['app', '--no-open'], { cwd: folder });
    const address = await new Promise((resolve) => {
        child.stdout.on('data', (text) => { resolve(String(text).split('\n')[0]); });
    });
    return { address, stop: () => child.kill('SIGINT'), ended: new Promise((resolve) => { child.on('exit', resolve); }) };
}

/** A host of files, in a folder of its own. */
async function host() {
    const server = createServer((asked, response) => {
        const path = join(dist, new URL(asked.url, 'http://x').pathname.replace(/^\/some\/place\//, '').replace(/^$/, 'index.html'));
        if (!existsSync(path)) { response.writeHead(404).end(); return; }
        response.writeHead(200, { 'content-type': TYPES[extname(path)] }).end(readFileSync(path));
    });
    await new Promise((resolve) => { server.listen(0, '127.0.0.1', resolve); });
    return { address: `http://127.0.0.1:${server.address().port}/some/place/`, stop: () => server.close() };
}

const done = (page) => page.locator('.status', { hasText: 'Done in' }).waitFor();
const start = (page) => page.getByRole('button', { name: 'Make it' }).click();

async function sample(page, name) {
    await page.getByRole('button', { name }).first().click();
    await done(page);
}

async function save(page, name) {
    const [saved] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name, exact: true }).click()]);
    const path = join(folder, saved.suggestedFilename());
    await saved.saveAs(path);
    return path;
}

/** The mesh of the page, as the command reads it. */
async function drop(page, name, content) {
    await page.locator('input[type=file]').setInputFiles({ name, mimeType: 'text/plain', buffer: Buffer.from(content) });
}

async function makesQuads(page) {
    await sample(page, 'Step');
    await page.getByLabel('Number of quads, or edge length').fill('300');
    await start(page);
    await page.locator('.kind', { hasText: 'Quad mesh' }).waitFor();
    const path = await save(page, 'OBJ');
    const quality = JSON.parse(run('quality', path, '--json'));
    const count = await page.evaluate(() => window.panels[0].model.scene.corners.length / 4);
    expect(quality.topology.polygons['4'] === count && quality.topology.bad_edges === 0, JSON.stringify(quality.topology).slice(0, 300));
    const binary = readFileSync(await save(page, 'GLB'));
    expect(binary.readUInt32LE(8) === binary.length, 'the GLB file says its length');
    await expectAccessible(page);
}

async function followsPickedEdges(page) {
    await page.locator('#features').selectOption('picked');
    await page.locator('.kind', { hasText: 'Mesh' }).waitFor();
    await done(page);
    const box = await page.locator('canvas').first().boundingBox();
    await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
    await page.locator('.status', { hasText: '1 edge is picked' }).waitFor();
    await start(page);
    await page.locator('.kind', { hasText: 'Quad mesh' }).waitFor();
    const features = await page.evaluate(() => window.panels[0].model.result.report.features);
    expect(features.edges === 1 && features.sources[0].source.startsWith('edges:'), JSON.stringify(features.sources));
}

async function makesAMap(page) {
    const spot = readFileSync(join(root, 'samples/bracket.obj'));
    await drop(page, 'bracket.obj', spot);
    await done(page);
    await page.getByRole('button', { name: 'Seamless map' }).click();
    await page.locator('#features').selectOption('none');
    await start(page);
    await page.locator('.kind', { hasText: 'Seamless map' }).waitFor();
    const path = await save(page, 'OBJ');
    run('check', join(root, 'samples/bracket.obj'), path);
    const shown = await page.evaluate(() => window.panels[0].model.result.report.distortion.tau);
    const made = JSON.parse(run('measure', join(root, 'samples/bracket.obj'), path, '--json'));
    const tau = made.measures.find(({ measure }) => measure === 'tau');
    expect(Math.abs(tau.max - shown) < 1e-9, `${tau.max} is not ${shown}`);
    await page.evaluate((face) => { window.panels[0].pick(face); }, tau.worst);
    const text = await page.locator('.readout').textContent();
    expect(text.includes(`tau ${tau.max.toFixed(4)}`), text);
    const html = readFileSync(await save(page, 'HTML'), 'utf8');
    expect(html.startsWith('<!doctype html>'), 'the page is saved as one file');
}

async function refuses(page) {
    const bad = 'v 0 0 0\nv 1 0 0\nf 1 2 7\n';
    await drop(page, 'bad.obj', bad);
    const shown = await page.locator('.failure').textContent();
    writeFileSync(join(folder, 'bad.obj'), bad);
    let said = '';
    try { run('check', 'bad.obj'); } catch (error) { said = error.stderr; }
    expect(said.startsWith(`error: ${shown}`), `${shown} is not ${said}`);
}

// A ball with bumps, of so many triangles that a map of it takes seconds.
function large() {
    const [around, up] = [400, 200];
    const lines = [];
    for (let j = 0; j <= up; j++) {
        for (let i = 0; i < around; i++) {
            const [a, b] = [2 * Math.PI * i / around, Math.PI * (j + 0.5) / (up + 1)];
            const r = 1 + 0.2 * Math.sin(7 * a) * Math.sin(9 * b);
            lines.push(`v ${r * Math.sin(b) * Math.cos(a)} ${r * Math.sin(b) * Math.sin(a)} ${r * Math.cos(b)}`);
        }
    }
    for (let j = 0; j < up; j++) {
        for (let i = 0; i < around; i++) {
            const [p, q] = [j * around + i + 1, j * around + (i + 1) % around + 1];
            lines.push(`f ${p} ${p + around} ${q + around} ${q}`);
        }
    }
    return lines.join('\n');
}

async function cancels(page) {
    await drop(page, 'large.obj', large());
    await done(page);
    await page.getByRole('button', { name: 'Seamless map' }).click();
    await start(page);
    await page.waitForTimeout(300);
    const begin = Date.now();
    // It moves as the progress does.
    await page.getByRole('button', { name: 'Cancel' }).click({ force: true });
    await page.locator('.failure', { hasText: 'Stopped' }).waitFor();
    expect(Date.now() - begin < 1000, `it took ${Date.now() - begin} ms to stop`);
    // What comes next works.
    await drop(page, 'triangle.obj', 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n');
    await done(page);
}

function flow(start) {
    return async (browser) => {
        const { address, stop } = await start();
        const page = await open(browser, address);
        try {
            for (const step of [makesQuads, followsPickedEdges, makesAMap, refuses]) await step(page);
            await page.reload();
            await cancels(page);
        } finally {
            stop();
        }
        return page;
    };
}

function status(address, headers = {}, method = 'GET') {
    return new Promise((resolve, reject) => {
        request(address, { headers, method }, (response) => { response.resume(); resolve(response.statusCode); }).on('error', reject).end();
    });
}

export const tests = {
    'the app of the program makes quads and maps': flow(program),

    async 'the program answers its own page only'() {
        const { address, stop, ended } = await program();
        const { host: own } = new URL(address);
        const found = await Promise.all([
            status(address),
            status(address, { Origin: `http://${own}` }),
            status(address, { Host: 'other.example' }),
            status(address, { Origin: 'http://other.example' }),
            status(`http://${own}/`),
            status(`http://${own}/${'0'.repeat(32)}/`),
            status(`${address}jobs?task=${encodeURIComponent('{"make":{"check":["pairs:/etc/passwd"]}}')}`, {}, 'POST'),
            status(`${address}jobs/1`),
        ]);
        expect(String(found) === '200,200,403,403,403,403,400,404', String(found));
        stop();
        expect(await ended === 0, 'Ctrl-C ends it');
    },
};

if (existsSync(join(dist, 'pkg/seamstress_wasm_bg.wasm'))) {
    tests['the app in a browser makes quads and maps by itself'] = flow(host);
} else {
    console.log('SKIPPED: the app in a browser; .ci/wasm builds what it needs');
}
