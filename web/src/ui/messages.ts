import { button } from "./controls.ts";
import { byId, element } from "./dom.ts";
import { kIcons } from "./icons.ts";

const kShown = 8000; // ms that a note stays; errors stay until they are closed
const kMaxMessages = 4;

/** Messages over the picture; also said to screen readers. */
export class Messages {
    private progress = new Map<string, HTMLElement>(); // by what it is that takes its time

    constructor(private root: HTMLElement) {}

    error(text: string): void {
        this.add(text, true);
    }

    note(text: string): void {
        this.add(text, false);
    }

    /** A note with something that can be done about it; stays until it is closed. */
    offer(text: string, name: string, action: () => void): void {
        const message = this.add(text, false, Infinity);
        const accept = element(
            "button",
            {
                type: "button",
                class: "button",
                click: () => {
                    message.remove();
                    action();
                },
            },
            name,
        );
        message.lastElementChild!.before(accept);
    }

    /** A line that something is under way; "" ends it. */
    busy(text: string, what: "task" | "frame" = "task"): void {
        const line = this.progress.get(what) ?? element("div", { class: "message busy" });
        this.progress.set(what, line);
        line.replaceChildren(element("span", { class: "spinner" }), text);
        if (text === "") {
            line.remove();
        } else {
            this.root.append(line);
            this.say(text);
        }
    }

    /** Takes errors away, as another run opens. */
    clear(): void {
        this.root.replaceChildren();
    }

    say(text: string): void {
        byId("status").textContent = text;
    }

    private add(text: string, isError: boolean, milliseconds = kShown): HTMLElement {
        const same = [...this.root.children].find((one) => one.textContent === text);
        same?.remove();
        const close = button("Close this message", kIcons.close, () => message.remove());
        const message = element(
            "div",
            { class: isError ? "message error" : "message", role: isError ? "alert" : "status" },
            element("span", {}, text),
            close,
        );
        this.root.append(message);
        while (this.root.childElementCount > kMaxMessages) {
            this.root.firstElementChild!.remove();
        }
        if (!isError && milliseconds < Infinity) {
            setTimeout(() => message.remove(), milliseconds);
        }
        return message;
    }
}
