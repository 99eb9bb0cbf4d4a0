#pragma once

#include <pent/mesher/body_request.h>

namespace pent::mesher {

/// Throws an Error for numbers that no body can have, and for options that go with no other.
///
/// @param dim  Of the body: 3 or 4.
void check_request(const BodyRequest& request, int dim);

// Each of these throws an Error if an option is set that the input would silently ignore.

/// For inputs that are the body already.
void refuse_extrusion(const BodyRequest& request);

/// For inputs that are cells already.
void refuse_filling(const BodyRequest& request);

/// For inputs of which nothing is mended.
void refuse_repair(const BodyRequest& request);

/// For inputs without a surface that tetrahedra fill.
void refuse_generator(const BodyRequest& request);

}  // namespace pent::mesher
