// The app: a mesh in, quads or a map out, made by a worker of the page or by the program that serves it.
import { download, h } from './dom';
import { Refusal, ServerEngine, WorkerEngine, type Engine, type MeshFile, type Outcome, type Progress, type Task } from './engine';
import { Form } from './form';
import { glb } from './glb';
import { makeModel } from './model';
import { Panel } from './panel';
import { SAMPLES } from './samples';
import { heading, sections } from './sections';

const isServed = document.documentElement.dataset.engine === 'server';
const engine: Engine = isServed ? new ServerEngine() : new WorkerEngine(new URL('worker.js', document.baseURI).href);
/** Larger files are refused: they would not fit into memory. */
const LARGEST = (isServed ? 1000 : 200) * 1e6;

const stage = h('div', { class: 'place-of-result' });
const side = h('div', { class: 'about' });
const status = h('div', { class: 'status', role: 'status' });
const form = new Form((task) => { void make(task); }, () => { void showMesh(); });
const input = h('input', { type: 'file', accept: '.obj,.off,.ply,.stl,.gz', 'aria-label': 'A mesh', hidden: true, onchange: () => { void take(input.files?.[0]); } });
let file: MeshFile | undefined;
let running: AbortController | undefined;
let shown: Panel | undefined;

function welcome(): HTMLElement {
    const samples = SAMPLES.map(({ name, text, make: makeSample }) => h('button', { type: 'button', class: 'sample', onclick: () => { open(makeSample()); } }, h('b', {}, name), text));
    const where = isServed ? 'The program on this machine does the work.' : 'This page does the work: nothing is uploaded.';
    return h('div', { class: 'drop' },
        h('h2', { class: 'call' }, 'Drop a mesh here'),
        h('p', {}, 'OBJ, OFF, PLY or STL, also compressed with gzip. ', where),
        h('p', {}, h('button', { type: 'button', class: 'button primary', onclick: () => { input.click(); } }, 'Choose a file')),
        h('p', { class: 'meaning' }, 'Or try a sample:'),
        h('div', { class: 'samples' }, ...samples));
}

function say(...parts: readonly (Node | string)[]): void {
    status.replaceChildren(...parts);
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

/** Takes a mesh, and shows it. */
function open(mesh: MeshFile): void {
    file = mesh;
    form.picked = [];
    void make({ surface: { repair: false }, make: { check: ['auto'] } });
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

async function make(task: Task): Promise<void> {
    if (!file) return;
    running?.abort();
    const controller = running = new AbortController();
    form.enabled = false;
    const cancel = h('button', { type: 'button', class: 'button cancel', onclick: () => { controller.abort(); } }, 'Cancel');
    const [bar, words] = [h('progress', { max: 1, value: 0, 'aria-label': 'Share of the stage' }), h('span', {}, 'reading')];
    say(h('div', { class: 'running' }, words, bar, cancel));
    const start = performance.now();
    const show = ({ stage: name, component, n_components, fraction }: Progress): void => {
        const part = n_components > 1 ? `, part ${component + 1} of ${n_components}` : '';
        words.textContent = `${name}${part} · ${((performance.now() - start) / 1000).toFixed(1)} s`;
        bar.value = fraction;
    };
    try {
        const outcome = await engine.run(task, file, show, controller.signal);
        if (controller === running) showOutcome(outcome, (performance.now() - start) / 1000);
    } catch (error) {
        if (controller === running) fail(error);
    } finally {
        if (controller === running) {
            running = undefined;
            form.enabled = true;
        }
    }
}

function showOutcome(outcome: Outcome, seconds: number): void {
    const { result, scene } = outcome;
    const isMesh = scene.uvs === undefined && scene.sides === 3;
    // Vertices that were merged or repaired are not those of the file.
    const { repairs, welded_vertices } = (result.report.input ?? result.report) as { repairs?: unknown[]; welded_vertices?: number };
    const isAsInFile = repairs?.length === 0 && welded_vertices === 0;
    const panel = new Panel(makeModel(scene, result), undefined, isMesh && isAsInFile ? { side: pickEdge } : {});
    shown = panel;
    const base = result.facts.name.replace(/\.(gz|obj|off|ply|stl)$/i, '').replace(/\.(obj|off|ply|stl)$/i, '');
    const save = (ending: string, type: string, content: () => Promise<Uint8Array> | Uint8Array): HTMLElement =>
        h('button', { type: 'button', class: 'button', onclick: () => {
            Promise.resolve(content()).then((bytes) => { download(`${base}${ending}`, bytes as BlobPart, type); }, fail);
        } }, ending.replace(/^.*\./, '').toUpperCase());
    const isQuads = scene.sides === 4;
    const kind = isQuads ? '_quads' : '_map';
    const isMade = isQuads || scene.uvs !== undefined;
    const text = (name: string): HTMLElement => save(name, 'text/plain', () => outcome.file(name));
    const saves = [
        ...(isMade ? [text(`${kind}.obj`)] : []),
        ...(isQuads ? [text(`${kind}.ply`)] : []),
        ...(isMade ? [save(`${kind}.glb`, 'model/gltf-binary', () => glb(scene))] : []),
        save('.html', 'text/html', () => outcome.file('page.html')),
    ];
    stage.replaceChildren(panel.element);
    side.replaceChildren(heading(result), h('p', { class: 'saves' }, 'Save as ', ...saves), ...sections(result, (vertices, faces) => { panel.goTo(vertices, faces); }));
    panel.start();
    window.panels = [panel];
    say(h('p', { class: 'meaning' }, `Done in ${seconds.toFixed(1)} s.`));
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

form.enabled = false;
stage.append(welcome());
document.body.append(h('main', { class: 'report app' },
    stage,
    h('aside', { tabindex: 0, 'aria-label': 'What to make, and the result' },
        h('div', { class: 'brand' }, h('h1', { class: 'name' }, 'Seamstress'), h('button', { type: 'button', class: 'button', onclick: () => { input.click(); } }, 'Open a mesh'), input),
        form.element, status, side)));

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
