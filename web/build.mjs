// Bundles the viewer into the crates that embed it.
//
//   node build.mjs            writes the bundles
//   node build.mjs --check    fails if those that are committed are not what the sources make
import { build } from 'esbuild';
import { mkdir, readFile, writeFile } from 'node:fs/promises';
import { dirname } from 'node:path';

const REPORT = '../crates/seamstress/src/page/assets';
const targets = [
    { from: 'src/report.ts', to: `${REPORT}/report.js` },
    { from: 'src/style.css', to: `${REPORT}/style.css` },
];

async function bundle(entry) {
    const { outputFiles } = await build({
        entryPoints: [entry],
        bundle: true,
        minify: true,
        write: false,
        format: 'esm',
        target: 'es2022',
        charset: 'utf8',
        legalComments: 'none',
    });
    return outputFiles[0].text;
}

const isCheck = process.argv.includes('--check');
let isFresh = true;
for (const { from, to } of targets) {
    const text = await bundle(from);
    if (isCheck) {
        const found = await readFile(to, 'utf8').catch(() => '');
        if (found !== text) {
            console.error(`${to} is not what web/${from} makes: run npm run build in web/`);
            isFresh = false;
        }
    } else {
        await mkdir(dirname(to), { recursive: true });
        await writeFile(to, text);
        console.log(`${to}: ${text.length} bytes`);
    }
}
process.exitCode = isFresh ? 0 : 1;
