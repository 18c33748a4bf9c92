// Meshes to try, made here: no file is needed.
import type { MeshFile } from './engine';

type Point = readonly [number, number, number];

function obj(name: string, points: readonly Point[], faces: readonly (readonly number[])[]): MeshFile {
    const lines = [
        ...points.map((point) => `v ${point.map((x) => x.toFixed(6)).join(' ')}`),
        ...faces.map((face) => `f ${face.map((v) => v + 1).join(' ')}`),
    ];
    return { name: `${name}.obj`, content: new TextEncoder().encode(`${lines.join('\n')}\n`) };
}

/** A grid of triangles, closed in one direction or in both. */
function grid(n: number, m: number, isClosed: readonly [boolean, boolean], at: (s: number, t: number) => Point): [Point[], number[][]] {
    const [columns, rows] = [isClosed[0] ? n : n + 1, isClosed[1] ? m : m + 1];
    const points: Point[] = [];
    for (let j = 0; j < rows; j++) for (let i = 0; i < columns; i++) points.push(at(i / n, j / m));
    const id = (i: number, j: number): number => (j % rows) * columns + (i % columns);
    const faces: number[][] = [];
    for (let j = 0; j < m; j++) {
        for (let i = 0; i < n; i++) {
            const [a, b, c, d] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
            faces.push(...((i + j) % 2 === 0 ? [[a, b, c], [a, c, d]] : [[a, b, d], [b, c, d]]));
        }
    }
    return [points, faces];
}

const TURN = 2 * Math.PI;

/** A knotted tube. */
function knot(): MeshFile {
    const centre = (s: number): Point => {
        const a = TURN * s;
        const r = 2 + Math.cos(3 * a);
        return [r * Math.cos(2 * a), r * Math.sin(2 * a), 1.2 * Math.sin(3 * a)];
    };
    const cross = (u: Point, v: Point): Point => [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const unit = (v: Point): Point => {
        const length = Math.hypot(...v);
        return [v[0] / length, v[1] / length, v[2] / length];
    };
    const at = (s: number, t: number): Point => {
        const [p, q] = [centre(s), centre(s + 1e-3)];
        const along = unit([q[0] - p[0], q[1] - p[1], q[2] - p[2]]);
        const side = unit(cross(along, unit(p)));
        const up = cross(side, along);
        const [x, y] = [0.45 * Math.cos(TURN * t), 0.45 * Math.sin(TURN * t)];
        return [p[0] + x * side[0] + y * up[0], p[1] + x * side[1] + y * up[1], p[2] + x * side[2] + y * up[2]];
    };
    return obj('knot', ...grid(140, 14, [true, true], at));
}

/** A bowl with a rim, open above. */
function bowl(): MeshFile {
    const at = (s: number, t: number): Point => {
        const a = TURN * s;
        const r = (0.35 + 0.9 * Math.sin(1.35 * t)) * (1 + 0.06 * Math.cos(6 * a) * t);
        return [r * Math.sin(a), 1.5 * t * t, r * Math.cos(a)];
    };
    return obj('bowl', ...grid(48, 20, [true, false], at));
}

/** A block with a step: sharp edges to follow. */
function step(): MeshFile {
    const n = 5;
    const outline: readonly (readonly [number, number])[] = [[0, 0], [3, 0], [3, 1], [1, 1], [1, 2], [0, 2]];
    const known = new Map<string, number>();
    const points: Point[] = [];
    const faces: number[][] = [];
    const vertex = (point: Point): number => {
        const key = point.map((x) => Math.round(1e4 * x)).join(' ');
        const found = known.get(key) ?? points.push(point) - 1;
        known.set(key, found);
        return found;
    };
    const patch = (from: Point, u: Point, v: Point, columns: number, rows: number): void => {
        const at = (i: number, j: number): number => vertex([0, 1, 2].map((k) => from[k] + (i / n) * u[k] + (j / n) * v[k]) as unknown as Point);
        for (let i = 0; i < columns * n; i++) {
            for (let j = 0; j < rows * n; j++) {
                const [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                faces.push([a, b, c], [a, c, d]);
            }
        }
    };
    outline.forEach(([x, y], k) => {
        const [ex, ey] = outline[(k + 1) % outline.length];
        const length = Math.hypot(ex - x, ey - y);
        patch([x, y, -2], [(ex - x) / length, (ey - y) / length, 0], [0, 0, 1], length, 2);
    });
    for (const [x, y] of [[0, 0], [1, 0], [2, 0], [0, 1]] as const) {
        patch([x, y, 0], [1, 0, 0], [0, 1, 0], 1, 1);
        patch([x, y, -2], [0, 1, 0], [1, 0, 0], 1, 1);
    }
    return obj('step', points, faces);
}

export interface Sample {
    readonly name: string;
    readonly text: string;
    /** What to try with it. */
    readonly next: string;
    readonly make: () => MeshFile;
}

export const SAMPLES: readonly Sample[] = [
    { name: 'Step', text: 'a block whose sharp edges the quads follow', next: 'Its creases and corners were found by their shape. “Make it” lays quads along them.', make: step },
    { name: 'Knot', text: 'a smooth tube, closed: cones where it bends', next: 'Make a seamless map, and show “Tau” to see how little it is stretched; then quads with direction 0 and 1.', make: knot },
    { name: 'Bowl', text: 'open above: the quads end at its rim', next: 'The quads follow the rim. With “None” for features they need not, and those that the rim would cut are left out.', make: bowl },
];
