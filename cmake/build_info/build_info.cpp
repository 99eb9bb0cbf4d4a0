#include "build_info.h"

#include "commit.h"  // written by write_commit.cmake at each build

namespace pent {

const char* build_info() {
    return "commit: " PENT_COMMIT
           "\n"
           "compiler: " PENT_COMPILER
           "\n"
           "features: " PENT_FEATURES;
}

}  // namespace pent
