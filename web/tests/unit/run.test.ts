import assert from "node:assert/strict";
import { test } from "node:test";
import { gridMesh } from "../../src/mesh/grid.ts";
import { ExampleRun, kExamples } from "../../src/run/example.ts";
import { ByteCache } from "../../src/run/byte_cache.ts";
import { Decoder } from "../../src/run/decode.ts";
import { commonFrames, framePath, listPaths } from "../../src/run/listing.ts";
import type { Moment, Run } from "../../src/run/run.ts";
import { FrameStream } from "../../src/run/stream.ts";
import { parseListing, WebFiles } from "../../src/run/sources.ts";
import { writeFrame, writeMesh } from "../support/write_pent.ts";

test("a dropped run is found in whatever folder it is", () => {
    const paths = [
        "a/b/run/meshes/x.pent",
        "a/b/run/meshes/y_1.pent",
        "a/b/run/frames/x_000002.pent",
        "a/b/run/frames/x_000001.pent",
        "a/b/run/frames/y_1_000001.pent",
        "a/b/run/frames/.x_000003.pent",
        "a/b/run/report.json",
        "a/b/run/checkpoint/meshes/x.pent",
    ];
    const { listing, prefix } = listPaths(paths);
    assert.equal(prefix, "a/b/run/");
    assert.deepEqual(listing.meshes, ["x", "y_1"]);
    assert.deepEqual(commonFrames(listing), [1]);
    assert.equal(framePath("y_1", 1), "frames/y_1_000001.pent");
});

test("obstacles of a dropped run are found, at rest or moving", () => {
    const of = (more: string[]) =>
        listPaths(["r/meshes/a.pent", "r/frames/a_000000.pent", ...more]).listing.obstacles;
    assert.equal(of([]), "none");
    assert.equal(of(["obstacles.json", "r/checkpoint/obstacles.json"]), "none");
    assert.equal(of(["r/obstacles.json"]), "still");
    assert.equal(of(["r/obstacles/000000.json"]), "moving");
});

test("a dropped mesh is found, and what is neither is refused", () => {
    assert.equal(listPaths(["octopus.pent"]).listing.mesh, "octopus.pent");
    assert.throws(
        () => listPaths(["notes.txt"]),
        /^Error: notes.txt: found no .pent file; expected/,
    );
    assert.throws(() => listPaths(["a.pent", "b.pent"]), /found 2 meshes but no folder meshes/);
    assert.throws(() => listPaths([]), /expected a run folder/);
});

test("a run without frames of a body, or without a common one, is refused", () => {
    const of = (paths: string[]) => listPaths(paths).listing;
    assert.throws(
        () => commonFrames(of(["r/meshes/a.pent"])),
        /^Error: frames\/a_000000.pent: no such frame nor a later one of this body; did pent-sim run\?$/,
    );
    assert.throws(
        () =>
            commonFrames(
                of([
                    "r/meshes/a.pent",
                    "r/meshes/b.pent",
                    "r/frames/a_000000.pent",
                    "r/frames/b_000001.pent",
                ]),
            ),
        /no frame that all bodies have/,
    );
});

test("addresses of runs and files are asked for as they are, and called by their names", async () => {
    const kName = "50% #1 \u00fc?";
    const files = new Map([
        [`runs/${kName}/run.json`, '{"meshes":["a#b"],"frames":{"a#b":[[0,0]]}}'],
        [`runs/${kName}/meshes/a#b.pent`, "mesh"],
        [`runs/${kName}/a.pent`, "single"],
        [`runs/${kName}.pent`, "named so"],
        ["100%/run.json", '{"mesh":"of any name"}'],
        ["100%/of any name", "whatever"],
    ]);
    const asked = globalThis.fetch;
    globalThis.fetch = (address) => {
        const path = new URL(String(address), "http://a/").pathname.slice(1);
        const text = files.get(path.split("/").map(decodeAsServersDo).join("/"));
        return Promise.resolve(
            new Response(text ?? null, { status: text === undefined ? 404 : 200 }),
        );
    };
    const textOf = async (source: WebFiles, path: string) =>
        new TextDecoder().decode(await source.read(path));
    try {
        const encoded = encodeURIComponent(kName);
        const run = new WebFiles(`runs/${encoded}/`);
        assert.equal(run.title, kName);
        assert.deepEqual((await run.list()).meshes, ["a#b"]);
        assert.equal(await textOf(run, "meshes/a#b.pent"), "mesh");
        const single = new WebFiles(`runs/${encoded}.pent`);
        assert.equal(single.title, kName);
        assert.equal(await textOf(single, (await single.list()).mesh!), "named so");
        // A % that stands for itself, and a file that a list names.
        const other = new WebFiles("100%/");
        assert.equal(other.title, "100%");
        assert.equal(await textOf(other, (await other.list()).mesh!), "whatever");
    } finally {
        globalThis.fetch = asked;
    }
});

