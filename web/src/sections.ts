// What a page says beside its viewer.
import { download, h } from './dom';
import type { Claim, Note, Result } from './facts';

/** Rows of a list that are shown at first. */
const SHOWN = 8;

/** Shows elements in the viewer: vertices and faces of its scene. */
export type GoTo = (vertices: readonly number[], faces: readonly number[]) => void;

function section(title: string, ...children: readonly (Node | string)[]): HTMLElement {
    return h('section', {}, h('h2', {}, title), ...children);
}

/** The result in one sentence, with what it is of. */
export function heading({ facts }: Result, kind = facts.kind): HTMLElement {
    const isGood = facts.claims.every(({ passed }) => passed);
    return h('header', { class: 'heading' },
        h('p', { class: 'kind' }, kind),
        h('h1', {}, facts.name),
        h('p', { class: 'headline' }, h('span', { class: isGood ? 'mark good' : 'mark bad', 'aria-hidden': 'true' }, isGood ? '✓' : '✕'), facts.headline));
}

/** All that is said of a result; with `save` to save its report, where nothing else does. */
export function sections(result: Result, goTo: GoTo, save?: HTMLElement): HTMLElement[] {
    const { facts } = result;
    const parts = [
        section('What was checked', h('ul', { class: 'claims' }, ...facts.claims.map(claim))),
        section('In numbers', metrics(result)),
    ];
    if (facts.notes.length > 0) parts.push(section('Notes and warnings', notes(facts.notes, goTo)));
    if (facts.dropped.length > 0) parts.push(section('Features that are not followed', dropped(result, goTo)));
    parts.push(reproduce(result, save));
    return parts;
}

function claim({ passed, title, text }: Claim): HTMLElement {
    return h('li', { class: passed ? 'good' : 'bad' },
        h('span', { class: 'mark', role: 'img', 'aria-label': passed ? 'passed' : 'failed' }, passed ? '✓' : '✕'),
        h('div', {}, h('h3', {}, title), h('p', {}, text)));
}

function metrics({ facts }: Result): HTMLElement {
    const rows = facts.metrics.map(({ name, value, meaning }) =>
        h('tr', {}, h('th', { scope: 'row' }, name, h('span', { class: 'meaning' }, meaning)), h('td', {}, value)));
    return h('table', { class: 'metrics' }, h('tbody', {}, ...rows));
}

/** A list whose first rows are shown, and all if asked. */
function longList<T>(items: readonly T[], row: (item: T) => HTMLElement): HTMLElement {
    const list = h('ul', { class: 'notes' }, ...items.slice(0, SHOWN).map(row));
    if (items.length <= SHOWN) return list;
    const more = h('button', { type: 'button', class: 'more', onclick: () => {
        list.append(...items.slice(SHOWN).map(row));
        more.remove();
    } }, `Show ${items.length - SHOWN} more`);
    return h('div', {}, list, more);
}

function notes(items: readonly Note[], goTo: GoTo): HTMLElement {
    return longList(items, ({ severity, text, vertices, faces }) => {
        const label = severity ? h('b', { class: severity }, severity === 'error' ? 'Fault' : 'Warning') : undefined;
        const isPlaced = vertices.length + faces.length > 0;
        const words = isPlaced ? h('button', { type: 'button', class: 'place', onclick: () => { goTo(vertices, faces); } }, text) : text;
        return h('li', {}, label, words);
    });
}

function dropped({ facts }: Result, goTo: GoTo): HTMLElement {
    const byReason = new Map<string, number[]>();
    for (const { vertices, reason } of facts.dropped) byReason.set(reason, [...(byReason.get(reason) ?? []), ...vertices]);
    const rows = [...byReason].map(([reason, vertices]) => {
        const edges = Array.from({ length: vertices.length / 2 }, (_, k) => vertices.slice(2 * k, 2 * k + 2));
        const places = longList(edges, (edge) => h('li', {}, h('button', { type: 'button', class: 'place', onclick: () => { goTo(edge, []); } }, `edge ${edge.join('–')}`)));
        return h('li', {}, h('details', {}, h('summary', {}, `${edges.length} ${edges.length === 1 ? 'edge' : 'edges'}: ${reason}`), places));
    });
    return h('ul', { class: 'notes' }, ...rows);
}

/** Saves the report that a page has in itself. */
export function saveReport({ report, facts }: Result): HTMLElement {
    return h('button', { type: 'button', class: 'button', onclick: () => {
        download(`${facts.name.replace(/\.[^.]*$/, '')}.json`, JSON.stringify(report, null, 2), 'application/json');
    } }, 'Save the report as JSON');
}

function reproduce({ command, report, facts }: Result, save?: HTMLElement): HTMLElement {
    const options = report.options === undefined ? [] : [h('details', {}, h('summary', {}, 'All options'), h('pre', { tabindex: 0 }, JSON.stringify(report.options, null, 2)))];
    const line = command === null ? [] : [h('pre', { class: 'command', tabindex: 0 }, command)];
    return section('To repeat this', ...line, ...options, ...(save ? [h('p', {}, save)] : []), h('p', { class: 'meaning' }, `Made by Seamstress ${facts.version}`));
}
