// Elements of a page, made in one call.

type Child = Node | string | undefined | false | null;
type Properties = Readonly<Record<string, string | number | boolean | ((event: Event) => void) | undefined>>;

/** An element with attributes, listeners (`onclick`) and children. */
export function h<K extends keyof HTMLElementTagNameMap>(
    name: K,
    properties: Properties = {},
    ...children: readonly Child[]
): HTMLElementTagNameMap[K] {
    const element = document.createElement(name);
    for (const [key, value] of Object.entries(properties)) {
        if (typeof value === 'function') element.addEventListener(key.slice(2), value);
        else if (value === true) element.setAttribute(key, '');
        else if (value !== false && value !== undefined) element.setAttribute(key, String(value));
    }
    element.append(...children.filter((child): child is Node | string => !!child));
    return element;
}

/** A file for the user to keep. */
export function download(name: string, content: BlobPart, type: string): void {
    const address = URL.createObjectURL(new Blob([content], { type }));
    h('a', { href: address, download: name }).click();
    setTimeout(() => { URL.revokeObjectURL(address); }, 10_000);
}
