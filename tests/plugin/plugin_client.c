#include "plugin_client.h"

#include <dlfcn.h>
#include <pent_plugin.h>
#include <stdio.h>
#include <string.h>

typedef int (*version_function)(void);
typedef const char* (*error_function)(void);
typedef pent_simulation* (*open_function)(const char*, int);
typedef int (*close_function)(pent_simulation*);
typedef int (*count_function)(const pent_simulation*);
typedef int64_t (*size_function)(const pent_simulation*, int);
typedef const double* (*array_function)(const pent_simulation*, int);
typedef int (*step_function)(pent_simulation*, pent_step_report*);

/* dlsym gives an object pointer where a function pointer is meant: copied, not cast. */
static int find(void* library, const char* name, void* function) {
    void* symbol = dlsym(library, name);
    memcpy(function, &symbol, sizeof symbol);
    return symbol != NULL;
}

int drive_plugin(const char* library, const char* scene, int steps, struct plugin_sight* sight) {
    version_function version = NULL;
    error_function last_error = NULL;
    open_function open_scene = NULL;
    close_function close_scene = NULL;
    count_function dimension = NULL;
    count_function bodies = NULL;
    size_function vertices = NULL;
    size_function cells = NULL;
    array_function positions = NULL;
    step_function step = NULL;
    void* handle = dlopen(library, RTLD_NOW | RTLD_LOCAL);
    if (handle == NULL || !find(handle, "pent_plugin_version", &version)
        || !find(handle, "pent_last_error", &last_error)
        || !find(handle, "pent_open_file", &open_scene) || !find(handle, "pent_close", &close_scene)
        || !find(handle, "pent_dimension", &dimension) || !find(handle, "pent_body_count", &bodies)
        || !find(handle, "pent_vertex_count", &vertices) || !find(handle, "pent_cell_count", &cells)
        || !find(handle, "pent_positions", &positions) || !find(handle, "pent_step", &step)) {
        return -1;
    }
    sight->version = version();
    if (open_scene("/no/such/scene.toml", 1) == NULL) {
        snprintf(sight->bad_scene, sizeof sight->bad_scene, "%s", last_error());
    }
    pent_simulation* simulation = open_scene(scene, 2);
    if (simulation == NULL) {
        return -1;
    }
    sight->dimension = dimension(simulation);
    sight->bodies = bodies(simulation);
    sight->vertices = vertices(simulation, 0);
    sight->cells = cells(simulation, 0);
    if (positions(simulation, 99) == NULL) {
        snprintf(sight->bad_body, sizeof sight->bad_body, "%s", last_error());
    }
    pent_step_report report = {0};
    for (int i = 0; i < steps; ++i) {
        sight->last_step = step(simulation, &report);
    }
    sight->time = report.time;
    sight->height = positions(simulation, 0)[1];
    close_scene(simulation);
    return 0;
}

void drive_version_1(const char* library, const char* scene, char* told, int size) {
    error_function last_error = NULL;
    open_function open_scene = NULL;
    void* handle = dlopen(library, RTLD_NOW | RTLD_LOCAL);
    told[0] = 0;
    if (handle != NULL && find(handle, "pent_last_error", &last_error)
        && find(handle, "pent_open", &open_scene) && open_scene(scene, 1) == NULL) {
        snprintf(told, (size_t)size, "%s", last_error());
    }
}
