// The app: a mesh in, quads or a map out, made by a worker of the page or by the program that serves it.
import { download, h } from './dom';
import { Refusal, ServerEngine, STOPPED, WorkerEngine, type Engine, type MeshFile, type Outcome, type Task } from './engine';
import { Form } from './form';
import { makeModel } from './model';
import { Panel } from './panel';
import { Running } from './running';
import { SAMPLES } from './samples';
import { polygonCount } from './scene';
import { heading, sections } from './sections';
import { suitable } from './settings';

/** Triangles of a preview, and of meshes that get one: it takes a second, and what it shows takes several. */
const [COARSE, LARGE] = [4_000, 12_000];
const ENDINGS = ['obj', 'off', 'ply', 'stl', 'glb', 'gltf'];

const here = (name: string): string => new URL(name, document.baseURI).href;
const isServed = document.documentElement.dataset.engine === 'server';
const engine: Engine = isServed ? new ServerEngine() : new WorkerEngine(here('worker.js'), here('pkg/seamstress_wasm_bg.wasm'));
/** Larger files are refused: they would not fit into memory. */
const LARGEST = (isServed ? 1000 : 200) * 1e6;

const stage = h('div', { class: 'place-of-result' });
const side = h('div', { class: 'about' });
const status = h('div', { class: 'status', role: 'status' });
const form = new Form((task) => { void make(task); }, () => { void showMesh(); });
const input = h('input', { type: 'file', accept: [...ENDINGS, 'gz'].map((ending) => `.${ending}`).join(), 'aria-label': 'A mesh', hidden: true, onchange: () => { void take(input.files?.[0]); } });
/** Not announced as the status is, since it changes all the time. */
const work = h('div', {});
let file: MeshFile | undefined;
let running: AbortController | undefined;
/** Ends what is done before there is a mesh. */
const warming = new AbortController();
let shown: Panel | undefined;
/** Triangles of the mesh, as far as known. */
let triangles = 0;

function welcome(): HTMLElement {
    const samples = SAMPLES.map(({ name, text, next, make: makeSample }) => h('button', { type: 'button', class: 'sample', onclick: () => { open(makeSample(), next); } }, h('b', {}, name), text));
    const where = isServed ? 'The program on this machine does the work.' : 'This page does the work: nothing is uploaded.';
    return h('div', { class: 'drop' },
        h('h2', { class: 'call' }, 'Drop a mesh here'),
        h('p', {}, 'OBJ, OFF, PLY, STL or glTF, also compressed with gzip. ', where),
        h('p', {}, h('button', { type: 'button', class: 'button primary', onclick: () => { input.click(); } }, 'Choose a file')),
        h('p', { class: 'meaning' }, 'Or try a sample:'),
        h('div', { class: 'samples' }, ...samples));
}

function say(...parts: readonly Node[]): void {
    status.replaceChildren(...parts);
    if (parts.length > 0) status.scrollIntoView({ block: 'nearest' });
}

function fail(error: unknown): void {
    const [text, hint] = error instanceof Refusal ? [error.message, error.hint] : [String(error), null];
    say(h('p', { class: 'failure', role: 'alert' }, text), ...(hint ? [h('p', { class: 'meaning' }, `Hint: ${hint}`)] : []));
}

async function take(given: File | undefined): Promise<void> {
    if (!given) return;
    if (given.size > LARGEST) {
        fail(new Refusal(`${given.name} has ${(given.size / 1e6).toFixed(0)} MB; at most ${(LARGEST / 1e6).toFixed(0)} MB are taken here.`));
        return;
    }
    open({ name: given.name, content: new Uint8Array(await given.arrayBuffer()) });
}

/** Takes a mesh, and shows it with what to try next. */
function open(mesh: MeshFile, next?: string): void {
    file = mesh;
    form.picked = [];
    triangles = 0;
    void make({ surface: { repair: false }, make: { check: ['auto'] } }, next);
}

/** Shows the mesh, to click on edges. */
async function showMesh(): Promise<void> {
    await make({ surface: { repair: false }, make: { check: [] } });
    shown?.setFeatures(form.picked);
}

/** Takes an edge among the features, or out again. */
function pickEdge([a, b]: readonly [number, number]): void {
    if (!form.isPicking) return;
    const rest = form.picked.filter(([c, d]) => !((a === c && b === d) || (a === d && b === c)));
    form.picked = rest.length < form.picked.length ? rest : [...rest, [a, b]];
    shown?.setFeatures(form.picked);
    say(h('p', { class: 'meaning' }, form.picked.length === 1 ? '1 edge is picked.' : `${form.picked.length} edges are picked.`));
}

