#ifndef PENT_PLUGIN_H
#define PENT_PLUGIN_H

#include <stdint.h>

/// Plain C interface to the simulator, for game engines, ctypes and other hosts of shared
/// libraries.
///
/// Everything returned belongs to the simulation; arrays hold until the next pent_step() and are
/// gone after pent_close(). No exception leaves the library: a function that fails returns NULL or
/// a negative number, and pent_last_error() says why. A simulation must not be used by two threads
/// at once; different simulations may.

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define PENT_PLUGIN_API __attribute__((visibility("default")))
#else
#define PENT_PLUGIN_API
#endif

/// Grows when a function here changes its meaning; compare with pent_plugin_version().
#define PENT_PLUGIN_VERSION 1

typedef struct pent_simulation pent_simulation;

typedef struct pent_step_report {
    uint64_t step;      /**< Steps taken so far. */
    double time;        /**< s. */
    int32_t iterations; /**< Of the linear solver. */
    int32_t substeps;   /**< 1, or more where the step had to be cut. */
    double residual;    /**< Of the linear solver, relative. */
    int64_t inverted;   /**< Elements turned inside out. */
    double kinetic;     /**< Energies, J. */
    double elastic;
    double gravity;
    double obstacle;
} pent_step_report;

/// What touched at the end of the last step. All zero, and the smallest distance infinite, before
/// the first step and in a scene without contact.
typedef struct pent_contact_report {
    int64_t point_facet; /**< Vertices in contact with facets of bodies. */
    int64_t mixed;       /**< Edges in contact with triangles (with edges in three dimensions). */
    int64_t obstacle;    /**< Vertices in contact with obstacles. */
    double energy;       /**< Between bodies, J. */
    double deepest;      /**< Deepest penetration of a vertex, m. */
    double smallest_distance; /**< Signed, m. */
    double seconds;           /**< Spent on contact in the step. */
} pent_contact_report;

/// PENT_PLUGIN_VERSION of the library that is loaded.
PENT_PLUGIN_API int pent_plugin_version(void);

/// What went wrong last in this thread, one line; "" if nothing did.
PENT_PLUGIN_API const char* pent_last_error(void);

/// Reads a scene file and its meshes. `threads` is at least 1. NULL on failure.
PENT_PLUGIN_API pent_simulation* pent_open(const char* scene_path, int threads);

/// Frees a simulation; NULL is fine.
PENT_PLUGIN_API void pent_close(pent_simulation* simulation);

PENT_PLUGIN_API int pent_dimension(const pent_simulation* simulation);
PENT_PLUGIN_API int pent_body_count(const pent_simulation* simulation);

/// Below, `body` is from 0 to pent_body_count() - 1; another one gives NULL or -1.
PENT_PLUGIN_API const char* pent_body_name(const pent_simulation* simulation, int body);
PENT_PLUGIN_API int64_t pent_vertex_count(const pent_simulation* simulation, int body);
PENT_PLUGIN_API int64_t pent_cell_count(const pent_simulation* simulation, int body);

/// (dimension + 1) indices a cell.
PENT_PLUGIN_API const uint32_t* pent_cells(const pent_simulation* simulation, int body);

/// dimension numbers a vertex: m, m/s, N (elastic, gravity and contact).
PENT_PLUGIN_API const double* pent_positions(const pent_simulation* simulation, int body);
PENT_PLUGIN_API const double* pent_velocities(const pent_simulation* simulation, int body);
PENT_PLUGIN_API const double* pent_forces(const pent_simulation* simulation, int body);

/// One time step of the scene. 0: done; -1: it could not be solved, and the state is as before.
/// `report` may be NULL.
PENT_PLUGIN_API int pent_step(pent_simulation* simulation, pent_step_report* report);

/// Contacts of the last step. 0, or -1 on failure.
PENT_PLUGIN_API int pent_contacts(const pent_simulation* simulation, pent_contact_report* report);

#ifdef __cplusplus
}
#endif

#endif
