#pragma once

#include "file_grid.h"
#include "number_reader.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pent::mesher {

/// A word in capitals: VTK knows keywords in any.
[[nodiscard]] std::string in_capitals(std::string_view word);

/// The arrays of points, cells and of the file in a legacy file of VTK, each behind a keyword.
class LegacyArrays {
public:
    LegacyArrays(TextReader& text, NumberReader& numbers) : text_(text), numbers_(numbers) {}

    /// Reads what stands behind a keyword, or skips what is no array.
    ///
    /// @param keyword  In capitals, as in "SCALARS".
    /// @param rows     Tuples of each array.
    /// @return         Whether it is one of the keywords of arrays.
    [[nodiscard]] bool read(const std::string& keyword,
                            std::int64_t rows,
                            std::vector<FileArray>& arrays);

    /// Skips the arrays of the file itself, behind FIELD.
    void skip_field();

    /// Skips names of components and the like, to an empty line.
    void skip_metadata();

    /// A number of things, which stands in a line of text in any case.
    [[nodiscard]] std::int64_t line_count();

    /// Bytes of a value of a type. Throws an Error for what has no fixed size.
    [[nodiscard]] std::size_t bytes_of(std::string_view type) const;

    /// The line behind the current one, which may have no word.
    std::string_view take_line();

private:
    [[nodiscard]] std::string next_name();
    [[nodiscard]] FileArray read_scalars(std::int64_t rows);
    void read_field(std::optional<std::int64_t> rows, std::vector<FileArray>& arrays);
    void skip_strings(std::int64_t count);
    void skip_lookup_table();
    [[nodiscard]] FileArray read_values(const std::string& name,
                                        std::int64_t components,
                                        std::int64_t rows,
                                        std::string_view type);
    [[nodiscard]] double value_of_type(const std::string& type);

    TextReader& text_;
    NumberReader& numbers_;
};

}  // namespace pent::mesher
