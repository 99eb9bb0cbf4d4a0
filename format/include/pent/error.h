#pragma once

#include <stdexcept>

namespace pent {

/// Something from outside is not as it must be: a file, an option, a scene, a full disk.
///
/// The text is one line: where (file, element, line), what was found, what was expected or what to
/// do. Programs print it and exit with 1. Our own mistakes are asserts, never an Error.
class Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace pent
