#include "gmsh_arrays.h"
#include "number_reader.h"
#include "tet_readers.h"

#include <pent/counted.h>
#include <pent/formatted.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace pent::mesher {

namespace {

// Gmsh's number for a type of elements, what it is, and how many nodes it has. In all of them the
// corners come first.
struct ElementType {
    std::int64_t number;
    CellKind kind;
    std::int64_t nodes;
};

constexpr std::array kTypes = {
    ElementType{1, CellKind::Line, 2},
    ElementType{2, CellKind::Triangle, 3},
    ElementType{3, CellKind::Quadrilateral, 4},
    ElementType{4, CellKind::Tetrahedron, 4},
    ElementType{5, CellKind::Hexahedron, 8},
    ElementType{6, CellKind::Prism, 6},
    ElementType{7, CellKind::Pyramid, 5},
    ElementType{8, CellKind::Line, 3},
    ElementType{9, CellKind::Triangle, 6},
    ElementType{10, CellKind::Quadrilateral, 9},
    ElementType{11, CellKind::Tetrahedron, 10},
    ElementType{12, CellKind::Hexahedron, 27},
    ElementType{13, CellKind::Prism, 18},
    ElementType{14, CellKind::Pyramid, 14},
    ElementType{15, CellKind::Point, 1},
    ElementType{16, CellKind::Quadrilateral, 8},
    ElementType{17, CellKind::Hexahedron, 20},
    ElementType{18, CellKind::Prism, 15},
    ElementType{19, CellKind::Pyramid, 13},
    ElementType{20, CellKind::Triangle, 9},
    ElementType{21, CellKind::Triangle, 10},
    ElementType{22, CellKind::Triangle, 12},
    ElementType{23, CellKind::Triangle, 15},
    ElementType{24, CellKind::Triangle, 15},
    ElementType{25, CellKind::Triangle, 21},
    ElementType{26, CellKind::Line, 4},
    ElementType{27, CellKind::Line, 5},
    ElementType{28, CellKind::Line, 6},
    ElementType{29, CellKind::Tetrahedron, 20},
    ElementType{30, CellKind::Tetrahedron, 35},
    ElementType{31, CellKind::Tetrahedron, 56},
    ElementType{36, CellKind::Quadrilateral, 16},
    ElementType{37, CellKind::Quadrilateral, 25},
    ElementType{38, CellKind::Quadrilateral, 36},
    ElementType{90, CellKind::Prism, 40},
    ElementType{91, CellKind::Prism, 75},
    ElementType{92, CellKind::Hexahedron, 64},
    ElementType{93, CellKind::Hexahedron, 125},
    ElementType{94, CellKind::Hexahedron, 216},
    ElementType{106, CellKind::Prism, 126},
    ElementType{118, CellKind::Pyramid, 30},
    ElementType{119, CellKind::Pyramid, 55},
    ElementType{120, CellKind::Pyramid, 91},
};

const ElementType& type_of(const TextReader& text, std::int64_t number) {
    for (const ElementType& type : kTypes) {
        if (type.number == number) {
            return type;
        }
    }
    text.fail("elements of Gmsh's type " + std::to_string(number)
              + "; expected lines, triangles, quadrilaterals, tetrahedra, hexahedra, prisms and"
                " pyramids up to order 5");
}

// Nodes have numbers of their own, in any order and with gaps.
class Nodes {
public:
    explicit Nodes(FileGrid& grid) : grid_(grid) {}

    void add(const TextReader& text, std::int64_t number, const Eigen::Vector3d& point) {
        const auto name = static_cast<std::uint32_t>(grid_.soup.points.size());
        if (!names_.try_emplace(number, name).second) {
            text.fail("node " + std::to_string(number) + " is there twice");
        }
        grid_.soup.points.push_back(point);
        grid_.point_numbers.push_back(number);
    }

    [[nodiscard]] std::uint32_t name(const TextReader& text, std::int64_t number) const {
        const auto place = names_.find(number);
        if (place == names_.end()) {
            text.fail("node " + std::to_string(number) + " of an element is not in the file");
        }
        return place->second;
    }

private:
    FileGrid& grid_;
    std::map<std::int64_t, std::uint32_t> names_;
};

// Reads sections of either version, which differ in their order and in the size of whole numbers.
class GmshReader {
public:
    explicit GmshReader(const std::filesystem::path& path)
        : text_(path, '\0'),
          numbers_(text_, Encoding::Text),
          arrays_(text_, numbers_),
          nodes_(grid_) {
        grid_.soup.has_labels = true;
    }

