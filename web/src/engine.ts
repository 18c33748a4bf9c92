// Who does the work: a worker of this page, or the program on this machine that serves the page.
import type { Result } from './facts';
import { unpackScene, type Scene } from './scene';

/** Something to make of a mesh, as `task.rs` reads it. */
export interface Task {
    /** For a preview: of a coarser mesh, of about so many triangles. */
    readonly coarse?: number;
    readonly surface: { readonly repair: boolean };
    readonly make: Readonly<Record<string, unknown>>;
}

export interface MeshFile {
    readonly name: string;
    readonly content: Uint8Array;
}

export interface Progress {
    readonly stage: string;
    readonly component: number;
    readonly n_components: number;
    readonly fraction: number;
}

export interface Outcome {
    readonly result: Result;
    readonly scene: Scene;
    /** The result as a file, whose ending says the format. */
    file(name: string): Promise<Uint8Array>;
}

/** Why there is no outcome. */
export class Refusal extends Error {
    constructor(message: string, readonly hint: string | null = null) {
        super(message);
    }
}

export interface Engine {
    /** Does a task. The signal stops it at once. */
    run(task: Task, file: MeshFile, progress: (progress: Progress) => void, signal: AbortSignal): Promise<Outcome>;
}

export const STOPPED = 'Stopped.';

function refusal(json: string): Refusal {
    try {
        const { message, hint } = JSON.parse(json) as { message: string; hint: string | null };
        return new Refusal(message, hint);
    } catch {
        return new Refusal(json);
    }
}

/** What a worker is asked, and answers. */
export type Request =
    | { readonly kind: 'run'; readonly module: WebAssembly.Module; readonly task: string; readonly name: string; readonly content: Uint8Array }
    | { readonly kind: 'file'; readonly name: string };
export type Answer =
    | ({ readonly kind: 'progress' } & Progress)
    | { readonly kind: 'done'; readonly facts: string; readonly scene: Uint8Array }
    | { readonly kind: 'file'; readonly content: Uint8Array }
    | { readonly kind: 'refused'; readonly error: string }
    | { readonly kind: 'broken'; readonly text: string };

/** Works in this page, with WebAssembly: every task has a worker of its own, which also writes the files of its result. */
export class WorkerEngine implements Engine {
    /** Compiled once, for all workers. */
    private module: Promise<WebAssembly.Module> | undefined;
    /** The worker of the last result. */
    private last: Worker | undefined;

    constructor(private readonly worker: string, private readonly method: string) {}

    async run(task: Task, { name, content }: MeshFile, progress: (progress: Progress) => void, signal: AbortSignal): Promise<Outcome> {
        this.module ??= load(this.method);
        const module = await this.module.catch((error: unknown) => {
            this.module = undefined;
            throw new Refusal('The method could not be loaded from where this page is.', String(error));
        });
        if (signal.aborted) throw new Refusal(STOPPED);
        const worker = new Worker(this.worker, { type: 'module' });
        const ask = (request: Request): Promise<Answer> => new Promise((resolve, reject) => {
            signal.addEventListener('abort', () => { reject(new Refusal(STOPPED)); }, { once: true });
            worker.onerror = (event) => { event.preventDefault(); reject(new Refusal(BROKEN)); };
            worker.onmessage = ({ data }: MessageEvent<Answer>) => {
                if (data.kind === 'progress') progress(data);
                else if (data.kind === 'refused') reject(refusal(data.error));
                else if (data.kind === 'broken') reject(new Refusal(BROKEN, data.text));
                else resolve(data);
            };
            worker.postMessage(request);
        });
        const file = async (name: string): Promise<Uint8Array> => {
            const answer = await ask({ kind: 'file', name });
            return answer.kind === 'file' ? answer.content : new Uint8Array();
        };
        try {
            const answer = await ask({ kind: 'run', module, task: JSON.stringify(task), name, content });
            if (answer.kind !== 'done') throw new Refusal(BROKEN);
            this.last?.terminate();
            this.last = worker;
            return { result: JSON.parse(answer.facts) as Result, scene: unpackScene(answer.scene), file };
        } catch (error) {
            worker.terminate();
            throw error;
        }
    }
}

/** As a stream, whose machine code browsers keep for the next visit, from hosts that name the type of the file. */
async function load(address: string): Promise<WebAssembly.Module> {
    const response = await fetch(address);
    if (!response.ok) throw new Error(`${response.status} ${response.statusText}`);
    const isNamed = response.headers.get('content-type') === 'application/wasm';
    return isNamed ? WebAssembly.compileStreaming(response) : WebAssembly.compile(await response.arrayBuffer());
}

/** A browser gives a page 4 GB at most, and some much less. */
const BROKEN = 'The work broke off in this browser, most likely for want of memory: try a smaller mesh, or the program `seamstress app`.';

interface State {
    readonly state: 'running' | 'done' | 'failed';
    readonly progress: Progress | null;
    readonly error: { readonly message: string; readonly hint: string | null } | null;
}

/** Works in the program that serves this page. */
export class ServerEngine implements Engine {
    run(task: Task, file: MeshFile, progress: (progress: Progress) => void, signal: AbortSignal): Promise<Outcome> {
        const stopped = new Promise<never>((_, reject) => {
            signal.addEventListener('abort', () => { reject(new Refusal(STOPPED)); }, { once: true });
        });
        return Promise.race([stopped, this.work(task, file, progress, signal)]);
    }

    private async work(task: Task, { name, content }: MeshFile, progress: (progress: Progress) => void, signal: AbortSignal): Promise<Outcome> {
        const query = new URLSearchParams({ name, task: JSON.stringify(task) });
        const job = await (await request(`jobs?${query.toString()}`, { method: 'POST', body: content as BodyInit })).text();
        // A page that is closed can still say so.
        const stop = (): void => { void request(`jobs/${job}`, { method: 'DELETE', keepalive: true }).catch(() => undefined); };
        if (signal.aborted) stop();
        signal.addEventListener('abort', stop, { once: true });
        for (;;) {
            const state = await (await request(`jobs/${job}`, { signal })).json() as State;
            if (state.error) throw new Refusal(state.error.message, state.error.hint);
            if (state.state === 'done') break;
            // The program waits a little before it answers: timers of pages that are not seen may stand still.
            if (state.progress) progress(state.progress);
        }
        const bytes = async (path: string): Promise<Uint8Array> => new Uint8Array(await (await request(path)).arrayBuffer());
        const result = await (await request(`jobs/${job}/facts`)).json() as Result;
        const scene = unpackScene(await bytes(`jobs/${job}/scene`));
        return { result, scene, file: (name) => bytes(`jobs/${job}/files/${encodeURIComponent(name)}`) };
    }
}

async function request(path: string, options?: RequestInit): Promise<Response> {
    const response = await fetch(path, options).catch(() => {
        throw new Refusal('The program that serves this page has stopped.', 'Start `seamstress app` again.');
    });
    if (!response.ok) throw refusal(await response.text());
    return response;
}
