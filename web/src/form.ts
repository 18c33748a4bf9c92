// What is to be made, as a form.
import { h } from './dom';
import type { Task } from './engine';
import { helpOf, type Option } from './words';

type Kind = 'quads' | 'map' | 'check';

const KINDS: readonly (readonly [Kind, string])[] = [['quads', 'Quads'], ['map', 'Seamless map'], ['check', 'Check only']];
const FEATURES: readonly (readonly [string, string])[] = [
    ['auto', 'Found by shape'], ['angle', 'Where it bends by an angle'], ['boundary', 'The boundary'], ['picked', 'Edges that I click on'], ['none', 'None'],
];
/** Options of a map that are numbers: with their limits, and whether they are shown at once. */
const NUMBERS = [
    { option: 'align', text: 'Direction', limits: { min: 0, max: 1, step: 0.05 }, isShown: true },
    { option: 'adaptive', text: 'Density', limits: { min: 0, max: 1, step: 0.05 }, isShown: true },
    { option: 'min_edge', text: 'Least edge length', limits: { min: 0, step: 'any' }, isShown: false },
    { option: 'max_edge', text: 'Largest edge length', limits: { min: 0, step: 'any' }, isShown: false },
    { option: 'cone_bias', text: 'Cone bias', limits: { min: 0, step: 'any' }, isShown: false },
] as const;

function labelled(text: string, option: Option | undefined, control: HTMLElement): HTMLElement {
    const help = option && h('span', { class: 'meaning' }, helpOf(option));
    return h('label', { class: 'field' }, h('span', {}, text), control, help);
}

export class Form {
    readonly element: HTMLElement;
    /** Edges that were clicked on, by their vertices. */
    picked: readonly (readonly [number, number])[] = [];
    private kind: Kind = 'quads';
    private readonly kinds = h('div', { class: 'group', role: 'group', 'aria-label': 'What to make' });
    private readonly fields = h('div', { class: 'fields' });
    private readonly sizeKind = h('select', { 'aria-label': 'How fine' }, h('option', { value: 'quads' }, 'Quads'), h('option', { value: 'edge-length' }, 'Edge length'));
    private readonly size = h('input', { type: 'number', min: 0, step: 'any', value: 1500, 'aria-label': 'Number of quads, or edge length' });
    private readonly features = h('select', {}, ...FEATURES.map(([value, name]) => h('option', { value }, name)));
    private readonly angle = h('input', { type: 'number', min: 1, max: 180, value: 40, 'aria-label': 'Angle in degrees' });
    private readonly numbers = NUMBERS.map((number) => ({ ...number, control: h('input', { type: 'number', placeholder: 'usual', ...number.limits }) }));
    private readonly smooth = h('input', { type: 'number', min: 0, max: 100, value: 0 });
    private readonly repair = h('input', { type: 'checkbox' });
    private readonly start = h('button', { type: 'submit', class: 'button primary' }, 'Make it');

    constructor(make: (task: Task) => void, pick: () => void) {
        this.features.addEventListener('change', () => {
            this.show();
            if (this.isPicking) pick();
        });
        this.sizeKind.addEventListener('change', () => { this.size.value = this.sizeKind.value === 'quads' ? '1500' : ''; });
        this.element = h('form', { class: 'make', 'aria-label': 'What to make', onsubmit: (event) => {
            event.preventDefault();
            make(this.task());
        } }, this.kinds, this.fields, this.start);
        this.show();
    }

    /** Whether work can be started. */
    set enabled(isOn: boolean) {
        this.start.disabled = !isOn;
    }

    task(): Task {
        const surface = { repair: this.repair.checked };
        const features = this.sources();
        const given = this.numbers.filter(({ control }) => control.value !== '').map(({ option, control }) => [option, Number(control.value)] as const);
        const map = { features, ...Object.fromEntries(given) };
        switch (this.kind) {
            case 'check': return { surface, make: { check: features } };
            case 'map': return { surface, make: { map } };
            case 'quads': return { surface, make: { quads: { size: { [this.sizeKind.value]: Number(this.size.value) }, shape: { smooth: Number(this.smooth.value) }, map } } };
        }
    }

    /** Whether edges are to be clicked on. */
    get isPicking(): boolean {
        return this.features.value === 'picked';
    }

    private sources(): string[] {
        switch (this.features.value) {
            case 'none': return [];
            case 'angle': return [`angle:${this.angle.value}`];
            case 'picked': return this.picked.length > 0 ? [`edges:${this.picked.map((edge) => edge.join('-')).join(',')}`] : [];
            default: return [this.features.value];
        }
    }

    private show(): void {
        this.kinds.replaceChildren(...KINDS.map(([kind, name]) => h('button', { type: 'button', class: 'toggle', 'aria-pressed': String(kind === this.kind), onclick: () => {
            this.kind = kind;
            this.show();
        } }, name)));
        const fields: HTMLElement[] = [];
        if (this.kind === 'quads') {
            fields.push(h('div', { class: 'field' }, h('span', {}, 'How fine'), h('span', { class: 'pair' }, this.sizeKind, this.size)));
        }
        const angle = this.features.value === 'angle' ? [this.angle] : [];
        const help = this.isPicking ? 'Click on edges of the mesh; a second click takes one back' : helpOf('features');
        fields.push(h('div', { class: 'field' }, h('label', { for: 'features' }, 'Features'), h('span', { class: 'pair' }, this.features, ...angle), h('span', { class: 'meaning' }, help)));
        this.features.id = 'features';
        const numbers = this.kind === 'check' ? [] : this.numbers;
        const shown = (isShown: boolean): HTMLElement[] => numbers.filter((number) => number.isShown === isShown).map(({ text, option, control }) => labelled(text, option, control));
        fields.push(...shown(true));
        fields.push(labelled('Repair', 'repair', this.repair));
        const more = [...(this.kind === 'quads' ? [labelled('Rounds of smoothing', 'smooth', this.smooth)] : []), ...shown(false)];
        if (more.length > 0) fields.push(h('details', {}, h('summary', {}, 'More'), ...more));
        this.fields.replaceChildren(...fields);
    }
}
