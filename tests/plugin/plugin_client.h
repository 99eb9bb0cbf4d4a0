#ifndef PENT_TESTS_PLUGIN_CLIENT_H
#define PENT_TESTS_PLUGIN_CLIENT_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** What a host program in C saw of the plugin. */
struct plugin_sight {
    int version;
    int dimension;
    int bodies;
    int64_t vertices;
    int64_t cells;
    int last_step;       /**< What pent_step() returned last. */
    double height;       /**< y of vertex 0 at the end. */
    double time;         /**< Of the last report. */
    char bad_scene[512]; /**< Error of opening a scene that is not there. */
    char bad_body[512];  /**< Error of asking for body 99. */
};

/** Loads the library, takes steps of the scene, closes everything. 0, or -1 if a symbol is missing.
 * */
int drive_plugin(const char* library, const char* scene, int steps, struct plugin_sight* sight);

/** A host of version 1: what it is told where it opens a scene, or "" if it is not refused. */
void drive_version_1(const char* library, const char* scene, char* told, int size);

#ifdef __cplusplus
}
#endif

#endif
