#pragma once

#include "common/program.h"
#include "mesh_options.h"

namespace pent::apps {

/// Reads the moving mesh that the command line asks for, makes its space-time mesh, writes it and
/// says what it is.
void make_and_write_space_time(Program& program, const MeshArguments& arguments);

}  // namespace pent::apps
