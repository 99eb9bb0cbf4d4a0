#ifndef PENT_PLUGIN_MESHES_H
#define PENT_PLUGIN_MESHES_H

#include "pent_plugin.h"

/** What a host does without a simulation: meshes and frames from files and arrays, and the text of
 * scenes. All that pent_plugin.h says of errors holds here. */

#ifdef __cplusplus
extern "C" {
#endif

/** A mesh, and a frame of a run, that the library keeps. Both are numbers in disguise. They never
 * change: any number of threads may look at one, and its arrays hold until it is freed. */
typedef struct pent_stored_mesh pent_stored_mesh;
typedef struct pent_stored_frame pent_stored_frame;

typedef struct pent_mesh_info {
    int32_t dimension;      /**< 2, 3 or 4. */
    pent_mesh arrays;       /**< NULL for what the mesh does not have. */
    double hypervolume;     /**< m^dimension. */
    const char* created_by; /**< Program and version, of a file; else "". */
    uint32_t crc32c;        /**< The checksum that the file states; else 0. */
} pent_mesh_info;

/** A quantity of vertices, or of cells. */
typedef struct pent_field {
    const char* name;
    const double* values; /**< rows x vertices, or rows x cells. */
    int32_t rows;         /**< 1, or dimension for a vector. */
} pent_field;

/** What there may be beside a mesh, as docs/pent-format.md has it; 0 and NULL for what is not. */
typedef struct pent_mesh_extras {
    const pent_field* vertex_fields; /**< With names that differ from one another. */
    int64_t vertex_field_count;
    const pent_field* cell_fields; /**< The same of cells. */
    int64_t cell_field_count;
    const uint32_t* facets; /**< Those that have labels: dimension x facets, outward. */
    int64_t facet_count;
    const uint16_t* labels;        /**< One a facet. */
    const uint16_t* base_labels;   /**< What the base mesh has there, one a facet. */
    const uint8_t* bisection_tags; /**< One a cell. */
} pent_mesh_extras;

typedef struct pent_frame_info {
    int32_t dimension;
    int64_t vertices;
    const double* positions;      /**< dimension x vertices, m. */
    const double* velocities;     /**< The same, m/s, or NULL. */
    const double* contact_forces; /**< The same, N, or NULL. */
    int64_t field_count;          /**< Further quantities of the vertices. */
    const char* mesh_name;        /**< File name of the mesh. */
    uint32_t mesh_crc32c;         /**< The checksum that it states. */
    uint64_t frame;               /**< From 0. */
    uint64_t step;                /**< Steps taken so far. */
    double time;                  /**< s. */
} pent_frame_info;

/** A turn of bodies about the origin that takes axis `from` towards axis `to`; 0 to 3 are x y z w.
 */
typedef struct pent_turn {
    int32_t from;
    int32_t to;
    double degrees;
} pent_turn;

/** w = offset, of bodies that were turned before, in this order. */
typedef struct pent_hyperplane {
    const pent_turn* turns;
    int64_t turn_count;
    double offset; /**< m. */
} pent_hyperplane;

/** A .pent file with a mesh, read and validated. */
PENT_PLUGIN_API pent_stored_mesh* pent_read_mesh(const char* path);

/** A mesh of arrays, and what is beside it unless that is NULL, copied, and validated as files are:
 * indices in range, cells positively oriented and not degenerate, numbers finite, quantities with
 * names that a file can have. */
PENT_PLUGIN_API pent_stored_mesh* pent_store_mesh(int dimension,
                                                  const pent_mesh* mesh,
                                                  const pent_mesh_extras* extras);

/** Writes a .pent file, with what is beside the mesh. `created_by` is
 * one line of at most 4077 bytes; `is_ascii` 0 for binary. */
PENT_PLUGIN_API int pent_write_mesh(const pent_stored_mesh* mesh,
                                    const char* path,
                                    const char* created_by,
                                    int is_ascii);
PENT_PLUGIN_API int pent_mesh_info_of(const pent_stored_mesh* mesh, pent_mesh_info* info);
PENT_PLUGIN_API int pent_mesh_extras_of(const pent_stored_mesh* mesh, pent_mesh_extras* extras);

/** The facets of its boundary: `dimension` indices each, outward, and how many there are. An error
 * where cells do not fit together. */
PENT_PLUGIN_API const uint32_t* pent_mesh_boundary(const pent_stored_mesh* mesh, int64_t* count);

/** pent_slice() of a mesh of three or four dimensions, with its vertices at `positions`, or at rest
 * where that is NULL. The arrays of the surface hold until this thread slices a mesh again. */
PENT_PLUGIN_API int pent_slice_mesh(const pent_stored_mesh* mesh,
                                    const double* positions,
                                    const double* normal,
                                    double offset,
                                    pent_surface* surface);

/** The same by a hyperplane as pent-slice --rotate has it, to the bit; `plane` may be NULL in three
 * dimensions. `normals` gets, unless it is NULL, those of smooth shading: 3 numbers for each corner
 * of each triangle, of the boundary in all its dimensions, with edges where it turns sharply. */
PENT_PLUGIN_API int pent_slice_turned(const pent_stored_mesh* mesh,
                                      const double* positions,
                                      const pent_hyperplane* plane,
                                      pent_surface* surface,
                                      const double** normals);

/** How much the cells around each vertex are strained, with the vertices at `positions`: the mean
 * of |E|, the Frobenius norm of the Green strain, over the cells by their volume. One number a
 * vertex, which hold until this thread asks again. */
PENT_PLUGIN_API const double* pent_mesh_strain(const pent_stored_mesh* mesh,
                                               const double* positions);

/** A quantity of the cells at the vertices: its mean over the cells at each, by their volume at
 * rest. `values` are rows x cells; rows x vertices come back, and hold until this thread asks
 * again. */
PENT_PLUGIN_API const double* pent_mesh_means(const pent_stored_mesh* mesh,
                                              const double* values,
                                              int32_t rows);

/** The colors in which pent-render shows a quantity ("body", "w", "speed", "strain", "force",
 * "reaction", "energy_density", or any other by its name): red, green, blue a value, 0..1, linear
 * light. `low` and `high` get the first and the last color; of "body" values are numbers of bodies,
 * from 0. All numbers, and high - low, are finite. They hold until this thread asks again. */
PENT_PLUGIN_API const float* pent_colors(
    const char* quantity, const double* values, int64_t count, double low, double high);
PENT_PLUGIN_API int pent_free_mesh(pent_stored_mesh* mesh);

/** A .pent file with a frame, read and validated. */
PENT_PLUGIN_API pent_stored_frame* pent_read_frame(const char* path);
PENT_PLUGIN_API int pent_frame_info_of(const pent_stored_frame* frame, pent_frame_info* info);

/** `field` from 0 to field_count - 1. */
PENT_PLUGIN_API int pent_frame_field(const pent_stored_frame* frame,
                                     int64_t field,
                                     pent_field* found);
PENT_PLUGIN_API int pent_free_frame(pent_stored_frame* frame);

/** The text of a scene, checked and with every default filled in. `name` stands for its file in
 * messages, and paths of meshes come out behind `folder`. The text given holds until this thread
 * calls this again. */
PENT_PLUGIN_API const char* pent_scene_text(const char* scene,
                                            const char* name,
                                            const char* folder);

/** The same for a file in another folder: paths of meshes, and of files in recipes, which are
 * relative to `folder`, come out relative to `target`, as in the folder of a run. */
PENT_PLUGIN_API const char* pent_scene_text_for(const char* scene,
                                                const char* name,
                                                const char* folder,
                                                const char* target);

/** pent_open_text() of a text with such a name and folder. */
PENT_PLUGIN_API pent_simulation* pent_open_scene(const char* scene,
                                                 const char* name,
                                                 const char* folder,
                                                 const pent_mesh* meshes,
                                                 int64_t mesh_count,
                                                 int threads);

#ifdef __cplusplus
}
#endif

#endif
