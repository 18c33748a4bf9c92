// What a page draws, unpacked: the other side of `crates/seamstress/src/page/scene.rs`.

/** A mesh of triangles or quads, perhaps with a map, values and feature edges. */
export interface Scene {
    /** Corners of a polygon: 3 or 4. */
    readonly sides: number;
    /** Three coordinates a vertex; the last vertices may be in no polygon. */
    readonly positions: Float32Array;
    /** Vertices of the polygons, `sides` each. */
    readonly corners: Uint32Array;
    /** Two coordinates a corner, or none without a map. */
    readonly uvs: Float32Array | undefined;
    /** For every corner a number that it shares with those of the same vertex and UV. */
    readonly wedges: Uint32Array;
    /** A value of every polygon, infinite where it has none. */
    readonly values: Float64Array | undefined;
    /** Feature edges: two vertices each. */
    readonly features: Uint32Array;
}

interface Grid {
    readonly origin: readonly number[];
    readonly step: number;
}

interface Header {
    readonly sides: number;
    readonly vertices: number;
    readonly positions: Grid;
    readonly uvs: Grid | null;
    readonly values: readonly [number, number] | null;
    readonly arrays: readonly { name: string; length: number; planes: number }[];
}

/** Stands for a value that is not finite; the one below for the largest. */
const NOT_FINITE = 65535;

/** Number of polygons. */
export function polygonCount(scene: Scene): number {
    return scene.corners.length / scene.sides;
}

/** Reads a packed scene. */
export function unpackScene(bytes: Uint8Array): Scene {
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const start = 4 + view.getUint32(0, true);
    const header = JSON.parse(new TextDecoder().decode(bytes.subarray(4, start))) as Header;
    const arrays = unpackArrays(header, bytes, start);
    const all = (name: string): readonly Uint32Array[] => arrays.get(name) ?? [];
    const [faces, vertices] = [undelta(all('faces')[0]), undelta(all('vertices')[0])];
    const { wedges, known } = walk(all('codes')[0], faces, vertices.length, header.sides);
    return {
        sides: header.sides,
        positions: unpackPositions(header, all('positions'), vertices, known),
        corners: wedges.map((wedge) => vertices[wedge]),
        uvs: header.uvs ? unpackUvs(header.uvs, all('uvs'), known, wedges) : undefined,
        wedges,
        values: header.values ? unpackValues(header.values, all('values')[0], faces) : undefined,
        features: undelta(all('features')[0]),
    };
}

/** What codes say: there is no polygon behind a gate; a corner is new; a corner is the last new one. */
const [NOTHING, NEW, LAST] = [0, 1, 2];
/** Stands for nothing that a point is predicted from. */
const NONE = 0xffffffff;

/** The wedges of all corners, and what each wedge is predicted from: three others. As `walk.rs` has walked. */
function walk(codes: Uint32Array, faces: Uint32Array, count: number, sides: number): { wedges: Uint32Array; known: Uint32Array } {
    const wedges = new Uint32Array(faces.length * sides);
    const known = new Uint32Array(3 * count).fill(NONE);
    const gates: number[] = [];
    let [at, next, read, gate] = [0, 0, 0, 0];
    for (; at < faces.length; at++) {
        const first = sides * faces[at];
        while (gate < gates.length && codes[read] === NOTHING) {
            read++;
            gate += 3;
        }
        const isSeed = gate === gates.length;
        const [from, to, beside] = isSeed ? [NONE, NONE, NONE] : gates.slice(gate, gate + 3);
        if (!isSeed) {
            gate += 3;
            [wedges[first], wedges[first + 1]] = [to, from];
        }
        for (let k = isSeed ? 0 : 2; k < sides; k++) {
            const code = codes[read++];
            wedges[first + k] = code === NEW ? next : next - 1 - (code - LAST);
            if (code === NEW) known.set([from, to, beside], 3 * next++);
        }
        const wedge = (k: number): number => wedges[first + (k % sides)];
        for (let k = isSeed ? 0 : 1; k < sides; k++) gates.push(wedge(k), wedge(k + 1), wedge(k + 2));
    }
    return { wedges, known };
}

