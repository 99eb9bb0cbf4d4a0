#pragma once

#include <cstdint>

namespace pent::contact {

/// What becomes of negative eigenvalues of a Hessian.
enum class Filter : std::uint8_t {
    Clamp,     ///< They are set to 0.
    Absolute,  ///< They are replaced by their absolute values [chen2024].
    None,      ///< Nothing: the Hessian may be indefinite.
};

}  // namespace pent::contact
