// What the tests in a browser have in common.
import { chromium } from 'playwright-core';
import { execFileSync } from 'node:child_process';
import { mkdtempSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';

export const root = resolve(import.meta.dirname, '../../..');
export const command = resolve(process.env.CARGO_TARGET_DIR ?? join(root, 'target'), 'release/seamstress');
export const folder = mkdtempSync(join(tmpdir(), 'page-'));

/** Runs the command in the folder of the tests; returns what it prints. */
export function run(...words) {
    return execFileSync(command, words, { cwd: folder, encoding: 'utf8', stdio: 'pipe' });
}

/** A browser that draws in software, and opens no connection of its own. */
export function launch() {
    return chromium.launch({
        executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
        args: ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking',
            '--disable-component-update', '--disable-sync', '--use-gl=angle', '--use-angle=swiftshader',
            '--enable-unsafe-swiftshader'],
    });
}

/** A page whose errors, and requests that leave this machine, fail the test. */
export async function open(browser, address, options = {}) {
    const context = await browser.newContext({ viewport: { width: 1200, height: 800 }, ...options });
    const page = await context.newPage();
    page.faults = [];
    page.setDefaultTimeout(60_000);
    page.on('pageerror', (error) => page.faults.push(error.message));
    page.on('console', (message) => { if (message.type() === 'error') page.faults.push(message.text()); });
    page.on('request', (request) => {
        if (!/^(file|blob|data|http:\/\/127\.0\.0\.1)/.test(request.url())) page.faults.push(`request: ${request.url()}`);
    });
    await page.goto(address);
    return page;
}

/** Fails unless something is so. */
export function expect(isSo, text) {
    if (!isSo) throw new Error(text);
}
