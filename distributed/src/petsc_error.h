#pragma once

#include <petscsys.h>

namespace pent::distributed {

/// Throws an Error with what PETSc says of a code other than 0.
void check(PetscErrorCode code);

}  // namespace pent::distributed
