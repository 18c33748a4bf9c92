// The viewer: a surface, its map beside it, what is shown of them, and what is under the pointer.
import { colourOf, coneColour, css, PLAIN, type Colour } from './colours';
import { h } from './dom';
import { histogram, type Measure } from './measures';
import type { Model } from './model';
import { nearestSide } from './picking';
import { polygonCount } from './scene';
import { MARKS, suitable, type Settings } from './settings';
import { trianglesOf } from './model';
import { canDraw, View, type MarkName, type Paint } from './view';

export interface PanelEvents {
    /** The settings have changed by the user's hand. */
    change?(settings: Settings): void;
    /** A side of a face has been picked, by its vertices. */
    side?(vertices: readonly [number, number]): void;
}

const CHECKS = 14;
const BINS = 40;

export class Panel {
    readonly element = h('section', { class: 'panel', 'aria-label': 'Viewer' });
    settings: Settings;
    private readonly views: View[] = [];
    private readonly stage = h('div', { class: 'stage' });
    private readonly legend = h('div', { class: 'legend' });
    private readonly readout = h('p', { class: 'readout', role: 'status' });
    private readonly toolbar = h('div', { class: 'toolbar', role: 'toolbar', 'aria-label': 'What is shown' });
    private readonly tints = new Map<string, Uint8Array>();
    private hovered = -1;

    constructor(readonly model: Model, settings: Settings | undefined, private readonly events: PanelEvents = {}) {
        this.settings = settings ?? suitable(model);
        this.element.append(this.toolbar, this.stage, h('div', { class: 'below' }, this.legend, this.readout));
    }

    /** Starts drawing; the element must be in the page. */
    start(): void {
        if (!canDraw()) {
            this.stage.append(h('p', { class: 'empty' }, 'The 3D view needs WebGL 2, which this browser does not have or has switched off.'));
            return;
        }
        const { model } = this;
        const uvs = this.cornerUvs();
        const halves = trianglesOf(model.scene.sides).length;
        for (const [drawing, name] of [[model.surface, 'Surface'], [model.plane, 'Map in the plane']] as const) {
            if (!drawing) continue;
            const canvas = h('canvas', { tabindex: 0, role: 'application', 'aria-label': `${name}: arrow keys turn or move it, plus and minus zoom, 0 shows all` });
            this.stage.append(h('div', { class: `view ${drawing.isFlat ? 'map' : 'surface'}` }, canvas, h('span', { class: 'caption' }, name)));
            const view = new View(canvas, drawing, uvs, halves, {
                hover: (face) => { this.hover(face); },
                pick: (face, point) => {
                    this.pick(face);
                    if (point && !drawing.isFlat) this.pickSide(face, point);
                },
                move: (pose) => { if (!drawing.isFlat) this.set({ pose }); },
            });
            this.views.push(view);
        }
        this.apply();
    }

    /** Draws no more. */
    end(): void {
        this.views.forEach((view) => { view.end(); });
    }

    /** Changes some settings. */
    set(changes: Partial<Settings>, isOurs = true): void {
        this.settings = { ...this.settings, ...changes };
        this.apply(Object.keys(changes));
        if (isOurs) this.events.change?.(this.settings);
    }

    pick(face: number): void {
        this.set({ picked: face });
    }

    /** Draws these edges as features, in the place of those found. */
    setFeatures(pairs: readonly (readonly [number, number])[]): void {
        const { positions } = this.model.scene;
        this.views[0]?.setFeatures(Float32Array.from(pairs.flat().flatMap((vertex) => [...positions.subarray(3 * vertex, 3 * vertex + 3)])));
    }

    private pickSide(face: number, point: readonly number[]): void {
        const { corners, positions, sides } = this.model.scene;
        const vertices = [...corners.subarray(sides * face, sides * (face + 1))];
        const [a, b] = nearestSide(vertices.map((vertex) => [...positions.subarray(3 * vertex, 3 * vertex + 3)]), point);
        this.events.side?.([vertices[a], vertices[b]]);
    }

