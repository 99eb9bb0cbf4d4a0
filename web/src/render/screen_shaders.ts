// Shaders over the whole picture: light by what was drawn, and all of it together.

import { kHead } from "./shaders.ts";

const kDepth = `
uniform sampler2D depths;
uniform ivec4 tile;     // origin and size, pixels
uniform vec4 lens;      // slopes across and upright, near, far
float distanceAt(ivec2 pixel) {
    float z = 2.0 * texelFetch(depths, clamp(pixel, tile.xy, tile.xy + tile.zw - 1), 0).r - 1.0;
    return 2.0 * lens.z * lens.w / (lens.w + lens.z - z * (lens.w - lens.z));
}
`;

const kNoise = `
float noise(vec2 pixel) {  // interleaved gradient noise [jimenez2014]
    return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715))));
}
`;

const kShadow = `
uniform sampler2DShadow shadowMap;
uniform sampler2D shadowDepths;  // the same texture, read as numbers
uniform mat4 lightMatrix;        // from the space of the camera to 0..1 each way
uniform vec3 lightSize;          // of a texel, m; depth of the map, m; its width, m
vec2 onDisk(int i, int count, float turn) {  // a sunflower
    float angle = 2.3999632 * float(i) + 6.2831853 * turn;
    return sqrt((float(i) + 0.5) / float(count)) * vec2(cos(angle), sin(angle));
}
// How much of the key light arrives: a lamp of radius 0.14 seen from here, so that shadows are
// sharp where they begin and soft further away [fernando2005].
float keyVisibility(vec3 point, vec3 n, float turn) {
    const float kLamp = 0.14;
    const float kSearch = 0.06;
    vec3 p = (lightMatrix * vec4(point + 2.0 * lightSize.x * n, 1)).xyz;
    if (any(lessThan(p.xy, vec2(0))) || any(greaterThan(p.xy, vec2(1)))) {
        return 1.0;  // beyond the map, whose edge says nothing of it
    }
    p.z = min(p.z, 1.0);  // ground may lie deeper
    float bias = 1.5 * lightSize.x / lightSize.y;
    float sum = 0.0;
    float blockers = 0.0;
    for (int i = 0; i < 12; ++i) {
        float depth = texture(shadowDepths, p.xy + kSearch * onDisk(i, 12, turn)).r;
        if (depth < p.z - bias) {
            sum += depth;
            blockers += 1.0;
        }
    }
    if (blockers == 0.0) {
        return 1.0;
    }
    float gap = (p.z - sum / blockers) * lightSize.y;
    float radius = clamp(kLamp * gap / lightSize.z, 1.5 * lightSize.x / lightSize.z, kSearch);
    float open = 0.0;
    for (int i = 0; i < 16; ++i) {
        open += texture(shadowMap, vec3(p.xy + radius * onDisk(i, 16, turn), p.z - bias));
    }
    return open / 16.0;
}
`;

/** From depth alone: how much of the sky is open, red [mcguire2012], and of the lamp, green. Each
 * pixel has a few samples in a pattern of its own; kCompose takes the mean over neighbors. */
export const kOcclusion = `${kHead}${kDepth}${kNoise}${kShadow}
uniform float reach;    // of surroundings that count, m
uniform float perMeter; // pixels of a meter at distance 1
out vec4 result;
vec3 pointAt(ivec2 pixel) {
    ivec2 p = clamp(pixel, tile.xy, tile.xy + tile.zw - 1);
    vec2 place = 2.0 * (vec2(p - tile.xy) + 0.5) / vec2(tile.zw) - 1.0;
    return distanceAt(p) * vec3(place * lens.xy, -1);
}
vec3 smaller(vec3 a, vec3 b) { return abs(a.z) < abs(b.z) ? a : b; }
float skyVisibility(ivec2 pixel, vec3 p, vec3 n, float turn) {
    const int kSamples = 14;
    float radius = min(reach * perMeter / -p.z, 220.0);
    float sum = 0.0;
    for (int i = 0; i < kSamples; ++i) {
        float way = (float(i) + 0.5) / float(kSamples);
        float angle = 43.9822972 * way + 6.2831853 * turn;  // seven turns
        vec3 v = pointAt(pixel + ivec2(way * radius * vec2(cos(angle), sin(angle)))) - p;
        float square = dot(v, v);
        float near = max(reach * reach - square, 0.0);
        float lift = (dot(v, n) + 0.004 * p.z) / (square + 1e-4 * reach * reach);
        sum += near * near * near * max(lift, 0.0);
    }
    return max(0.0, 1.0 - sum * 6.0 / (pow(reach, 5.0) * float(kSamples)));
}
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 p = pointAt(pixel);
    if (-p.z > 0.999 * lens.w) {
        result = vec4(1);
        return;
    }
    vec3 across = smaller(pointAt(pixel + ivec2(1, 0)) - p, p - pointAt(pixel - ivec2(1, 0)));
    vec3 upward = smaller(pointAt(pixel + ivec2(0, 1)) - p, p - pointAt(pixel - ivec2(0, 1)));
    vec3 n = normalize(cross(across, upward));
    float turn = noise(gl_FragCoord.xy);
    result = vec4(skyVisibility(pixel, p, n, turn), keyVisibility(p, n, turn), 0, 1);
}`;

/** Background, solid things with their occlusion, ghosts in front; into the canvas, as sRGB. */
export const kCompose = `${kHead}${kDepth}${kNoise}
uniform sampler2D sky;
uniform sampler2D lamp;
uniform sampler2D ghosts;
uniform sampler2D occlusion;
uniform bool hasOcclusion;
uniform vec3 top;
uniform vec3 bottom;
out vec4 color;
// Mean over the neighbors that are about as far away.
vec2 visibilityAt(ivec2 pixel) {
    float own = distanceAt(pixel);
    vec3 sum = vec3(0);
    for (int y = -3; y <= 3; ++y) {
        for (int x = -3; x <= 3; ++x) {
            ivec2 other = clamp(pixel + ivec2(x, y), tile.xy, tile.xy + tile.zw - 1);
            float weight = abs(distanceAt(other) - own) < 0.015 * own ? 1.0 : 0.0;
            sum += weight * vec3(texelFetch(occlusion, other, 0).rg, 1);
        }
    }
    return sum.xy / max(sum.z, 1.0);
}
vec3 encoded(vec3 linear) {
    return mix(12.92 * linear, 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055,
               step(0.0031308, linear));
}
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float height = (gl_FragCoord.y - float(tile.y)) / float(tile.w);
    vec2 visibility = hasOcclusion ? visibilityAt(pixel) : vec2(1);
    vec4 fromSky = texelFetch(sky, pixel, 0);
    vec4 fromLamp = texelFetch(lamp, pixel, 0);
    vec3 background = mix(bottom, top, smoothstep(0.0, 1.0, height));
    // The floor has the color of the background, and darkens it.
    float dark = 1.0 - visibility.x * mix(0.42, 1.0, visibility.y);
    background *= 1.0 - dark * fromLamp.a;
    vec3 result = background * (1.0 - fromSky.a) + fromSky.rgb * visibility.x
        + fromLamp.rgb * mix(1.0, visibility.x, 0.4) * visibility.y;
    vec4 ghost = texelFetch(ghosts, pixel, 0);
    result = result * (1.0 - ghost.a) + ghost.rgb;
    // Half a step of noise, so that the background shows no bands.
    color = vec4(encoded(clamp(result, 0.0, 1.0)) + (noise(gl_FragCoord.xy) - 0.5) / 255.0, 1);
}`;
