// Runs the tests in a browser, one after the other.
import { mkdirSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { folder, launch } from './browser.mjs';
import { tests as ofApp } from './app.mjs';
import { tests as ofGuards } from './guard.mjs';
import { tests as ofReports } from './report.mjs';
import { tests as ofStates } from './states.mjs';

// With a folder in PICTURES, what each test ends with is kept there.
const pictures = process.env.PICTURES;
if (pictures) mkdirSync(pictures, { recursive: true });

// With a word, only the tests that have it in their names.
const wanted = process.argv[2] ?? '';
const all = Object.entries({ ...ofReports, ...ofStates, ...ofApp, ...ofGuards }).filter(([name]) => name.includes(wanted));
const browser = await launch();
let failed = 0;
for (const [name, test] of all) {
    const start = Date.now();
    try {
        const page = await test(browser);
        const faults = page?.faults ?? [];
        if (faults.length > 0) throw new Error(faults.join('\n'));
        if (pictures && page) await page.screenshot({ path: join(pictures, `${name.replaceAll(/\W+/g, '-')}.png`) });
        await page?.context().close();
        console.log(`ok      ${name} (${((Date.now() - start) / 1000).toFixed(1)} s)`);
    } catch (error) {
        failed++;
        console.error(`FAILED  ${name}\n${error.stack}`);
    }
}
await browser.close();
rmSync(folder, { recursive: true });
process.exit(failed > 0 ? 1 : 0);
