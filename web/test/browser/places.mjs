// Where the app is: served by the program, or files on some host.
import { spawn } from 'node:child_process';
import { existsSync, readFileSync } from 'node:fs';
import { createServer, request } from 'node:http';
import { extname, join } from 'node:path';
import { command, folder, root } from './browser.mjs';

const dist = join(root, 'web/dist');
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm' };

/** Whether the method has been built for browsers. */
export const hasMethod = existsSync(join(dist, 'pkg/seamstress_wasm_bg.wasm'));

/** The program, as `seamstress app` starts it. */
export async function program(...words) {
    const child = spawn(command, ['app', '--no-open', ...words], { cwd: folder });
    const address = await new Promise((resolve) => {
        child.stdout.on('data', (text) => { resolve(String(text).split('\n')[0]); });
    });
    return { address, id: child.pid, stop: () => child.kill('SIGINT'), ended: new Promise((resolve) => { child.on('exit', resolve); }) };
}

/** A host of files, in a folder of its own; what it sends can be changed. */
export async function host(change = (path, content) => content) {
    const server = createServer((asked, response) => {
        const path = join(dist, new URL(asked.url, 'http://x').pathname.replace(/^\/some\/place\//, '').replace(/^$/, 'index.html'));
        if (!existsSync(path)) { response.writeHead(404).end(); return; }
        response.writeHead(200, { 'content-type': TYPES[extname(path)] }).end(change(path, readFileSync(path)));
    });
    await new Promise((resolve) => { server.listen(0, '127.0.0.1', resolve); });
    const stop = () => { server.close(); server.closeAllConnections(); };
    return { address: `http://127.0.0.1:${server.address().port}/some/place/`, stop };
}

/** The status of what is answered to a request. */
export function status(address, headers = {}, method = 'GET') {
    return new Promise((resolve, reject) => {
        request(address, { headers, method }, (response) => { response.resume(); resolve(response.statusCode); }).on('error', reject).end();
    });
}
