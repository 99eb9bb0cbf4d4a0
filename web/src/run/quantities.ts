import type { Field } from "../format/fields.ts";
import { scalarsOf } from "../mesh/quantities.ts";
import type { Values } from "../mesh/quantities.ts";
import type { Body, BodyFrame } from "./decode.ts";

/** One number a vertex of each quantity that there is, by its name: "speed", "force" (of contact), "strain" where it was
 * asked for, or that of a field. */
export type Quantities = Map<string, Values>;

const kOwn = ["body", "w", "speed", "strain", "force"];

/** What a picture may be colored by whatever is open; any other name is that of a field, and so are the last two, which
 * pent-sim writes. */
export const kColorings: readonly string[] = [...kOwn, "reaction", "energy_density"];

/** Fields of a frame or mesh that can be asked for by their names. */
export function namedFields(fields: Field[]): Quantities {
    return scalarsOf(fields.filter(({ name }) => !kOwn.includes(name)));
}

/** A quantity of a body: of the frame, or else of the mesh. */
export function quantityOf(body: Body, frame: BodyFrame, name: string): Values | undefined {
    return frame.quantities.get(name) ?? body.fields.get(name);
}
