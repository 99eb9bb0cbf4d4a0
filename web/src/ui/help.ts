import { kActions } from "./actions.ts";
import { button } from "./controls.ts";
import { element } from "./dom.ts";
import { kIcons } from "./icons.ts";

const kGestures = [
    ["drag", "look around"],
    ["right drag, shift drag", "turn in xw (across) and yw (upright)"],
    ["alt drag, control drag", "turn in zw (upright) and xy (across)"],
    ["middle drag, two fingers", "move the picture"],
    ["wheel, pinch", "nearer, further away"],
    ["shift wheel, alt wheel", "slice along w"],
    ["buttons under the picture", "what one finger or the left button does"],
] as const;

const kPlaying = [
    ["drag a body", "pull it, along the picture"],
    ["wheel or shift while pulling", "pull it along w"],
    ["P", "take hold of what is in the middle; let go (escape)"],
    ["arrows while holding", "pull along the picture; along w with shift"],
    ["space", "pause, go on"],
    ["\u2192", "one step"],
    ["backspace", "back to the start"],
] as const;

function table(rows: readonly (readonly [string, string])[]): HTMLElement {
    return element(
        "table",
        {},
        ...rows.map(([what, does]) =>
            element("tr", {}, element("th", { scope: "row" }, what), element("td", {}, does)),
        ),
    );
}

/** The legend of keys and gestures. */
export function fillHelp(dialog: HTMLDialogElement): void {
    dialog.append(
        element("h2", { id: "help-title" }, "Keys and gestures"),
        button("Close", kIcons.close, () => dialog.close()),
        element(
            "div",
            { class: "columns" },
            table(kActions.map(({ shown, does }) => [shown, does] as const)),
            element(
                "div",
                {},
                table(kGestures),
                element("h3", {}, "In the playground"),
                table(kPlaying),
                element(
                    "p",
                    {},
                    "The picture shows the three-dimensional slice of the bodies at " +
                        "height w, after they have been turned. In four dimensions a rotation has a " +
                        "plane in place of an axis: xw takes x towards w. The ring at the end of an " +
                        "axis tells how far it points out of the slice.",
                ),
            ),
        ),
    );
    dialog.addEventListener("click", (event) => {
        if (event.target === dialog) {
            dialog.close();
        }
    });
}
