#pragma once

#include "file_grid.h"
#include "number_reader.h"

#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace pent::mesher {

/// The values that a file of Gmsh has of its nodes and elements: each array in a section of its
/// own, or, in a partitioned mesh, in one section for each partition.
class GmshArrays {
public:
    GmshArrays(TextReader& text, NumberReader& numbers) : text_(text), numbers_(numbers) {}

    /// Reads what stands behind "$NodeData" or "$ElementData". Of an array with values at several
    /// times those of the first one in the file are kept.
    void read(const std::string& section);

    /// Reads the name behind "$ElementNodeData", whose values no vertex and no cell has: they are
    /// those of an element at each of its nodes.
    void leave_out();

    /// Gives what was read to a grid, whose points and cells have numbers.
    void finish(FileGrid& grid);

private:
    using Moment = std::pair<std::int64_t, double>;  // a step and its time

    // What stands in front of values.
    struct Header {
        std::string name;
        Moment moment = {};
        std::int64_t components = 0;
        std::int64_t count = 0;
        std::int64_t part = 0;
    };

    // An array, in the order of the file.
    struct Collected {
        std::string name;
        std::int64_t components = 0;
        Moment moment;
        std::set<std::int64_t> parts;       // partitions whose values are there
        std::set<Moment> others;            // times whose values are left out
        std::vector<std::int64_t> numbers;  // of the node or element of each tuple
        std::vector<double> values;
    };

    [[nodiscard]] Header read_header();
    [[nodiscard]] std::string read_name();
    [[nodiscard]] Collected* place_for(const Header& header, std::vector<Collected>& all);
    void read_values(const Header& header, Collected& array);

    TextReader& text_;
    NumberReader& numbers_;
    std::vector<Collected> of_nodes_;
    std::vector<Collected> of_elements_;
    std::vector<std::string> left_out_;
};

}  // namespace pent::mesher