    FileGrid read() {
        while (text_.next_line()) {
            const std::string section(text_.word());
            if (section == "$MeshFormat") {
                read_format();
            } else if (section == "$Comments") {
                skip_section("$EndComments");
                static_cast<void>(text_.next_line());
            } else if (version_ == 0) {
                text_.fail("no $MeshFormat at the start; expected a Gmsh file");
            } else if ((section == "$Entities" || section == "$PartitionedEntities")
                       && version_ == 4) {
                read_entities(section);
            } else if (section == "$Nodes") {
                version_ == 2 ? read_nodes_2() : read_nodes_4();
            } else if (section == "$Elements") {
                version_ == 2 ? read_elements_2() : read_elements_4();
            } else if (section == "$NodeData" || section == "$ElementData") {
                arrays_.read(section);
            } else if (section == "$ElementNodeData") {
                arrays_.leave_out();
                skip_section("$EndElementNodeData");
            } else if (section.starts_with("$") && !section.starts_with("$End")) {
                skip_section("$End" + section.substr(1));
            }
        }
        // Without groups volumes are told apart by their own numbers.
        std::vector<std::int64_t>& labels = grid_.soup.labels;
        if (std::all_of(labels.begin(), labels.end(),
                        [](std::int64_t group) { return group == 0; })) {
            labels = std::move(volumes_);
        }
        arrays_.finish(grid_);
        return std::move(grid_);
    }

private:
    void read_format() {
        const double version = text_.number(text_.next_word("a version"), "a version");
        if (!(version >= 2 && version <= 2.2) && version != 4.1) {  // 2.0 and 2.1 have fewer tags
            text_.fail(
                formatted("Gmsh version %g; expected 2.0 to 2.2 or 4.1: save it again with"
                          " gmsh -save -format msh41",
                          version));
        }
        version_ = version < 4 ? 2 : 4;
        const std::int64_t is_binary = text_.integer(text_.word(), "0 for text or 1 for binary");
        const std::int64_t size = text_.integer(text_.word(), "the size of numbers");
        if (is_binary == 0) {
            return;
        }
        if (size != 8) {
            text_.fail("numbers of " + counted(size, "byte", "bytes") + "; expected 8");
        }
        // The number 1, which tells the order of bytes.
        constexpr std::int64_t kSwapped = 1 << 24;
        numbers_.set_encoding(Encoding::LittleEndian);
        const std::int64_t one = number();
        if (one == kSwapped) {
            numbers_.set_encoding(Encoding::BigEndian);
        } else if (one != 1) {
            text_.fail("found " + std::to_string(one) + ", expected the number 1 of a binary file");
        }
    }

    // Searches for the end and not by lines, which some sections of a binary file do not have.
    void skip_section(const std::string& end) {
        const std::size_t at = text_.rest().find(end);
        if (at == std::string_view::npos) {
            text_.fail("the file ends here; expected " + end);
        }
        static_cast<void>(text_.take_bytes(at, end));
    }

    // In a text an element is a line; a row that is too long or too short shows here.
    void end_row() {
        if (numbers_.is_text() && !text_.word().empty()) {
            text_.fail("more words or fewer than the element before has");
        }
    }

    std::int64_t number() { return numbers_.whole<std::int32_t>("a whole number"); }
    std::int64_t count() { return numbers_.count<std::int32_t>("a count"); }
    std::int64_t long_number() { return numbers_.whole<std::uint64_t>("a whole number"); }
    std::int64_t long_count() { return numbers_.count<std::uint64_t>("a count"); }

    // The physical groups of the volumes: in version 4 elements name their entity alone, which in a
    // partitioned mesh is a part of a volume.
    void read_entities(const std::string& section) {
        constexpr std::size_t kVolume = 3;
        const bool has_parts = section == "$PartitionedEntities";
        if (has_parts) {
            static_cast<void>(long_number());  // of processes
            const std::int64_t ghosts = long_count();
            for (std::int64_t i = 0; i < 2 * ghosts; ++i) {
                static_cast<void>(number());
            }
        }
        std::array<std::int64_t, kVolume + 1> counts{};  // by dimension
        for (std::int64_t& entities : counts) {
            entities = long_count();
        }
        for (std::size_t dimension = 0; dimension < counts.size(); ++dimension) {
            for (std::int64_t i = 0; i < counts[dimension]; ++i) {
                const std::int64_t entity = number();
                if (has_parts) {
                    const std::int64_t whole_dimension = number();
                    const std::int64_t whole = number();
                    if (dimension == kVolume && whole_dimension == kVolume) {
                        wholes_[entity] = whole;
                    }
                    static_cast<void>(read_tags());  // which processes have it
                }
                for (int corner = 0; corner < (dimension == 0 ? 1 : 2); ++corner) {
                    static_cast<void>(numbers_.point<double>());  // of the box around it
                }
                const std::int64_t group = read_tags();
                if (dimension == kVolume && group != 0) {
                    groups_[entity] = group;
                }
                if (dimension > 0) {
                    static_cast<void>(read_tags());  // of what bounds it
                }
            }
        }
        const std::string end = "$End" + section.substr(1);
        if (text_.next_word(end) != end) {
            text_.fail(
                "more or less than the numbers of points, curves, surfaces and volumes say;"
                " expected "
                + end);
        }
    }

