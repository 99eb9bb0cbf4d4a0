import { makeProgram } from "./gl.ts";
import type { Gl, Program } from "./gl.ts";
import * as screen from "./screen_shaders.ts";
import * as shaders from "./shaders.ts";

/** A program that is made when it is first asked for. */
export type Lazy = () => Program;

/** All programs. Each is made when it is first used: making all takes seconds where software
 * draws. */
export function makePrograms(gl: Gl) {
    const lazy = (vertex: string, fragment: string, captured: string[] = []) => {
        let made: Program | null = null;
        return () => (made ??= makeProgram(gl, vertex, fragment, captured));
    };
    const pair = (fragment: string, captured: string[] = []) => ({
        slice: lazy(shaders.kSlice, fragment, captured),
        skin: lazy(shaders.kSkin, fragment, captured),
    });
    return {
        facets: lazy(shaders.kFullScreen, shaders.kFacetNormals),
        corners: lazy(shaders.kFullScreen, shaders.kCornerNormals),
        solid: pair(shaders.kSolid),
        ghost: pair(shaders.kGhost),
        shadow: pair(shaders.kNothing),
        capture: pair(shaders.kNothing, shaders.kCaptured),
        fold: lazy(shaders.kFold, shaders.kGhost),
        floor: lazy(shaders.kFloorVertex, shaders.kFloor),
        line: lazy(shaders.kLineVertex, shaders.kLine),
        occlusion: lazy(shaders.kFullScreen, screen.kOcclusion),
        compose: lazy(shaders.kFullScreen, screen.kCompose),
    };
}
