// What is computed of a scene: normals, seams, components, measures of every polygon.
import { polygonCount, type Scene } from './scene';

/** Normals of corners: smooth across flat edges, sharp across others. */
export function cornerNormals(scene: Scene): Float32Array {
    const { positions, corners, sides } = scene;
    const count = polygonCount(scene);
    const ofFaces = new Float32Array(3 * count);
    const ofVertices = new Float32Array(positions.length);
    for (let face = 0; face < count; face++) {
        const normal = vectorArea(scene, face);
        for (let k = 0; k < 3; k++) ofFaces[3 * face + k] = normal[k];
        for (let side = 0; side < sides; side++) {
            const vertex = corners[sides * face + side];
            for (let k = 0; k < 3; k++) ofVertices[3 * vertex + k] += normal[k];
        }
    }
    normalize(ofFaces);
    normalize(ofVertices);
    const normals = new Float32Array(3 * corners.length);
    for (let corner = 0; corner < corners.length; corner++) {
        const [face, vertex] = [3 * Math.floor(corner / sides), 3 * corners[corner]];
        let cosine = 0;
        for (let k = 0; k < 3; k++) cosine += ofFaces[face + k] * ofVertices[vertex + k];
        const [from, at] = cosine > SMOOTH ? [ofVertices, vertex] : [ofFaces, face];
        for (let k = 0; k < 3; k++) normals[3 * corner + k] = from[at + k];
    }
    return normals;
}

/** Cosine of the angle between normals above which a surface looks smooth. */
const SMOOTH = 0.8;

function normalize(vectors: Float32Array): void {
    for (let at = 0; at < vectors.length; at += 3) {
        const length = Math.hypot(vectors[at], vectors[at + 1], vectors[at + 2]) || 1;
        for (let k = 0; k < 3; k++) vectors[at + k] /= length;
    }
}

function point(scene: Scene, corner: number): [number, number, number] {
    const at = 3 * scene.corners[corner];
    return [scene.positions[at], scene.positions[at + 1], scene.positions[at + 2]];
}

/** Twice the area of a polygon, along its normal. */
function vectorArea(scene: Scene, face: number): [number, number, number] {
    const first = scene.sides * face;
    const sum: [number, number, number] = [0, 0, 0];
    const a = point(scene, first);
    for (let side = 1; side + 1 < scene.sides; side++) {
        const [b, c] = [point(scene, first + side), point(scene, first + side + 1)];
        const [u, v] = [b.map((x, k) => x - a[k]), c.map((x, k) => x - a[k])];
        sum[0] += u[1] * v[2] - u[2] * v[1];
        sum[1] += u[2] * v[0] - u[0] * v[2];
        sum[2] += u[0] * v[1] - u[1] * v[0];
    }
    return sum;
}

function flatArea(uvs: Float32Array, corner: number): number {
    const [u0, v0, u1, v1, u2, v2] = uvs.subarray(2 * corner, 2 * corner + 6);
    return (u1 - u0) * (v2 - v0) - (u2 - u0) * (v1 - v0);
}

/** Sides of polygons as vertices, seams and boundaries apart: pairs of vertices, one after the other. */
export interface Edges {
    readonly boundary: Uint32Array;
    readonly seams: Uint32Array;
    /** For every polygon the first of those connected with it. */
    readonly component: Uint32Array;
}

/** Boundary, seams and connected components. */
export function findEdges(scene: Scene): Edges {
    const { corners, wedges, sides, positions } = scene;
    const count = polygonCount(scene);
    const parent = Uint32Array.from({ length: count }, (_, face) => face);
    const root = (face: number): number => {
        while (parent[face] !== face) face = parent[face] = parent[parent[face]];
        return face;
    };
    const seams: number[] = [];
    const open = new Map<number, number>();
    const n = positions.length / 3;
    for (let corner = 0; corner < corners.length; corner++) {
        const face = Math.floor(corner / sides);
        const after = (corner + 1) % sides === 0 ? corner + 1 - sides : corner + 1;
        const [a, b] = [corners[corner], corners[after]];
        const key = Math.min(a, b) * n + Math.max(a, b);
        const other = open.get(key);
        if (other === undefined) {
            open.set(key, corner);
            continue;
        }
        open.delete(key);
        const otherFace = Math.floor(other / sides);
        const otherAfter = (other + 1) % sides === 0 ? other + 1 - sides : other + 1;
        const [x, y] = [root(face), root(otherFace)];
        parent[Math.max(x, y)] = Math.min(x, y);
        const same = corners[other] === a ? [other, otherAfter] : [otherAfter, other];
        if (wedges[same[0]] !== wedges[corner] || wedges[same[1]] !== wedges[after]) seams.push(a, b);
    }
    const boundary: number[] = [];
    for (const key of open.keys()) boundary.push(Math.floor(key / n), key % n);
    for (let face = 0; face < count; face++) parent[face] = root(face);
    return { boundary: Uint32Array.from(boundary), seams: Uint32Array.from(seams), component: parent };
}

/** A measure of every polygon and how it is shown. */
export interface Measure {
    readonly id: string;
    readonly name: string;
    readonly meaning: string;
    /** Whether smaller and larger than the middle of the range are different things. */
    readonly diverging: boolean;
    readonly values: Float64Array;
    /** The values with the first and the last colour. */
    readonly range: readonly [number, number];
}

