// Words of options: those of the command's help, from the schemas in `docs/schema`, put in by the bundler.

declare const WORDS: Readonly<Record<string, string>>;

export type Option = 'repair' | 'quads' | 'edge_length' | 'features' | 'align' | 'adaptive' | 'min_edge' | 'max_edge' | 'smooth' | 'cone_bias';

/** What an option does: the first sentence of its help. */
export function helpOf(option: Option): string {
    return WORDS[option].replaceAll('`', '');
}
