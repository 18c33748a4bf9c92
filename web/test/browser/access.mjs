// What people need who do not see the page, or use no pointer.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { expect } from './browser.mjs';

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

/** Fails for serious faults that axe finds. */
export async function expectAccessible(page) {
    await page.evaluate(axe);
    const { violations } = await page.evaluate(() => window.axe.run(document));
    const serious = violations.filter(({ impact }) => impact === 'serious' || impact === 'critical');
    const text = serious.map(({ id, nodes }) => `${id}: ${nodes.slice(0, 3).map(({ html }) => html.slice(0, 120)).join(' | ')}`);
    expect(serious.length === 0, text.join('\n'));
}