/** All measures of a scene: of its map, or of its quads. */
export function measuresOf(scene: Scene, edges: Edges): Measure[] {
    const measures: Measure[] = [];
    const add = (id: string, name: string, meaning: string, values: Float64Array, range?: [number, number]): void => {
        const diverging = range !== undefined && range[0] === -range[1];
        measures.push({ id, name, meaning, diverging, values, range: range ?? rangeOf(values) });
    };
    if (scene.values) add('tau', 'Tau', 'largest or smallest stretch; 1 is none', scene.values);
    if (scene.uvs) {
        add('area', 'Area', 'area on the map against the surface, powers of 2', areas(scene, scene.uvs), [-1, 1]);
        add('angle', 'Angle', 'ratio of the stretches of a triangle; 1 keeps angles', conformal(scene, scene.uvs));
    }
    if (scene.sides === 4) {
        add('corner', 'Corners', 'largest deviation of a corner from 90 degrees', cornerDeviation(scene), [0, 45]);
        add('aspect', 'Aspect', 'longest over shortest side of a quad', sideRatio(scene));
    }
    const roots = [...new Set(edges.component)].sort((a, b) => a - b);
    if (roots.length > 1) {
        const number = new Map(roots.map((root, k) => [root, k]));
        const values = Float64Array.from(edges.component, (root) => number.get(root) ?? 0);
        add('component', 'Component', 'pieces that are not connected', values, [0, roots.length - 1]);
    }
    return measures;
}

/** From the least value to one that 1 of 100 exceeds. */
function rangeOf(values: Float64Array): [number, number] {
    const sorted = values.filter(Number.isFinite).sort();
    if (sorted.length === 0) return [0, 1];
    const low = sorted[0];
    const high = sorted[Math.floor(0.99 * (sorted.length - 1))];
    return [low, Math.max(high, low + 1e-6)];
}

/** Binary logarithm of the area of each triangle on the map, over that on the surface, about the mean. */
function areas(scene: Scene, uvs: Float32Array): Float64Array {
    const count = polygonCount(scene);
    const onSurface = Float64Array.from({ length: count }, (_, face) => Math.hypot(...vectorArea(scene, face)));
    const flat = Float64Array.from({ length: count }, (_, face) => flatArea(uvs, 3 * face));
    const sum = (values: Float64Array): number => values.reduce((total, x) => total + Math.abs(x), 0);
    const scale = sum(onSurface) / sum(flat) || 1;
    return flat.map((area, face) => {
        const ratio = (scale * area) / onSurface[face];
        return ratio > 0 ? Math.log2(ratio) : Infinity;
    });
}

/** The larger over the smaller stretch of each triangle. */
function conformal(scene: Scene, uvs: Float32Array): Float64Array {
    return Float64Array.from({ length: polygonCount(scene) }, (_, face) => {
        const [a, b, c] = [0, 1, 2].map((k) => point(scene, 3 * face + k));
        const [e, g] = [b.map((x, k) => x - a[k]), c.map((x, k) => x - a[k])];
        const x1 = Math.hypot(...e);
        const x2 = (e[0] * g[0] + e[1] * g[1] + e[2] * g[2]) / x1;
        const y2 = Math.hypot(...vectorArea(scene, face)) / x1;
        const [u0, v0, u1, v1, u2, v2] = uvs.subarray(6 * face, 6 * face + 6);
        const [ux, vx] = [(u1 - u0) / x1, (v1 - v0) / x1];
        const [uy, vy] = [(u2 - u0 - ux * x2) / y2, (v2 - v0 - vx * x2) / y2];
        const [sum, difference] = [Math.hypot(ux + vy, vx - uy), Math.hypot(ux - vy, vx + uy)];
        return sum > difference ? (sum + difference) / (sum - difference) : Infinity;
    });
}

/** The largest deviation of a corner from a right angle, degrees. */
function cornerDeviation(scene: Scene): Float64Array {
    return Float64Array.from({ length: polygonCount(scene) }, (_, face) => {
        const points = [0, 1, 2, 3].map((k) => point(scene, 4 * face + k));
        const angles = points.map((at, k) => {
            const [u, v] = [points[(k + 1) % 4], points[(k + 3) % 4]].map((to) => to.map((x, d) => x - at[d]));
            const cosine = (u[0] * v[0] + u[1] * v[1] + u[2] * v[2]) / (Math.hypot(...u) * Math.hypot(...v));
            return Math.abs((180 / Math.PI) * Math.acos(Math.max(-1, Math.min(1, cosine))) - 90);
        });
        return Math.max(...angles);
    });
}

/** The longest over the shortest side. */
function sideRatio(scene: Scene): Float64Array {
    return Float64Array.from({ length: polygonCount(scene) }, (_, face) => {
        const points = [0, 1, 2, 3].map((k) => point(scene, 4 * face + k));
        const sides = points.map((at, k) => Math.hypot(...at.map((x, d) => x - points[(k + 1) % 4][d])));
        return Math.max(...sides) / Math.min(...sides);
    });
}

/** How many values fall into each of the bins of a range; those outside count in the first and the last. */
export function histogram(measure: Measure, bins: number): number[] {
    const counts = new Array<number>(bins).fill(0);
    const [low, high] = measure.range;
    for (const value of measure.values) {
        if (Number.isNaN(value)) continue;
        const bin = Math.floor((bins * (value - low)) / (high - low));
        counts[Math.max(0, Math.min(bins - 1, bin))]++;
    }
    return counts;
}
