#pragma once

#include <pent/viewer/color.h>
#include <pent/viewer/section.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace pent::viewer {

/// One of the pictures side by side in a picture: the sections it shows, one, or with onion skin
/// all.
struct Tile {
    std::vector<std::size_t> sections;
    std::size_t solid = 0;  ///< The section that is not a ghost.
    std::string label;      ///< Empty in three dimensions.
};

/// A tile for each section, or one for all with the middle one solid.
[[nodiscard]] std::vector<Tile> make_tiles(const std::vector<Section>& sections,
                                           const SectionOptions& options,
                                           bool is_onion);

/// The color of a section that is a ghost, from teal (the first) to orange (the last); none for the
/// solid one.
[[nodiscard]] std::optional<Color> ghost_tint(const Tile& tile, std::size_t section);

}  // namespace pent::viewer
