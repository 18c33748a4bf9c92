// The app, wherever it is: meshes in, quads and maps out.
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { expectAccessible } from './access.mjs';
import { expect, folder, open, root, run } from './browser.mjs';
import { hasMethod, host, program } from './places.mjs';
import { ball, done, drop, makeMap, sample, save, start } from './steps.mjs';

const bracket = join(root, 'samples/bracket.obj');

/** Checks a map by a program that shares no code with ours where there is one, else by our own. */
function verify(mesh, map) {
    const other = join(root, '../shared/tools/verify_seamless.py');
    const python = process.env.PYTHON ?? 'python3';
    const has = () => {
        try { execFileSync(python, ['-c', 'import numpy, scipy'], { stdio: 'ignore' }); return true; } catch { return false; }
    };
    if (!existsSync(other)) console.log('SKIPPED: another checker of maps, which is not beside the checkout');
    else if (has()) execFileSync(python, [other, mesh, map, '--strict'], { stdio: 'pipe' });
    else console.log('SKIPPED: another checker of maps, since NumPy and SciPy were not found');
    run('check', mesh, map);
}

/** Saves what is said of the result: the page, and its report, which is returned. */
async function saveReports(page, kind) {
    const html = readFileSync(await save(page, 'HTML'), 'utf8');
    expect(html.startsWith('<!doctype html>') && html.includes(`: ${kind}</title>`), 'the page is saved as one file');
    return JSON.parse(readFileSync(await save(page, 'JSON'), 'utf8'));
}

/** A number as the page shows it. */
function metric(page, name) {
    return page.locator('.metrics tr').evaluateAll((rows, wanted) =>
        rows.find((row) => row.querySelector('th').firstChild.textContent === wanted)?.querySelector('td').textContent, name);
}

async function makesQuads(page) {
    await sample(page, 'Step');
    await page.getByLabel('Number of quads, or edge length').fill('300');
    await page.getByLabel('Direction').fill('0.5');
    await page.getByLabel('Density').fill('0.25');
    await start(page);
    await page.locator('.kind', { hasText: 'Quad mesh' }).waitFor();
    const path = await save(page, 'OBJ');
    const quality = JSON.parse(run('quality', path, '--json'));
    const { count, align, adaptive } = await page.evaluate(() => {
        const { scene, result } = window.panels[0].model;
        const { align, adaptive } = result.report.options.map;
        return { count: scene.corners.length / 4, align, adaptive };
    });
    expect(quality.topology.polygons['4'] === count && quality.topology.bad_edges === 0, JSON.stringify(quality.topology).slice(0, 300));
    expect(align === 0.5 && adaptive === 0.25, `direction ${align} and density ${adaptive} are those of the form`);
    const binary = readFileSync(await save(page, 'GLB'));
    expect(binary.readUInt32LE(8) === binary.length, 'the GLB file says its length');
    const ply = JSON.parse(run('quality', await save(page, 'PLY'), '--json'));
    expect(ply.topology.polygons['4'] === count, 'the PLY file has the same quads');
    const report = await saveReports(page, 'quad mesh');
    const shown = await metric(page, 'Quads');
    expect(report.quads.count === count && String(count) === shown, `${report.quads.count} of ${count} quads; the page shows ${shown}`);
    await expectAccessible(page);
}

async function followsPickedEdges(page) {
    await page.locator('#features').selectOption('picked');
    await page.locator('.kind', { hasText: 'Mesh' }).waitFor();
    await done(page);
    const box = await page.locator('canvas').first().boundingBox();
    const click = (dx) => page.mouse.click(box.x + box.width / 2 + dx, box.y + box.height / 2);
    const says = (text) => page.locator('.status', { hasText: text }).waitFor();
    await click(0);
    await says('1 edge is picked');
    await click(0);
    await says('0 edges are picked');
    await click(0);
    await click(90);
    await says('2 edges are picked');
    await start(page);
    await page.locator('.kind', { hasText: 'Quad mesh' }).waitFor();
    const features = await page.evaluate(() => window.panels[0].model.result.report.features);
    expect(features.edges === 2 && features.sources[0].source.startsWith('edges:'), JSON.stringify(features.sources));
}

