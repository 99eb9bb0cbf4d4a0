import { button } from "./controls.ts";
import { byId, element } from "./dom.ts";
import { kIcons } from "./icons.ts";

/** The card that greets where no run is open. */
export function showWelcome(actions: {
    openFolder(): void;
    openFiles(): void;
    play(): void;
}): void {
    const card = byId("welcome");
    card.replaceChildren(
        element(
            "p",
            {},
            element("b", {}, "Bodies of four dimensions, a slice at a time. "),
            "Move w below, and turn the body in xw: what you see is the part of it that " +
                "lies in the space w = 0.",
        ),
        element(
            "p",
            {},
            "Drop a run folder of pent-sim, a .pent mesh or a G4MF model here, or open",
        ),
        element(
            "div",
            { class: "actions" },
            button("Open a run folder", kIcons.open, actions.openFolder, "Folder"),
            button("Open files (.pent, .g4b, .g4tf)", kIcons.open, actions.openFiles, "Files"),
            button("Pull at bodies in the playground", kIcons.play, actions.play, "Play"),
        ),
        button("Close", kIcons.close, () => {
            card.hidden = true;
        }),
    );
    card.hidden = false;
}
