import { crc32c, hex8 } from "./crc32c.ts";
import { PentError } from "./error.ts";
import { kPlyTypes, parseCount, parseReal } from "./ply.ts";
import type { PlyElement, PlyProperty, PlyType } from "./ply.ts";

export type Dimension = 2 | 3 | 4;

/** The header of a .pent file, as parsed; not yet compared with the body. */
export interface Header {
    isAscii: boolean;
    dimension: Dimension;
    createdBy: string;
    crc32c: number | null; // null where an ascii file states none
    mesh: { name: string; crc: number } | null; // of a frame
    frame: number;
    step: number;
    time: number; // s
    elements: PlyElement[]; // vertex first, then the cells (not in a frame), then others
    body: number; // offset of the byte after end_header's newline
}

const kCellNames = { 2: "triangle", 3: "tetrahedron", 4: "pentachoron" } as const;
const kCellPlurals = { 2: "triangles", 3: "tetrahedra", 4: "pentachora" } as const;

export function cellName(dimension: Dimension): string {
    return kCellNames[dimension];
}

export function cellNamePlural(dimension: Dimension): string {
    return kCellPlurals[dimension];
}

const kComments = [
    "pent",
    "dimension",
    "created_by",
    "crc32c",
    "header_crc32c",
    "mesh",
    "frame",
    "step",
    "time",
];
const kLongestLine = 4096;
const kMaxVertices = 0xffffffffn; // indices are 32 bits wide

// One byte a character.
function toText(bytes: Uint8Array): string {
    let text = "";
    for (let i = 0; i < bytes.length; i += kLongestLine) {
        text += String.fromCharCode(...bytes.subarray(i, i + kLongestLine));
    }
    return text;
}

export function printable(text: string): string {
    return text.replace(/[^ -~]/g, "?");
}

// A character of UTF-8 [RFC 3629] that is no control character, a byte each.
const kCharacter = [
    "[\\t -~]",
    "\\xc2[\\xa0-\\xbf]|[\\xc3-\\xdf][\\x80-\\xbf]",
    "\\xe0[\\xa0-\\xbf][\\x80-\\xbf]|[\\xe1-\\xec\\xee\\xef][\\x80-\\xbf]{2}|\\xed[\\x80-\\x9f][\\x80-\\xbf]",
    "\\xf0[\\x90-\\xbf][\\x80-\\xbf]{2}|[\\xf1-\\xf3][\\x80-\\xbf]{3}|\\xf4[\\x80-\\x8f][\\x80-\\xbf]{2}",
].join("|");

// A name as messages show it: what is no text stands there as numbers of bytes.
function nameOf(bytes: string): string {
    return bytes.replace(new RegExp(`(${kCharacter})|[^]`, "g"), (all: string, whole?: string) =>
        whole === undefined
            ? `\\x${all.charCodeAt(0).toString(16).padStart(2, "0")}`
            : new TextDecoder().decode(Uint8Array.from(whole, (c) => c.charCodeAt(0))),
    );
}

function quoted(text: string): string {
    const kLongest = 60;
    return `'${printable(text.slice(0, kLongest))}${text.length > kLongest ? "..." : ""}'`;
}

function declaration(property: PlyProperty): string {
    return `property ${property.countType ? "list " : ""}${property.type} ${property.name}`;
}

// Reads a header line by line; every failure names the line.
class Parser {
    private at = 0;
    private begin = 0; // of the line that was read last
    private checksum: { value: number; begin: number; end: number } | null = null; // of the header
    private line = 0;
    private seen = new Set<string>();
    private header: Header = {
        isAscii: false,
        dimension: 4,
        createdBy: "",
        crc32c: null,
        mesh: null,
        frame: 0,
        step: 0,
        time: 0,
        elements: [],
        body: 0,
    };

    constructor(
        private bytes: Uint8Array,
        private path: string,
    ) {}

    parse(): Header {
        this.parsePreamble();
        for (;;) {
            const line = this.nextLine();
            if (line === "end_header") {
                break;
            }
            const words = line.split(" ").filter((word) => word !== "");
            if (words[0] === "comment") {
                if (words.length >= 2) {
                    this.parseComment(words, line);
                }
            } else if (words[0] === "element" && words.length === 3) {
                this.parseElement(words, line);
            } else if (words[0] === "property" && words.length >= 3) {
                this.parseProperty(words, line);
            } else {
                this.fail(line, "a comment, element, property or end_header line");
            }
        }
        this.header.body = this.at;
        this.checkChecksum();
        this.checkElements();
        return this.header;
    }

