import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { crc32c, hex8 } from "../../src/format/crc32c.ts";
import { parseHeader } from "../../src/format/header.ts";
import { determinant } from "../../src/format/mesh.ts";
import { readFrame, readMesh } from "../../src/format/pent_file.ts";
import { makeBoundary } from "../../src/mesh/boundary.ts";
import { gridMesh } from "../../src/mesh/grid.ts";
import { damage } from "../support/damage.ts";
import { messageOf } from "../support/message.ts";
import { kRoot, native, randomFrom } from "../support/native.ts";
import { writeFrame, writeMesh } from "../support/write_pent.ts";

const kCorpus = ["pent", "pent_checksum"].flatMap((folder) => {
    const path = join(kRoot, "tests/fuzz/corpus", folder);
    return readdirSync(path).map((name) => ({ name, bytes: readFileSync(join(path, name)) }));
});

const kUnit = gridMesh([1, 1, 1, 1], (p) => p);

function textMesh(lines: string[], body: string[]): Uint8Array {
    return new TextEncoder().encode([...lines, ...body, ""].join("\n"));
}

const kTriangle = [
    "ply",
    "format ascii 1.0",
    "comment pent 1.0",
    "comment dimension 2",
    "element vertex 3",
    "property double x",
    "property double y",
    "element triangle 1",
    "property uint v0",
    "property uint v1",
    "property uint v2",
    "end_header",
];

/** Reads a file of either kind, as pent-check does, and finds the boundary of a mesh. */
function read(bytes: Uint8Array, path: string): void {
    if (parseHeader(bytes, path).mesh) {
        readFrame(bytes, path);
    } else {
        const mesh = readMesh(bytes, path);
        makeBoundary(mesh, path);
    }
}

test("crc32c has the value that docs/pent-format.md states", () => {
    assert.equal(hex8(crc32c(new TextEncoder().encode("123456789"))), "e3069283");
    // Lengths that are no multiple of eight go through both loops: against the plain definition.
    const bytes = Uint8Array.from({ length: 61 }, (_, i) => (i * 37) & 255);
    let plain = 0xffffffff;
    for (const byte of bytes) {
        plain ^= byte;
        for (let bit = 0; bit < 8; ++bit) {
            plain = plain & 1 ? (plain >>> 1) ^ 0x82f63b78 : plain >>> 1;
        }
    }
    assert.equal(crc32c(bytes), (plain ^ 0xffffffff) >>> 0);
});

test("a mesh and a frame come back as they were written", () => {
    const file = writeMesh(kUnit);
    const mesh = readMesh(file, "unit.pent");
    assert.deepEqual(mesh.positions, kUnit.positions);
    assert.deepEqual(mesh.cells, kUnit.cells);
    const moved = [...kUnit.positions].map((value) => value + 0.1);
    const frame = readFrame(writeFrame(file, 7, 0.25, moved, moved), "body_000007.pent");
    assert.deepEqual([...frame.positions], moved);
    assert.deepEqual([frame.frame, frame.time, frame.meshCrc], [7, 0.25, mesh.crc]);
    assert.equal(frame.contactForces, null);
});

test("every sample of the corpus is taken or said why not, in one line", () => {
    let taken = 0;
    for (const { bytes } of kCorpus) {
        taken += messageOf(() => read(bytes, "sample.pent")) === "" ? 1 : 0;
    }
    assert.ok(taken >= 3, "else damage of the samples would try no more than the first lines");
});

test("messages name line, place, what was found and what was expected", () => {
    const cases: [Uint8Array, RegExp][] = [
        [new Uint8Array(0), /^a\.pent: the file is empty, expected a \.pent file$/],
        [
            textMesh(["solid x"], []),
            /^a\.pent: header line 1: found 'solid x', expected 'ply' \(is this a \.pent file\?\)$/,
        ],
        [textMesh(["ply\r"], []), /header line 1: found 'ply\?', expected lines that end with LF/],
        [
            textMesh(
                kTriangle.map((line) => line.replace("vertex 3", "vertex 300")),
                ["0 0"],
            ),
            /element vertex: the header announces 300 of at least 4 bytes each, but \d+ bytes are left/,
        ],
        [
            textMesh(kTriangle, ["0 0", "1 0", "0 nan", "0 1 2"]),
            /^a\.pent: vertex 2: y is nan, expected a finite number$/,
        ],
        [
            textMesh(kTriangle, ["0 0", "1 0", "0 1", "0 1 3"]),
            /^a\.pent: triangle 0: vertex 3 of 3, expected at most 2$/,
        ],
        [textMesh(kTriangle, ["0 0", "1 0", "0 1", "0 2 1"]), /triangle 0: inverted/],
        [textMesh(kTriangle, ["0 0", "1 0", "2 0", "0 1 2"]), /triangle 0: degenerate/],
        [textMesh(kTriangle, ["0 0", "1 0", "0 1", "0 1 1"]), /vertex 1 appears twice/],
        [
            textMesh(kTriangle, ["0 0", "1 0", "0 +1", "0 1 2"]),
            /^a\.pent: vertex 2: y is '\+1', expected a number of type double$/,
        ],
    ];
    for (const [bytes, expected] of cases) {
        assert.match(
            messageOf(() => read(bytes, "a.pent")),
            expected,
        );
    }
});