function decodeAsServersDo(part: string): string {
    return /%(?![0-9a-f]{2})/i.test(part) ? part : decodeURIComponent(part);
}

test("lists of pent-view and reports of pent-sim are understood, and nothing else", () => {
    const ours = parseListing(
        '{"meshes":["a"],"frames":{"a":[[0,2],[5,5]]},"follow":true}',
        "run.json",
    );
    assert.deepEqual(ours.frames.get("a"), [0, 1, 2, 5]);
    assert.equal(ours.isGrowing, true);
    const report = parseListing(
        '{"verdict":"running","bodies":[{"name":"b"},{"name":"a"}],' +
            '"frames":[{"frame":0},{"frame":1}]}',
        "report.json",
    );
    assert.deepEqual(
        [report.meshes, report.frames.get("b"), report.isGrowing],
        [["a", "b"], [0, 1], true],
    );
    for (const text of ["", "{}", "[]", "null", "7", '{"bodies":3,"frames":[]}', "<html>"]) {
        assert.throws(
            () => parseListing(text, "run.json"),
            /^Error: run.json: cannot be understood/,
        );
    }
    for (const range of ["[0,1e12]", "[3,1]", "[-1,1]", "[0.5,1]", '["0",1]']) {
        assert.throws(
            () => parseListing(`{"meshes":["a"],"frames":{"a":[${range}]}}`, "run.json"),
            /run.json: found frames/,
        );
    }
});

test("frames of another mesh are refused", () => {
    const decoder = new Decoder();
    const grid = gridMesh([1, 1, 1, 1], (p) => p);
    const mesh = writeMesh(grid);
    const other = writeMesh(gridMesh([1, 1, 1, 1], (p) => [2 * p[0], p[1], p[2], p[3]]));
    decoder.mesh(mesh, "a", "meshes/a.pent");
    const frame = (of: Uint8Array) =>
        writeFrame(of, 0, 0, [...grid.positions], [...grid.positions]);
    assert.equal(decoder.frame(frame(mesh), "a", "f").frame.positions.length, 64);
    assert.throws(
        () => decoder.frame(frame(other), "a", "frames/a_000000.pent"),
        /^Error: frames\/a_000000.pent: belongs to another mesh than meshes\/a.pent; expected both/,
    );
});

test("speeds, forces and strain of a frame are those of its vectors", () => {
    const decoder = new Decoder();
    const grid = gridMesh([1, 1, 1, 1], (p) => p);
    const mesh = writeMesh(grid);
    decoder.mesh(mesh, "a", "a");
    const velocities = [...grid.positions].map((_, i) => (i % 4 === 3 ? 4 : i % 4 === 0 ? 3 : 0));
    const { frame, time } = decoder.frame(
        writeFrame(mesh, 1, 0.5, [...grid.positions], velocities, velocities),
        "a",
        "f",
    );
    assert.equal(time, 0.5);
    assert.ok(frame.quantities.get("speed")!.every((value) => value === 5));
    assert.ok(frame.quantities.get("force")!.every((value) => value === 5));
    assert.ok(decoder.strain("a", frame.positions).every((value) => value === 0));
});

test("meshes of dimension 2 are refused, those of 3 are taken", () => {
    const positions = Float64Array.of(0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1);
    const tet = writeMesh({ dimension: 3, positions, cells: Uint32Array.of(0, 1, 2, 3) });
    assert.equal(new Decoder().mesh(tet, "t", "t.pent").body.boundary.facetCount, 4);
    const triangle = writeMesh({
        dimension: 2,
        positions: Float64Array.of(0, 0, 1, 0, 0, 1),
        cells: Uint32Array.of(0, 1, 2),
    });
    assert.throws(
        () => new Decoder().mesh(triangle, "t", "t.pent"),
        /^Error: t.pent: has dimension 2; expected 3 or 4$/,
    );
});

