#ifndef PENT_TESTS_PLUGIN_CLIENT_H
#define PENT_TESTS_PLUGIN_CLIENT_H

#ifdef __cplusplus
extern "C" {
#endif

/// What a host program in C saw of the plugin.
struct plugin_sight {
    int version;
    int dimension;
    int bodies;
    long vertices;
    long cells;
    int last_step;       /**< What pent_step() returned last. */
    double height;       /**< y of vertex 0 at the end. */
    double time;         /**< Of the last report. */
    char bad_scene[512]; /**< Error of opening a scene that is not there. */
    char bad_body[512];  /**< Error of asking for body 99. */
};

/// Loads the library, takes steps of the scene, closes everything. 0, or -1 if a symbol is missing.
int drive_plugin(const char* library, const char* scene, int steps, struct plugin_sight* sight);

#ifdef __cplusplus
}
#endif

#endif
