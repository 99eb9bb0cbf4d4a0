import { PentError } from "./error.ts";
import type { G4mfDocument } from "./g4mf_document.ts";
import type { JsonEntry } from "./json_entry.ts";
import { determinant } from "./mesh.ts";

/** A mesh where a node has it. */
export interface ModelBody {
    name: string;
    points: Float64Array; // four numbers each, m
    tetrahedra: Uint32Array; // four corners each, outward in our sense where the file is in its own
}

/** What blend shapes show. */
export interface ModelFrame {
    frame: number;
    time: number; // s
    shape: number | null; // that is blended in; null: what the file itself blends in
}

const kMaxCount = 1 << 24; // points, and tetrahedra: what a graphics card takes
const kLargest = 3.4e38; // that a float holds
const kSecondsPerShape = 1; // of shapes that say nothing of time
// Blend shapes as pent-convert names them: "octopus_000012 at 0.4 s".
const kFrameName = /_(\d{6,15}) at (\d[\d.]*(?:e[+-]?\d+)?) s$/;

/** A linear map, row by row, and what is added to it. */
interface Placement {
    linear: number[];
    shift: number[];
}

const kIdentity: Placement = {
    linear: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
    shift: [0, 0, 0, 0],
};

function after(above: Placement, below: Placement): Placement {
    const row = (i: number, values: (k: number) => number) =>
        [0, 1, 2, 3].reduce((sum, k) => sum + above.linear[4 * i + k]! * values(k), 0);
    return {
        linear: Array.from({ length: 16 }, (_, at) =>
            row(at >> 2, (k) => below.linear[4 * k + (at & 3)]!),
        ),
        shift: above.shift.map((value, i) => value + row(i, (k) => below.shift[k]!)),
    };
}

interface Instance {
    name: string;
    mesh: JsonEntry;
    place: Placement;
}

/** The meshes of a G4MF file of four dimensions, and what its blend shapes make of them. */
export class G4mfModel {
    /** All that hang on the first node, where nodes put them; all as they are where there are no nodes. */
    readonly bodies: ModelBody[] = [];
    /** One, and one for each blend shape; where all shapes are frames of a run, these alone. */
    readonly frames: ModelFrame[];
    private shown: Instance[] = []; // one a body

    constructor(private document: G4mfDocument) {
        let points = 0;
        let tetrahedra = 0;
        for (const instance of this.instances()) {
            const body = this.body(instance);
            if (body.tetrahedra.length === 0) {
                continue;
            }
            points += body.points.length / 4;
            tetrahedra += body.tetrahedra.length / 4;
            if (points > kMaxCount || tetrahedra > kMaxCount) {
                instance.mesh.fail(`with it there are more than ${kMaxCount} points or tetrahedra`);
            }
            this.bodies.push(body);
            this.shown.push(instance);
        }
        if (this.bodies.length === 0) {
            throw new PentError(
                `${document.path}: no tetrahedron in it; expected the boundary of a body of four dimensions`,
            );
        }
        this.frames = framesOf(this.shown.map(({ mesh }) => shapesOf(mesh)));
    }

    /** The points of every body in a frame. */
    points({ shape }: ModelFrame): Float64Array[] {
        return this.shown.map(({ mesh, place }) => this.pointsOf(mesh, place, shape));
    }

    private instances(): Instance[] {
        const { json } = this.document;
        const nodes = json.has("nodes") ? json.at("nodes").list() : [];
        if (nodes.length > 0) {
            return this.instancesAt(nodes);
        }
        const meshes = json.has("meshes") ? json.at("meshes").list() : [];
        return meshes.map((mesh, i) => ({
            name: nameOf(mesh, `mesh ${i}`),
            mesh,
            place: kIdentity,
        }));
    }

    private instancesAt(nodes: JsonEntry[]): Instance[] {
        const { json } = this.document;
        const seen = new Set<string>();
        const instances: Instance[] = [];
        const waiting: { node: JsonEntry; above: Placement }[] = [
            { node: nodes[0]!, above: kIdentity },
        ];
        for (let next = waiting.pop(); next; next = waiting.pop()) {
            const { node, above } = next;
            if (seen.has(node.where)) {
                node.fail("is the child of two nodes");
            }
            seen.add(node.where);
            const place = after(above, placementOf(node));
            const holder = node.has("meshInstance") ? node.at("meshInstance") : node; // in earlier drafts
            if (holder.has("mesh")) {
                const mesh = json.at("meshes").pointed(holder.at("mesh"));
                const name = nameOf(node, nameOf(mesh, `mesh ${instances.length}`));
                instances.push({ name, mesh, place });
            }
            const children = node.has("children") ? node.at("children").list() : [];
            for (const child of children.reverse()) {
                waiting.push({ node: json.at("nodes").pointed(child), above: place });
            }
        }
        return instances;
    }

    private body({ name, mesh, place }: Instance): ModelBody {
        const points = this.pointsOf(mesh, place, null);
        const parts = mesh
            .at("surfaces")
            .list()
            .flatMap((surface) => accessorsOf(surface))
            .map((accessor) => this.corners(accessor, points.length / 4));
        const tetrahedra = new Uint32Array(parts.reduce((sum, part) => sum + part.length, 0));
        parts.reduce((at, part) => (tetrahedra.set(part, at), at + part.length), 0);
        // Its outside is our inside; a mirrored node turns it once more.
        if (determinant(place.linear, 4) > 0) {
            turnOver(tetrahedra);
        }
        return { name, points, tetrahedra };
    }

