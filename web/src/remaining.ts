// How far work is, and how long it is likely to take yet.
import type { Progress } from './engine';

/** Stages in their order, with the share of the time that each usually takes. */
const STAGES: readonly (readonly [string, number])[] = [
    ['cut', 1], ['rounding', 42], ['clean-up', 12], ['layout', 16], ['polish', 30], ['certificate', 1],
    ['quantization', 16], ['extraction', 5], ['shaping', 5],
];
/** Those of a map. */
const OF_MAP = 6;

/** No time is told before so many seconds, and so much of the work. */
const [SOON, LITTLE] = [1, 0.08];

export class Remaining {
    readonly stages: readonly string[];
    /** The stage at work, by its place in the list, or -1. */
    stage = -1;
    /** The share of all work that is done. */
    share = 0;
    private readonly weights: readonly number[];

    constructor(isMap: boolean) {
        const stages = isMap ? STAGES.slice(0, OF_MAP) : STAGES;
        const sum = stages.reduce((all, [, weight]) => all + weight, 0);
        this.stages = stages.map(([name]) => name);
        this.weights = stages.map(([, weight]) => weight / sum);
    }

    /** Takes note of how far the work is. It never goes back. */
    see({ stage, component, n_components, fraction }: Progress): void {
        const at = this.stages.indexOf(stage);
        if (at < 0) return;
        const before = this.weights.slice(0, at).reduce((all, weight) => all + weight, 0);
        const share = (component + before + fraction * this.weights[at]) / n_components;
        if (share < this.share) return;
        this.share = share;
        this.stage = at;
    }

    /** Seconds that are likely left after so many, if that can be told yet. */
    after(seconds: number): number | undefined {
        return seconds < SOON || this.share < LITTLE ? undefined : (seconds * (1 - this.share)) / this.share;
    }
}

/** A time in words, no more exact than it is. */
export function aboutText(seconds: number): string {
    if (seconds < 10) return `about ${Math.max(1, Math.round(seconds))} s left`;
    if (seconds < 100) return `about ${5 * Math.round(seconds / 5)} s left`;
    return `about ${Math.round(seconds / 60)} min left`;
}
