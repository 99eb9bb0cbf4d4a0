#ifndef PENT_PLUGIN_H
#define PENT_PLUGIN_H

#include "pent_plugin_types.h"

/** Plain C interface to the simulator, for game engines, ctypes and other hosts of shared
 * libraries.
 *
 * No exception leaves the library, and no misuse of it that can be seen crashes: a function that
 * fails returns NULL or -1, and pent_last_error() says why in one line, as long as this thread
 * calls no other function here. Functions that give an int give 0 for success unless they say
 * otherwise. Whatever is refused has changed nothing.
 *
 * Arrays that are given belong to the simulation. Those of its vertices and cells stay where they
 * are and show the state as it is at the time, until bodies come or go or it is closed, and beyond
 * that while they are kept (pent_keep()). All others hold until a function that takes it without
 * `const` is called. Arrays that are taken are copied. A simulation that another thread is using
 * at the time is refused; different simulations may be used at once.
 *
 * pent_plugin_meshes.h has meshes, frames and scenes without a simulation. */

#ifdef __cplusplus
extern "C" {
#endif

/** Grows when a function here changes its meaning; compare with pent_plugin_version(). Hosts of
 * version 1 are told so where they call pent_open(). */
#define PENT_PLUGIN_VERSION 2

/** PENT_PLUGIN_VERSION of the library that is loaded. */
PENT_PLUGIN_API int pent_plugin_version(void);

/** What went wrong in the last call of this thread, one line; "" if nothing did. Functions that
 * close or free leave it as it is where they succeed: collectors of garbage call them at any time.
 * */
PENT_PLUGIN_API const char* pent_last_error(void);

/** Reads a scene file and its meshes. `threads` is at least 1; results do not depend on it. */
PENT_PLUGIN_API pent_simulation* pent_open_file(const char* scene_path, int threads);

/** A scene from memory: its text as of a scene file, and a mesh for each [[body]] in their order,
 * in place of the files that `mesh` names. */
PENT_PLUGIN_API pent_simulation* pent_open_text(const char* scene,
                                                const pent_mesh* meshes,
                                                int64_t mesh_count,
                                                int threads);
PENT_PLUGIN_API int pent_close(pent_simulation* simulation);

/** Keeps the arrays of vertices, cells and boundaries of now where they are until pent_free_kept(),
 * whatever becomes of the simulation: they show what was there last. */
PENT_PLUGIN_API pent_kept* pent_keep(const pent_simulation* simulation);
PENT_PLUGIN_API int pent_free_kept(pent_kept* kept);

/* What is there. `body` is from 0 to pent_body_count() - 1. */

PENT_PLUGIN_API int pent_dimension(const pent_simulation* simulation);
PENT_PLUGIN_API double pent_time_step(const pent_simulation* simulation); /**< s. */
PENT_PLUGIN_API double pent_time(const pent_simulation* simulation);      /**< s. */
PENT_PLUGIN_API int pent_body_count(const pent_simulation* simulation);
PENT_PLUGIN_API int pent_obstacle_count(const pent_simulation* simulation);
PENT_PLUGIN_API const char* pent_body_name(const pent_simulation* simulation, int body);
PENT_PLUGIN_API int pent_find_body(const pent_simulation* simulation, const char* name);
PENT_PLUGIN_API int64_t pent_vertex_count(const pent_simulation* simulation, int body);
PENT_PLUGIN_API int64_t pent_cell_count(const pent_simulation* simulation, int body);

/** (dimension + 1) indices a cell. */
PENT_PLUGIN_API const uint32_t* pent_cells(const pent_simulation* simulation, int body);

/** dimension numbers a vertex: m at rest, m, m/s, N (of all that has an energy); masses one, kg. */
PENT_PLUGIN_API const double* pent_rest_positions(const pent_simulation* simulation, int body);
PENT_PLUGIN_API const double* pent_positions(const pent_simulation* simulation, int body);
PENT_PLUGIN_API const double* pent_velocities(const pent_simulation* simulation, int body);
PENT_PLUGIN_API const double* pent_forces(const pent_simulation* simulation, int body);
PENT_PLUGIN_API const double* pent_masses(const pent_simulation* simulation, int body);

/** 1 if a body sleeps, else 0. */
PENT_PLUGIN_API int pent_is_asleep(const pent_simulation* simulation, int body);

/** The facets of its boundary: `dimension` indices each, outward, and how many there are. */
PENT_PLUGIN_API const uint32_t* pent_boundary(pent_simulation* simulation,
                                              int body,
                                              int64_t* count);

/** The slice of a body by the hyperplane normal . x = offset: `normal` has four numbers and any
 * length but 0, `offset` is in m times that length. In three dimensions its whole surface; `normal`
 * may be NULL then. After turns, or with smooth normals, it is pent_slice_turned() of the stored
 * mesh of the body at pent_positions(). */
PENT_PLUGIN_API int pent_slice(pent_simulation* simulation,
                               int body,
                               const double* normal,
                               double offset,
                               pent_surface* surface);

/** The point of the bodies that a ray comes to first, by its shadow on the hyperplane of a slice;
 * NULL as `normal` for the ray as it is. Normal, origin (m) and direction (of any length but 0)
 * have `dimension` numbers each. 1: it is in `hit`; 0: there is none, and `hit` is as it was. */
PENT_PLUGIN_API int pent_pick(const pent_simulation* simulation,
                              const double* normal,
                              double offset,
                              const double* origin,
                              const double* direction,
                              pent_hit* hit);

/** All contacts, and all parts of the energy, as they are now. */
PENT_PLUGIN_API const pent_contact* pent_contacts(pent_simulation* simulation, int64_t* count);
PENT_PLUGIN_API const pent_energy* pent_energies(pent_simulation* simulation, int64_t* count);

/* What a host does. It counts from the next step on; docs/simulator.md says what each means. */

/** One time step. -1 also if it could not be solved: the state is then as before. `report` may be
 * NULL. */
PENT_PLUGIN_API int pent_step(pent_simulation* simulation, pent_step_report* report);

/** Takes vertices of a body to targets (dimension x count) by the end of the next step, and holds
 * them. */
PENT_PLUGIN_API int pent_set_targets(pent_simulation* simulation,
                                     int body,
                                     const uint32_t* vertices,
                                     int64_t count,
                                     const double* targets);
PENT_PLUGIN_API int pent_release(pent_simulation* simulation,
                                 int body,
                                 const uint32_t* vertices,
                                 int64_t count);

/** The number of the new grab, > 0. */
PENT_PLUGIN_API int64_t pent_add_grab(pent_simulation* simulation, const pent_grab* grab);
PENT_PLUGIN_API int pent_move_grab(pent_simulation* simulation, int64_t grab, const double* anchor);
PENT_PLUGIN_API int pent_remove_grab(pent_simulation* simulation, int64_t grab);

/** dimension x vertices, N; NULL for none. */
PENT_PLUGIN_API int pent_set_forces(pent_simulation* simulation, int body, const double* forces);
PENT_PLUGIN_API int pent_set_gravity(pent_simulation* simulation, const double* gravity);

/** Positions and velocities of a body, dimension x vertices each. */
PENT_PLUGIN_API int pent_set_state(pent_simulation* simulation,
                                   int body,
                                   const double* positions,
                                   const double* velocities);

/** All that goes from one step to the next, in memory, until pent_free_state(). It fits a
 * simulation of the same bodies and obstacles with the same time step; one of the same scene goes
 * on to the bit. */
PENT_PLUGIN_API pent_state* pent_save(const pent_simulation* simulation);
PENT_PLUGIN_API int pent_restore(pent_simulation* simulation, const pent_state* state);
PENT_PLUGIN_API int pent_free_state(pent_state* state);

/** A body as the one [[body]] of a text, and an obstacle as the one [[obstacle]]; a text with
 * anything else, as [solver], is refused. They come last. */
PENT_PLUGIN_API int pent_add_body(pent_simulation* simulation,
                                  const char* text,
                                  const pent_mesh* mesh);
PENT_PLUGIN_API int pent_remove_body(pent_simulation* simulation, int body);
PENT_PLUGIN_API int pent_add_obstacle(pent_simulation* simulation, const char* text);
PENT_PLUGIN_API int pent_remove_obstacle(pent_simulation* simulation, int obstacle);

#ifdef __cplusplus
}
#endif

#endif
