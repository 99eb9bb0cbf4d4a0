#include "petsc_error.h"

#include <pent/error.h>

#include <string>

namespace pent::distributed {

void check(PetscErrorCode code) {
    if (code == 0) {
        return;
    }
    const char* text = nullptr;
    char* detail = nullptr;
    PetscErrorMessage(code, &text, &detail);
    std::string line = "PETSc: " + (text != nullptr ? std::string(text) : std::to_string(code));
    if (detail != nullptr && *detail != '\0') {
        line += ": " + std::string(detail);
    }
    throw Error(line);
}

}  // namespace pent::distributed
