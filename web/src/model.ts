// A scene made ready for drawing, on the surface and in the plane.
import type { Result } from './facts';
import { cornerNormals, findEdges, measuresOf, type Edges, type Measure } from './measures';
import { polygonCount, type Scene } from './scene';

/** Lines: six coordinates each. Points: three coordinates each, with the index of each. */
export interface Marks {
    readonly seams: Float32Array;
    readonly boundary: Float32Array;
    readonly features: Float32Array;
    readonly dropped: Float32Array;
    readonly cones: Float32Array;
    readonly coneIndices: Int32Array;
}

/** Something to draw: triangles of three corners each, nine coordinates. */
export interface Drawing {
    readonly triangles: Float32Array;
    readonly normals: Float32Array;
    readonly marks: Marks;
    readonly centre: readonly [number, number, number];
    readonly radius: number;
    /** Half the sizes of the box around it. */
    readonly extents: readonly [number, number, number];
    readonly isFlat: boolean;
}

export interface Model {
    readonly scene: Scene;
    readonly result: Result;
    readonly edges: Edges;
    readonly measures: readonly Measure[];
    /** For every corner of a triangle its corner in the scene. */
    readonly cornerOf: Uint32Array;
    readonly surface: Drawing;
    /** The map, if there is one. */
    readonly plane: Drawing | undefined;
}

/** Triangles of one polygon. */
export function trianglesOf(sides: number): readonly (readonly [number, number, number])[] {
    return sides === 4 ? [[0, 1, 2], [0, 2, 3]] : [[0, 1, 2]];
}

export function makeModel(scene: Scene, result: Result): Model {
    const fans = trianglesOf(scene.sides);
    const cornerOf = new Uint32Array(polygonCount(scene) * fans.length * 3);
    let at = 0;
    for (let first = 0; first < scene.corners.length; first += scene.sides) {
        for (const fan of fans) for (const side of fan) cornerOf[at++] = first + side;
    }
    const edges = findEdges(scene);
    const measures = measuresOf(scene, edges);
    const surface = surfaceDrawing(scene, result, edges, cornerOf);
    const plane = scene.uvs && planeDrawing(scene, scene.uvs, result, edges, cornerOf);
    return { scene, result, edges, measures, cornerOf, surface, plane };
}

function surfaceDrawing(scene: Scene, result: Result, edges: Edges, cornerOf: Uint32Array): Drawing {
    const { positions, corners, features } = scene;
    const gather = (vertices: ArrayLike<number>): Float32Array => {
        const points = new Float32Array(3 * vertices.length);
        for (let k = 0; k < vertices.length; k++) {
            points.set(positions.subarray(3 * vertices[k], 3 * vertices[k] + 3), 3 * k);
        }
        return points;
    };
    const ofCorners = cornerNormals(scene);
    const normals = new Float32Array(3 * cornerOf.length);
    cornerOf.forEach((corner, k) => { normals.set(ofCorners.subarray(3 * corner, 3 * corner + 3), 3 * k); });
    const { cones, dropped } = result.facts;
    const marks: Marks = {
        seams: gather(edges.seams),
        boundary: gather(edges.boundary),
        features: gather(features),
        dropped: gather(dropped.flatMap((edge) => edge.vertices)),
        cones: gather(cones.map(([vertex]) => vertex)),
        coneIndices: Int32Array.from(cones, ([, index]) => index),
    };
    const triangles = gather(cornerOf.map((corner) => corners[corner]));
    return { triangles, normals, marks, ...boundsOf(triangles.length > 0 ? triangles : positions), isFlat: false };
}

function planeDrawing(
    scene: Scene,
    uvs: Float32Array,
    result: Result,
    edges: Edges,
    cornerOf: Uint32Array,
): Drawing {
    const { corners, wedges, sides } = scene;
    const gather = (from: ArrayLike<number>): Float32Array => {
        const points = new Float32Array(3 * from.length);
        for (let k = 0; k < from.length; k++) points.set(uvs.subarray(2 * from[k], 2 * from[k] + 2), 3 * k);
        return points;
    };
    const n = scene.positions.length / 3;
    const keyOf = (a: number, b: number): number => Math.min(a, b) * n + Math.max(a, b);
    // Sides of faces on some edges: of an edge with two faces both.
    const images = (pairs: ArrayLike<number>): Float32Array => {
        const keys = new Set<number>();
        for (let k = 0; k < pairs.length; k += 2) keys.add(keyOf(pairs[k], pairs[k + 1]));
        const found: number[] = [];
        if (keys.size === 0) return new Float32Array();
        for (let corner = 0; corner < corners.length; corner++) {
            const after = (corner + 1) % sides === 0 ? corner + 1 - sides : corner + 1;
            if (keys.has(keyOf(corners[corner], corners[after]))) found.push(corner, after);
        }
        return gather(found);
    };
    const { cones, dropped } = result.facts;
    const [at, indices, known, index] = [[] as number[], [] as number[], new Set<number>(), new Map(cones)];
    corners.forEach((vertex, corner) => {
        const cone = index.get(vertex);
        if (cone === undefined || known.has(wedges[corner])) return;
        known.add(wedges[corner]);
        at.push(corner);
        indices.push(cone);
    });
    const marks: Marks = {
        seams: images(edges.seams),
        boundary: images(edges.boundary),
        features: images(scene.features),
        dropped: images(dropped.flatMap((edge) => edge.vertices)),
        cones: gather(at),
        coneIndices: Int32Array.from(indices),
    };
    const triangles = gather(cornerOf);
    const normals = new Float32Array(triangles.length).map((_, k) => (k % 3 === 2 ? 1 : 0));
    return { triangles, normals, marks, ...boundsOf(triangles), isFlat: true };
}

function boundsOf(points: Float32Array): Pick<Drawing, 'centre' | 'radius' | 'extents'> {
    if (points.length === 0) return { centre: [0, 0, 0], radius: 1, extents: [1, 1, 1] };
    const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    for (let k = 0; k < points.length; k++) {
        low[k % 3] = Math.min(low[k % 3], points[k]);
        high[k % 3] = Math.max(high[k % 3], points[k]);
    }
    const centre = low.map((x, k) => (x + high[k]) / 2) as [number, number, number];
    const extents = low.map((x, k) => (high[k] - x) / 2) as [number, number, number];
    let radius = 0;
    for (let at = 0; at < points.length; at += 3) {
        radius = Math.max(radius, Math.hypot(points[at] - centre[0], points[at + 1] - centre[1], points[at + 2] - centre[2]));
    }
    return { centre, radius: radius || 1, extents };
}
