import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { parseHeader } from "../../src/format/header.ts";
import { readObstacles } from "../../src/format/obstacles.ts";
import { readFrame, readMesh } from "../../src/format/pent_file.ts";
import { makeBoundary } from "../../src/mesh/boundary.ts";
import { Decoder, ModelDecoder } from "../../src/run/decode.ts";
import { EmbeddedRun } from "../../src/run/embedded.ts";
import { gridMesh } from "../../src/mesh/grid.ts";
import { listPaths } from "../../src/run/listing.ts";
import { parseListing } from "../../src/run/sources.ts";
import { formatState, parseState } from "../../src/view/state.ts";
import { damage } from "../support/damage.ts";
import { messageOf } from "../support/message.ts";
import { kRoot, randomFrom } from "../support/native.ts";
import { writeMesh } from "../support/write_pent.ts";

// Every reader of the page over all samples of tests/fuzz, those of other readers among them, and over what damage makes
// of them: each is taken, or refused by a PentError of one line (messageOf). Damage of .pent files with their checksums
// mended is in format.test.ts, that of G4MF in g4mf.test.ts.

const kCorpus = join(kRoot, "tests/fuzz/corpus");

function samples(folder: string): Uint8Array[] {
    const path = join(kCorpus, folder);
    return readdirSync(path).map((name) => readFileSync(join(path, name)));
}

const text = (bytes: Uint8Array) => new TextDecoder().decode(bytes);

const kReaders: Record<string, (bytes: Uint8Array) => void> = {
    pent(bytes) {
        const isMesh = parseHeader(bytes, "a.pent").mesh === null;
        if (isMesh) {
            makeBoundary(readMesh(bytes, "a.pent"), "a.pent");
        } else {
            readFrame(bytes, "a.pent");
        }
    },
    mesh: (bytes) => void new Decoder().mesh(bytes, "a", "a.pent"),
    model(bytes) {
        const decoder = new ModelDecoder();
        const beside = decoder.open(bytes, "a.g4tf");
        decoder.bodies(new Map(beside.map((uri) => [uri, new Uint8Array(64)])));
        decoder.frame(0);
    },
    obstacles4: (bytes) => void readObstacles(text(bytes), "obstacles.json", 4),
    obstacles3: (bytes) => void readObstacles(text(bytes), "obstacles.json", 3),
    listing: (bytes) => void parseListing(text(bytes), "run.json"),
};

// What each reader should be tried on the most: some of it is taken.
const kOwn: Record<string, string[]> = {
    pent: ["pent", "pent_checksum"],
    mesh: ["pent"],
    model: ["g4mf", "g4mf_chunks"],
    obstacles4: ["obstacles"],
    obstacles3: ["obstacles"],
    listing: ["report", "record"],
};

test("no reader of the page is upset by a sample of any other", () => {
    let refused = 0;
    for (const folder of readdirSync(kCorpus)) {
        for (const bytes of samples(folder)) {
            for (const read of Object.values(kReaders)) {
                refused += messageOf(() => read(bytes)) === "" ? 0 : 1;
            }
        }
    }
    assert.ok(refused > 300);
});

for (const [name, read] of Object.entries(kReaders)) {
    test(`the reader ${name}: its samples, damaged, are taken or said why not`, () => {
        const random = randomFrom(21);
        const own = kOwn[name]!.flatMap(samples);
        const outcomes = new Set<boolean>();
        for (let i = 0; i < 600; ++i) {
            const bytes = damage(own[i % own.length]!, random);
            outcomes.add(messageOf(() => read(i < own.length ? own[i]! : bytes)) === "");
        }
        assert.deepEqual([...outcomes].sort(), [false, true], "some are taken, others refused");
    });
}

