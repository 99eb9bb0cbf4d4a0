#include "terminal.h"

#include <cstdlib>
#include <unistd.h>

namespace pent::apps {

namespace {

// Set by Open MPI, and by MPICH and its like.
bool is_rank() {
    return std::getenv("OMPI_COMM_WORLD_RANK") != nullptr || std::getenv("PMI_RANK") != nullptr;
}

}  // namespace

bool is_on_terminal() {
    return ::isatty(STDOUT_FILENO) == 1 && !is_rank();
}

}  // namespace pent::apps
