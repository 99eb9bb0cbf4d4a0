#ifndef PENT_PLUGIN_TYPES_H
#define PENT_PLUGIN_TYPES_H

#include <stdint.h>

#if defined(__GNUC__)
#define PENT_PLUGIN_API __attribute__((visibility("default")))
#else
#define PENT_PLUGIN_API
#endif

/** What pent_plugin.h takes and gives. Points and vectors have as many numbers as the scene has
 * dimensions, 3 or 4; where there is room for 4 the last is 0 in three dimensions. */

/** A simulation, a state that one was in, and arrays of one. All are numbers in disguise: one that
 * is not there (any more) is an error, never a crash. */
typedef struct pent_simulation pent_simulation;
typedef struct pent_state pent_state;
typedef struct pent_kept pent_kept;

/** A mesh of a host, read while it is handed over. */
typedef struct pent_mesh {
    const double* positions; /**< dimension x vertices, m. */
    int64_t vertices;
    const uint32_t* cells; /**< (dimension + 1) x cell_count, from 0. */
    int64_t cell_count;
    const uint16_t* regions; /**< One a cell, or NULL. */
    const uint32_t* columns; /**< Of an extruded mesh, one a vertex, or NULL. */
    const uint32_t* layers;  /**< The same. */
    const uint32_t* parents; /**< Of quadratic cells, one a cell, or NULL. */
    const double* fibers;    /**< Directions, dimension x cell_count, or NULL. */
} pent_mesh;

/** What one step did. */
typedef struct pent_step_report {
    uint64_t step;             /**< Steps taken so far. */
    double time;               /**< s. */
    double seconds;            /**< Spent on it. */
    int32_t substeps;          /**< 1, or more where the step had to be cut. */
    int32_t refused;           /**< Attempts that were thrown away. */
    int32_t newton_iterations; /**< Behind the first, linear step. */
    int32_t iterations;        /**< Of the linear solver. */
    double residual;           /**< Of the linear solver, relative. */
    int64_t unknowns;          /**< Scalars solved for. */
    int64_t inverted;          /**< Cells turned inside out. */
    int64_t asleep;            /**< Bodies that sleep. */
    int64_t point_facet;       /**< Vertices in contact with facets of bodies. */
    int64_t mixed;             /**< Edges in contact with triangles (with edges in 3D). */
    int64_t obstacle;          /**< Vertices in contact with obstacles. */
    double deepest;            /**< Deepest penetration of a vertex, m. */
    double smallest_distance;  /**< Signed, m; infinite where nothing touches. */
} pent_step_report;

/** A part of the energy. */
typedef struct pent_energy {
    const char* name;  /**< "kinetic", "elastic", "gravity", "contact" and so on. */
    double energy;     /**< J. */
    int32_t is_stored; /**< 0 for what cannot be had back: it is of use to a line search. */
} pent_energy;

/** One contact. */
typedef struct pent_contact {
    int32_t first;       /**< Body. */
    int32_t second;      /**< Body, or obstacle; the same as `first` within a body. */
    int32_t is_obstacle; /**< Whether `second` is an obstacle. */
    double distance;     /**< Signed, m. */
    double force[4];     /**< On the first body, N. */
} pent_contact;

/** A point of a body: barycentric coordinates (dimension + 1 of them) in a cell. */
typedef struct pent_point {
    int32_t body;
    int64_t cell;
    double weights[5];
} pent_point;

/** A spring from a point of a body to an anchor. */
typedef struct pent_grab {
    pent_point point;
    double anchor[4];
    double stiffness; /**< N/m, > 0. */
    double damping;   /**< N s/m, >= 0. */
    double max_force; /**< N: it never pulls harder. 0: what the cells around the point bear. */
} pent_grab;

/** What a ray meets. */
typedef struct pent_hit {
    pent_point point;
    double place[4]; /**< m. */
    double distance; /**< From the ray's origin, m. */
} pent_hit;

/** A closed surface of triangles, counter-clockwise from outside. Its arrays belong to the
 * simulation and hold until the next pent_slice(), pent_step() or change. */
typedef struct pent_surface {
    const double* positions; /**< 3 x vertices, m, in the frame. */
    int64_t vertices;
    const uint32_t* triangles; /**< 3 x triangle_count. */
    int64_t triangle_count;
    const uint32_t* ends; /**< 2 x vertices: each lies on the edge between these of the mesh, ... */
    const double* weights; /**< ... this far from the first towards the second, 0..1. */
    /** Of the slice: rows x, y, z of the picture, and the normal; row-major. The identity in three
     * dimensions. */
    double frame[16];
} pent_surface;

#endif
