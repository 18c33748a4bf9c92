import { describe, expect, it } from 'vitest';
import { SAMPLES } from '../src/samples';

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
