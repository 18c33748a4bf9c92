// Which triangle is under the pointer.

/** A ray: where it starts and where it goes. */
export interface Ray {
    readonly origin: readonly number[];
    readonly direction: readonly number[];
}

/** A triangle and the point where a ray meets it. */
export interface Hit {
    readonly triangle: number;
    readonly point: readonly number[];
}

/** The first triangle that a ray meets, of triangles of nine coordinates each. Möller and Trumbore. */
export function firstHit(triangles: Float32Array, { origin, direction }: Ray): Hit | undefined {
    const [ox, oy, oz] = origin;
    const [dx, dy, dz] = direction;
    let [nearest, found] = [Infinity, -1];
    for (let at = 0; at < triangles.length; at += 9) {
        const [x, y, z] = [triangles[at], triangles[at + 1], triangles[at + 2]];
        const e1x = triangles[at + 3] - x, e1y = triangles[at + 4] - y, e1z = triangles[at + 5] - z;
        const e2x = triangles[at + 6] - x, e2y = triangles[at + 7] - y, e2z = triangles[at + 8] - z;
        const px = dy * e2z - dz * e2y, py = dz * e2x - dx * e2z, pz = dx * e2y - dy * e2x;
        const determinant = e1x * px + e1y * py + e1z * pz;
        if (determinant === 0) continue;
        const sx = ox - x, sy = oy - y, sz = oz - z;
        const u = (sx * px + sy * py + sz * pz) / determinant;
        if (!(u >= 0 && u <= 1)) continue;
        const qx = sy * e1z - sz * e1y, qy = sz * e1x - sx * e1z, qz = sx * e1y - sy * e1x;
        const v = (dx * qx + dy * qy + dz * qz) / determinant;
        if (!(v >= 0 && u + v <= 1)) continue;
        const t = (e2x * qx + e2y * qy + e2z * qz) / determinant;
        if (t > 0 && t < nearest) [nearest, found] = [t, at / 9];
    }
    return found < 0 ? undefined : { triangle: found, point: origin.map((x, k) => x + nearest * direction[k]) };
}

/** The side of a polygon that is nearest to a point, by its two corners. */
export function nearestSide(corners: readonly (readonly number[])[], point: readonly number[]): readonly [number, number] {
    const distance = (a: readonly number[], b: readonly number[]): number => {
        const along = b.map((x, k) => x - a[k]);
        const square = along.reduce((sum, x) => sum + x * x, 0);
        const share = square > 0 ? along.reduce((sum, x, k) => sum + x * (point[k] - a[k]), 0) / square : 0;
        const t = Math.max(0, Math.min(1, share));
        return Math.hypot(...along.map((x, k) => a[k] + t * x - point[k]));
    };
    const distances = corners.map((corner, k) => distance(corner, corners[(k + 1) % corners.length]));
    const side = distances.indexOf(Math.min(...distances));
    return [side, (side + 1) % corners.length];
}
