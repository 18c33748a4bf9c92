// The worker of the page in a browser: does one task, and writes its files.
import type { Answer, Request } from './engine';

interface Outcome {
    readonly facts: string;
    readonly scene: Uint8Array;
    file(name: string): Uint8Array;
}

interface Module {
    default(options: { module_or_path: WebAssembly.Module }): Promise<unknown>;
    run(task: string, content: Uint8Array, name: string, listener: (...progress: [string, number, number, number]) => void): Outcome;
}

/** Messages of progress come no more often, milliseconds. */
const EVERY = 60;

const glue = new URL('pkg/seamstress_wasm.js', self.location.href).href;
let outcome: Outcome | undefined;

function answer(message: Answer): void {
    self.postMessage(message);
}

async function handle(request: Request): Promise<void> {
    if (request.kind === 'file') {
        if (outcome) answer({ kind: 'file', content: outcome.file(request.name) });
        return;
    }
    const module = await import(glue) as Module;
    await module.default({ module_or_path: request.module });
    let last = 0;
    outcome = module.run(request.task, request.content, request.name, (stage, component, n_components, fraction) => {
        const now = performance.now();
        if (now - last < EVERY) return;
        last = now;
        answer({ kind: 'progress', stage, component, n_components, fraction });
    });
    answer({ kind: 'done', facts: outcome.facts, scene: outcome.scene });
}

self.addEventListener('message', ({ data }: MessageEvent<Request>) => {
    // Refusals are texts; all else is a fault, after which the module is dead.
    handle(data).catch((error: unknown) => {
        answer(typeof error === 'string' ? { kind: 'refused', error } : { kind: 'broken', text: String(error) });
    });
});
