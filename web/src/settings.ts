// What a viewer shows, kept in the address of the page.
import { parsePose, poseText, START, type Pose } from './camera';
import type { Model } from './model';
import type { MarkName } from './view';

export interface Settings {
    /** `plain`, `checks`, `grid`, or a measure. */
    readonly show: string;
    readonly edges: boolean;
    readonly marks: ReadonlySet<MarkName>;
    readonly layout: 'surface' | 'both' | 'map';
    readonly pose: Pose;
    /** The face that is picked, or -1. */
    readonly picked: number;
}

export const MARKS: readonly { name: MarkName; label: string; title: string }[] = [
    { name: 'cones', label: 'Cones', title: 'Points at which other than four squares meet: orange where fewer, blue where more' },
    { name: 'seams', label: 'Seams', title: 'Edges along which the surface is cut to lie flat' },
    { name: 'features', label: 'Features', title: 'Feature edges that are followed' },
    { name: 'dropped', label: 'Dropped', title: 'Feature edges that are not followed' },
    { name: 'boundary', label: 'Boundary', title: 'Rims of the surface' },
];

/** Meshes of so many polygons are drawn with their edges. */
const FEW = 30_000;

/** What suits a model. */
export function suitable({ scene, plane, result }: Model): Settings {
    const mapped = result.facts.has_grid ? 'grid' : 'checks';
    const marks: MarkName[] = ['cones', 'features', 'dropped', 'boundary'];
    return {
        show: plane ? mapped : 'plain',
        edges: !plane && scene.corners.length < FEW * scene.sides,
        marks: new Set(marks),
        layout: plane && innerWidth > 700 ? 'both' : 'surface',
        pose: START,
        picked: -1,
    };
}

/** The settings that differ from the suitable ones, for an address. */
export function settingsText(settings: Settings, usual: Settings): string {
    const parameters = new URLSearchParams();
    if (settings.show !== usual.show) parameters.set('show', settings.show);
    if (settings.edges !== usual.edges) parameters.set('edges', settings.edges ? '1' : '0');
    const marks = [...settings.marks].sort().join(',');
    if (marks !== [...usual.marks].sort().join(',')) parameters.set('marks', marks);
    if (settings.layout !== usual.layout) parameters.set('layout', settings.layout);
    if (settings.picked >= 0) parameters.set('face', String(settings.picked));
    const pose = poseText(settings.pose);
    if (pose !== poseText(usual.pose)) parameters.set('view', pose);
    return parameters.toString();
}

/** The settings of an address; what it does not say, or says wrongly, is as usual. */
export function parseSettings(text: string, usual: Settings, shows: readonly string[], faces: number): Settings {
    const parameters = new URLSearchParams(text);
    const known = new Set<string>(MARKS.map(({ name }) => name));
    const show = parameters.get('show');
    const edges = parameters.get('edges');
    const marks = parameters.get('marks')?.split(',').filter((name): name is MarkName => known.has(name));
    const layout = parameters.get('layout');
    const face = Number(parameters.get('face') ?? -1);
    return {
        show: show !== null && shows.includes(show) ? show : usual.show,
        edges: edges === null ? usual.edges : edges === '1',
        marks: marks ? new Set(marks) : usual.marks,
        layout: layout === 'surface' || layout === 'both' || layout === 'map' ? layout : usual.layout,
        pose: parsePose(parameters.get('view') ?? '') ?? usual.pose,
        picked: Number.isInteger(face) && face >= 0 && face < faces ? face : -1,
    };
}
