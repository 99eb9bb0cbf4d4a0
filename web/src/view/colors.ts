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

/** What a picture can be colored by. */
export const kColorBy = ["body", "w", "speed", "strain", "force"] as const;
export type ColorBy = (typeof kColorBy)[number];

export const kColorTitles: Record<ColorBy, string> = {
    body: "",
    w: "w, m",
    speed: "speed, m/s",
    strain: "strain",
    force: "contact force, N",
};

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
export function mapColor(by: ColorBy, value: number): Color {
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

/** What the bar of colors ends at: 0 and the 99th percentile, so that one bad element does not take
 * the colors from all others; for w both ends as they are. */
export function suitableRange(values: Float32Array, by: ColorBy): [number, number] {
    const sorted = values.slice().sort();
    if (sorted.length === 0) {
        return [0, 0];
    }
    const last = sorted.length - 1;
    return by === "w" ? [sorted[0]!, sorted[last]!] : [0, sorted[Math.floor((last * 99) / 100)]!];
}
