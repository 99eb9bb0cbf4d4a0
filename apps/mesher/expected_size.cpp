// SPDX-License-Identifier: GPL-3.0-or-later

#include "expected_size.h"

#include "common/heartbeat.h"
#include "common/progress.h"

#include <pent/counted.h>
#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/simplex_mesh.h>

#include <string>

namespace pent::apps {

namespace {

// "3200", "1.25 million", "4.35 billion".
std::string readable_count(double count) {
    if (count < 1e6) {
        return formatted("%.0f", count);
    }
    return count < 1e9 ? formatted("%.3g million", count / 1e6)
                       : formatted("%.4g billion", count / 1e9);
}

}  // namespace

void ask_about_size(const Program& program, bool yes, const mesher::ExpectedSize& size, int dim) {
    constexpr double kManyCells = 5e6;
    constexpr double kLong = 60;  // s
    if (size.cells <= kManyCells && size.seconds <= kLong) {
        return;
    }
    const std::string layers = size.layers > 0 ? " (" + readable_count(size.base_cells)
                                                     + " cells of the base in "
                                                     + counted(size.layers, "layer", "layers") + ")"
                                               : "";
    const std::string text = "about " + readable_count(size.cells) + " "
                             + std::string(cell_name_plural(dim)) + layers + ", and about "
                             + readable_time(size.seconds) + " of work";
    if (!yes) {
        throw Error("this would make " + text
                          + "; ask for less by --edge-length, --surface-triangles, --layers or"
                            " --target-pentachora, or for all of it by --yes");
    }
    program.say("expected   " + text);
}

}  // namespace pent::apps