    private fail(found: string, expected: string): never {
        throw new PentError(
            `${this.path}: header line ${this.line}: found ${quoted(found)}, expected ${expected}`,
        );
    }

    private failHeader(what: string): never {
        throw new PentError(`${this.path}: header: ${what}`);
    }

    private nextLine(): string {
        ++this.line;
        if (this.at >= this.bytes.length) {
            throw new PentError(
                `${this.path}: header line ${this.line}: ` +
                    "the file ends here, expected more header up to end_header",
            );
        }
        const end = this.bytes.indexOf(10, this.at);
        if (end < 0 || end - this.at > kLongestLine) {
            this.fail(
                toText(this.bytes.subarray(this.at, this.at + kLongestLine)),
                this.line === 1
                    ? "'ply' (is this a .pent file?)"
                    : "a line that ends with a newline",
            );
        }
        const line = toText(this.bytes.subarray(this.at, end));
        this.begin = this.at;
        this.at = end + 1;
        if (line.endsWith("\r")) {
            this.fail(line, "lines that end with LF alone (CR LF comes from a text-mode transfer)");
        }
        return line;
    }

    private parsePreamble(): void {
        if (this.bytes.length === 0) {
            throw new PentError(`${this.path}: the file is empty, expected a .pent file`);
        }
        let line = this.nextLine();
        if (line !== "ply") {
            this.fail(line, "'ply' (is this a .pent file?)");
        }
        line = this.nextLine();
        this.header.isAscii = line === "format ascii 1.0";
        if (!this.header.isAscii && line !== "format binary_little_endian 1.0") {
            this.fail(line, "'format binary_little_endian 1.0' or 'format ascii 1.0'");
        }
        line = this.nextLine();
        if (line !== "comment pent 1.0") {
            this.fail(line, "'comment pent 1.0'");
        }
        line = this.nextLine();
        const dimension = /^comment dimension ([234])$/.exec(line);
        if (!dimension) {
            this.fail(line, "'comment dimension D' with D = 2, 3 or 4");
        }
        this.header.dimension = Number(dimension[1]) as Dimension;
    }

    private parseComment(words: string[], line: string): void {
        const key = words[1]!;
        if (!kComments.includes(key)) {
            return;
        }
        if (this.header.elements.length > 0) {
            this.fail(line, `the comment '${key}' in front of the first element`);
        }
        if (key === "pent" || key === "dimension" || this.seen.has(key)) {
            this.fail(line, `the comment '${key}' only once`);
        }
        this.seen.add(key);
        if (key === "created_by") {
            this.header.createdBy = line.slice("comment created_by ".length);
        } else if (key === "crc32c") {
            this.header.crc32c = this.parseCrc(words, 2, line);
        } else if (key === "header_crc32c") {
            const value = this.parseCrc(words, 2, line);
            this.checksum = { value, begin: this.begin, end: this.at };
        } else if (key === "mesh") {
            const crc = this.parseCrc(words, 3, line);
            this.header.mesh = { name: nameOf(words[2]!), crc };
        } else if (key === "time") {
            const time = words.length === 3 ? parseReal(words[2]!) : null;
            if (time === null) {
                this.fail(line, "'comment time NUMBER'");
            }
            if (!Number.isFinite(time)) {
                this.fail(line, "a finite time in seconds");
            }
            this.header.time = time;
        } else {
            const count = words.length === 3 ? parseCount(words[2]!) : null;
            if (count === null) {
                this.fail(line, `'comment ${key} NUMBER'`);
            }
            this.header[key as "frame" | "step"] = Number(count);
        }
    }

    private parseCrc(words: string[], word: number, line: string): number {
        if (words.length !== word + 1 || !/^[0-9a-fA-F]{8}$/.test(words[word]!)) {
            this.fail(
                line,
                `'comment ${word === 2 ? words[1] : "mesh NAME"} XXXXXXXX' ` +
                    "with 8 hexadecimal digits",
            );
        }
        return Number.parseInt(words[word]!, 16);
    }