async function make(task: Task, next?: string): Promise<void> {
    const mesh = file;
    if (!mesh) return;
    running?.abort();
    warming.abort();
    const controller = running = new AbortController();
    const { signal } = controller;
    form.enabled = false;
    say();
    const start = performance.now();
    const run = async (what: Task, title: string): Promise<Outcome> => {
        const shows = new Running(what, title, () => { controller.abort(); });
        work.replaceChildren(shows.element);
        work.scrollIntoView({ block: 'nearest' });
        return engine.run(what, mesh, (progress) => { shows.show(progress); }, signal).finally(() => { shows.end(); });
    };
    try {
        const isCheck = 'check' in task.make;
        if (!isCheck && triangles > LARGE) {
            // What a coarse mesh cannot show, the mesh itself may.
            const preview = await run({ ...task, coarse: COARSE }, 'Preview').catch(() => undefined);
            if (signal.aborted) throw new Refusal(STOPPED);
            if (preview) showPreview(preview);
        }
        const outcome = await run(task, isCheck ? 'Reading' : 'Working');
        if (controller === running) showOutcome(outcome, (performance.now() - start) / 1000, next);
    } catch (error) {
        if (controller === running) fail(error);
    } finally {
        if (controller === running) {
            running = undefined;
            work.replaceChildren();
            form.enabled = true;
        }
    }
}

/** Draws a result, seen from where the one before was if it is of the same mesh. */
function draw({ result, scene }: Outcome, pick?: (side: readonly [number, number]) => void): Panel {
    const model = makeModel(scene, result);
    const pose = shown?.model.result.facts.name === result.facts.name ? { pose: shown.settings.pose } : {};
    const panel = new Panel(model, { ...suitable(model), ...pose }, pick ? { side: pick } : {});
    shown?.end();
    shown = panel;
    stage.replaceChildren(panel.element);
    panel.start();
    window.panels = [panel];
    return panel;
}

function showPreview(outcome: Outcome): void {
    draw(outcome).reveal();
    side.replaceChildren(heading(outcome.result, 'Preview'), h('p', { class: 'meaning' }, 'Made of a coarser mesh, to show what to expect. The result follows.'));
}

function showOutcome(outcome: Outcome, seconds: number, next?: string): void {
    const { result, scene } = outcome;
    const isMesh = scene.uvs === undefined && scene.sides === 3;
    if (isMesh) triangles = polygonCount(scene);
    // Vertices that were merged or repaired are not those of the file.
    const { repairs, welded_vertices } = (result.report.input ?? result.report) as { repairs?: unknown[]; welded_vertices?: number };
    const isAsInFile = repairs?.length === 0 && welded_vertices === 0;
    const panel = draw(outcome, isMesh && isAsInFile ? pickEdge : undefined);
    const base = result.facts.name.replace(/\.gz$/i, '').replace(new RegExp(`\\.(${ENDINGS.join('|')})$`, 'i'), '');
    const save = (ending: string, name = ending): HTMLElement =>
        h('button', { type: 'button', class: 'button', onclick: () => {
            outcome.file(name).then((bytes) => { download(`${base}${ending}`, bytes as BlobPart, 'application/octet-stream'); }, fail);
        } }, ending.replace(/^.*\./, '').toUpperCase());
    const [kind, formats] = scene.sides === 4 ? ['quads', ['obj', 'ply', 'glb']] : ['map', isMesh ? [] : ['obj', 'ply', 'glb']];
    const saves = [...formats.map((format) => save(`_${kind}.${format}`)), save('.json', 'report.json'), save('.html', 'page.html')];
    side.replaceChildren(heading(result), h('p', { class: 'saves' }, 'Save as ', ...saves), ...sections(result, (vertices, faces) => { panel.goTo(vertices, faces); }));
    say(...[`Done in ${seconds.toFixed(1)} s.`, ...(next ? [next] : [])].map((text) => h('p', { class: 'meaning' }, text)));
    panel.reveal();
}

addEventListener('dragover', (event) => {
    event.preventDefault();
    document.body.classList.add('dragging');
});
addEventListener('dragleave', () => { document.body.classList.remove('dragging'); });
addEventListener('drop', (event) => {
    event.preventDefault();
    document.body.classList.remove('dragging');
    void take(event.dataTransfer?.files[0]);
});

// Who leaves the page wants no result.
addEventListener('pagehide', () => { running?.abort(); });

form.enabled = false;
stage.append(welcome());
document.body.append(h('main', { class: 'report app' },
    stage,
    h('aside', { tabindex: 0, 'aria-label': 'What to make, and the result' },
        h('div', { class: 'brand' }, h('h1', { class: 'name' }, 'Seamstress'), h('button', { type: 'button', class: 'button', onclick: () => { input.click(); } }, 'Open a mesh'), input),
        work, status, form.element, side)));

if (isServed) {
    // The program ends when no page asks it any more.
    setInterval(() => { fetch('alive').catch(() => undefined); }, 60_000);
    // A mesh that the program was started with.
    fetch('mesh').then(async (response) => {
        if (response.status !== 200) return;
        const name = decodeURIComponent(response.headers.get('x-name') ?? 'mesh');
        open({ name, content: new Uint8Array(await response.arrayBuffer()) });
    }).catch(fail);
} else if ('serviceWorker' in navigator && location.protocol !== 'file:') {
    // Works without a network once it has been loaded.
    navigator.serviceWorker.register('offline.js').catch(() => undefined);
}
if (!isServed) {
    // Browsers compile the method as it runs, for all workers: here with a sample, while nobody waits for it.
    const warm = (): void => { engine.run({ surface: { repair: false }, make: { quads: {} } }, SAMPLES[0].make(), () => undefined, warming.signal).catch(() => undefined); };
    // Safari cannot tell when a page is idle.
    if ('requestIdleCallback' in window) requestIdleCallback(warm);
    else setTimeout(warm, 1000);
}
