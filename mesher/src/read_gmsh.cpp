#include "tet_readers.h"
#include "text_reader.h"

#include <map>
#include <string>

namespace pent::mesher {

namespace {

constexpr std::int64_t kTetrahedron = 4;  // Gmsh's number for the type
constexpr std::int64_t kTetrahedron10 = 11;

std::int64_t next_integer(TextReader& text) {
    return text.integer(text.next_word("a whole number"), "a whole number");
}

std::int64_t next_count(TextReader& text) {
    return text.count(text.next_word("a count"), "a count");
}

Eigen::Vector3d next_point(TextReader& text) {
    Eigen::Vector3d point;
    for (double& coordinate : point) {
        coordinate = text.number(text.next_word("a coordinate"), "a coordinate");
    }
    return point;
}

// Nodes have numbers of their own, in any order and with gaps.
class Nodes {
public:
    explicit Nodes(TetSoup& soup) : soup_(soup) {}

    void add(const TextReader& text, std::int64_t number, const Eigen::Vector3d& point) {
        const auto name = static_cast<std::uint32_t>(soup_.points.size());
        if (!names_.try_emplace(number, name).second) {
            text.fail("node " + std::to_string(number) + " is there twice");
        }
        soup_.points.push_back(point);
    }

    [[nodiscard]] std::uint32_t name(const TextReader& text, std::int64_t number) const {
        const auto place = names_.find(number);
        if (place == names_.end()) {
            text.fail("node " + std::to_string(number) + " of an element is not in the file");
        }
        return place->second;
    }

private:
    TetSoup& soup_;
    std::map<std::int64_t, std::uint32_t> names_;
};

bool is_tetrahedron(std::int64_t type) {
    return type == kTetrahedron || type == kTetrahedron10;
}

// The four corners come first, also in elements of higher order.
void add_tet(TextReader& text, const Nodes& nodes, std::int64_t label, TetSoup& soup) {
    std::array<std::uint32_t, 4> tet{};
    for (std::uint32_t& corner : tet) {
        corner = nodes.name(text, text.integer(text.word(), "a node"));
    }
    soup.tets.push_back(tet);
    soup.labels.push_back(label);
}

void read_nodes_2(TextReader& text, Nodes& nodes) {
    const std::int64_t count = next_count(text);
    for (std::int64_t i = 0; i < count; ++i) {
        const std::int64_t number = next_integer(text);
        const Eigen::Vector3d point = next_point(text);
        nodes.add(text, number, point);
    }
}

void read_elements_2(TextReader& text, const Nodes& nodes, TetSoup& soup) {
    const std::int64_t count = next_count(text);
    for (std::int64_t i = 0; i < count; ++i) {
        static_cast<void>(next_integer(text));  // the element's number
        const std::int64_t type = text.integer(text.word(), "the type of an element");
        const std::int64_t tags = text.count(text.word(), "the number of tags");
        std::int64_t label = 0;
        for (std::int64_t tag = 0; tag < tags; ++tag) {
            const std::int64_t value = text.integer(text.word(), "a tag");
            label = tag == 0 ? value : label;
        }
        if (is_tetrahedron(type)) {
            add_tet(text, nodes, label, soup);
        } else {
            text.skip_line();
        }
    }
}

void read_nodes_4(TextReader& text, Nodes& nodes) {
    const std::int64_t blocks = next_count(text);
    static_cast<void>(next_count(text));    // nodes in all
    static_cast<void>(next_integer(text));  // lowest and highest number
    static_cast<void>(next_integer(text));
    for (std::int64_t block = 0; block < blocks; ++block) {
        static_cast<void>(next_integer(text));  // dimension and number of the entity
        static_cast<void>(next_integer(text));
        const bool is_parametric = next_integer(text) != 0;
        const std::int64_t count = next_count(text);
        std::vector<std::int64_t> numbers;
        for (std::int64_t i = 0; i < count; ++i) {
            numbers.push_back(next_integer(text));
        }
        for (const std::int64_t number : numbers) {
            nodes.add(text, number, next_point(text));
            if (is_parametric) {
                text.skip_line();
            }
        }
    }
}

void read_elements_4(TextReader& text, const Nodes& nodes, TetSoup& soup) {
    const std::int64_t blocks = next_count(text);
    static_cast<void>(next_count(text));  // elements in all
    static_cast<void>(next_integer(text));
    static_cast<void>(next_integer(text));
    for (std::int64_t block = 0; block < blocks; ++block) {
        static_cast<void>(next_integer(text));  // dimension
        const std::int64_t entity = next_integer(text);
        const std::int64_t type = next_integer(text);
        const std::int64_t count = next_count(text);
        for (std::int64_t i = 0; i < count; ++i) {
            static_cast<void>(next_integer(text));  // the element's number
            if (is_tetrahedron(type)) {
                add_tet(text, nodes, entity, soup);
            }
            text.skip_line();
        }
    }
}

// The version, 2 or 4.
std::int64_t read_format(TextReader& text) {
    const double version = text.number(text.next_word("a version"), "a version");
    const std::int64_t is_binary = next_integer(text);
    if (is_binary != 0) {
        text.fail("a binary Gmsh file; expected text (gmsh -bin 0)");
    }
    if (version != 2.2 && version != 4.1) {
        text.fail("Gmsh version " + std::to_string(version) + "; expected 2.2 or 4.1");
    }
    return version == 2.2 ? 2 : 4;
}

}  // namespace

TetSoup read_gmsh(const std::filesystem::path& path) {
    TextReader text(path, '\0');
    TetSoup soup;
    Nodes nodes(soup);
    std::int64_t version = 0;
    while (text.next_line()) {
        const std::string_view section = text.word();
        if (section == "$MeshFormat") {
            version = read_format(text);
        } else if (section == "$Nodes" && version != 0) {
            version == 2 ? read_nodes_2(text, nodes) : read_nodes_4(text, nodes);
        } else if (section == "$Elements" && version != 0) {
            version == 2 ? read_elements_2(text, nodes, soup) : read_elements_4(text, nodes, soup);
        } else if (version == 0) {
            text.fail("no $MeshFormat at the start; expected a Gmsh file");
        }
    }
    return soup;
}

}  // namespace pent::mesher