    /** Shows elements: picks the first face, and brings them to the middle. */
    goTo(vertices: readonly number[], faces: readonly number[]): void {
        const { scene } = this.model;
        const ofFaces = faces.flatMap((face) => [...scene.corners.subarray(scene.sides * face, scene.sides * (face + 1))]);
        const all = vertices.length > 0 ? vertices : ofFaces;
        if (all.length === 0) return;
        const points = all.map((vertex) => [...scene.positions.subarray(3 * vertex, 3 * vertex + 3)]);
        const middle = [0, 1, 2].map((k) => points.reduce((sum, point) => sum + point[k], 0) / points.length);
        const extent = Math.max(...points.map((point) => Math.hypot(...point.map((x, k) => x - middle[k]))), this.edgeLength());
        this.views[0]?.goTo(middle, extent);
        if (faces.length > 0) this.pick(faces[0]);
        if (this.settings.layout === 'map') this.set({ layout: 'both' });
        this.views[0]?.canvas.focus({ preventScroll: true });
        this.reveal();
    }

    /** Scrolls to the drawing where it is out of sight. */
    reveal(): void {
        this.stage.scrollIntoView({ block: 'nearest' });
    }

    /** Milliseconds that drawing takes, the mean of some frames. */
    frameTime(frames = 10): number {
        let sum = 0;
        for (let k = 0; k < frames; k++) sum += this.views[0].measure();
        return sum / frames;
    }

    /** The measure that is shown. */
    private measure(): Measure | undefined {
        return this.model.measures.find(({ id }) => id === this.settings.show);
    }

    /** What can be shown, with names. */
    static shows({ plane, measures }: Model): readonly (readonly [string, string])[] {
        const patterns: [string, string][] = plane ? [['checks', 'Checkerboard'], ['grid', 'Grid lines']] : [];
        return [...patterns, ...measures.map(({ id, name }): [string, string] => [id, name]), ['plain', 'Plain']];
    }

    private edgeLength(): number {
        const count = Math.max(1, polygonCount(this.model.scene));
        return this.model.surface.radius * Math.sqrt(8 / count);
    }

    private apply(changed: readonly string[] = ['show', 'layout', 'picked', 'pose']): void {
        const { settings, model } = this;
        if (changed.includes('show') || changed.includes('edges') || changed.includes('marks') || changed.includes('layout')) {
            this.toolbar.replaceChildren(...this.controls());
            this.legend.replaceChildren(...this.legendParts());
            const pattern = settings.show === 'checks' || settings.show === 'grid' ? settings.show : 'none';
            const paint: Paint = {
                tints: this.tintsOf(settings.show),
                pattern,
                period: model.result.facts.has_grid ? 1 : model.surface.radius / CHECKS,
                edges: settings.edges,
                marks: settings.marks,
            };
            this.views.forEach((view) => { view.paint(paint); });
            this.stage.dataset.layout = model.plane ? settings.layout : 'surface';
        }
        if (changed.includes('pose')) this.views[0]?.setPose(settings.pose);
        this.show();
    }

    private hover(face: number): void {
        if (face === this.hovered) return;
        this.hovered = face;
        this.show();
    }

    /** Highlights, and says what is under the pointer or picked. */
    private show(): void {
        this.views.forEach((view) => { view.highlight(this.hovered, this.settings.picked); });
        const face = this.hovered >= 0 ? this.hovered : this.settings.picked;
        this.readout.textContent = face >= 0 ? this.describe(face) : 'Point at a face to read its numbers; click to keep it.';
    }

    private describe(face: number): string {
        const { scene, measures, result } = this.model;
        const words = [`${scene.sides === 4 ? 'Quad' : 'Triangle'} ${face}`];
        for (const measure of measures) {
            const value = measure.values[face];
            if (measure.id === 'component') words.push(`component ${value}`);
            else if (measure.id === 'area') words.push(`area × ${numberText(2 ** value)}`);
            else words.push(`${measure.name.toLowerCase()} ${numberText(value)}`);
        }
        const vertices = scene.corners.subarray(scene.sides * face, scene.sides * (face + 1));
        words.push(`vertices ${[...vertices].join(' ')}`);
        for (const [vertex, index] of result.facts.cones) {
            if (vertices.includes(vertex)) words.push(`cone of index ${index > 0 ? '+' : ''}${index} at ${vertex}`);
        }
        return words.join(' · ');
    }

    private cornerUvs(): Float32Array {
        const { scene, cornerOf } = this.model;
        const uvs = new Float32Array(2 * cornerOf.length);
        if (scene.uvs) for (let k = 0; k < cornerOf.length; k++) uvs.set(scene.uvs.subarray(2 * cornerOf[k], 2 * cornerOf[k] + 2), 2 * k);
        return uvs;
    }

