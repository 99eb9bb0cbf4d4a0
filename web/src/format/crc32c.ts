const kPolynomial = 0x82f63b78; // Castagnoli, reflected

// Eight tables, so that eight bytes are taken at a time.
const kTables = (() => {
    const tables = Array.from({ length: 8 }, () => new Uint32Array(256));
    for (let byte = 0; byte < 256; ++byte) {
        let value = byte;
        for (let bit = 0; bit < 8; ++bit) {
            value = value & 1 ? (value >>> 1) ^ kPolynomial : value >>> 1;
        }
        tables[0]![byte] = value;
    }
    for (let k = 1; k < 8; ++k) {
        for (let byte = 0; byte < 256; ++byte) {
            const value = tables[k - 1]![byte]!;
            tables[k]![byte] = tables[0]![value & 255]! ^ (value >>> 8);
        }
    }
    return tables;
})();

/** CRC-32C of bytes: Castagnoli polynomial, initial value and final xor 0xFFFFFFFF.
 * Of "123456789" it is 0xe3069283. */
export function crc32c(bytes: Uint8Array): number {
    const [t0, t1, t2, t3, t4, t5, t6, t7] = kTables as unknown as Uint32Array[] as [
        Uint32Array,
        Uint32Array,
        Uint32Array,
        Uint32Array,
        Uint32Array,
        Uint32Array,
        Uint32Array,
        Uint32Array,
    ];
    let crc = 0xffffffff;
    let i = 0;
    for (; i + 8 <= bytes.length; i += 8) {
        const low =
            crc ^
            (bytes[i]! | (bytes[i + 1]! << 8) | (bytes[i + 2]! << 16) | (bytes[i + 3]! << 24));
        crc =
            t7[low & 255]! ^
            t6[(low >>> 8) & 255]! ^
            t5[(low >>> 16) & 255]! ^
            t4[low >>> 24]! ^
            t3[bytes[i + 4]!]! ^
            t2[bytes[i + 5]!]! ^
            t1[bytes[i + 6]!]! ^
            t0[bytes[i + 7]!]!;
    }
    for (; i < bytes.length; ++i) {
        crc = t0[(crc ^ bytes[i]!) & 255]! ^ (crc >>> 8);
    }
    return (crc ^ 0xffffffff) >>> 0;
}

/** A checksum as files have it: eight hexadecimal digits. */
export function hex8(value: number): string {
    return value.toString(16).padStart(8, "0");
}
