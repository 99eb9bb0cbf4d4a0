#include "tile.h"

#include <numeric>

namespace pent::viewer {

std::vector<Tile> make_tiles(const std::vector<Section>& sections,
                             const SectionOptions& options,
                             bool is_onion) {
    std::vector<Tile> tiles;
    if (!is_onion || sections.size() < 2) {
        for (std::size_t section = 0; section < sections.size(); ++section) {
            tiles.push_back({{section}, section, sections[section].label});
        }
        return tiles;
    }
    Tile all;
    all.sections.resize(sections.size());
    std::iota(all.sections.begin(), all.sections.end(), std::size_t{0});
    all.solid = sections.size() / 2;
    all.label = sections[all.solid].label + ", ghosts " + span_label(options);
    return {all};
}

std::optional<Color> ghost_tint(const Tile& tile, std::size_t section) {
    if (section == tile.solid) {
        return std::nullopt;
    }
    return map_color(ColorMap::Diverging,
                     static_cast<double>(section) / static_cast<double>(tile.sections.size() - 1));
}

}  // namespace pent::viewer
