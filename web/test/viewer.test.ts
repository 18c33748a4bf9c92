import { describe, expect, it } from 'vitest';
import { axes, moved, parsePose, poseText, START, turned, zoomed } from '../src/camera';
import { colourOf } from '../src/colours';
import { findEdges, histogram, measuresOf } from '../src/measures';
import { firstHit, nearestSide } from '../src/picking';
import type { Scene } from '../src/scene';
import { parseSettings, settingsText, type Settings } from '../src/settings';
import type { MarkName } from '../src/view';

/** A square of two triangles in the plane, stretched to twice its width on the map. */
function square(wedges: number[]): Scene {
    const uvOf = [0, 0, 2, 0, 0, 1, 2, 1];
    const corners = [0, 1, 2, 2, 1, 3];
    return {
        sides: 3,
        positions: Float32Array.from([0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0]),
        corners: Uint32Array.from(corners),
        uvs: Float32Array.from(corners.flatMap((v) => uvOf.slice(2 * v, 2 * v + 2))),
        wedges: Uint32Array.from(wedges),
        values: Float64Array.from([1.5, 1.5]),
        features: new Uint32Array(),
    };
}

describe('findEdges', () => {
    it('finds the boundary, and no seam where both sides share UVs', () => {
        const edges = findEdges(square([0, 1, 2, 2, 1, 3]));
        expect(edges.boundary.length).toBe(8);
        expect(edges.seams.length).toBe(0);
        expect([...edges.component]).toEqual([0, 0]);
    });

    it('finds a seam where they do not', () => {
        const edges = findEdges(square([0, 1, 2, 3, 1, 4]));
        expect([...edges.seams]).toEqual([2, 1]);
    });
});

describe('measuresOf', () => {
    const scene = square([0, 1, 2, 2, 1, 3]);
    const measures = measuresOf(scene, findEdges(scene));
    const valuesOf = (id: string): number[] => [...(measures.find((measure) => measure.id === id)?.values ?? [])];

    it('measures angles and areas', () => {
        valuesOf('angle').forEach((value) => { expect(value).toBeCloseTo(2); });
        // The mean area is taken out.
        valuesOf('area').forEach((value) => { expect(value).toBeCloseTo(0); });
        expect(valuesOf('tau')).toEqual([1.5, 1.5]);
    });

    it('measures the corners and sides of quads', () => {
        const quad: Scene = { ...scene, sides: 4, corners: Uint32Array.from([0, 1, 3, 2]), uvs: undefined, values: undefined, wedges: Uint32Array.from([0, 1, 2, 3]) };
        const wide = { ...quad, positions: quad.positions.map((x, k) => (k % 3 === 0 ? 3 * x : x)) };
        const byName = new Map(measuresOf(wide, findEdges(wide)).map((measure) => [measure.id, [...measure.values]]));
        expect(byName.get('corner')?.[0]).toBeCloseTo(0);
        expect(byName.get('aspect')?.[0]).toBeCloseTo(3);
    });

    it('counts values in bins, those outside in the last', () => {
        const measure = { ...measures[0], values: Float64Array.from([1, 1.4, 2, 9, Infinity]), range: [1, 2] as const };
        expect(histogram(measure, 2)).toEqual([2, 3]);
        expect(colourOf(measure, 1)).toEqual([68, 1, 84]);
        expect(colourOf(measure, 5)).toEqual([253, 231, 37]);
    });
});

describe('firstHit', () => {
    const triangles = Float32Array.from([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1]);

    it('is the nearest triangle in front', () => {
        expect(firstHit(triangles, { origin: [0.2, 0.2, 3], direction: [0, 0, -1] })).toEqual({ triangle: 1, point: [0.2, 0.2, 1] });
        expect(firstHit(triangles, { origin: [0.2, 0.2, 0.5], direction: [0, 0, -1] })?.triangle).toBe(0);
        expect(firstHit(triangles, { origin: [0.2, 0.2, 3], direction: [0, 0, 1] })).toBeUndefined();
        expect(firstHit(triangles, { origin: [0.9, 0.9, 3], direction: [0, 0, -1] })).toBeUndefined();
    });

    it('is at some side of its triangle', () => {
        const corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0]];
        expect(nearestSide(corners, [0.4, 0.05, 0])).toEqual([0, 1]);
        expect(nearestSide(corners, [0.48, 0.48, 0])).toEqual([1, 2]);
        expect(nearestSide(corners, [0.02, 0.5, 0])).toEqual([2, 0]);
    });
});

describe('poses', () => {
    it('go through text', () => {
        const pose = zoomed(moved(turned(START, 0.25, 9), 0.5, -0.25), 3);
        const again = parsePose(poseText(pose));
        expect(poseText(again ?? START)).toBe(poseText(pose));
        expect(parsePose('1,2,three')).toBeUndefined();
        expect(parsePose('1,2,3')).toBeUndefined();
    });

    it('have a frame of unit vectors', () => {
        const [x, y, z] = axes(turned(START, 1, 0.3));
        const dot = (a: number[], b: number[]): number => a.reduce((sum, u, k) => sum + u * b[k], 0);
        for (const [a, b, value] of [[x, x, 1], [y, y, 1], [z, z, 1], [x, y, 0], [y, z, 0], [x, z, 0]] as const) {
            expect(dot(a, b)).toBeCloseTo(value);
        }
    });

    it('never turn over the top', () => {
        expect(turned(START, 0, 9).pitch).toBeLessThan(Math.PI / 2);
    });
});

describe('settings', () => {
    const usual: Settings = { show: 'checks', edges: false, marks: new Set<MarkName>(['cones']), layout: 'both', pose: START, picked: -1 };

    it('go through an address, and only what is unusual', () => {
        expect(settingsText(usual, usual)).toBe('');
        const changed: Settings = { ...usual, show: 'tau', edges: true, marks: new Set<MarkName>(['seams']), picked: 7 };
        expect(parseSettings(settingsText(changed, usual), usual, ['checks', 'tau'], 10)).toEqual(changed);
    });

    it('are as usual where an address is wrong', () => {
        expect(parseSettings('show=beauty&face=99&view=x&layout=deep', usual, ['checks'], 10)).toEqual(usual);
    });
});
