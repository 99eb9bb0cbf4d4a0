#include <pent_plugin.h>
#include <pent_plugin_meshes.h>

/* The library that is there is the one of the headers. */
int main(void) {
    return pent_plugin_version() == PENT_PLUGIN_VERSION ? 0 : 1;
}
