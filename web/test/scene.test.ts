import { describe, expect, it } from 'vitest';
import { unpackScene, undelta } from '../src/scene';

/** A scene as the Rust side packs it: a square of two triangles with a seam along its diagonal. */
function packed(): Uint8Array {
    const arrays: [string, number[]][] = [
        // Three new corners, nothing behind their sides; then the other triangle.
        ['codes', [1, 1, 1, 0, 0, 0, 1, 1, 1]],
        ['faces', [0, 2]],
        // 0 1 2, 2 1 3 as differences of either sign.
        ['vertices', [0, 2, 2, 0, 1, 4]],
        ['positions', [0, 20, 19, 20]],
        ['positions', [0, 0, 20, 0]],
        ['positions', [0, 0, 0, 0]],
        ['uvs', [0, 20, 19, 0, 20, 0]],
        ['uvs', [0, 0, 20, 0, 19, 20]],
        ['features', [0, 2]],
        ['values', [0, 255]],
    ];
    const header = JSON.stringify({
        sides: 3,
        vertices: 4,
        positions: { origin: [1, 2, 3], step: 0.5 },
        uvs: { origin: [0, 0], step: 0.1 },
        values: [1.5, 6],
        arrays: arrays.map(([name, numbers]) => ({ name, length: numbers.length, planes: name === 'values' ? 2 : 1 })),
    });
    const text = new TextEncoder().encode(header);
    // The second level is 65535: not finite.
    const bytes = arrays.flatMap(([name, numbers]) => (name === 'values' ? [...numbers, 0, 255] : numbers));
    return Uint8Array.from([text.length & 255, text.length >> 8, 0, 0, ...text, ...bytes]);
}

describe('unpackScene', () => {
    const scene = unpackScene(packed());

    it('gives corners, wedges and positions back', () => {
        expect([...scene.corners]).toEqual([0, 1, 2, 2, 1, 3]);
        expect([...scene.wedges]).toEqual([0, 1, 2, 3, 4, 5]);
        expect([...scene.positions]).toEqual([1, 2, 3, 6, 2, 3, 1, 7, 3, 6, 7, 3]);
        expect([...scene.features]).toEqual([0, 1]);
    });

    it('gives the ends of the range exactly, and infinity', () => {
        expect([...(scene.values ?? [])]).toEqual([1.5, Infinity]);
    });

    it('reads a scene that does not start at the start of its buffer', () => {
        const shifted = new Uint8Array([9, 9, 9, ...packed()]).subarray(3);
        expect(unpackScene(shifted).corners).toEqual(scene.corners);
    });
});

describe('undelta', () => {
    it('sums differences of either sign', () => {
        expect([...undelta(Uint32Array.from([6, 1, 4, 0, 7, 1]))]).toEqual([3, 2, 4, 4, 0, 4294967295]);
    });
});
