// Where a view is seen from.

/** Around a surface by two angles, and a window on the plane: the same numbers for both. */
export interface Pose {
    /** Angle around the axis that is up, radians. */
    readonly yaw: number;
    /** Angle above the horizon, radians. */
    readonly pitch: number;
    /** How much larger than the whole. */
    readonly zoom: number;
    /** What is in the middle, in radii from the centre of everything. */
    readonly middle: readonly [number, number, number];
}

/** From the front, a little from the right and from above. */
export const START: Pose = { yaw: 0.5, pitch: 0.35, zoom: 1, middle: [0, 0, 0] };

const MOST_PITCH = Math.PI / 2 - 0.01;
const [LEAST_ZOOM, MOST_ZOOM] = [0.2, 200];

const clamp = (x: number, low: number, high: number): number => Math.max(low, Math.min(high, x));

/** Unit vectors of the view: to the right, up, and towards the eye. */
export function axes({ yaw, pitch }: Pose): [number[], number[], number[]] {
    const [sy, cy, sp, cp] = [Math.sin(yaw), Math.cos(yaw), Math.sin(pitch), Math.cos(pitch)];
    return [[cy, 0, -sy], [-sp * sy, cp, -sp * cy], [cp * sy, sp, cp * cy]];
}

export function turned(pose: Pose, yaw: number, pitch: number): Pose {
    return { ...pose, yaw: pose.yaw + yaw, pitch: clamp(pose.pitch + pitch, -MOST_PITCH, MOST_PITCH) };
}

/** Moved within the view by shares of its radius. */
export function moved(pose: Pose, right: number, up: number): Pose {
    const [x, y] = axes(pose);
    const middle = pose.middle.map((at, k) => clamp(at + (right * x[k] + up * y[k]) / pose.zoom, -3, 3));
    return { ...pose, middle: middle as [number, number, number] };
}

export function zoomed(pose: Pose, factor: number): Pose {
    return { ...pose, zoom: clamp(pose.zoom * factor, LEAST_ZOOM, MOST_ZOOM) };
}

/** Short text of a pose for an address. */
export function poseText(pose: Pose): string {
    const numbers = [pose.yaw, pose.pitch, pose.zoom, ...pose.middle];
    return numbers.map((x) => String(Number(x.toFixed(3)))).join(',');
}

/** The pose of a text, if it is one. */
export function parsePose(text: string): Pose | undefined {
    const numbers = text.split(',').map(Number);
    if (numbers.length !== 6 || !numbers.every(Number.isFinite)) return undefined;
    const [yaw, pitch, zoom, x, y, z] = numbers;
    const [height, size] = [clamp(pitch, -MOST_PITCH, MOST_PITCH), clamp(zoom, LEAST_ZOOM, MOST_ZOOM)];
    return { yaw, pitch: height, zoom: size, middle: [clamp(x, -3, 3), clamp(y, -3, 3), clamp(z, -3, 3)] };
}