test("JSON whose values are anything is taken or said why not", () => {
    const random = randomFrom(22);
    const values = [
        "null",
        "-1",
        "1e999",
        '"x"',
        "[]",
        "{}",
        "[[]]",
        "true",
        "99999999999999999999",
    ];
    const own = ["obstacles", "report", "g4mf"].flatMap(samples).map(text);
    for (let i = 0; i < 1500; ++i) {
        const sample = own[i % own.length]!;
        const places = [...sample.matchAll(/:\s*("[^"]*"|-?\d[\d.e+-]*|true|false|null)/g)];
        const place = places[Math.floor(random() * places.length)];
        const value = values[Math.floor(random() * values.length)]!;
        const changed = place
            ? `${sample.slice(0, place.index)}:${value}${sample.slice(place.index + place[0].length)}`
            : value;
        const bytes = new TextEncoder().encode(changed);
        Object.values(kReaders).forEach((read) => messageOf(() => read(bytes)));
    }
});

// A page that pent-view exported, of two frames of one small body, as its elements by their ids.
function exported(): Map<string, string> {
    const grid = gridMesh([1, 1, 1, 1], (p) => p);
    const { facets, facetCount } = makeBoundary(grid, "grid");
    const base64 = (array: ArrayBufferView) =>
        Buffer.from(array.buffer, array.byteOffset, array.byteLength).toString("base64");
    const frame = new Uint8Array(grid.vertexCount * (8 + 1)).fill(100);
    const description = {
        version: 2,
        title: "run",
        dimension: 4,
        low: [-1, -1, -1, -1],
        high: [1, 1, 1, 1],
        quantities: [{ name: "speed", low: 0, high: 2 }],
        fields: [{ name: "heat", low: 290, high: 300 }],
        bodies: [
            { name: "a", vertices: grid.vertexCount, cells: grid.cellCount, facets: facetCount },
        ],
        frames: [
            { frame: 0, time: 0 },
            { frame: 4, time: 0.5 },
        ],
        obstacles: [],
    };
    return new Map([
        ["pent-run", JSON.stringify(description)],
        ["pent-facets", base64(facets)],
        ["pent-fields", base64(new Uint8Array(grid.vertexCount).fill(51))],
        ["pent-frame-0", base64(frame)],
        ["pent-frame-1", base64(frame)],
    ]);
}

// The run of a page with these elements, to its last frame; what is wrong with it or "".
async function openExported(parts: Map<string, string>): Promise<string> {
    const getElementById = (id: string) => (parts.has(id) ? { textContent: parts.get(id) } : null);
    Object.assign(globalThis, { document: { getElementById } });
    let run: EmbeddedRun | null = null;
    const message = messageOf(() => {
        run = EmbeddedRun.find();
    });
    for (const frame of (run as EmbeddedRun | null)?.frames ?? []) {
        try {
            await (run as unknown as EmbeddedRun).load(frame);
        } catch (error) {
            return messageOf(() => {
                throw error;
            });
        }
    }
    return message;
}

test("an exported page that was damaged says so, and whatever is in it", async () => {
    const random = randomFrom(23);
    assert.equal(await openExported(exported()), "");
    for (const id of exported().keys()) {
        const parts = exported();
        parts.delete(id);
        const expected =
            id === "pent-run"
                ? ""
                : `this page: part ${id} of the run is missing; export the page again`;
        assert.equal(await openExported(parts), expected);
    }
    let refused = 0;
    for (let i = 0; i < 1200; ++i) {
        const parts = exported();
        const id = ["pent-run", "pent-facets", "pent-fields", "pent-frame-1"][i % 4]!;
        const bytes = damage(new TextEncoder().encode(parts.get(id)), random);
        refused += (await openExported(parts.set(id, text(bytes)))) === "" ? 0 : 1;
    }
    assert.ok(refused > 400, `${refused}`);
});

test("any address is understood as far as it goes, and is written as it is understood", () => {
    const random = randomFrom(24);
    const whole =
        "#w=0.1&rotate=xw:40,yz:-20&camera=30,20,1,0,0&frame=5&layout=side&slices=4&range=0,1" +
        "&spacing=0.1&speed=2&color=strain&ghost=perspective&theme=dark&shade=off";
    for (let i = 0; i < 1000; ++i) {
        const changed = text(damage(new TextEncoder().encode(whole), random));
        const { state } = parseState(changed);
        const again = formatState(parseState(`#${formatState(state)}`).state);
        assert.equal(again, formatState(state), changed);
    }
});

test("paths of any kind are a run, a mesh, or refused", () => {
    const random = randomFrom(25);
    const path = "a/run/meshes/x.pent\na/run/frames/x_000002.pent\nb.g4tf\n.pent\n//\n";
    for (let i = 0; i < 1000; ++i) {
        const paths = text(damage(new TextEncoder().encode(path), random)).split("\n");
        messageOf(() => listPaths(paths));
    }
});

test("meshes of any kind of cells have a boundary or are refused", () => {
    const random = randomFrom(26);
    const grid = gridMesh([2, 1, 1, 1], (p) => p);
    let refused = 0;
    for (let i = 0; i < 200; ++i) {
        const cells = grid.cells.slice();
        for (let k = 0; k < 3; ++k) {
            cells[Math.floor(random() * cells.length)] = Math.floor(
                random() * (grid.vertexCount + 2),
            );
        }
        const bytes = writeMesh({ ...grid, cells });
        refused += messageOf(() => kReaders["mesh"]!(bytes)) === "" ? 0 : 1;
    }
    assert.ok(refused > 150);
});
