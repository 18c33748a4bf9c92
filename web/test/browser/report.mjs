// Reports from files, with the network off.
import { readFileSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { expect, folder, open, root, run } from './browser.mjs';
import { expectAccessible } from './access.mjs';

const spot = join(root, 'samples/spot.obj');
const address = (name) => `file://${join(folder, name)}`;
const readout = (page) => page.locator('.readout').first().textContent();
const ready = (page) => page.waitForFunction(() => window.panels !== undefined);

export const tests = {
    async 'a map can be turned, and a triangle picked whose tau is that of the report'(browser) {
        run('map', spot, '-o', 'spot.obj', '--report', 'spot.html', '--report', 'spot.json');
        run('measure', spot, 'spot.obj', '--json');
        const report = JSON.parse(readFileSync(join(folder, 'spot.json'), 'utf8'));
        const page = await open(browser, address('spot.html'));
        await page.context().setOffline(true);
        await ready(page);
        const worst = JSON.parse(run('measure', spot, 'spot.obj', '--json')).measures.find(({ measure }) => measure === 'tau');
        await page.evaluate((face) => { window.panels[0].pick(face); }, worst.worst);
        const text = await readout(page);
        expect(text.includes(`Triangle ${worst.worst}`) && text.includes(`tau ${report.distortion.tau.toFixed(4)}`), text);

        const canvas = page.locator('canvas').first();
        const box = await canvas.boundingBox();
        const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
        const before = await page.evaluate(() => window.panels[0].settings.pose.yaw);
        await page.mouse.move(x, y);
        await page.mouse.down();
        await page.mouse.move(x + 80, y + 10, { steps: 4 });
        await page.mouse.up();
        const { pose, picked } = await page.evaluate(() => window.panels[0].settings);
        expect(pose.yaw !== before, 'a drag turns the surface');
        expect(picked === worst.worst, 'a drag picks nothing');
        await page.mouse.click(x, y);
        const clicked = await page.evaluate(() => window.panels[0].settings.picked);
        expect(clicked >= 0 && clicked !== worst.worst, `a click picks what is in the middle: ${clicked}`);

        // The keyboard does the same, and the address keeps it.
        await canvas.focus();
        await page.keyboard.press('ArrowLeft');
        await page.keyboard.press('+');
        await page.locator('select').selectOption('tau');
        await page.waitForFunction(() => location.hash.includes('show=tau') && location.hash.includes('view='));
        const kept = await page.evaluate(() => [location.hash, window.panels[0].settings.pose.yaw.toFixed(2)]);
        await page.reload();
        await ready(page);
        const again = await page.evaluate(() => [location.hash, window.panels[0].settings.pose.yaw.toFixed(2)]);
        expect(String(again) === String(kept), `${again} is not ${kept}`);
        await expectAccessible(page);
        return page;
    },

    async 'quads show their edges, at the width of a telephone and in the dark'(browser) {
        run('quad', join(root, 'samples/bracket.obj'), '--quads', '600', '-o', 'quads.obj', '--report', 'quads.html');
        const page = await open(browser, address('quads.html'), { viewport: { width: 390, height: 844 }, colorScheme: 'dark', hasTouch: true });
        await ready(page);
        const width = await page.evaluate(() => document.documentElement.scrollWidth);
        expect(width <= 390, `the page is ${width} pixels wide`);
        const { sides, edges } = await page.evaluate(() => ({ sides: window.panels[0].model.scene.sides, edges: window.panels[0].settings.edges }));
        expect(sides === 4 && edges, `${sides} sides, edges ${edges}`);
        await expectAccessible(page);
        return page;
    },

    async 'reports are small'() {
        for (const name of ['spot', 'bracket']) {
            const mesh = join(root, `samples/${name}.obj`);
            const faces = JSON.parse(run('check', mesh, '--json')).input.faces;
            run('map', mesh, '-o', 'small_map.obj', '--report', 'map.html');
            run('integer', mesh, '--quads', '1500', '-o', 'small_integer.obj', '--report', 'integer.html');
            run('quad', mesh, '--quads', '1500', '-o', 'small_quads.obj', '--report', 'quad.html');
            run('check', mesh, '--report', 'check.html');
            run('check', mesh, 'small_map.obj', '--report', 'checked.html');
            for (const command of ['map', 'integer', 'quad', 'check', 'checked']) {
                const { size } = statSync(join(folder, `${command}.html`));
                expect(size < 60_000 + 15 * faces, `${command} of ${name}: ${size} bytes, at most ${60_000 + 15 * faces}`);
            }
        }
    },

    async 'a fault of a mesh can be gone to'(browser) {
        const text = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nf 1 2 3\nf 2 1 4\nf 1 2 5\n';
        writeFileSync(join(folder, 'fan.obj'), text);
        try { run('check', 'fan.obj', '--report', 'fan.html'); } catch { /* It is no mesh, and says so. */ }
        const page = await open(browser, address('fan.html'));
        await ready(page);
        const before = await page.evaluate(() => window.panels[0].settings.pose.zoom);
        await page.locator('.place').first().click();
        const after = await page.evaluate(() => window.panels[0].settings.pose);
        expect(after.middle.some((x) => x !== 0), `the fault is in the middle: ${JSON.stringify(after)} after ${before}`);
        return page;
    },

    async 'reports side by side turn together'(browser) {
        run('report', 'spot.html', 'quads.html', '-o', 'both.html');
        const page = await open(browser, address('both.html'));
        await ready(page);
        await page.locator('canvas').first().focus();
        await page.keyboard.press('ArrowRight');
        const [a, b] = await page.evaluate(() => window.panels.map(({ settings }) => settings.pose.yaw));
        expect(a === b, `${a} and ${b}`);
        await expectAccessible(page);
        return page;
    },

    async 'a page without WebGL says so, and says the rest'(browser) {
        const page = await open(browser, 'about:blank');
        await page.addInitScript(() => { HTMLCanvasElement.prototype.getContext = () => null; });
        await page.goto(address('spot.html'));
        await ready(page);
        expect((await page.locator('.empty').textContent()).includes('WebGL'), 'it says what is missing');
        expect((await page.locator('.claims li').count()) === 3, 'the certificate is there');
        return page;
    },
};
