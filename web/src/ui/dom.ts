/** Small helpers over the page's elements. */

type Child = Node | string | null;
type Attributes = Record<string, string | number | boolean | ((event: Event) => void)>;

/** An element with attributes, listeners (functions, by name of the event) and children. */
export function element<Tag extends keyof HTMLElementTagNameMap>(
    tag: Tag,
    attributes: Attributes = {},
    ...children: Child[]
): HTMLElementTagNameMap[Tag] {
    const made = document.createElement(tag);
    for (const [key, value] of Object.entries(attributes)) {
        if (typeof value === "function") {
            made.addEventListener(key, value);
        } else if (typeof value === "boolean") {
            made.toggleAttribute(key, value);
        } else {
            made.setAttribute(key, String(value));
        }
    }
    made.append(...children.filter((child) => child !== null));
    return made;
}

export function byId<Type extends HTMLElement = HTMLElement>(id: string): Type {
    return document.getElementById(id) as Type;
}

const kSvg = "http://www.w3.org/2000/svg";

export function svg(
    tag: string,
    attributes: Record<string, string | number>,
    ...children: Child[]
) {
    const made = document.createElementNS(kSvg, tag);
    for (const [key, value] of Object.entries(attributes)) {
        made.setAttribute(key, String(value));
    }
    made.append(...children.filter((child) => child !== null));
    return made;
}

/** An icon of 24 x 24 by the d of its path, drawn as lines. */
export function icon(path: string): SVGElement {
    return svg(
        "svg",
        {
            viewBox: "0 0 24 24",
            width: 20,
            height: 20,
            "aria-hidden": "true",
            fill: "none",
            stroke: "currentColor",
            "stroke-width": 1.8,
            "stroke-linecap": "round",
            "stroke-linejoin": "round",
        },
        svg("path", { d: path }),
    ) as SVGElement;
}

/** Saves a blob under a name, as if it were a download. */
export function save(blob: Blob, name: string): void {
    const link = element("a", { href: URL.createObjectURL(blob), download: name });
    document.body.append(link);
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}
