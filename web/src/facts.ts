// What a page says: the other side of `crates/seamstress/src/page/facts.rs`.

/** Something that was checked. */
export interface Claim {
    readonly passed: boolean;
    readonly title: string;
    readonly text: string;
}

/** A number with its meaning. */
export interface Metric {
    readonly name: string;
    readonly value: string;
    readonly meaning: string;
}

/** Something to know, with the elements it is about. */
export interface Note {
    readonly severity: 'warning' | 'error' | null;
    readonly text: string;
    readonly vertices: readonly number[];
    readonly faces: readonly number[];
}

/** An edge that is not followed. */
export interface Dropped {
    readonly vertices: readonly [number, number];
    readonly reason: string;
}

export interface Facts {
    readonly kind: string;
    readonly name: string;
    readonly version: string;
    readonly headline: string;
    readonly claims: readonly Claim[];
    readonly metrics: readonly Metric[];
    readonly notes: readonly Note[];
    /** Vertices with their indices in quarter turns. */
    readonly cones: readonly (readonly [number, number])[];
    readonly dropped: readonly Dropped[];
    readonly has_grid: boolean;
}

/** What is known of a result. */
export interface Result {
    readonly facts: Facts;
    readonly report: Readonly<Record<string, unknown>>;
    readonly command: string | null;
}
