import { PentError } from "../format/error.ts";

// What xz --format=raw --lzma1=lc=4,lp=0,pb=0 writes, as the module of the page comes: a third smaller than deflated,
// which is all that browsers read by themselves. A range coder of bits, each by the probability that those like it had;
// bits make up bytes, and lengths and distances of what is copied from before.

const kLiteralContext = 4; // bits of the byte before
const kStates = 12; // of what the last few symbols were
const kLengthStates = 4;
const kAligned = 4; // lowest bits of far distances, which have probabilities of their own
const kSlots = 6; // bits of the size of a distance
const kNearEnd = 14; // first size of distances whose middle bits are all alike
const kMinLength = 2;
const kCopied = 7; // states from this on: the last symbol was a copy
const kHalf = 1024; // of 2048: a bit that is as often 0 as 1

const damaged = () => new PentError("its file is damaged; build the page again");
const tree = (bits: number) => new Uint16Array(1 << bits).fill(kHalf);

class BitReader {
    private at = 5;
    private range = 0xffffffff;
    private code: number;

    constructor(private bytes: Uint8Array) {
        this.code = new DataView(bytes.buffer, bytes.byteOffset).getUint32(1);
    }

    private normalize(): void {
        if (this.range < 0x1000000) {
            if (this.at >= this.bytes.length) {
                throw damaged();
            }
            this.range = (this.range << 8) >>> 0;
            this.code = ((this.code << 8) | this.bytes[this.at++]!) >>> 0;
        }
    }

    bit(odds: Uint16Array, place: number): number {
        this.normalize();
        const odd = odds[place]!;
        const bound = (this.range >>> 11) * odd;
        if (this.code < bound) {
            this.range = bound;
            odds[place] = odd + ((2048 - odd) >>> 5);
            return 0;
        }
        this.range -= bound;
        this.code -= bound;
        odds[place] = odd - (odd >>> 5);
        return 1;
    }

    /** Bits from the highest to the lowest, each by those above it. */
    number(odds: Uint16Array, bits: number): number {
        let place = 1;
        for (let i = 0; i < bits; ++i) {
            place = (place << 1) | this.bit(odds, place);
        }
        return place - (1 << bits);
    }

    /** Bits from the lowest to the highest. */
    reversed(odds: Uint16Array, bits: number, first = 0): number {
        let place = 1;
        let result = 0;
        for (let i = 0; i < bits; ++i) {
            const bit = this.bit(odds, first + place);
            place = (place << 1) | bit;
            result |= bit << i;
        }
        return result;
    }

    /** Bits that are as often 0 as 1. */
    even(bits: number): number {
        let result = 0;
        for (let i = 0; i < bits; ++i) {
            this.normalize();
            this.range >>>= 1;
            const bit = this.code >= this.range ? 1 : 0;
            this.code -= bit * this.range;
            result = (result << 1) | bit;
        }
        return result;
    }
}

class LengthReader {
    private choice = tree(1);
    private low = tree(3);
    private middle = tree(3);
    private high = tree(8);

    read(bits: BitReader): number {
        return (
            kMinLength +
            (bits.bit(this.choice, 0) === 0
                ? bits.number(this.low, 3)
                : bits.bit(this.choice, 1) === 0
                  ? 8 + bits.number(this.middle, 3)
                  : 16 + bits.number(this.high, 8))
        );
    }
}

class DistanceReader {
    private slots = Array.from({ length: kLengthStates }, () => tree(kSlots));
    private near = new Uint16Array(128).fill(kHalf);
    private aligned = tree(kAligned);

    /** Less one, as all distances here. */
    read(bits: BitReader, length: number): number {
        const state = Math.min(length - kMinLength, kLengthStates - 1);
        const slot = bits.number(this.slots[state]!, kSlots);
        if (slot < 4) {
            return slot;
        }
        const below = (slot >> 1) - 1; // bits that the slot does not tell
        const start = (2 | (slot & 1)) << below;
        return slot < kNearEnd
            ? start + bits.reversed(this.near, below, start - slot)
            : start +
                  (bits.even(below - kAligned) << kAligned) +
                  bits.reversed(this.aligned, kAligned);
    }
}

