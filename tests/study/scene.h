#pragma once

#include "support/kuhn_box.h"
#include "support/temp_folder.h"

#include <pent/pent_file.h>

#include <fstream>
#include <string>

namespace pent::study::test {

/// A scene file for a small bar, held at its left end, that bends under gravity; no contact.
inline std::filesystem::path write_bar(const pent::test::TempFolder& folder,
                                       const std::string& more = "") {
    write_mesh(folder / "bar.pent", pent::test::kuhn_box<4>({3, 1, 1, 1}, {1.5, 0.5, 0.5, 0.5}));
    std::ofstream(folder / "bar.toml") << R"([scene]
gravity = [0, -9.8, 0, 0]
frames = 4

[[body]]
name = "bar"
mesh = "bar.pent"

[[constraint]]
body = "bar"
select = { half_space = { normal = [1, 0, 0, 0], offset = 1e-6 } }
)" << more;
    return folder / "bar.toml";
}

}  // namespace pent::study::test
