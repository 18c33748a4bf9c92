// What the page looks like, in ten states; and in each, that it is for everybody.
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { expectAccessible } from './access.mjs';
import { folder, open, root, run } from './browser.mjs';
import { expectPicture, prepare } from './pictures.mjs';
import { program } from './places.mjs';
import { done, drop, sample, start } from './steps.mjs';

const DESK = { viewport: { width: 1100, height: 640 } };
const PHONE = { viewport: { width: 390, height: 700 }, hasTouch: true };
const DARK = { colorScheme: 'dark' };
const ready = (page) => page.waitForFunction(() => window.panels !== undefined);
const FAN = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nf 1 2 3\nf 2 1 4\nf 1 2 5\n';

/** A state of a report: how it is made, how it is looked at. */
const report = (name, make, options, look = () => undefined) => async (browser) => {
    make(`${name}.html`);
    const page = await open(browser, `file://${join(folder, `${name}.html`)}`, options);
    await ready(page);
    await look(page);
    return page;
};

/** A state of the app. */
const app = (options, go = () => undefined) => async (browser, address) => {
    const page = await open(browser, address, options);
    await go(page);
    return page;
};

const input = (name) => join(root, `samples/${name}.obj`);
const make = (command, name, ...words) => (html) => run(command, input(name), '-o', `${html}.obj`, ...words, '--report', html);
const show = (measure) => (page) => page.locator('select').selectOption(measure);

const states = {
    welcome: app(DESK),
    'welcome-phone-dark': app({ ...PHONE, ...DARK }),
    'picked-edges': app(DESK, async (page) => {
        await sample(page, 'Step');
        await page.locator('#features').selectOption('picked');
        await page.locator('.kind', { hasText: 'Mesh' }).waitFor();
        await done(page);
        const { x, y, width, height } = await page.locator('canvas').first().boundingBox();
        await page.mouse.click(x + width / 2, y + height / 2);
    }),
    quads: app(DESK, async (page) => {
        await sample(page, 'Step');
        await page.getByLabel('Number of quads, or edge length').fill('300');
        await start(page);
        await page.locator('.kind', { hasText: 'Quad mesh' }).waitFor();
    }),
    'refused-dark': app({ ...DESK, ...DARK }, async (page) => {
        await drop(page, 'bad.obj', 'v 0 0 0\nv 1 0 0\nf 1 2 7\n');
        await page.locator('.failure').waitFor();
        await page.addStyleTag({ content: '.status { visibility: visible !important }' });
    }),
    map: report('map', make('map', 'spot'), DESK),
    'map-tau-dark': report('map-tau-dark', make('map', 'spot'), { ...DESK, ...DARK }, show('tau')),
    integer: report('integer', make('integer', 'bracket', '--quads', '600'), DESK, show('area')),
    'quads-phone-dark': report('quads-phone-dark', make('quad', 'bracket', '--quads', '600'), { ...PHONE, ...DARK }),
    fault: report('fault', (html) => {
        writeFileSync(join(folder, 'fan.obj'), FAN);
        try { run('check', 'fan.obj', '--report', html); } catch { /* It is no mesh, and says so. */ }
    }, DESK, (page) => page.locator('.place').first().click()),
    comparison: report('comparison', (html) => run('report', 'map.html', 'integer.html', '-o', html), DESK),
};

export const tests = {
    async 'ten states look as they did, and axe finds no serious fault in them'(browser) {
        const { address, stop } = await program();
        const faults = [];
        try {
            for (const [name, reach] of Object.entries(states)) {
                const page = await reach(browser, address);
                const hasLetters = await prepare(page);
                try {
                    await expectAccessible(page);
                    if (hasLetters) await expectPicture(page, name);
                    else console.log(`SKIPPED: the picture of ${name}, since the font DejaVu Sans was not found`);
                } catch (error) {
                    faults.push(`${name}: ${error.message}`);
                }
                faults.push(...page.faults);
                await page.context().close();
            }
        } finally {
            stop();
        }
        if (faults.length > 0) throw new Error(faults.join('\n'));
    },
};
