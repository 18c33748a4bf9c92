// A report: results that are in the page itself.
import type { Result } from './facts';
import { h } from './dom';
import { makeModel, type Model } from './model';
import { Panel } from './panel';
import { inflate, polygonCount, unpackScene } from './scene';
import { heading, saveReport, sections } from './sections';
import { parseSettings, settingsText, suitable, type Settings } from './settings';

declare global {
    interface Window {
        /** The viewers of the page, for tests. */
        panels?: Panel[];
    }
}

async function readPages(): Promise<Model[]> {
    const texts = (name: string): string[] =>
        [...document.querySelectorAll(`script.${name}`)].map((element) => element.textContent);
    const scenes = await Promise.all(texts('scene').map(inflate));
    const facts = await Promise.all(texts('facts').map(inflate));
    return scenes.map((scene, k) => makeModel(unpackScene(scene), JSON.parse(new TextDecoder().decode(facts[k])) as Result));
}

/** The settings of the address. */
function addressed(model: Model): Settings {
    const shows = Panel.shows(model).map(([value]) => value);
    return parseSettings(location.hash.slice(1), suitable(model), shows, polygonCount(model.scene));
}

let timer = 0;

function keepInAddress(settings: Settings, usual: Settings): void {
    clearTimeout(timer);
    timer = setTimeout(() => {
        const text = settingsText(settings, usual);
        history.replaceState(null, '', text ? `#${text}` : location.pathname + location.search);
    }, 250);
}

function one(model: Model): Panel[] {
    const usual = suitable(model);
    const panel = new Panel(model, addressed(model), { change: (settings) => { keepInAddress(settings, usual); } });
    const aside = h('aside', { tabindex: 0, 'aria-label': 'About the result' },
        heading(model.result), ...sections(model.result, (vertices, faces) => { panel.goTo(vertices, faces); }, saveReport(model.result)));
    document.body.append(h('main', { class: 'report' }, panel.element, aside));
    return [panel];
}

/** Several results side by side, seen from one place. */
function several(models: readonly Model[]): Panel[] {
    const panels = models.map((model) => new Panel(model, { ...suitable(model), layout: 'surface' }, {
        change: ({ pose, show, edges, marks }) => {
            for (const other of panels) {
                if (other.model === model) continue;
                const hasShow = Panel.shows(other.model).some(([value]) => value === show);
                other.set({ pose, edges, marks, ...(hasShow ? { show } : {}) }, false);
            }
        },
    }));
    const columns = models.map((model, k) => h('div', { class: 'column' }, heading(model.result), panels[k].element));
    document.body.append(h('main', { class: 'comparison' }, h('div', { class: 'columns' }, ...columns), comparison(models)));
    return panels;
}

function comparison(models: readonly Model[]): HTMLElement {
    const names = [...new Set(models.flatMap(({ result }) => result.facts.metrics.map(({ name }) => name)))];
    const value = (result: Result, name: string): string => result.facts.metrics.find((metric) => metric.name === name)?.value ?? '–';
    const head = h('tr', {}, h('td'), ...models.map(({ result }) => h('th', { scope: 'col' }, result.facts.name)));
    const rows = names.map((name) => {
        const values = models.map(({ result }) => value(result, name));
        const differ = values.some((text) => text !== values[0]);
        return h('tr', { class: differ ? 'differs' : '' }, h('th', { scope: 'row' }, name), ...values.map((text) => h('td', {}, text)));
    });
    const commands = models.map(({ result }) => h('td', {}, h('code', {}, result.command ?? '–')));
    const last = h('tr', {}, h('th', { scope: 'row' }, 'Command'), ...commands);
    return h('section', { class: 'table' }, h('h2', {}, 'In numbers'), h('table', { class: 'metrics' }, h('thead', {}, head), h('tbody', {}, ...rows, last)));
}

const models = await readPages();
const panels = models.length === 1 ? one(models[0]) : several(models);
panels.forEach((panel) => { panel.start(); });
window.panels = panels;