    private parseElement(words: string[], line: string): void {
        const count = parseCount(words[2]!);
        if (count === null) {
            this.fail(line, "'element NAME COUNT' with a count of 0 to 2^64 - 1");
        }
        const name = nameOf(words[1]!);
        if (this.header.elements.some((element) => element.name === name)) {
            this.fail(line, "each element only once");
        }
        this.header.elements.push({ name, count, properties: [] });
    }

    private parseType(word: string, line: string): PlyType {
        const type = kPlyTypes.find((known) => known.name === word || known.alias === word);
        return (
            type?.name ??
            this.fail(line, "a PLY type: char uchar short ushort int uint float double")
        );
    }

    private parseProperty(words: string[], line: string): void {
        const element = this.header.elements.at(-1);
        if (!element) {
            this.fail(line, "an element line in front of the first property");
        }
        const property: PlyProperty = { name: "", type: "double", countType: null };
        if (words[1] === "list" && words.length === 5) {
            property.countType = this.parseType(words[2]!, line);
            if (property.countType === "float" || property.countType === "double") {
                this.fail(line, "a whole-number type for the length of a list");
            }
            property.type = this.parseType(words[3]!, line);
            property.name = nameOf(words[4]!);
        } else if (words[1] !== "list" && words.length === 3) {
            property.type = this.parseType(words[1]!, line);
            property.name = nameOf(words[2]!);
        } else {
            this.fail(line, "'property TYPE NAME' or 'property list TYPE TYPE NAME'");
        }
        if (element.properties.some((other) => other.name === property.name)) {
            this.fail(line, "each property only once in an element");
        }
        element.properties.push(property);
    }

    // Of every byte but the line that has it; files of version 0.1.0 have none.
    private checkChecksum(): void {
        if (!this.checksum) {
            return;
        }
        const { value, begin, end } = this.checksum;
        const rest = new Uint8Array(this.header.body - (end - begin));
        rest.set(this.bytes.subarray(0, begin));
        rest.set(this.bytes.subarray(end, this.header.body), begin);
        const found = crc32c(rest);
        if (found !== value) {
            this.failHeader(
                `its checksum is ${hex8(found)}, the header says ${hex8(value)}: ` +
                    "it was changed since it was written",
            );
        }
    }

    // The known elements must begin with their required properties, in order.
    private checkPrefix(element: PlyElement, names: string[], type: PlyType): void {
        names.forEach((name, i) => {
            const found = element.properties[i];
            if (!found || found.name !== name || found.type !== type || found.countType) {
                this.failHeader(
                    `property ${i} of element ${element.name}` +
                        (found ? ` is '${declaration(found)}'` : " is missing") +
                        `, expected '${declaration({ name, type, countType: null })}'`,
                );
            }
        });
        const list = element.properties.find((property) => property.countType);
        if (list) {
            this.failHeader(
                `element ${element.name} has the list property ${list.name}` +
                    ", expected properties of fixed width",
            );
        }
    }

    private checkElements(): void {
        const { dimension, elements, isAscii, crc32c, mesh } = this.header;
        const [vertex, cells] = elements;
        if (vertex?.name !== "vertex") {
            const found = vertex ? `element ${vertex.name} first` : "no element";
            this.failHeader(`found ${found}, expected element vertex first`);
        }
        if (vertex.count > kMaxVertices) {
            this.failHeader(
                `element vertex has ${vertex.count} vertices, ` +
                    `expected at most ${kMaxVertices}`,
            );
        }
        this.checkPrefix(vertex, [..."xyzw"].slice(0, dimension), "double");
        if (!isAscii && crc32c === null) {
            this.failHeader("no 'comment crc32c', expected one in a binary file");
        }
        if (mesh) {
            return;
        }
        if (cells?.name !== cellName(dimension)) {
            this.failHeader(
                `found ${cells ? `element ${cells.name}` : "no element"} after element ` +
                    `vertex, expected element ${cellName(dimension)} (dimension ${dimension})`,
            );
        }
        this.checkPrefix(
            cells,
            [..."01234"].slice(0, dimension + 1).map((k) => `v${k}`),
            "uint",
        );
    }
}

/** Parses and checks the header at the start of `bytes`; a PentError names the line, what was found
 * and what was expected. */
export function parseHeader(bytes: Uint8Array, path: string): Header {
    return new Parser(bytes, path).parse();
}
