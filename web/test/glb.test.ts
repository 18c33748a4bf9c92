import { describe, expect, it } from 'vitest';
import { glb } from '../src/glb';
import { SAMPLES } from '../src/samples';

describe('glb', () => {
    const bytes = glb({
        sides: 4,
        positions: Float32Array.from([0, 0, 0, 1, 0, 0, 1, 2, 0, 0, 2, 0]),
        corners: Uint32Array.from([0, 1, 2, 3]),
        wedges: Uint32Array.from([0, 1, 2, 3]),
        uvs: undefined,
        values: undefined,
        features: new Uint32Array(),
    });
    const view = new DataView(bytes.buffer);
    const length = view.getUint32(12, true);
    const json = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + length))) as {
        accessors: { count: number; max?: number[] }[];
        bufferViews: { byteOffset: number; byteLength: number }[];
    };

    it('has chunks of whole words that fill the file', () => {
        expect(view.getUint32(0, true)).toBe(0x46546c67);
        expect(view.getUint32(8, true)).toBe(bytes.length);
        expect(length % 4).toBe(0);
        expect(20 + length + 8 + view.getUint32(20 + length, true)).toBe(bytes.length);
    });

    it('has two triangles for a quad, and bounds', () => {
        expect(json.accessors.map(({ count }) => count)).toEqual([6, 4]);
        expect(json.accessors[1].max).toEqual([1, 2, 0]);
        const start = 28 + length + json.bufferViews[0].byteOffset;
        expect([...new Uint32Array(bytes.slice(start, start + 24).buffer)]).toEqual([0, 1, 2, 0, 2, 3]);
    });
});

describe('samples', () => {
    it.each(SAMPLES.map((sample) => [sample.name, sample] as const))('%s is a manifold with one side up', (_, sample) => {
        const text = new TextDecoder().decode(sample.make().content);
        const faces = [...text.matchAll(/^f (\d+) (\d+) (\d+)$/gm)].map((found) => found.slice(1).map(Number));
        const sides = faces.flatMap(([a, b, c]) => [[a, b], [b, c], [c, a]].map((side) => side.join('-')));
        // Every side once: of two faces at an edge, one runs along it and the other against.
        expect(new Set(sides).size).toBe(sides.length);
        const open = sides.filter((side) => !sides.includes(side.split('-').reverse().join('-')));
        expect(open.length > 0).toBe(sample.name === 'Bowl');
    });
});
