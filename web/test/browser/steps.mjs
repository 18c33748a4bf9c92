// What people do in the app.
import { join } from 'node:path';
import { folder } from './browser.mjs';

/** Waits for a result. */
export const done = (page) => page.locator('.status', { hasText: 'Done in' }).waitFor();

export const start = (page) => page.getByRole('button', { name: 'Make it' }).click();

/** Opens a sample. */
export async function sample(page, name) {
    await page.getByRole('button', { name }).first().click();
    await done(page);
}

/** Opens a file of this name and content. */
export async function drop(page, name, content) {
    await page.locator('input[type=file]').setInputFiles({ name, mimeType: 'text/plain', buffer: Buffer.from(content) });
}

/** Makes a map that follows no features. */
export async function makeMap(page) {
    await page.getByRole('button', { name: 'Seamless map' }).click();
    await page.locator('#features').selectOption('none');
    await start(page);
    await page.locator('.kind', { hasText: 'Seamless map' }).waitFor();
    await done(page);
}

/** Saves the result as a file of some kind; returns where it is. */
export async function save(page, kind) {
    const [saved] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: kind, exact: true }).click()]);
    const path = join(folder, saved.suggestedFilename());
    await saved.saveAs(path);
    return path;
}

/** A ball with bumps, of twice as many triangles as `around` times `up`. */
export function ball(around, up) {
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
