// What the app must not do: answer strangers, ask strangers, disturb others, go on for nobody.
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { expect, folder, open, run } from './browser.mjs';
import { hasMethod, host, program, status } from './places.mjs';
import { ball, done, drop, makeMap, sample, save, start } from './steps.mjs';

/** What a map is, without what a file says of it. */
const lines = (path) => readFileSync(path, 'utf8').split('\n').filter((line) => /^(v|vt|f) /.test(line)).join('\n');

export const tests = {
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

    async 'two pages of the program get what each has asked for'(browser) {
        const { address, stop } = await program();
        const meshes = { 'one.obj': ball(90, 50), 'two.obj': ball(80, 60) };
        try {
            const made = await Promise.all(Object.entries(meshes).map(async ([name, content]) => {
                const page = await open(browser, address);
                await drop(page, name, content);
                await done(page);
                await makeMap(page);
                const path = await save(page, 'OBJ');
                await page.context().close();
                return path;
            }));
            Object.entries(meshes).forEach(([name, content], k) => {
                writeFileSync(join(folder, name), content);
                run('map', name, '-o', `alone_${name}`);
                expect(lines(made[k]) === lines(join(folder, `alone_${name}`)), `the map of ${name} is that of the command`);
            });
        } finally {
            stop();
        }
    },

    async 'a page that is closed cancels its job'(browser) {
        const { address, stop } = await program();
        try {
            const page = await open(browser, address);
            await drop(page, 'large.obj', ball(400, 200));
            await done(page);
            await page.getByRole('button', { name: 'Seamless map' }).click();
            const asked = page.waitForRequest(/jobs\/\d+$/);
            await start(page);
            const job = (await asked).url();
            expect(await status(job) === 200, 'the job is at work');
            await page.close({ runBeforeUnload: true });
            const begin = Date.now();
            while (await status(job) !== 404) expect(Date.now() - begin < 5000, 'the job goes on without its page');
        } finally {
            stop();
        }
    },

    async 'a page that nobody sees, whose timers stand still, gets its result'(browser) {
        const { address, stop } = await program();
        try {
            const page = await open(browser, 'about:blank');
            await page.addInitScript(() => { window.setTimeout = () => 0; });
            await page.goto(address);
            await sample(page, 'Step');
            return page;
        } finally {
            stop();
        }
    },
};

/** The same method with less memory: the largest size of its memory, the only one, becomes so many pages of 64 kB. */
function withMemory(method, pages) {
    const number = (at) => {
        let [value, shift, next] = [0, 0, at];
        do { value += (method[next] & 127) * 2 ** shift; shift += 7; } while (method[next++] & 128);
        return { value, next };
    };
    const bytes = (value) => value < 128 ? [value] : [value % 128 + 128, ...bytes(Math.floor(value / 128))];
    // After the magic number and the version: sections, each with its kind and length.
    for (let at = 8; at < method.length;) {
        const { value: length, next } = number(at + 1);
        if (method[at] === 5) {
            const { value: least } = number(next + 2);
            const section = [1, 1, ...bytes(least), ...bytes(pages)];
            return Buffer.concat([method.subarray(0, at), Buffer.from([5, section.length, ...section]), method.subarray(next + length)]);
        }
        at = next + length;
    }
    throw new Error('the method has no memory');
}

if (hasMethod) {
    tests['a browser with little memory says what is amiss, and goes on'] = async (browser) => {
        const { address, stop } = await host((path, content) => path.endsWith('.wasm') ? withMemory(content, 400) : content);
        try {
            const page = await open(browser, address, { serviceWorkers: 'block' });
            await drop(page, 'large.obj', ball(400, 200));
            await page.locator('.failure', { hasText: 'for want of memory' }).waitFor();
            const text = await page.locator('.failure').textContent();
            expect(text.includes('a smaller mesh') && text.includes('seamstress app'), text);
            // The next task has a worker, and a memory, of its own.
            await sample(page, 'Step');
            return page;
        } finally {
            stop();
        }
    };

    tests['the app in a browser works without a network, and asks nobody'] = async (browser) => {
        const { address, stop } = await host();
        // What another page of the host keeps stays.
        const page = await open(browser, `${address}style.css`);
        await page.evaluate(() => caches.open('of another page'));
        await page.goto(address);
        // That one had no icon.
        page.faults.length = 0;
        await page.evaluate(() => navigator.serviceWorker.ready);
        stop();
        await page.context().setOffline(true);
        await page.reload();
        const kept = await page.evaluate(() => caches.keys());
        expect(kept.length === 2 && kept.includes('of another page'), String(kept));
        await sample(page, 'Step');
        await page.getByLabel('Number of quads, or edge length').fill('200');
        await start(page);
        await page.locator('.kind', { hasText: 'Quad mesh' }).waitFor();

        await page.context().setOffline(false);
        const blocked = await page.evaluate(() => new Promise((resolve) => {
            addEventListener('securitypolicyviolation', ({ effectiveDirective }) => { resolve(effectiveDirective); });
            fetch('http://127.0.0.1:1/').catch(() => undefined);
        }));
        expect(blocked === 'connect-src', `the page may ask others: ${blocked}`);
        page.faults = page.faults.filter((text) => !text.includes('127.0.0.1:1'));
        return page;
    };
}
