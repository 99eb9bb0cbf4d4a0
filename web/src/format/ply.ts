/** The scalar types of PLY, their other names, and their width in bytes. */
export const kPlyTypes = [
    { name: "char", alias: "int8", size: 1 },
    { name: "uchar", alias: "uint8", size: 1 },
    { name: "short", alias: "int16", size: 2 },
    { name: "ushort", alias: "uint16", size: 2 },
    { name: "int", alias: "int32", size: 4 },
    { name: "uint", alias: "uint32", size: 4 },
    { name: "float", alias: "float32", size: 4 },
    { name: "double", alias: "float64", size: 8 },
] as const;

export type PlyType = (typeof kPlyTypes)[number]["name"];

export function sizeOf(type: PlyType): number {
    return kPlyTypes.find((known) => known.name === type)!.size;
}

export interface PlyProperty {
    name: string;
    type: PlyType;
    countType: PlyType | null; // of a list: the type of its length
}

export interface PlyElement {
    name: string;
    count: bigint; // as announced, up to 2^64 - 1
    properties: PlyProperty[];
}

// What from_chars of the C++ reader takes: no plus sign, no blanks, and no hexadecimals.
const kWhole = /^-?\d+$/;
const kReal = /^-?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?$/;
const kNoNumber = /^-?(?:inf|infinity|nan|nan\([A-Za-z0-9_]*\))$/i;

/** A whole number of 0 to 2^64 - 1, or null. */
export function parseCount(word: string): bigint | null {
    if (!/^\d+$/.test(word)) {
        return null;
    }
    const value = BigInt(word);
    return value < 1n << 64n ? value : null;
}

/** A real number, infinities and NaN among them; null where it is none or out of range. */
export function parseReal(word: string, type: "float" | "double" = "double"): number | null {
    if (kNoNumber.test(word)) {
        const isNan = /nan/i.test(word);
        return isNan ? NaN : word.startsWith("-") ? -Infinity : Infinity;
    }
    if (!kReal.test(word)) {
        return null;
    }
    const exact = Number(word);
    const value = type === "float" ? Math.fround(exact) : exact;
    const isZero = !/[1-9]/.test(word.split(/[eE]/)[0]!);
    return Number.isFinite(value) && (value !== 0 || isZero) ? value : null;
}

const kRanges: Partial<Record<PlyType, [number, number]>> = {
    char: [-128, 127],
    uchar: [0, 255],
    short: [-32768, 32767],
    ushort: [0, 65535],
    int: [-2147483648, 2147483647],
    uint: [0, 4294967295],
};

/** A number of the given type, or null. */
export function parseNumber(word: string, type: PlyType): number | null {
    const range = kRanges[type];
    if (!range) {
        return parseReal(word, type as "float" | "double");
    }
    // Types of one byte are read as int, so that "-0" is a number for uchar but not for uint.
    const isSigned = range[0] < 0 || type === "uchar";
    if (!kWhole.test(word) || (word.startsWith("-") && !isSigned)) {
        return null;
    }
    const value = Number(word);
    return value >= range[0] && value <= range[1] ? value : null;
}

/** One number of a binary body. */
export function readBinary(view: DataView, at: number, type: PlyType): number {
    switch (type) {
        case "char":
            return view.getInt8(at);
        case "uchar":
            return view.getUint8(at);
        case "short":
            return view.getInt16(at, true);
        case "ushort":
            return view.getUint16(at, true);
        case "int":
            return view.getInt32(at, true);
        case "uint":
            return view.getUint32(at, true);
        case "float":
            return view.getFloat32(at, true);
        case "double":
            return view.getFloat64(at, true);
    }
}
