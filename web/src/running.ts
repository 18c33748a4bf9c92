// Work that is going on: its stages, how far it is, how long it may take, and a way to stop it.
import { h } from './dom';
import type { Progress, Task } from './engine';
import { aboutText, Remaining } from './remaining';

/** How often the time is renewed, milliseconds. */
const EVERY = 200;

export class Running {
    readonly element: HTMLElement;
    private readonly remaining: Remaining | undefined;
    private readonly steps: readonly HTMLElement[];
    private readonly bar = h('progress', { max: 1, 'aria-label': 'Share of the work that is done' });
    private readonly time = h('span', {});
    private readonly part = h('span', {});
    private readonly start = performance.now();
    private readonly timer: number;

    constructor({ make }: Task, title: string, cancel: () => void) {
        // A check is one stage.
        this.remaining = 'check' in make ? undefined : new Remaining('map' in make);
        this.steps = this.remaining?.stages.map((stage) => h('li', {}, stage)) ?? [];
        this.element = h('div', { class: 'running' },
            h('p', {}, h('b', {}, title), this.part, ' · ', this.time), this.bar,
            h('button', { type: 'button', class: 'button cancel', onclick: cancel }, 'Cancel'),
            this.steps.length > 0 && h('ol', { class: 'stages' }, ...this.steps));
        this.tick();
        this.timer = window.setInterval(() => { this.tick(); }, EVERY);
    }

    show(progress: Progress): void {
        const { remaining } = this;
        if (!remaining) return;
        remaining.see(progress);
        this.bar.value = remaining.share;
        this.steps.forEach((step, k) => {
            step.classList.toggle('over', k < remaining.stage);
            if (k === remaining.stage) step.setAttribute('aria-current', 'step');
            else step.removeAttribute('aria-current');
        });
        const { component, n_components } = progress;
        this.part.textContent = n_components > 1 ? `, part ${component + 1} of ${n_components}` : '';
    }

    end(): void {
        clearInterval(this.timer);
    }

    private tick(): void {
        const seconds = (performance.now() - this.start) / 1000;
        const left = this.remaining?.after(seconds);
        this.time.textContent = `${seconds.toFixed(1)} s${left === undefined ? '' : `, ${aboutText(left)}`}`;
    }
}
