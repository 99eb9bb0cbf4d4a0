#include "tet_readers.h"

#include <pent/text_reader.h>

#include <array>
#include <string>

namespace pent::mesher {

// HOBAK: "v x y z" and "t a b c d" lines, 0-based.
CellSoup read_tobj(const std::filesystem::path& path) {
    TextReader text(path);
    CellSoup soup;
    while (text.next_line()) {
        const std::string_view keyword = text.word();
        if (keyword == "v") {
            soup.points.push_back(text.point());
        } else if (keyword == "t") {
            std::array<std::uint32_t, 4> tet{};
            for (std::uint32_t& corner : tet) {
                corner = text.index(text.word(), static_cast<std::int64_t>(soup.points.size()));
            }
            soup.add(CellKind::Tetrahedron, tet);
        } else {
            text.fail("\"" + std::string(keyword) + "\"; expected a line of v or t");
        }
    }
    return soup;
}

}  // namespace pent::mesher