test("the cache keeps what was used last, within its bytes", () => {
    const cache = new ByteCache<number, string>(100);
    cache.set(1, "a", 40);
    cache.set(2, "b", 40);
    cache.get(1);
    cache.set(3, "c", 40);
    assert.deepEqual(
        [cache.has(1), cache.has(2), cache.has(3), cache.bytes],
        [true, false, true, 80],
    );
    cache.set(4, "larger than all", 1000);
    assert.deepEqual([cache.size, cache.bytes], [1, 1000]); // what came last stays
    cache.set(4, "less", 10);
    assert.equal(cache.bytes, 10);
});

// A run of frames of 160 bytes that come when they are told to.
class SlowRun implements Run {
    title = "slow";
    dimension = 4 as const;
    bodies = [];
    frames = Array.from({ length: 100 }, (_, i) => i);
    isGrowing = false;
    asked: number[] = [];
    private waiting = new Map<number, (moment: Moment) => void>();

    load(frame: number): Promise<Moment> {
        this.asked.push(frame);
        return new Promise((resolve) => this.waiting.set(frame, resolve));
    }

    async bring(frame: number): Promise<void> {
        this.waiting.get(frame)!({
            frame,
            time: 0,
            obstacles: [],
            bodies: [
                {
                    positions: new Float32Array(40),
                    quantities: new Map(),
                },
            ],
        });
        await new Promise((resolve) => setTimeout(resolve));
    }

    refresh = () => Promise.resolve(false);
    close = () => {};
}

test("frames are brought a few at a time, what is wanted first, and read ahead", async () => {
    const run = new SlowRun();
    const came: number[] = [];
    const stream = new FrameStream(run, (place) => came.push(place), 1e6, 2);
    stream.want(10, 5, false);
    assert.deepEqual(run.asked, [10, 11]);
    await run.bring(10);
    assert.deepEqual([came, run.asked], [[10], [10, 11]]); // no more ahead than is known to fit
    stream.want(50, 5, false); // scrubbed elsewhere: what had not begun is forgotten
    await run.bring(11);
    assert.deepEqual(run.asked, [10, 11, 50, 51]);
    assert.equal(stream.readyFrom(10, 1), 2);
    assert.equal(stream.get(50), undefined);
});

test("no more is kept than the bytes allow, and half of them at most is read ahead", async () => {
    const run = new SlowRun();
    const stream = new FrameStream(run, () => {}, 800, 4); // five frames
    stream.want(0, 24, true);
    for (let i = 0; i < 3; ++i) {
        await run.bring(run.asked[i]!);
        stream.want(0, 24, true);
    }
    assert.ok(stream.bytes <= 800);
    assert.ok(Math.max(...run.asked) <= 2 + 1, run.asked.join());
});

test("a frame that fails is said once and does not hold the others up", async () => {
    const run = new SlowRun();
    const load = run.load.bind(run);
    run.load = (frame) => (frame === 1 ? Promise.reject(new Error("damaged")) : load(frame));
    const stream = new FrameStream(run, () => {}, 1e6, 1);
    stream.want(1, 0, false);
    await new Promise((resolve) => setTimeout(resolve));
    assert.equal(stream.failure(1)!.message, "damaged");
    stream.want(1, 0, false);
    await new Promise((resolve) => setTimeout(resolve));
    assert.equal(stream.failure(1)!.message, "damaged");
    stream.want(2, 0, false);
    assert.deepEqual(run.asked, [2]);
    await run.bring(2);
    run.load = load; // the network is there again
    stream.want(1, 1, false);
    await run.bring(1);
    assert.equal(stream.failure(1), undefined);
    assert.equal(stream.get(1)!.frame, 1);
});

test("every example makes frames that fit its body", async () => {
    for (const [name, example] of Object.entries(kExamples)) {
        const run = new ExampleRun(example, name);
        const moment = await run.load(30);
        assert.equal(moment.bodies[0]!.positions.length, 4 * run.bodies[0]!.vertexCount);
        assert.ok(moment.bodies[0]!.positions.every(Number.isFinite));
        const { quantities } = moment.bodies[0]!;
        assert.ok(quantities.get("speed")!.some((value) => value > 0));
        await run.addStrain(moment);
        assert.equal(quantities.get("strain")!.length, run.bodies[0]!.vertexCount);
    }
});
