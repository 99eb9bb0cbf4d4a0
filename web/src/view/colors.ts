import type { Values } from "../mesh/quantities.ts";
import { kColorings } from "../run/quantities.ts";

/** Colors, the same as in the pictures of pent-render. Linear light, 0..1. */
export type Color = [number, number, number];

type Stop = [lightness: number, chroma: number, hue: number]; // Oklch, degrees

const kHeat: Stop[] = [
    [0.6, 0.11, 255],
    [0.78, 0.09, 195],
    [0.89, 0.14, 105],
    [0.74, 0.16, 60],
    [0.55, 0.2, 25],
];
const kDiverging: Stop[] = [
    [0.52, 0.1, 215],
    [0.73, 0.09, 205],
    [0.93, 0.02, 90],
    [0.76, 0.13, 60],
    [0.58, 0.17, 40],
];
const kBodies: Stop[] = [
    [0.72, 0.14, 48],
    [0.68, 0.11, 240],
    [0.74, 0.12, 150],
    [0.72, 0.13, 350],
    [0.82, 0.13, 92],
    [0.75, 0.1, 195],
    [0.68, 0.12, 300],
    [0.62, 0.16, 25],
];

/** The gray of obstacles, in which no body is shown; on a dark page a dark one. */
export function obstacleColor(theme: "light" | "dark"): Color {
    return fromOklab(...toOklab([theme === "dark" ? 0.5 : 0.8, 0.012, 75]));
}

/** The quantity with its unit, over the bar of colors; of a field its name.
 *
 * @param by  One of kColorings, or a field. */
export function colorTitle(by: string, dimension: number): string {
    const titles = new Map([
        ["body", ""],
        ["w", "w, m"],
        ["speed", "speed, m/s"],
        ["force", "contact force, N"],
        ["reaction", "reaction, N"],
        ["energy_density", `energy_density, J/m^${dimension}`],
    ]);
    return titles.get(by) ?? by;
}

/** Oklab to linear sRGB [ottosson2020]. */
function fromOklab(L: number, a: number, b: number): Color {
    const l = (L + 0.3963377774 * a + 0.2158037573 * b) ** 3;
    const m = (L - 0.1055613458 * a - 0.0638541728 * b) ** 3;
    const s = (L - 0.0894841775 * a - 1.291485548 * b) ** 3;
    const clamp = (value: number) => Math.min(Math.max(value, 0), 1);
    return [
        clamp(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
        clamp(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
        clamp(-0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s),
    ];
}

function toOklab([lightness, chroma, hue]: Stop): Color {
    const angle = (hue * Math.PI) / 180;
    return [lightness, chroma * Math.cos(angle), chroma * Math.sin(angle)];
}

/** The color of a value 0..1, beyond that clamped: heat from little to much, diverging for w. */
export function mapColor(by: string, value: number): Color {
    const stops = by === "w" ? kDiverging : kHeat;
    const place = Math.min(Math.max(value, 0), 1) * (stops.length - 1);
    const i = Math.min(Math.floor(place), stops.length - 2);
    const a = toOklab(stops[i]!);
    const b = toOklab(stops[i + 1]!);
    const mix = (k: 0 | 1 | 2) => a[k] + (b[k] - a[k]) * (place - i);
    return fromOklab(mix(0), mix(1), mix(2));
}

/** A color to tell the i-th body by; eight different ones, then over again. */
export function bodyColor(i: number): Color {
    return fromOklab(...toOklab(kBodies[i % kBodies.length]!));
}

/** "rgb(255 128 0)". */
export function toCss(color: Color): string {
    const encoded = color.map((linear) => {
        const value = linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055;
        return Math.round(255 * value);
    });
    return `rgb(${encoded.join(" ")})`;
}

/** What the bar of colors ends at: 0, of fields the first percentile, and the 99th, so that one bad element does not take
 * the colors from all others; for w both ends as they are. */
export function suitableRange(values: Values, by: string): [number, number] {
    const sorted = values.slice().sort();
    if (sorted.length === 0) {
        return [0, 0];
    }
    const last = sorted.length - 1;
    if (by === "w") {
        return [sorted[0]!, sorted[last]!];
    }
    const behind = (hundredths: number) => sorted[Math.floor((last * hundredths) / 100)]!;
    return [kColorings.includes(by) ? 0 : behind(1), behind(99)];
}

/** A range that is no wider than the rounding of floats is a single value. */
export function settled([low, high]: [number, number]): [number, number] {
    const kFloat = 2 ** -22;
    return high - low > kFloat * Math.max(Math.abs(low), Math.abs(high)) ? [low, high] : [low, low];
}

/** What values and the ends of their range are multiplied by for a graphics card, whose floats end at 1e38 and have few
 * digits left below 1e-38: a power of two, 1 where they need none. */
export function unitOf([low, high]: [number, number]): number {
    const kUsual = 1e20;
    const largest = Math.max(Math.abs(low), Math.abs(high));
    if (largest === 0 || (largest > 1 / kUsual && largest < kUsual)) {
        return 1;
    }
    const kMost = 1000; // that 2 to it and 1 over it are numbers
    return 2 ** -Math.max(-kMost, Math.min(kMost, Math.floor(Math.log2(largest))));
}

/** Values for the graphics card. What is far out of the range has the color of its end, and stays finite, as its
 * neighbors in a triangle are mixed with it. */
export function inUnits(values: Values, unit: number): Float32Array {
    if (unit === 1 && values instanceof Float32Array) {
        return values;
    }
    const kFar = 1e30;
    return Float32Array.from(values, (value) => Math.max(-kFar, Math.min(kFar, value * unit)));
}

/** The colors from the low end of a range to the high one. Where both are one value there is one color: the middle of
 * those of w, which go to two sides, and the first of others. */
export function rangeColors(by: string, [low, high]: [number, number], count: number): Color[] {
    const alone = by === "w" ? 0.5 : 0;
    return Array.from({ length: count }, (_, i) =>
        mapColor(by, high > low ? i / (count - 1) : alone),
    );
}