    private tintsOf(show: string): Uint8Array {
        const measure = this.measure();
        const key = measure ? show : 'plain';
        const known = this.tints.get(key);
        if (known) return known;
        const { scene, cornerOf } = this.model;
        const colours: Colour[] = Array.from({ length: polygonCount(scene) }, (_, face) => measure ? colourOf(measure, measure.values[face]) : PLAIN);
        const tints = new Uint8Array(3 * cornerOf.length);
        cornerOf.forEach((corner, k) => { tints.set(colours[Math.floor(corner / scene.sides)], 3 * k); });
        this.tints.set(key, tints);
        return tints;
    }

    private controls(): HTMLElement[] {
        const { settings, model } = this;
        const options = Panel.shows(model).map(([value, name]) => h('option', { value, selected: value === settings.show }, name));
        const select = h('select', { onchange: () => { this.set({ show: select.value }); } }, ...options);
        const toggle = (label: string, title: string, isOn: boolean, change: () => void): HTMLElement =>
            h('button', { type: 'button', class: 'toggle', title, 'aria-pressed': String(isOn), onclick: change }, label);
        const marks = MARKS.filter(({ name }) => model.surface.marks[name].length > 0).map(({ name, label, title }) =>
            toggle(label, title, settings.marks.has(name), () => { this.toggleMark(name); }));
        const layouts = ([['surface', 'Surface'], ['both', 'Both'], ['map', 'Map']] as const).map(([value, label]) =>
            toggle(label, `Show the ${value === 'both' ? 'surface and the map' : value}`, settings.layout === value, () => { this.set({ layout: value }); }));
        return [
            h('label', { class: 'show' }, h('span', {}, 'Show'), select),
            toggle('Edges', 'Edges of the mesh', settings.edges, () => { this.set({ edges: !settings.edges }); }),
            ...marks,
            h('span', { class: 'gap' }),
            ...(model.plane ? [h('span', { class: 'group', role: 'group', 'aria-label': 'Layout' }, ...layouts)] : []),
            h('button', { type: 'button', class: 'toggle', title: 'Show all', onclick: () => { this.views.forEach((view) => { view.fit(); }); } }, 'Fit'),
        ];
    }

    private toggleMark(name: MarkName): void {
        const marks = new Set(this.settings.marks);
        if (!marks.delete(name)) marks.add(name);
        this.set({ marks });
    }

    private legendParts(): HTMLElement[] {
        const measure = this.measure();
        const parts: HTMLElement[] = [];
        if (measure && measure.id !== 'component') parts.push(this.scale(measure));
        const indices = [...new Set(this.model.result.facts.cones.map(([, index]) => index))].sort((a, b) => b - a);
        if (this.settings.marks.has('cones') && indices.length > 0) {
            const word = this.model.scene.sides === 4 ? 'Irregular' : 'Cones';
            const dots = indices.map((index) => h('span', { class: 'dot' }, h('i', { style: `background:${css(coneColour(index))}` }), `${index > 0 ? '+' : '−'}${Math.abs(index)}`));
            parts.push(h('span', { class: 'dots', title: 'Index in quarters of a turn: 4 less the number of squares' }, `${word} `, ...dots));
        }
        return parts;
    }

    /** Colours of a measure with its distribution. */
    private scale(measure: Measure): HTMLElement {
        const counts = histogram(measure, BINS);
        const most = Math.max(...counts.map(Math.sqrt));
        const [low, high] = measure.range;
        const bars = counts.map((count, bin) => {
            const colour = css(colourOf(measure, low + ((bin + 0.5) / BINS) * (high - low)));
            return h('i', { style: `height:${String(Math.round(3 + (24 * Math.sqrt(count)) / most))}px;background:${colour}` });
        });
        const text = (x: number): string => measure.id === 'area' ? `× ${numberText(2 ** x)}` : numberText(x);
        return h('figure', { class: 'scale' },
            h('div', { class: 'bars', 'aria-hidden': 'true' }, ...bars),
            h('figcaption', {}, h('span', {}, text(low)), h('span', { class: 'what' }, `${measure.name}: ${measure.meaning}`), h('span', {}, text(high))));
    }
}

/** About five digits. */
export function numberText(x: number): string {
    if (!Number.isFinite(x)) return x > 0 ? 'infinite' : 'undefined';
    const size = Math.abs(x);
    return size !== 0 && (size < 1e-3 || size >= 1e5) ? x.toExponential(2) : x.toFixed(4);
}