function unpackArrays(header: Header, bytes: Uint8Array, start: number): Map<string, Uint32Array[]> {
    const arrays = new Map<string, Uint32Array[]>();
    let at = start;
    for (const { name, length, planes } of header.arrays) {
        const numbers = new Uint32Array(length);
        for (let plane = 0; plane < planes; plane++, at += length) {
            for (let k = 0; k < length; k++) numbers[k] |= bytes[at + k] << (8 * plane);
        }
        arrays.set(name, [...(arrays.get(name) ?? []), numbers]);
    }
    return arrays;
}

/** A number that was stored as 0, 1, 2, 3, 4 for 0, -1, 1, -2, 2. */
function signed(code: number): number {
    return (code >>> 1) ^ -(code & 1);
}

/** Sums of differences. */
export function undelta(codes: Uint32Array): Uint32Array {
    const numbers = new Uint32Array(codes.length);
    let before = 0;
    for (let k = 0; k < codes.length; k++) {
        before = (before + signed(codes[k])) >>> 0;
        numbers[k] = before;
    }
    return numbers;
}

function unpackPositions(header: Header, axes: readonly Uint32Array[], vertices: Uint32Array, known: Uint32Array): Float32Array {
    const count = header.vertices;
    const order = new Uint32Array(count);
    const isMet = new Uint8Array(count);
    const predictions = new Uint32Array(3 * count).fill(NONE);
    let place = 0;
    vertices.forEach((vertex, wedge) => {
        if (isMet[vertex]) return;
        isMet[vertex] = 1;
        for (let k = 0; k < 3 && known[3 * wedge] !== NONE; k++) predictions[3 * place + k] = vertices[known[3 * wedge + k]];
        order[place++] = vertex;
    });
    for (let vertex = 0; vertex < count; vertex++) if (!isMet[vertex]) order[place++] = vertex;
    return unpackPoints(header.positions, axes, order, predictions);
}

function unpackUvs(grid: Grid, axes: readonly Uint32Array[], known: Uint32Array, wedges: Uint32Array): Float32Array {
    const order = Uint32Array.from({ length: known.length / 3 }, (_, wedge) => wedge);
    const points = unpackPoints(grid, axes, order, known);
    const uvs = new Float32Array(2 * wedges.length);
    wedges.forEach((wedge, corner) => { uvs.set(points.subarray(2 * wedge, 2 * wedge + 2), 2 * corner); });
    return uvs;
}

/** Points from their differences to the fourth corners of parallelograms, or to the points before. */
function unpackPoints({ origin, step }: Grid, axes: readonly Uint32Array[], order: Uint32Array, known: Uint32Array): Float32Array {
    const n = axes.length;
    const points = new Float32Array(n * order.length);
    axes.forEach((codes, k) => {
        const levels = new Int32Array(order.length);
        let before = 0;
        order.forEach((point, place) => {
            const [a, b, c] = known.subarray(3 * place, 3 * place + 3);
            const expected = a === NONE ? before : levels[a] + levels[b] - levels[c];
            before = levels[point] = expected + signed(codes[place]);
        });
        levels.forEach((level, point) => { points[n * point + k] = origin[k] + step * level; });
    });
    return points;
}

function unpackValues([low, high]: readonly [number, number], levels: Uint32Array, faces: Uint32Array): Float64Array {
    const value = (level: number): number => {
        if (level === NOT_FINITE) return Infinity;
        const share = level / (NOT_FINITE - 1);
        return share === 1 ? high : low * (high / low) ** share;
    };
    const values = new Float64Array(faces.length);
    faces.forEach((face, k) => { values[face] = value(levels[k]); });
    return values;
}

/** Bytes of a text that the Rust side has compressed and encoded. */
export async function inflate(text: string): Promise<Uint8Array> {
    const compressed = Uint8Array.from(atob(text.trim()), (character) => character.charCodeAt(0));
    const stream = new Blob([compressed]).stream().pipeThrough(new DecompressionStream('deflate'));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}