    // A count and so many tags: the first one, or 0. Their signs say which way they are turned.
    std::int64_t read_tags() {
        constexpr std::int64_t kLowest = -std::numeric_limits<std::int64_t>::max();
        std::int64_t first = 0;
        const std::int64_t tags = long_count();
        for (std::int64_t i = 0; i < tags; ++i) {
            const std::int64_t tag = number();
            first = i == 0 ? std::abs(std::max(tag, kLowest)) : first;
        }
        return first;
    }

    [[nodiscard]] std::int64_t group_of(std::int64_t volume) const {
        const auto found = groups_.find(volume);
        return found == groups_.end() ? 0 : found->second;
    }

    void read_nodes_2() {
        const std::int64_t count = text_.count(text_.next_word("a count"), "the number of nodes");
        for (std::int64_t i = 0; i < count; ++i) {
            const std::int64_t name = number();
            nodes_.add(text_, name, numbers_.point<double>());
        }
    }

    void read_elements_2() {
        const std::int64_t count =
            text_.count(text_.next_word("a count"), "the number of elements");
        std::int64_t done = 0;
        while (done < count) {
            if (numbers_.is_text()) {
                const std::int64_t element = number();
                const ElementType& type = type_of(text_, number());
                read_element_2(element, type, this->count());
                end_row();
                ++done;
                continue;
            }
            const ElementType& type = type_of(text_, number());
            const std::int64_t following = this->count();
            const std::int64_t tags = this->count();
            for (std::int64_t i = 0; i < following; ++i) {
                read_element_2(number(), type, tags);
            }
            done += std::max<std::int64_t>(following, 1);  // an end for damaged files, too
        }
    }

    void read_element_2(std::int64_t element, const ElementType& type, std::int64_t tags) {
        Place place;
        for (std::int64_t tag = 0; tag < tags; ++tag) {
            const std::int64_t value = number();
            place.group = tag == 0 ? value : place.group;
            place.entity = tag == 1 ? value : place.entity;
        }
        read_cell(element, type, place, [this] { return number(); });
    }

    void read_nodes_4() {
        const std::int64_t blocks = long_count();
        static_cast<void>(long_count());   // nodes in all
        static_cast<void>(long_number());  // lowest and highest number
        static_cast<void>(long_number());
        for (std::int64_t block = 0; block < blocks; ++block) {
            const std::int64_t dimension = number();
            static_cast<void>(number());  // of the entity
            const std::int64_t parameters = number() != 0 ? dimension : 0;
            const std::int64_t count = long_count();
            std::vector<std::int64_t> names;
            for (std::int64_t i = 0; i < count; ++i) {
                names.push_back(long_number());
            }
            for (const std::int64_t name : names) {
                nodes_.add(text_, name, numbers_.point<double>());
                for (std::int64_t i = 0; i < parameters; ++i) {
                    static_cast<void>(numbers_.real<double>("a parameter"));
                }
            }
        }
    }

    void read_elements_4() {
        const std::int64_t blocks = long_count();
        static_cast<void>(long_count());  // elements in all
        static_cast<void>(long_number());
        static_cast<void>(long_number());
        for (std::int64_t block = 0; block < blocks; ++block) {
            static_cast<void>(number());  // dimension
            const std::int64_t entity = number();
            const auto whole = wholes_.find(entity);
            const Place place{.group = group_of(entity),
                              .entity = whole == wholes_.end() ? entity : whole->second};
            const ElementType& type = type_of(text_, number());
            const std::int64_t count = long_count();
            for (std::int64_t i = 0; i < count; ++i) {
                read_cell(long_number(), type, place, [this] { return long_number(); });
                end_row();
            }
        }
    }

    // What an element is part of: a physical group, or 0 for none, and an entity of the geometry.
    struct Place {
        std::int64_t group = 0;
        std::int64_t entity = 0;
    };

    template <typename Next>
    void read_cell(std::int64_t element, const ElementType& type, const Place& place, Next next) {
        cell_.clear();
        for (std::int64_t i = 0; i < type.nodes; ++i) {
            const std::int64_t node = next();
            cell_.push_back(dimension_of(type.kind) == 3 ? nodes_.name(text_, node) : 0);
        }
        grid_.soup.add(type.kind, cell_, place.group);
        if (dimension_of(type.kind) == 3) {
            grid_.solid_cells.push_back(element);
            volumes_.push_back(place.entity);
        }
    }

    TextReader text_;
    NumberReader numbers_;
    GmshArrays arrays_;
    FileGrid grid_;
    Nodes nodes_;
    std::map<std::int64_t, std::int64_t> groups_;  // of volumes that are in one
    std::map<std::int64_t, std::int64_t> wholes_;  // of parts: the volume of each
    std::vector<std::int64_t> volumes_;            // one a cell of three dimensions
    std::vector<std::uint32_t> cell_;
    std::int64_t version_ = 0;  // 2 or 4
};

}  // namespace

FileGrid read_gmsh(const std::filesystem::path& path) {
    return GmshReader(path).read();
}

}  // namespace pent::mesher
