/* An engine that hosts the simulator through its C interface: a body of four dimensions lies on the
 * ground, a pointer at its slice takes hold of it, carries it towards w, and lets it go. No file is
 * read. */
#include <pent_plugin.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char* const kScene =
    "[scene]\nframes_per_second = 60\ngravity = [0, -9.8, 0, 0]\n"
    "[[body]]\nname = \"jelly\"\nmesh = \"in memory\"\nmaterial = { young = 5e4, density = 100 }\n"
    "[[obstacle]]\nhalf_space = { normal = [0, 1, 0, 0], offset = 0 }\nstiffness = 200\n"
    "[damping]\nmass = 1\nstiffness = 0.01\n";

/* Two pentachora upon one tetrahedron. */
static const double kPositions[] = {0, 0.1, 0,   0, 0.5, 0.1, 0, 0,  0, 0.6, 0, 0,
                                    0, 0.1, 0.5, 0, 0,   0.1, 0, .5, 0, 0.1, 0, -.5};
static const uint32_t kCells[] = {0, 1, 2, 3, 4, 1, 0, 2, 3, 5};

static void check(int is_right) {
    if (!is_right) {
        fprintf(stderr, "%s\n", pent_last_error());
        exit(1);
    }
}

static void draw(pent_simulation* simulation) {
    const double w[] = {0, 0, 0, 1};
    pent_surface slice; /* triangles for the graphics card; none while the body is beside w = 0 */
    check(pent_slice(simulation, 0, w, 0, &slice) == 0);
}

int main(void) {
    const pent_mesh mesh = {
        .positions = kPositions, .vertices = 6, .cells = kCells, .cell_count = 2};
    check(pent_plugin_version() == PENT_PLUGIN_VERSION);
    pent_simulation* simulation = pent_open_text(kScene, &mesh, 1, 2);
    check(simulation != NULL);
    int64_t hand = 0;
    double most = 0; /* of w, at vertex 0 */
    for (int frame = 0; frame < 240; ++frame) {
        if (frame == 60) { /* the button goes down over the body */
            const double w[] = {0, 0, 0, 1};
            const double eye[] = {0.1, 0.1, -3, 0};
            const double sight[] = {0, 0, 1, 0};
            pent_hit hit;
            check(pent_pick(simulation, w, 0.01, eye, sight, &hit) == 1);
            pent_grab grab = {.point = hit.point, .stiffness = 500, .damping = 20};
            memcpy(grab.anchor, hit.place, sizeof grab.anchor);
            check((hand = pent_add_grab(simulation, &grab)) > 0);
        } else if (frame > 60 && frame <= 120) { /* it is dragged */
            const double s = (frame - 60) / 60.0;
            const double anchor[] = {0.1, 0.1 + 0.5 * s, 0, 0.4 * s};
            check(pent_move_grab(simulation, hand, anchor) == 0);
        } else if (frame == 150) { /* and let go */
            check(pent_remove_grab(simulation, hand) == 0);
        }
        check(pent_step(simulation, NULL) == 0);
        draw(simulation);
        most = pent_positions(simulation, 0)[3] > most ? pent_positions(simulation, 0)[3] : most;
    }
    double lowest = 1;
    for (int vertex = 0; vertex < 6; ++vertex) {
        const double y = pent_positions(simulation, 0)[4 * vertex + 1];
        lowest = y < lowest ? y : lowest;
    }
    printf("carried to w = %.2f, fell back: %s\n", most, lowest < 0.02 ? "yes" : "no");
    return pent_close(simulation) == 0 ? 0 : 1;
}
