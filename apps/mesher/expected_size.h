#pragma once

#include "common/program.h"

#include <pent/mesher/make_body.h>

namespace pent::apps {

/// Throws an Error that asks for --yes where millions of cells or minutes of work are to be
/// expected, unless `yes`: then it says so. Large bodies, and long work, only where they are meant.
void ask_about_size(const Program& program, bool yes, const mesher::ExpectedSize& size, int dim);

}  // namespace pent::apps
