#pragma once

#include <string>
#include <vector>

namespace pent::runs {

/// A key of scene files, as people read of it.
struct SchemaRow {
    std::string block;  ///< "[[body]]", "[contact]".
    std::string
        key;  ///< With those around and within it: "place.scale", "ball = { center, radius }".
    std::string values;    ///< Type, words, unit and range.
    std::string standard;  ///< Its default, or "required".
    std::string says;
    bool is_within =
        false;  ///< A key of a table that is the value of another: not in the docs' tables.
};

/// All keys, by blocks, as the schema has them.
[[nodiscard]] std::vector<SchemaRow> schema_rows();

/// ""friction" belongs to [contact]" for a key that other tables have, ""sleep" is a block of its
/// own, [sleep]" for a block; else "".
[[nodiscard]] std::string owners_text(const std::string& key);

}  // namespace pent::runs
