// Shaders in GLSL ES 3.00. What has an index lies in textures of kTextureWidth texels a row.

export const kTextureWidth = 2048;
/** Corners around a surface of revolution. */
export const kCircle = 64;
/** Pieces of an arc that is turned about an axis. */
export const kArcSteps = 32;

/** What every shader begins with. */
export const kHead = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler2DShadow;
precision highp usampler2D;
ivec2 texel(int i) { return ivec2(i & ${kTextureWidth - 1}, i >> 11); }
`;

const kAcross = `
// The normal of a facet with these corners: outward, as long as three times its measure and more.
vec4 across(vec4 e1, vec4 e2, vec4 e3) {
    return vec4(dot(e1.yzw, cross(e2.yzw, e3.yzw)), -dot(e1.xzw, cross(e2.xzw, e3.xzw)),
                dot(e1.xyw, cross(e2.xyw, e3.xyw)), -dot(e1.xyz, cross(e2.xyz, e3.xyz)));
}
`;

const kTurn = `
uniform sampler2D positions;
uniform mat4 rotation;
uniform vec4 shift;  // what is seen of p is rotation p + shift; its w is the height over the slice
vec4 seen(uint vertex) {
    return rotation * texelFetch(positions, texel(int(vertex)), 0) + shift;
}
${kAcross}`;

/** A triangle over the whole target. */
export const kFullScreen = `${kHead}
void main() {
    gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0, 1);
}`;

/** Pass 1 of smooth normals: the normal of each facet in its own space. */
export const kFacetNormals = `${kHead}
uniform usampler2D facets;
uniform sampler2D positions;
uniform int count;
uniform int dimension;
uniform float unit;  // 1 / a usual length, to stay within the range of floats
out vec4 normal;
${kAcross}
vec4 corner(uint vertex) { return unit * texelFetch(positions, texel(int(vertex)), 0); }
void main() {
    int facet = int(gl_FragCoord.y) * ${kTextureWidth} + int(gl_FragCoord.x);
    if (facet >= count) {
        discard;
    }
    uvec4 t = texelFetch(facets, texel(facet), 0);
    vec4 first = corner(t.x);
    vec4 e1 = corner(t.y) - first;
    vec4 e2 = corner(t.z) - first;
    normal = dimension == 3 ? vec4(cross(e1.xyz, e2.xyz), 0) : across(e1, e2, corner(t.w) - first);
}`;

/** Pass 2: at each corner of each facet the sum of the normals around the vertex, of those facets
 * that are within the crease angle of this one. */
export const kCornerNormals = `${kHead}
uniform usampler2D facets;
uniform usampler2D vertexBegin;
uniform usampler2D vertexFacets;
uniform sampler2D facetNormals;
uniform int count;
out vec4 normal;
void main() {
    const float kCreaseCosine = 0.5403023;  // 1 radian, 57 degrees
    int place = int(gl_FragCoord.y) * ${kTextureWidth} + int(gl_FragCoord.x);
    if (place >= 4 * count) {
        discard;
    }
    int vertex = int(texelFetch(facets, texel(place >> 2), 0)[place & 3]);
    vec4 own = texelFetch(facetNormals, texel(place >> 2), 0);
    int begin = int(texelFetch(vertexBegin, texel(vertex), 0).r);
    int end = int(texelFetch(vertexBegin, texel(vertex + 1), 0).r);
    vec4 sum = vec4(0);
    for (int i = begin; i < end; ++i) {
        int other = int(texelFetch(vertexFacets, texel(i), 0).r);
        vec4 n = texelFetch(facetNormals, texel(other), 0);
        if (dot(n, own) >= kCreaseCosine * length(own) * length(n)) {
            sum += n;
        }
    }
    float size = length(sum);
    normal = size > 0.0 ? sum / size : vec4(0);
}`;

// For a tetrahedron with corner k above where bit k of the mask is set: up to two triangles, each
// of three of its edges, numbered 01 02 03 12 13 23. The same table as the C++ slicer's.
const kCuts = `
const int kCuts[96] = int[](
    -1,-1,-1,-1,-1,-1,  0, 2, 1,-1,-1,-1,  0, 3, 4,-1,-1,-1,  2, 1, 3, 2, 3, 4,
     1, 5, 3,-1,-1,-1,  0, 2, 5, 0, 5, 3,  4, 0, 1, 4, 1, 5,  2, 5, 4,-1,-1,-1,
     2, 4, 5,-1,-1,-1,  4, 1, 0, 4, 5, 1,  0, 5, 2, 0, 3, 5,  1, 3, 5,-1,-1,-1,
     1, 2, 4, 1, 4, 3,  0, 4, 3,-1,-1,-1,  0, 1, 2,-1,-1,-1, -1,-1,-1,-1,-1,-1);
