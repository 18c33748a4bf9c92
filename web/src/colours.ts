// Colours that people tell apart whatever their eyes: viridis, blue to orange, and the palette of Okabe and Ito.
import type { Measure } from './measures';

export type Colour = readonly [number, number, number];

/** Viridis at equal steps. */
const SEQUENTIAL: readonly Colour[] = [
    [68, 1, 84], [72, 40, 120], [62, 74, 137], [49, 104, 142], [38, 130, 142],
    [31, 158, 137], [53, 183, 121], [109, 205, 89], [180, 222, 44], [253, 231, 37],
];

/** Blue where smaller, orange where larger. */
const DIVERGING: readonly Colour[] = [
    [20, 80, 160], [86, 140, 200], [168, 198, 224], [238, 238, 234], [244, 204, 158], [226, 150, 76], [184, 96, 16],
];

const CATEGORIES: readonly Colour[] = [
    [86, 180, 233], [230, 159, 0], [0, 158, 115], [240, 228, 66], [0, 114, 178], [213, 94, 0], [204, 121, 167],
    [160, 160, 160],
];

/** For what has no value: flipped, or without area. */
const UNDEFINED: Colour = [213, 64, 0];

/** A surface without colours. */
export const PLAIN: Colour = [226, 227, 230];

/** The colour of a cone: orange for fewer than four squares, blue for more; darker where it is larger. */
export function coneColour(index: number): Colour {
    if (index > 0) return index > 1 ? [176, 84, 0] : [240, 150, 30];
    return index < -1 ? [10, 60, 140] : [40, 120, 230];
}

/** The colour of a share of a range, from 0 to 1. */
function ramp(colours: readonly Colour[], share: number): Colour {
    const at = Math.max(0, Math.min(1, share)) * (colours.length - 1);
    const low = Math.min(Math.floor(at), colours.length - 2);
    const mix = (k: number): number => Math.round(colours[low][k] + (at - low) * (colours[low + 1][k] - colours[low][k]));
    return [mix(0), mix(1), mix(2)];
}

/** The colour of a value of a measure. */
export function colourOf(measure: Measure, value: number): Colour {
    if (!Number.isFinite(value)) return UNDEFINED;
    if (measure.id === 'component') return CATEGORIES[value % CATEGORIES.length];
    const [low, high] = measure.range;
    return ramp(measure.diverging ? DIVERGING : SEQUENTIAL, (value - low) / (high - low));
}

export function css([r, g, b]: Colour): string {
    return `rgb(${r} ${g} ${b})`;
}
