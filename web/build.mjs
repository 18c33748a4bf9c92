// Bundles the page.
//
//   node build.mjs            writes the bundles that crates embed, and the app for browsers into dist
//   node build.mjs --check    fails if the bundles that are committed are not what the sources make
import { build } from 'esbuild';
import { createHash } from 'node:crypto';
import { mkdir, readdir, readFile, writeFile } from 'node:fs/promises';
import { dirname } from 'node:path';

const REPORT = '../crates/seamstress/src/page/assets';
const APP = '../crates/cli/src/commands/app/assets';
const DIST = 'dist';

/** The help of options, as the facade documents them. */
async function words() {
    const [quads, surface] = await Promise.all(['quad-options', 'surface-options'].map(async (name) =>
        JSON.parse(await readFile(`../docs/schema/${name}.json`, 'utf8'))));
    const size = (name) => quads.$defs.GridSize.oneOf.find(({ required }) => required[0] === name);
    const { MapOptions: { properties: map }, ShapeOptions: { properties: shape } } = quads.$defs;
    const found = {
        repair: surface.properties.repair,
        quads: size('quads'),
        edge_length: size('edge-length'),
        features: map.features,
        align: map.align,
        adaptive: map.adaptive,
        min_edge: map.min_edge,
        max_edge: map.max_edge,
        smooth: shape.smooth,
        cone_bias: map.cone_bias,
    };
    return Object.fromEntries(Object.entries(found).map(([name, { description }]) => [name, description.split('\n\n')[0].replaceAll('\n', ' ')]));
}

async function bundle(entry, define = {}) {
    const { outputFiles } = await build({
        entryPoints: [entry],
        bundle: true,
        minify: true,
        write: false,
        format: 'esm',
        target: 'es2022',
        charset: 'utf8',
        legalComments: 'none',
        define,
    });
    return outputFiles[0].text;
}

const page = await readFile('src/app.html', 'utf8');
const [report, style, app, worker, offline] = await Promise.all([
    bundle('src/report.ts'),
    bundle('src/style.css'),
    words().then((found) => bundle('src/app.ts', { WORDS: JSON.stringify(found) })),
    bundle('src/worker.ts'),
    readFile('src/offline.js', 'utf8'),
]);
/** The method, if `.ci/wasm` has built it: a new one is another version of the app. */
const method = await Promise.all((await readdir(`${DIST}/pkg`).catch(() => [])).sort().map((name) => readFile(`${DIST}/pkg/${name}`)));
const hash = createHash('sha256');
[page, app, worker, style, ...method].forEach((content) => { hash.update(content); });
const version = hash.digest('hex').slice(0, 12);
const embedded = {
    [`${REPORT}/report.js`]: report,
    [`${REPORT}/style.css`]: style,
    [`${APP}/app.html`]: page.replace('ENGINE', 'server'),
    [`${APP}/app.js`]: app,
    [`${APP}/style.css`]: style,
};
const hosted = {
    [`${DIST}/index.html`]: page.replace('ENGINE', 'worker'),
    [`${DIST}/app.js`]: app,
    [`${DIST}/worker.js`]: worker,
    [`${DIST}/style.css`]: style,
    [`${DIST}/offline.js`]: offline.replace('BUILD', version),
};

const isCheck = process.argv.includes('--check');
for (const [path, text] of Object.entries(isCheck ? embedded : { ...embedded, ...hosted })) {
    if (!isCheck) {
        await mkdir(dirname(path), { recursive: true });
        await writeFile(path, text);
        console.log(`${path}: ${text.length} bytes`);
    } else if (await readFile(path, 'utf8').catch(() => '') !== text) {
        console.error(`${path} is not what its sources make: run npm run build in web`);
        process.exitCode = 1;
    }
}