const ivec2 kEnds[6] = ivec2[](ivec2(0, 1), ivec2(0, 2), ivec2(0, 3), ivec2(1, 2), ivec2(1, 3),
                               ivec2(2, 3));
`;

const kSurfaceOut = `
uniform usampler2D facets;
uniform sampler2D scalars;
uniform sampler2D cornerNormals;
uniform mat4 viewProjection;
uniform int valueOf;   // 0 nothing, 1 w of the body's own space, 2 the scalar
uniform bool isSmooth;
uniform vec3 cameraEye;
uniform float pushed;  // how much deeper is what is seen from behind
out vec3 world;
out vec3 normal;
out float value;
out float isDrawn;     // for what is captured
float valueAt(uint vertex) {
    return valueOf == 1 ? texelFetch(positions, texel(int(vertex)), 0).w
         : valueOf == 2 ? texelFetch(scalars, texel(int(vertex)), 0).r : 0.0;
}
vec4 normalAt(int corner) {
    return texelFetch(cornerNormals, texel(4 * gl_InstanceID + corner), 0);
}
// Sides that are seen from behind lie behind others, but for rounding along the rim: there some drivers take depths
// from beyond it.
void place(vec3 outward) {
    gl_Position = viewProjection * vec4(world, 1);
    gl_Position.z += dot(outward, cameraEye - world) < 0.0 ? pushed * gl_Position.w : 0.0;
}
void leaveOut() {
    world = vec3(0);
    normal = vec3(0);
    value = 0.0;
    isDrawn = 0.0;
    gl_Position = vec4(2, 2, 2, 1);
}
`;

/** The slice of a body: an instance for each boundary tetrahedron, six vertices of up to two
 * triangles. A vertex on the hyperplane counts as above it, and each edge is cut from its lower
 * vertex, so the surface is closed at every hyperplane. */
export const kSlice = `${kHead}${kTurn}${kCuts}${kSurfaceOut}
void main() {
    uvec4 tet = texelFetch(facets, texel(gl_InstanceID), 0);
    vec4 corners[4] = vec4[](seen(tet.x), seen(tet.y), seen(tet.z), seen(tet.w));
    int mask = 0;
    for (int k = 0; k < 4; ++k) {
        mask |= corners[k].w < 0.0 ? 0 : 1 << k;
    }
    int edge = kCuts[6 * mask + gl_VertexID];
    if (edge < 0) {
        leaveOut();
        return;
    }
    ivec2 ends = kEnds[edge];
    ends = tet[ends.x] < tet[ends.y] ? ends : ends.yx;
    vec4 a = corners[ends.x];
    vec4 b = corners[ends.y];
    float t = a.w / (a.w - b.w);
    world = (1.0 - t) * a.xyz + t * b.xyz;
    vec4 flatNormal = across(corners[1] - corners[0], corners[2] - corners[0],
                             corners[3] - corners[0]);
    normal = flatNormal.xyz;
    if (isSmooth) {
        vec3 smoothNormal =
            (rotation * ((1.0 - t) * normalAt(ends.x) + t * normalAt(ends.y))).xyz;
        // Else it vanished, or is turned away by a deep fold.
        normal = dot(smoothNormal, normal) > 0.0 ? smoothNormal : normal;
    }
    float size = length(normal);
    normal = size > 0.0 ? normal / size : vec3(0, 1, 0);
    value = valueOf == 0 ? 0.0
        : (1.0 - t) * valueAt(tet[ends.x]) + t * valueAt(tet[ends.y]);
    isDrawn = 1.0;
    place(flatNormal.xyz);
}`;

/** The boundary of a three-dimensional body, whole: an instance a triangle. */
export const kSkin = `${kHead}${kTurn}${kSurfaceOut}
void main() {
    uvec4 triangle = texelFetch(facets, texel(gl_InstanceID), 0);
    if (gl_VertexID > 2) {
        leaveOut();
        return;
    }
    vec3 a = seen(triangle.x).xyz;
    vec3 flatNormal = cross(seen(triangle.y).xyz - a, seen(triangle.z).xyz - a);
    world = seen(triangle[gl_VertexID]).xyz;
    normal = isSmooth ? (rotation * normalAt(gl_VertexID)).xyz : flatNormal;
    normal = dot(normal, flatNormal) > 0.0 ? normal : flatNormal;
    float size = length(normal);
    normal = size > 0.0 ? normal / size : vec3(0, 1, 0);
    value = valueAt(triangle[gl_VertexID]);
    isDrawn = 1.0;
    place(flatNormal);
}`;

/** The outline of the projection: an instance for each triangle between two boundary tetrahedra,
 * drawn where one of them faces the eye in the fourth dimension and the other does not. */
export const kFold = `${kHead}${kTurn}
uniform usampler2D folds;
uniform mat4 viewProjection;
uniform vec4 eye;  // xyz: the point of the film under it; w: its distance, 0 for infinitely far
out vec3 world;
out vec3 normal;
out float value;
out float isDrawn;
vec3 image(uint vertex) {
    vec4 p = seen(vertex);
    return eye.w > 0.0 ? eye.xyz + (p.xyz - eye.xyz) * (eye.w / (eye.w - p.w)) : p.xyz;
}
void main() {
    uvec4 t = texelFetch(folds, texel(2 * gl_InstanceID), 0);
    uint other = texelFetch(folds, texel(2 * gl_InstanceID + 1), 0).x;
    vec3 a = image(t.x);
    vec3 outward = cross(image(t.y) - a, image(t.z) - a);
    bool isFirstFacing = dot(outward, image(t.w) - a) > 0.0;
    bool isOtherFacing = dot(outward, image(other) - a) < 0.0;
    world = vec3(0);
    normal = vec3(0);
    value = 0.0;
    isDrawn = 0.0;
    gl_Position = vec4(2, 2, 2, 1);
    if (isFirstFacing == isOtherFacing) {
        return;
    }
    int corner = isFirstFacing ? (3 - gl_VertexID) % 3 : gl_VertexID;
    world = image(t[corner]);
    normal = normalize(isFirstFacing ? -outward : outward);
    isDrawn = 1.0;
    gl_Position = viewProjection * vec4(world, 1);
}`;

const kAround = Array.from({ length: kCircle }, (_, i) => (2 * Math.PI * i) / kCircle)
    .map((angle) => `vec2(${Math.cos(angle).toFixed(9)},${Math.sin(angle).toFixed(9)})`)
    .join();

/** A surface of revolution. Circles come in numbers: a card's own sine may be wrong by a thousandth. */
export const kRevolved = `${kHead}
uniform mat4 viewProjection;
uniform vec3 center;
uniform mat3 axes;
uniform bool isArc;
uniform float side;  // of an arc: 1 where its front is outside, -1 inside
uniform vec2 profile[${kArcSteps + 1}];  // distance from the axis, and along it
out vec3 world;
out vec3 normal;
out float value;
out float isDrawn;
const ivec2 kCorners[6] = ivec2[](ivec2(0, 0), ivec2(1, 0), ivec2(1, 1), ivec2(0, 0), ivec2(1, 1),
                                  ivec2(0, 1));