    private corners(accessor: JsonEntry, points: number): Uint32Array {
        const corners = this.document.indices(accessor, 4);
        const bad = corners.findIndex((corner) => corner >= points);
        if (bad >= 0) {
            accessor.fail(`tetrahedron ${bad >> 2}: point ${corners[bad]} of ${points}`);
        }
        return corners;
    }

    // Where the points of a mesh are, with one of its shapes, or with the amounts of the file.
    private pointsOf(mesh: JsonEntry, place: Placement, shape: number | null): Float64Array {
        const points = this.document.reals(mesh.at("vertices"), 4);
        const shapes = shapesOf(mesh);
        const blend = mesh.at("blend");
        const amounts =
            shape === null && blend.has("amounts")
                ? blend.at("amounts").reals(shapes.length)
                : shapes.map((_, i) => (i === shape ? 1 : 0));
        amounts.forEach((amount, i) => {
            if (amount !== 0 && shapes[i]!.has("position")) {
                this.move(points, shapes[i]!.at("position"), amount);
            }
        });
        putInPlace(points, place, mesh);
        return points;
    }

    private move(points: Float64Array, target: JsonEntry, amount: number): void {
        const indices = this.document.indices(target.at("indices"), 1);
        const offsets = this.document.reals(target.at("offsets"), 4);
        if (offsets.length !== 4 * indices.length) {
            target.fail(`${offsets.length / 4} offsets for ${indices.length} points`);
        }
        indices.forEach((point, i) => {
            if (4 * point >= points.length) {
                target.fail(`point ${point} of ${points.length / 4}`);
            }
            for (let axis = 0; axis < 4; ++axis) {
                points[4 * point + axis]! += amount * offsets[4 * i + axis]!;
            }
        });
    }
}

function nameOf(entry: JsonEntry, usual: string): string {
    return entry.has("name") ? entry.at("name").text() : usual;
}

function shapesOf(mesh: JsonEntry): JsonEntry[] {
    return mesh.has("blend") ? mesh.at("blend").at("shapes").list() : [];
}

// As drafts have called them.
function accessorsOf(surface: JsonEntry): JsonEntry[] {
    return ["simplexes", "cells"].filter((key) => surface.has(key)).map((key) => surface.at(key));
}

function framesOf(lists: JsonEntry[][]): ModelFrame[] {
    const shapes = lists.reduce((a, b) => (b.length > a.length ? b : a), []);
    const named = shapes.map((shape, i) => {
        const match = kFrameName.exec(nameOf(shape, ""));
        return match && { frame: Number(match[1]), time: Number(match[2]), shape: i };
    });
    const ofRun = named.filter(
        (one, i) =>
            one &&
            Number.isFinite(one.time) &&
            one.frame > (i > 0 ? (named[i - 1]?.frame ?? 0) : -1),
    ) as ModelFrame[];
    if (shapes.length > 0 && ofRun.length === shapes.length) {
        return ofRun;
    }
    const frame = (i: number, shape: number | null) => ({
        frame: i,
        time: i * kSecondsPerShape,
        shape,
    });
    return [frame(0, null), ...shapes.map((_, i) => frame(i + 1, i))];
}

// In our sense, from that of the file.
function turnOver(tetrahedra: Uint32Array): void {
    for (let at = 0; at < tetrahedra.length; at += 4) {
        const corner = tetrahedra[at + 2]!;
        tetrahedra[at + 2] = tetrahedra[at + 3]!;
        tetrahedra[at + 3] = corner;
    }
}

function putInPlace(points: Float64Array, { linear, shift }: Placement, mesh: JsonEntry): void {
    const p = [0, 0, 0, 0];
    for (let at = 0; at < points.length; at += 4) {
        for (let k = 0; k < 4; ++k) {
            p[k] = points[at + k]!;
        }
        for (let axis = 0; axis < 4; ++axis) {
            let value = shift[axis]!;
            for (let k = 0; k < 4; ++k) {
                value += linear[4 * axis + k]! * p[k]!;
            }
            if (!(Math.abs(value) <= kLargest)) {
                mesh.fail(`point ${at / 4} is not finite, or beyond what a float holds`);
            }
            points[at + axis] = value;
        }
    }
}

function placementOf(node: JsonEntry): Placement {
    if (node.has("rotor")) {
        node.fail("is turned by a rotor; expected a basis");
    }
    const shift = node.has("position") ? node.at("position").reals(4) : kIdentity.shift;
    if (node.has("basis")) {
        const basis = node.at("basis").reals(16); // column by column
        const linear = basis.map((_, at) => basis[4 * (at & 3) + (at >> 2)]!);
        return { linear, shift };
    }
    if (!node.has("scale")) {
        return { linear: kIdentity.linear, shift };
    }
    const entry = node.at("scale");
    const isUniform = Array.isArray(entry.value) && entry.value.length === 1;
    const scale = entry.reals(isUniform ? 1 : 4);
    const linear = kIdentity.linear.map((one, at) => one * (scale[at & 3] ?? scale[0]!));
    return { linear, shift };
}