// A byte; behind a copy the one that would have gone on with it is a hint.
function literal(bits: BitReader, odds: Uint16Array, first: number, hint: number | null): number {
    let place = 1;
    if (hint !== null) {
        let rest = hint;
        do {
            const expected = (rest >> 7) & 1;
            rest <<= 1;
            const bit = bits.bit(odds, first + ((1 + expected) << 8) + place);
            place = (place << 1) | bit;
            if (bit !== expected) {
                break;
            }
        } while (place < 256);
    }
    while (place < 256) {
        place = (place << 1) | bits.bit(odds, first + place);
    }
    return place & 255;
}

// Which of the last four distances a copy takes, put in front of the others; or a new one.
class Distances {
    readonly last = [0, 0, 0, 0]; // less one
    private isSecond = new Uint16Array(kStates).fill(kHalf);
    private isThird = new Uint16Array(kStates).fill(kHalf);
    private isFourth = new Uint16Array(kStates).fill(kHalf);

    /** Whether it is not the latest. */
    isOther(bits: BitReader, state: number): boolean {
        return bits.bit(this.isSecond, state) === 1;
    }

    repeat(bits: BitReader, state: number): void {
        const k = bits.bit(this.isThird, state) === 0 ? 1 : 2 + bits.bit(this.isFourth, state);
        this.last.unshift(...this.last.splice(k, 1));
    }

    add(distance: number): void {
        this.last.unshift(distance);
        this.last.pop();
    }
}

class Unpacker {
    private literals = new Uint16Array(0x300 << kLiteralContext).fill(kHalf);
    private isCopy = new Uint16Array(kStates).fill(kHalf);
    private isRepeat = new Uint16Array(kStates).fill(kHalf);
    private isLong = new Uint16Array(kStates).fill(kHalf);
    private newLengths = new LengthReader();
    private lengths = new LengthReader();
    private newDistances = new DistanceReader();
    private distances = new Distances();
    private state = 0;
    private at = 0;

    constructor(
        private bits: BitReader,
        private result: Uint8Array,
    ) {}

    run(): void {
        while (this.at < this.result.length) {
            if (this.bits.bit(this.isCopy, this.state) === 0) {
                this.putByte();
            } else {
                this.copy(this.findLength());
            }
        }
    }

    private putByte(): void {
        const { state, at, result } = this;
        const before = at > 0 ? result[at - 1]! : 0;
        const hint = state < kCopied ? null : result[at - this.distances.last[0]! - 1]!;
        const first = 0x300 * (before >> (8 - kLiteralContext));
        result[this.at++] = literal(this.bits, this.literals, first, hint);
        this.state = state < 4 ? 0 : state < 10 ? state - 3 : state - 6;
    }

    // Of a copy; the distance is then the latest.
    private findLength(): number {
        const { bits, state, distances } = this;
        const next = (plain: number, behindCopy: number) => {
            this.state = state < kCopied ? plain : behindCopy;
        };
        if (bits.bit(this.isRepeat, state) === 0) {
            next(7, 10);
            const length = this.newLengths.read(bits);
            distances.add(this.newDistances.read(bits, length));
            return length;
        }
        if (distances.isOther(bits, state)) {
            distances.repeat(bits, state);
        } else if (bits.bit(this.isLong, state) === 0) {
            next(9, 11);
            return 1;
        }
        next(8, 11);
        return this.lengths.read(bits);
    }

    private copy(length: number): void {
        const { result } = this;
        const from = this.at - this.distances.last[0]! - 1;
        if (!(from >= 0 && from < this.at && this.at + length <= result.length)) {
            throw damaged();
        }
        // One by one: a copy may go on into itself.
        for (let i = 0; i < length; ++i) {
            result[this.at + i] = result[from + i]!;
        }
        this.at += length;
    }
}

/** @param size  Of the result, bytes.
 *
 * Throws a PentError where the bytes end before, or copy what is not there. */
export function unpack(bytes: Uint8Array, size: number): Uint8Array {
    if (bytes.length < 5) {
        throw damaged();
    }
    const result = new Uint8Array(size);
    new Unpacker(new BitReader(bytes), result).run();
    return result;
}