const vec2 kAround[${kCircle}] = vec2[](${kAround});
void main() {
    ivec2 place = ivec2(gl_VertexID / 6 / ${kCircle}, gl_VertexID / 6 % ${kCircle})
        + kCorners[gl_VertexID % 6];
    vec2 p = profile[place.x];
    vec3 ring = vec3(p.x * kAround[place.y % ${kCircle}], p.y);
    world = center + axes * ring;
    vec3 squares = vec3(dot(axes[0], axes[0]), dot(axes[1], axes[1]), dot(axes[2], axes[2]));
    normal = isArc ? side * normalize(axes * (ring / squares)) : axes[2];
    value = 0.0;
    isDrawn = 1.0;
    gl_Position = viewProjection * vec4(world, 1);
}`;

const kShade = `
uniform vec3 cameraEye;
uniform vec3 toKey;
uniform vec3 toFill;
in vec3 world;
in vec3 normal;
in float value;
layout(location = 0) out vec4 sky;
layout(location = 1) out vec4 lamp;
void shade(vec3 albedo, vec3 n) {
    vec3 toEye = normalize(cameraEye - world);
    vec3 ambient = mix(vec3(0.24, 0.22, 0.20), vec3(0.36, 0.38, 0.42), 0.5 + 0.5 * n.y);
    float fill = 0.10 * max(dot(n, toFill), 0.0);
    float key = 0.85 * max(dot(n, toKey), 0.0);
    float gloss = 0.05 * pow(max(dot(n, normalize(toEye + toKey)), 0.0), 30.0);
    sky = vec4(albedo * (ambient + fill), 1);
    lamp = vec4(albedo * key + gloss, 0);
}
`;

/** Solid surfaces: one soft lamp and the sky, as in the pictures of pent-render. What the sky gives
 * and what the lamp gives stay apart: occlusion is of the one, shadows are of the other. */
export const kSolid = `${kHead}${kShade}
uniform sampler2D colorMap;
uniform vec3 bodyColor;
uniform int valueOf;
uniform vec2 range;
void main() {
    vec3 albedo = bodyColor;
    if (valueOf != 0) {
        float place = clamp((value - range.x) / max(range.y - range.x, 1e-30), 0.0, 1.0);
        albedo = texture(colorMap, vec2((place * 255.0 + 0.5) / 256.0, 0.5)).rgb;
    }
    vec3 n = normalize(normal);
    if (!gl_FrontFacing) {  // never, but where the body is turned inside out
        albedo = vec3(1.0, 0.0, 0.5);
        n = -n;
    }
    shade(albedo, n);
}`;

/** Ground: the same, and less of it the further it is from where it is nearest to the scene. */
export const kGround = `${kHead}${kShade}
uniform vec3 bodyColor;
uniform vec4 scene;     // center, distance at which ground has faded
uniform float nearest;  // of it all to the center
void main() {
    vec3 away = world - scene.xyz;
    float spread = sqrt(max(dot(away, away) - nearest * nearest, 0.0)) / scene.w;
    if (spread >= 1.0) {
        discard;
    }
    shade(bodyColor, normalize(normal));
    float presence = 1.0 - smoothstep(0.3, 1.0, spread);
    sky *= presence;
    lamp = presence * vec4(lamp.rgb, 1);
}`;

/** Surfaces to look through: clear where seen from the front, denser at the rim. */
export const kGhost = `${kHead}
uniform vec3 ghostColor;
uniform vec2 opacity;  // seen from the front, and edge-on
uniform vec3 cameraEye;
in vec3 world;
in vec3 normal;
out vec4 color;
void main() {
    float facing = abs(dot(normalize(normal), normalize(cameraEye - world)));
    float alpha = mix(opacity.y, opacity.x, 1.0 - pow(1.0 - facing, 3.0));
    color = vec4(ghostColor * alpha, alpha);
}`;

export const kNothing = `${kHead}
void main() {}`;

/** Where nothing is drawn but transform feedback listens. */
export const kCaptured = ["world", "isDrawn"];

/** The floor shows only what darkens it, and a little light of its own on a dark page. */
export const kFloorVertex = `${kHead}
uniform mat4 viewProjection;
uniform vec4 floorDisk;  // center, radius
out vec3 world;
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    world = floorDisk.xyz + floorDisk.w * vec3(corner.x, 0, -corner.y);
    gl_Position = viewProjection * vec4(world, 1);
}`;

export const kFloor = `${kHead}
uniform vec4 floorDisk;
uniform vec3 floorGlow;
in vec3 world;
layout(location = 0) out vec4 sky;
layout(location = 1) out vec4 lamp;  // alpha: how much of a floor there is
void main() {
    float reach = length(world.xz - floorDisk.xz) / floorDisk.w;
    if (reach >= 1.0) {
        discard;
    }
    float fade = 1.0 - smoothstep(0.3, 1.0, reach);
    sky = vec4(0);
    lamp = vec4(floorGlow * fade * fade, fade);
}`;

/** Segments of so many pixels across, ends a and b of each an attribute of the instance. */
export const kLineVertex = `${kHead}
layout(location = 0) in vec3 a;
layout(location = 1) in vec3 b;
layout(location = 2) in vec4 tint;
uniform mat4 viewProjection;
uniform vec2 pixels;  // of the target
uniform float width;
out vec4 shade;
void main() {
    vec4 p = viewProjection * vec4(a, 1);
    vec4 q = viewProjection * vec4(b, 1);
    vec2 along = (q.xy / q.w - p.xy / p.w) * pixels;
    vec2 side = vec2(-along.y, along.x) / max(length(along), 1e-6);
    vec4 end = gl_VertexID < 2 ? p : q;
    float s = (gl_VertexID & 1) == 0 ? 1.0 : -1.0;
    gl_Position = end + vec4(s * side * width / pixels * end.w, 0, 0);
    shade = tint;
}`;

export const kLine = `${kHead}
in vec4 shade;
out vec4 color;
void main() { color = vec4(shade.rgb * shade.a, shade.a); }`;
