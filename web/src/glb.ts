// A scene as a binary glTF file: triangles, with UVs if there is a map.
import { trianglesOf } from './model';
import type { Scene } from './scene';

const [FLOAT, UNSIGNED_INT, ARRAY, ELEMENTS] = [5126, 5125, 34962, 34963];

/** One vertex for each wedge. */
export function glb(scene: Scene): Uint8Array {
    const { corners, wedges, positions, uvs, sides } = scene;
    const count = wedges.reduce((most, wedge) => Math.max(most, wedge + 1), 0);
    const points = new Float32Array(3 * count);
    const textures = uvs && new Float32Array(2 * count);
    wedges.forEach((wedge, corner) => {
        points.set(positions.subarray(3 * corners[corner], 3 * corners[corner] + 3), 3 * wedge);
        // glTF has its first row of pixels above.
        if (uvs) textures?.set([uvs[2 * corner], 1 - uvs[2 * corner + 1]], 2 * wedge);
    });
    const indices = new Uint32Array((corners.length / sides) * (sides - 2) * 3);
    let at = 0;
    for (let first = 0; first < corners.length; first += sides) {
        for (const fan of trianglesOf(sides)) for (const k of fan) indices[at++] = wedges[first + k];
    }
    const bound = (least: (a: number, b: number) => number): number[] =>
        [0, 1, 2].map((k) => points.reduce((best, x, i) => (i % 3 === k ? least(best, x) : best), points[k]));
    const parts: { data: Float32Array | Uint32Array; target: number; accessor: Record<string, unknown> }[] = [
        { data: indices, target: ELEMENTS, accessor: { componentType: UNSIGNED_INT, count: indices.length, type: 'SCALAR' } },
        { data: points, target: ARRAY, accessor: { componentType: FLOAT, count, type: 'VEC3', min: bound(Math.min), max: bound(Math.max) } },
    ];
    if (textures) parts.push({ data: textures, target: ARRAY, accessor: { componentType: FLOAT, count, type: 'VEC2' } });
    let byteOffset = 0;
    const bufferViews = parts.map(({ data, target }) => {
        const view = { buffer: 0, byteOffset, byteLength: data.byteLength, target };
        byteOffset += data.byteLength;
        return view;
    });
    const json = {
        asset: { version: '2.0', generator: 'Seamstress' },
        buffers: [{ byteLength: byteOffset }],
        bufferViews,
        accessors: parts.map(({ accessor }, bufferView) => ({ bufferView, ...accessor })),
        materials: [{ doubleSided: true, pbrMetallicRoughness: { metallicFactor: 0, roughnessFactor: 0.8 } }],
        meshes: [{ primitives: [{ attributes: { POSITION: 1, ...(textures ? { TEXCOORD_0: 2 } : {}) }, indices: 0, material: 0 }] }],
        nodes: [{ mesh: 0 }],
        scenes: [{ nodes: [0] }],
        scene: 0,
    };
    const text = new TextEncoder().encode(JSON.stringify(json));
    const padding = (4 - (text.length % 4)) % 4;
    const total = 12 + 8 + text.length + padding + 8 + byteOffset;
    const bytes = new Uint8Array(total);
    const view = new DataView(bytes.buffer);
    // Magic, version, length; then chunks of a length, a type and data: JSON and BIN.
    [0x46546c67, 2, total, text.length + padding, 0x4e4f534a].forEach((word, k) => { view.setUint32(4 * k, word, true); });
    bytes.set(text, 20);
    bytes.fill(0x20, 20 + text.length, 20 + text.length + padding);
    const start = 20 + text.length + padding;
    view.setUint32(start, byteOffset, true);
    view.setUint32(start + 4, 0x004e4942, true);
    parts.forEach(({ data }, k) => {
        bytes.set(new Uint8Array(data.buffer, data.byteOffset, data.byteLength), start + 8 + bufferViews[k].byteOffset);
    });
    return bytes;
}