async function makesAMap(page) {
    await drop(page, 'bracket.obj', readFileSync(bracket));
    await done(page);
    await makeMap(page);
    const path = await save(page, 'OBJ');
    verify(bracket, path);
    const shown = await page.evaluate(() => window.panels[0].model.result.report.distortion.tau);
    const made = JSON.parse(run('measure', bracket, path, '--json'));
    const tau = made.measures.find(({ measure }) => measure === 'tau');
    expect(Math.abs(tau.max - shown) < 1e-9, `${tau.max} is not ${shown}`);
    await page.evaluate((face) => { window.panels[0].pick(face); }, tau.worst);
    const text = await page.locator('.readout').textContent();
    expect(text.includes(`tau ${tau.max.toFixed(4)}`), text);
    // In single precision.
    const uvs = (file) => run('measure', bracket, file, '--json');
    for (const kind of ['PLY', 'GLB']) {
        const other = JSON.parse(uvs(await save(page, kind))).measures.find(({ measure }) => measure === 'tau');
        expect(Math.abs(other.max / tau.max - 1) < 1e-4, `${kind}: ${other.max} is not ${tau.max}`);
    }
    const report = await saveReports(page, 'seamless map');
    const rounded = await metric(page, 'Tau');
    const digits = rounded.split('.')[1]?.length ?? 0;
    expect(report.distortion.tau === shown && shown.toFixed(digits) === rounded, `tau ${report.distortion.tau} is not ${shown}; the page shows ${rounded}`);
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

async function refusesWhatIsTooLarge(page) {
    await page.evaluate(() => {
        const event = new DragEvent('drop');
        Object.defineProperty(event, 'dataTransfer', { value: { files: [{ name: 'huge.obj', size: 2e9 }] } });
        window.dispatchEvent(event);
    });
    await page.locator('.failure', { hasText: 'huge.obj has 2000 MB; at most' }).waitFor();
}

/** A coarse map first, with the time that is left; then it is stopped within a second. */
async function cancels(page) {
    await drop(page, 'large.obj', ball(400, 200));
    await done(page);
    await page.getByRole('button', { name: 'Seamless map' }).click();
    await start(page);
    await page.locator('.kind', { hasText: 'Preview' }).waitFor();
    const { triangles, claims } = await page.evaluate(() => {
        const { scene, result } = window.panels[0].model;
        return { triangles: scene.corners.length / 3, claims: result.facts.claims };
    });
    expect(triangles === 4000 && claims.every(({ passed }) => passed), `${triangles} triangles, ${JSON.stringify(claims)}`);
    await page.locator('.running', { hasText: 'left' }).waitFor();
    const begin = Date.now();
    // It moves as the progress does.
    await page.getByRole('button', { name: 'Cancel' }).click({ force: true });
    await page.locator('.failure', { hasText: 'Stopped' }).waitFor();
    expect(Date.now() - begin < 1000, `it took ${Date.now() - begin} ms to stop`);
    // What comes next works.
    await drop(page, 'triangle.obj', 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n');
    await done(page);
}

/** All that can be done is reached by the keyboard. */
async function hasKeys(page) {
    await sample(page, 'Bowl');
    const wanted = await page.evaluate(() => [...document.querySelectorAll('button, select, input, canvas, summary')]
        .filter((element) => element.checkVisibility() && !element.disabled).length);
    const reached = new Set();
    for (let k = 0; k < wanted + 20; k++) {
        await page.keyboard.press('Tab');
        const found = await page.evaluate(() => {
            const all = [...document.querySelectorAll('button, select, input, canvas, summary')];
            return all.indexOf(document.activeElement);
        });
        if (found >= 0) reached.add(found);
    }
    expect(reached.size === wanted, `${reached.size} of ${wanted} controls are reached`);
}

function flow(place) {
    return async (browser) => {
        const { address, stop } = await place();
        const page = await open(browser, address);
        try {
            for (const step of [makesQuads, followsPickedEdges, makesAMap, refuses, refusesWhatIsTooLarge]) await step(page);
            for (const step of [hasKeys, cancels]) {
                await page.reload();
                await step(page);
            }
        } finally {
            stop();
        }
        return page;
    };
}

export const tests = {
    'the app of the program makes quads and maps': flow(program),

    async 'the program shows the mesh that it was started with'(browser) {
        const { address, stop } = await program(bracket);
        try {
            const page = await open(browser, address);
            await done(page);
            expect((await page.locator('.heading h1').textContent()) === 'bracket.obj', 'it is the mesh of the file');
            return page;
        } finally {
            stop();
        }
    },
};

if (hasMethod) {
    tests['the app in a browser makes quads and maps by itself'] = flow(host);
} else {
    console.log('SKIPPED: the app in a browser; .ci/wasm builds what it needs');
}
