import { makeProgram } from "./gl.ts";
import type { Gl, Program } from "./gl.ts";
import * as screen from "./screen_shaders.ts";
import * as shaders from "./shaders.ts";

/** A program that is made when it is first asked for. */
export type Lazy = () => Program;

/** The same picture of all kinds of surfaces: slices of bodies, skins of those of three dimensions, and what is made
 * by revolution. */
export interface SurfacePrograms {
    slice: Lazy;
    skin: Lazy;
    revolved: Lazy;
}

/** All programs. Each is made when it is first used: making all takes seconds where software
 * draws. */
export function makePrograms(gl: Gl) {
    const lazy = (vertex: string, fragment: string, captured: string[] = []) => {
        let made: Program | null = null;
        return () => (made ??= makeProgram(gl, vertex, fragment, captured));
    };
    const kind = (fragment: string, captured: string[] = []): SurfacePrograms => ({
        slice: lazy(shaders.kSlice, fragment, captured),
        skin: lazy(shaders.kSkin, fragment, captured),
        revolved: lazy(shaders.kRevolved, fragment, captured),
    });
    return {
        facets: lazy(shaders.kFullScreen, shaders.kFacetNormals),
        corners: lazy(shaders.kFullScreen, shaders.kCornerNormals),
        solid: kind(shaders.kSolid),
        ghost: kind(shaders.kGhost),
        shadow: kind(shaders.kNothing),
        capture: kind(shaders.kNothing, shaders.kCaptured),
        ground: lazy(shaders.kRevolved, shaders.kGround),
        fold: lazy(shaders.kFold, shaders.kGhost),
        floor: lazy(shaders.kFloorVertex, shaders.kFloor),
        line: lazy(shaders.kLineVertex, shaders.kLine),
        occlusion: lazy(shaders.kFullScreen, screen.kOcclusion),
        compose: lazy(shaders.kFullScreen, screen.kCompose),
    };
}
