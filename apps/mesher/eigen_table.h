#pragma once

#include "common/program.h"

/// `pent-check --eigen`: the eigensystems of the elastic energies against numbers found in other
/// ways, in dimensions 2 to 8 whole and in 10, 30 and 100 by samples. Throws an Error if one does
/// not hold.
void prove_eigensystems(pent::apps::Program& program);
