import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { unpack } from "../../src/play/lzma.ts";
import { damage } from "../support/damage.ts";
import { messageOf } from "../support/message.ts";
import { kRoot, randomFrom } from "../support/native.ts";
import { pack } from "../../pack.mjs";

const random = randomFrom(31);
const bytes = (count: number, of: (i: number) => number) =>
    Uint8Array.from({ length: count }, (_, i) => of(i));

// Far copies, near ones, copies that go on into themselves, the same again with a byte changed, and none at all.
const kSamples: Record<string, Uint8Array> = {
    nothing: bytes(0, () => 0),
    "a byte": bytes(1, () => 7),
    zeros: bytes(100_000, () => 0),
    noise: bytes(30_000, () => 256 * random()),
    "few letters": bytes(50_000, () => 97 + 3 * random()),
    "a long period": bytes(300_000, (i) => ((i % 70_001) * 2654435761) >>> 13),
    "numbers that grow": new Uint8Array(
        Uint32Array.from({ length: 40_000 }, (_, i) => 1000 * i + 50 * random()).buffer,
    ),
    text: readFileSync(join(kRoot, "docs/simulator.md")),
    code: readFileSync(process.execPath).subarray(0, 400_000),
};

for (const [name, expected] of Object.entries(kSamples)) {
    test(`${name}: what xz has packed comes out again`, () => {
        const found = unpack(pack(expected), expected.length);
        assert.equal(Buffer.compare(found, expected), 0);
    });
}

test("what is cut or damaged is refused, or gives other bytes, and comes to an end", () => {
    const expected = kSamples["few letters"]!;
    const packed = pack(expected);
    for (const length of [0, 1, 4, 5, 100, packed.length - 50]) {
        assert.match(
            messageOf(() => unpack(packed.slice(0, length), expected.length)),
            /^its file is damaged; build the page again$/,
        );
    }
    let refused = 0;
    for (let i = 0; i < 300; ++i) {
        refused += messageOf(() => unpack(damage(packed, random), expected.length)) === "" ? 0 : 1;
    }
    assert.ok(refused > 30, `${refused}`);
});

test("xz reads what the page is made with", () => {
    const text = kSamples["text"]!;
    const options = ["--decompress", "--format=raw", "--lzma1=lc=4,lp=0,pb=0", "--stdout"];
    assert.equal(Buffer.compare(execFileSync("xz", options, { input: pack(text) }), text), 0);
});
