import { element, icon } from "./dom.ts";

/** Controls of the panel: native inputs with labels, and a way to show a value in them. */
export interface Control<Value> {
    root: HTMLElement;
    show(value: Value): void;
}

export function toggle(
    label: string,
    onChange: (value: boolean) => void,
    title = "",
): Control<boolean> {
    const input = element("input", {
        type: "checkbox",
        change: () => onChange(input.checked),
    });
    const root = element("label", { class: "toggle", title }, input, element("span", {}, label));
    return {
        root,
        show: (value) => {
            input.checked = value;
        },
    };
}

type Options<Value> = readonly (readonly [Value, string, { disabled: boolean }?])[];

/** A choice among what is offered, at first or later. */
export function choice<Value extends string>(
    label: string,
    options: Options<Value>,
    onChange: (value: Value) => void,
) {
    const select = element("select", {
        "aria-label": label,
        change: () => onChange(select.value as Value),
    });
    let offered = "";
    const offer = (options: Options<Value>) => {
        if (offered !== JSON.stringify(options)) {
            offered = JSON.stringify(options);
            select.replaceChildren(
                ...options.map(([value, text, more]) =>
                    element("option", { value, ...more }, text),
                ),
            );
        }
    };
    offer(options);
    const root = element("label", { class: "row" }, element("span", {}, label), select);
    const show = (value: Value) => {
        select.value = value;
    };
    return { root, show, offer } satisfies Control<Value> & { offer: unknown };
}

/** A few choices side by side. */
export function segments<Value extends string>(
    label: string,
    options: readonly (readonly [Value, string, string?])[],
    onChange: (value: Value) => void,
) {
    const name = `segments-${label.replace(/\W/g, "")}`;
    const inputs = options.map(([value]) =>
        element("input", {
            type: "radio",
            name,
            value,
            change: () => onChange(value),
        }),
    );
    const root = element(
        "fieldset",
        { class: "segments" },
        element("legend", { class: "hidden-text" }, label),
        ...options.map(([, text, title], i) =>
            element("label", title ? { title } : {}, inputs[i]!, element("span", {}, text)),
        ),
    );
    const show = (value: Value) =>
        inputs.forEach((input) => {
            input.checked = input.value === value;
        });
    return { root, show } satisfies Control<Value>;
}

/** How far along a slider a value is. */
export interface Curve {
    toPlace(value: number): number;
    toValue(place: number): number;
}

const kStraight: Curve = { toPlace: (value) => value, toValue: (place) => place };

/** A slider with its number beside it. */
export class Slider {
    readonly root: HTMLElement;
    readonly input: HTMLInputElement;
    readonly number: HTMLInputElement;

    /** @param range     Of places.
     *  @param onChange  Is given what was chosen, by either. */
    constructor(
        label: string,
        private unit: string,
        range: { min: number; max: number; step: number },
        onChange: (value: number) => void,
        private curve = kStraight,
    ) {
        const shared = { min: range.min, max: range.max, step: range.step };
        this.input = element("input", {
            type: "range",
            ...shared,
            "aria-label": label,
            input: () => onChange(this.curve.toValue(Number(this.input.value))),
        });
        this.number = element("input", {
            type: "number",
            step: "any",
            "aria-label": `${label}, ${unit || "number"}`,
            change: () => {
                if (Number.isFinite(this.number.valueAsNumber)) {
                    onChange(this.number.valueAsNumber);
                }
            },
        });
        this.root = element(
            "div",
            { class: "slider" },
            element("span", { class: "name" }, label),
            this.input,
            this.number,
            element("span", { class: "unit" }, unit),
        );
    }

    setRange(min: number, max: number, step: number): void {
        this.input.min = String(min);
        this.input.max = String(max);
        this.input.step = String(step);
    }

    show(value: number, digits: number): void {
        const text = String(Number(value.toFixed(digits)));
        this.input.value = String(this.curve.toPlace(value));
        this.input.ariaValueText = `${text} ${this.unit}`.trim(); // not the place
        if (document.activeElement !== this.number) {
            this.number.value = text;
        }
    }
}

export function button(
    label: string,
    path: string,
    onClick: () => void,
    text = "",
): HTMLButtonElement {
    return element(
        "button",
        {
            type: "button",
            title: label,
            "aria-label": label,
            click: onClick,
            class: text ? "button" : "button round",
        },
        icon(path),
        text ? element("span", {}, text) : null,
    );
}

export function section(title: string, ...children: Node[]): HTMLDetailsElement {
    return element(
        "details",
        { open: true },
        element("summary", {}, title),
        element("div", { class: "group" }, ...children),
    );
}

/** A button that opens a small list of actions. */
export function menu(
    label: string,
    path: string,
    text: string,
    items: readonly (readonly [string, () => void])[],
): HTMLElement {
    const list = element(
        "div",
        { class: "menu", role: "menu", hidden: true },
        ...items.map(([name, action]) =>
            element(
                "button",
                {
                    type: "button",
                    role: "menuitem",
                    click: () => {
                        close();
                        action();
                    },
                },
                name,
            ),
        ),
    );
    const opener = button(
        label,
        path,
        () => {
            list.hidden = !list.hidden;
            opener.setAttribute("aria-expanded", String(!list.hidden));
            (list.firstElementChild as HTMLElement).focus();
        },
        text,
    );
    const close = () => {
        list.hidden = true;
        opener.setAttribute("aria-expanded", "false");
    };
    opener.setAttribute("aria-haspopup", "menu");
    opener.setAttribute("aria-expanded", "false");
    const root = element("div", { class: "menu-holder" }, opener, list);
    root.addEventListener("focusout", (event) => {
        if (!root.contains(event.relatedTarget as Node | null)) {
            close();
        }
    });
    root.addEventListener("keydown", (event) => {
        const buttons = [...list.querySelectorAll("button")];
        const at = buttons.indexOf(document.activeElement as HTMLButtonElement);
        const by = { ArrowDown: 1, ArrowUp: -1 }[event.key];
        if (event.key === "Escape" && !list.hidden) {
            close();
            opener.focus();
            event.stopPropagation();
        } else if (by && at >= 0) {
            buttons[(at + by + buttons.length) % buttons.length]!.focus();
            event.preventDefault();
            event.stopPropagation();
        }
    });
    return root;
}
