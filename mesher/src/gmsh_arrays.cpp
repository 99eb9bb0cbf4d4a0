#include "gmsh_arrays.h"

#include <pent/counted.h>

#include <algorithm>
#include <numeric>

namespace pent::mesher {

namespace {

// Sorts tuples by their node or element; stably, so that of several tuples of one node the first in
// the file is the one that a search finds.
FileArray in_order(std::string name,
                   std::int64_t components,
                   const std::vector<std::int64_t>& numbers,
                   const std::vector<double>& values) {
    std::vector<std::size_t> order(numbers.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return numbers[a] < numbers[b]; });
    FileArray array{std::move(name), components, {}, std::vector<std::int64_t>()};
    for (const std::size_t tuple : order) {
        array.numbers->push_back(numbers[tuple]);
        const auto first = values.begin() + static_cast<std::ptrdiff_t>(tuple) * components;
        array.values.insert(array.values.end(), first, first + components);
    }
    return array;
}

}  // namespace

void GmshArrays::read(const std::string& section) {
    const Header header = read_header();
    Collected other;  // read, as the next section is behind it, but not kept
    Collected* place = place_for(header, section == "$NodeData" ? of_nodes_ : of_elements_);
    read_values(header, place == nullptr ? other : *place);
    const std::string end = "$End" + section.substr(1);
    if (text_.next_word(end) != end) {
        text_.fail("more or less than the " + counted(header.count, "value", "values")
                   + " that its head says; expected " + end);
    }
}

void GmshArrays::leave_out() {
    left_out_.push_back("array " + read_header().name
                        + ", of which a node has one value for each element");
}

void GmshArrays::finish(FileGrid& grid) {
    for (const bool is_of_nodes : {true, false}) {
        for (Collected& one : is_of_nodes ? of_nodes_ : of_elements_) {
            if (const std::size_t times = one.others.size(); times > 0) {
                left_out_.push_back("array " + one.name + " at "
                                    + counted(times, "other time", "other times"));
            }
            (is_of_nodes ? grid.point_arrays : grid.cell_arrays)
                .push_back(in_order(std::move(one.name), one.components, one.numbers, one.values));
        }
    }
    grid.left_out = std::move(left_out_);
}

// The head of an array is text in binary files, too: strings, of which the first is the name, real
// numbers, of which the first is the time, and whole ones.
GmshArrays::Header GmshArrays::read_header() {
    Header header;
    const std::int64_t strings = text_.count(text_.next_word("a count"), "a number of strings");
    for (std::int64_t i = 0; i < strings; ++i) {
        const std::string name = read_name();
        header.name = i == 0 ? name : header.name;
    }
    const std::int64_t reals = text_.count(text_.next_word("a count"), "a number of real numbers");
    for (std::int64_t i = 0; i < reals; ++i) {
        const double value = text_.number(text_.next_word("a real number"), "a real number");
        header.moment.second = i == 0 ? value : header.moment.second;
    }
    std::vector<std::int64_t> whole;
    const std::int64_t count = text_.count(text_.next_word("a count"), "a number of whole numbers");
    for (std::int64_t i = 0; i < count; ++i) {
        whole.push_back(text_.integer(text_.next_word("a whole number"), "a whole number"));
    }
    if (whole.size() < 3) {
        text_.fail(counted(whole.size(), "whole number", "whole numbers")
                   + "; expected 3 or more: the step, the numbers of a value, and how"
                     " many values there are");
    }
    header.moment.first = whole[0];
    header.components = text_.count(whole[1], "the numbers of a value");
    header.count = text_.count(whole[2], "the number of values");
    header.part = whole.size() > 3 ? whole[3] : 0;
    return header;
}

// A line, in quotes.
std::string GmshArrays::read_name() {
    if (!text_.next_line()) {
        text_.fail("the file ends here; expected a name in quotes");
    }
    std::string name;
    for (std::string_view word = text_.word(); !word.empty(); word = text_.word()) {
        name += (name.empty() ? "" : " ") + std::string(word);
    }
    std::erase(name, '"');
    return name;
}

// A new array, or one of which another partition has come before; null for what is left out.
GmshArrays::Collected* GmshArrays::place_for(const Header& header, std::vector<Collected>& all) {
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const Collected& one) { return one.name == header.name; });
    if (found == all.end()) {
        all.push_back({header.name, header.components, header.moment, {header.part}, {}, {}, {}});
        return &all.back();
    }
    if (found->moment != header.moment) {
        found->others.insert(header.moment);
        return nullptr;
    }
    if (found->components != header.components || !found->parts.insert(header.part).second) {
        left_out_.push_back("array " + header.name + ", a second one");
        return nullptr;
    }
    return &*found;
}

void GmshArrays::read_values(const Header& header, Collected& array) {
    for (std::int64_t i = 0; i < header.count; ++i) {
        array.numbers.push_back(numbers_.whole<std::int32_t>("a number of a node or element"));
        for (std::int64_t k = 0; k < header.components; ++k) {
            array.values.push_back(numbers_.quantity<double>("a value"));
        }
        if (numbers_.is_text() && !text_.word().empty()) {
            text_.fail("a line with more than a number and "
                       + counted(header.components, "value", "values"));
        }
    }
}

}  // namespace pent::mesher