test("a header that was changed since it was written is refused", () => {
    const file = Buffer.from(writeMesh(kUnit)).toString("latin1");
    const readChanged = (text: string) =>
        messageOf(() => read(Buffer.from(text, "latin1"), "a.pent"));
    const without = file.replace(/comment header_crc32c .*\n/, "");
    assert.equal(readChanged(without), ""); // as files of version 0.1.0
    assert.notEqual(without, file);
    assert.match(
        readChanged(file.replace("comment pent 1.0\n", "comment pent 1.0 \n")),
        /expected 'comment pent 1\.0'/,
    );
    assert.match(
        readChanged(file.replace("element vertex", "comment more\nelement vertex")),
        /^a\.pent: header: its checksum is [0-9a-f]{8}, the header says [0-9a-f]{8}: it was changed/,
    );
    assert.match(
        readChanged(file.replace(/header_crc32c .*\n/, "header_crc32c 12\n")),
        /expected 'comment header_crc32c XXXXXXXX' with 8 hexadecimal digits/,
    );
});

test("names of elements that are no text are shown as numbers of bytes", () => {
    const bytes = textMesh(
        kTriangle.map((line) => line.replace("element vertex", "element w\u00fcrfel")),
        [],
    );
    assert.match(
        messageOf(() => read(bytes, "a.pent")),
        /found element w\u00fcrfel first/,
    );
    bytes[bytes.indexOf(0xc3)] = 0xbc;
    assert.match(
        messageOf(() => read(bytes, "a.pent")),
        /found element w\\xbc\\xbcrfel first/,
    );
});

test("huge counts are refused before anything is allocated", () => {
    const file = Buffer.from(writeMesh(kUnit)).toString("latin1");
    for (const count of ["4294967295", "99999999999", "18446744073709551615"]) {
        const damaged = file
            .replace(/comment header_crc32c .*\n/, "")
            .replace(/element vertex \d+/, `element vertex ${count}`);
        assert.match(
            messageOf(() => read(Buffer.from(damaged, "latin1"), "a.pent")),
            /announces|at most 4294967295/,
        );
    }
});

test("determinants agree with expansion along the first row", () => {
    const random = randomFrom(1);
    const expand = (m: number[][]): number =>
        m.length === 1
            ? m[0]![0]!
            : m[0]!.reduce(
                  (sum, value, j) =>
                      sum +
                      (j % 2 ? -1 : 1) *
                          value *
                          expand(m.slice(1).map((row) => row.filter((_, k) => k !== j))),
                  0,
              );
    for (const n of [2, 3, 4]) {
        const m = Array.from({ length: n }, () => Array.from({ length: n }, () => random() - 0.5));
        assert.ok(Math.abs(determinant(m.flat(), n) - expand(m)) < 1e-14); // rounding of 24 products
    }
});

function withChecksum(bytes: Uint8Array): Uint8Array {
    const text = Buffer.from(bytes).toString("latin1");
    const end = text.indexOf("end_header\n");
    const at = text.indexOf("crc32c ");
    if (end < 0 || at < 0 || at + 15 > text.length) {
        return bytes;
    }
    const sum = hex8(crc32c(bytes.subarray(end + "end_header\n".length)));
    return Buffer.from(text.slice(0, at + 7) + sum + text.slice(at + 15), "latin1");
}

test("damaged samples are taken or said why not, and nothing else is thrown", () => {
    const random = randomFrom(4);
    for (let i = 0; i < 1000; ++i) {
        const sample = kCorpus[Math.floor(random() * kCorpus.length)]!.bytes;
        const bytes = damage(sample, random);
        messageOf(() => read(i % 2 ? withChecksum(bytes) : bytes, "a.pent"));
    }
});

test("damaged samples get the very words of the C++ reader", (t) => {
    const check = native("pent-check");
    if (!check) {
        t.skip("pent-check is not built");
        return;
    }
    const folder = mkdtempSync(join(tmpdir(), "pent-web-"));
    const path = join(folder, "a.pent");
    const random = randomFrom(5);
    // What pent-check asks beyond reading: links of vertices and the like; and the sign of a NaN.
    const isBeyond = (words: string) =>
        /vertices without a cell|does not fit|facets|boundary/.test(words);
    let refused = 0;
    try {
        for (let i = 0; i < 240; ++i) {
            const sample = kCorpus[Math.floor(random() * kCorpus.length)]!.bytes;
            const damaged = damage(sample, random);
            const bytes = i % 2 ? withChecksum(damaged) : damaged;
            writeFileSync(path, bytes);
            const stderr: string = spawnSync(check, [path, "--quiet"], {
                encoding: "utf8",
            }).stderr;
            const expected: string = stderr
                .trim()
                .replace(/^pent-check: /, "")
                .replaceAll("-nan", "nan");
            const found = messageOf(() => read(bytes, path));
            if (!isBeyond(expected)) {
                assert.equal(found, expected);
            }
            refused += expected === "" ? 0 : 1;
        }
    } finally {
        rmSync(folder, { recursive: true });
    }
    assert.ok(refused > 120, "else there was little to compare");
});

test("what is written here is sound for pent-check", (t) => {
    const check = native("pent-check");
    if (!check) {
        t.skip("pent-check is not built");
        return;
    }
    const folder = mkdtempSync(join(tmpdir(), "pent-web-"));
    const path = join(folder, "grid.pent");
    writeFileSync(path, writeMesh(gridMesh([2, 1, 3, 2], (p) => p)));
    try {
        assert.match(execFileSync(check, [path], { encoding: "utf8" }), /is sound/);
    } finally {
        rmSync(folder, { recursive: true });
    }
});
