import { crc32c, hex8 } from "./crc32c.ts";
import { PentError } from "./error.ts";
import { printable } from "./header.ts";
import type { Header } from "./header.ts";
import { parseNumber, readBinary, sizeOf } from "./ply.ts";
import type { PlyElement, PlyType } from "./ply.ts";

/** One property to keep: row i goes to values[first + i * stride]. */
export interface Column {
    name: string;
    values: Float64Array | Uint32Array;
    first: number;
    stride: number;
}

const kNewline = 10;
const kSpace = 32;

// Bytes a row takes at least: a list may be empty; ascii has one digit and one space a number.
function leastRowBytes(element: PlyElement, isAscii: boolean): number {
    return element.properties.reduce(
        (bytes, property) => bytes + (isAscii ? 2 : sizeOf(property.countType ?? property.type)),
        0,
    );
}

/** Reads what stands behind a header, element by element, as the C++ reader does: counts against
 * the size of the file first, then the checksum, then values. */
export class BodyReader {
    private body: Uint8Array;
    private view: DataView;
    private at = 0;
    private nextElement = 0;

    constructor(
        private header: Header,
        file: Uint8Array,
        private path: string,
    ) {
        this.body = file.subarray(header.body);
        this.view = new DataView(this.body.buffer, this.body.byteOffset, this.body.byteLength);
        this.checkCounts();
        if (!header.isAscii) {
            this.checkChecksum();
        }
    }

    /** Reads the next element and keeps the columns that are asked for. */
    read(columns: Column[]): void {
        const element = this.header.elements[this.nextElement++]!;
        if (this.header.isAscii) {
            this.readAscii(element, columns);
        } else {
            this.readBinary(element, columns);
        }
    }

    /** Skips the elements that are left, and checks that nothing follows them. */
    finish(): void {
        for (; this.nextElement < this.header.elements.length; ++this.nextElement) {
            const element = this.header.elements[this.nextElement]!;
            if (this.header.isAscii) {
                this.skipAscii(element);
            } else {
                this.skipBinary(element);
            }
        }
        if (this.at !== this.body.length) {
            this.failAtEnd(this.body.length - this.at);
        }
        if (this.header.isAscii) {
            this.checkChecksum();
        }
    }

    private fail(where: string, what: string): never {
        throw new PentError(`${this.path}: ${where}: ${what}`);
    }

    private failAtEnd(bytes: number | bigint): never {
        this.fail("end of file", `${bytes} bytes follow the last element, expected none`);
    }

    private checkCounts(): void {
        const { isAscii, elements } = this.header;
        let left = BigInt(this.body.length);
        for (const element of elements) {
            const rowBytes = leastRowBytes(element, isAscii);
            if (rowBytes > 0 && element.count > left / BigInt(rowBytes)) {
                this.fail(
                    `element ${element.name}`,
                    `the header announces ${element.count} of ${isAscii ? "at least " : ""}` +
                        `${rowBytes} bytes each, but ${left} bytes are left: ` +
                        "the file is truncated or its header damaged",
                );
            }
            if (rowBytes === 0 && element.count > 0n) {
                this.fail(`element ${element.name}`, "has no properties, expected at least one");
            }
            left -= element.count * BigInt(rowBytes);
        }
        const hasLists = elements.some((element) => element.properties.some((p) => p.countType));
        if (!isAscii && !hasLists && left > 0n) {
            this.failAtEnd(left);
        }
    }

    private checkChecksum(): void {
        const expected = this.header.crc32c;
        if (expected === null) {
            return;
        }
        const found = crc32c(this.body);
        if (found !== expected) {
            this.fail(
                "checksum",
                `the data has crc32c ${hex8(found)}, expected ${hex8(expected)} ` +
                    "from the header: the file was changed after it was written",
            );
        }
    }

    private readBinary(element: PlyElement, columns: Column[]): void {
        const rows = Number(element.count);
        const rowBytes = leastRowBytes(element, false);
        let inRow = 0;
        for (const property of element.properties) {
            const column = columns.find((known) => known.name === property.name);
            if (column) {
                this.readColumn(column, property.type, this.at + inRow, rowBytes, rows);
            }
            inRow += sizeOf(property.type);
        }
        this.at += rowBytes * rows;
    }

    private readColumn(column: Column, type: PlyType, start: number, step: number, rows: number) {
        const { values, first, stride } = column;
        const view = this.view;
        if (type === "double") {
            for (let row = 0, from = start, to = first; row < rows; ++row) {
                values[to] = view.getFloat64(from, true);
                from += step;
                to += stride;
            }
        } else {
            for (let row = 0; row < rows; ++row) {
                values[first + row * stride] = readBinary(view, start + row * step, type);
            }
        }
    }

    private readAscii(element: PlyElement, columns: Column[]): void {
        const { properties } = element;
        const bound = properties.map((property) =>
            columns.find((column) => column.name === property.name),
        );
        const end = this.body.length;
        for (let row = 0; row < Number(element.count); ++row) {
            const where = `${element.name} ${row}`;
            for (let i = 0; i < properties.length; ++i) {
                const { name, type } = properties[i]!;
                this.skipSpaces();
                if (this.at === end || this.body[this.at] === kNewline) {
                    this.fail(
                        where,
                        `${this.at === end ? "the file" : "the line"} ends before ` +
                            `${name}, expected ${properties.length} numbers a line`,
                    );
                }
                const word = this.nextWord();
                const value = parseNumber(word, type);
                if (value === null) {
                    this.fail(
                        where,
                        `${name} is '${printable(word.slice(0, 20))}', ` +
                            `expected a number of type ${type}`,
                    );
                }
                const column = bound[i];
                if (column) {
                    column.values[column.first + row * column.stride] = value;
                }
            }
            this.skipSpaces();
            if (this.at === end || this.body[this.at] !== kNewline) {
                this.fail(
                    where,
                    this.at === end
                        ? "the file ends here, expected a newline"
                        : `more than ${properties.length} numbers on the line`,
                );
            }
            ++this.at;
        }
    }

    private skipSpaces(): void {
        while (this.body[this.at] === kSpace) {
            ++this.at;
        }
    }

    private nextWord(): string {
        const start = this.at;
        while (
            this.at < this.body.length &&
            this.body[this.at] !== kSpace &&
            this.body[this.at] !== kNewline
        ) {
            ++this.at;
        }
        // A number has fewer characters; the rest of a longer word cannot make it one.
        const kLongest = 4096;
        return String.fromCharCode(
            ...this.body.subarray(start, Math.min(this.at, start + kLongest)),
        );
    }

    private skipBinary(element: PlyElement): void {
        for (let row = 0n; row < element.count; ++row) {
            for (const property of element.properties) {
                const left = () => this.body.length - this.at;
                let count = 1;
                if (property.countType) {
                    const bytes = sizeOf(property.countType);
                    if (left() < bytes) {
                        this.fail(`${element.name} ${row}`, "the file ends here: it is truncated");
                    }
                    count = readBinary(this.view, this.at, property.countType);
                    this.at += bytes;
                }
                if (count < 0 || count > Math.floor(left() / sizeOf(property.type))) {
                    this.fail(
                        `${element.name} ${row}`,
                        `the file ends within property ${property.name}: it is truncated`,
                    );
                }
                this.at += count * sizeOf(property.type);
            }
        }
    }

    private skipAscii(element: PlyElement): void {
        for (let row = 0n; row < element.count; ++row) {
            const end = this.body.indexOf(kNewline, this.at);
            if (end < 0) {
                this.fail(`${element.name} ${row}`, "the file ends here: it is truncated");
            }
            this.at = end + 1;
        }
    }
}
