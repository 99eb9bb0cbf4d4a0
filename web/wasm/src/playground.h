#ifndef PENT_PLAYGROUND_H
#define PENT_PLAYGROUND_H

#include <pent_plugin.h>

/** What the playground of the page needs beside the C interface of plugin/. Failures are told as
 * there: NULL or -1, and pent_last_error() says why. */

#ifdef __cplusplus
extern "C" {
#endif

/** What a person may change of a scene while it runs. */
typedef struct play_settings {
    double stiffness;        /**< What all moduli of all materials are multiplied by, > 0. */
    double damping;          /**< Of stiffness, s; below 0: as the scene has it. */
    double steps_per_second; /**< 0: as the scene has it. */
} play_settings;

/** What the page shows of a scene that is open. */
typedef struct play_facts {
    double time_step;  /**< s. */
    double damping;    /**< Of stiffness, s. */
    double gravity[4]; /**< m/s^2. */
} play_facts;

/** Reads a scene file and its meshes, with the words of pent-sim for what is wrong in them. It goes
 * on from the state of `before`, a simulation of the same file, if that is not NULL. */
PENT_PLUGIN_API pent_simulation* play_open(const char* scene_path,
                                           const play_settings* settings,
                                           const pent_simulation* before);

PENT_PLUGIN_API int play_get_facts(const pent_simulation* simulation, play_facts* facts);

/** The file of a body's mesh, as seen from the current folder; it holds until the next call. */
PENT_PLUGIN_API const char* play_mesh_path(const pent_simulation* simulation, int body);

/** Forces of contact on the vertices of a body, N, dimension x vertices; they hold until the next
 * call. */
PENT_PLUGIN_API const double* play_contact_forces(const pent_simulation* simulation, int body);

/** Obstacles where they are now, as a run's file has them; it holds until the next call. */
PENT_PLUGIN_API const char* play_obstacles(const pent_simulation* simulation);

/** Begins a run in an empty folder, as pent-sim writes it: scene, meshes with what
 * their files have beside them, obstacles at rest. */
PENT_PLUGIN_API int play_begin_run(const pent_simulation* simulation, const char* folder);

/** Adds a frame to it. */
PENT_PLUGIN_API int play_add_frame(const pent_simulation* simulation,
                                   const char* folder,
                                   int frame);

#ifdef __cplusplus
}
#endif

#endif
