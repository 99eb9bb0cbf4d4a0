#pragma once

#include "header.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pent {

/// One property of an element, and where its values lie in memory: the one of row i at
/// data + i * stride.
struct Column {
    std::string name;
    PlyType type = PlyType::Double;
    char* data = nullptr;
    std::size_t stride = 0;
};

/// Appends `rows` rows of these columns to `body`, in this order.
void encode_rows(std::string& body,
                 Encoding encoding,
                 const std::vector<Column>& columns,
                 std::uint64_t rows);

/// Throws an Error unless a body of so many bytes can have the rows that the header announces.
void check_counts(const Header& header, std::uint64_t bytes, const std::filesystem::path& path);

/// Throws an Error unless the body has the checksum that its header says.
void refuse_checksum(std::uint32_t found,
                     std::uint32_t expected,
                     const std::filesystem::path& path);

/// Reads the body of a .pent file element by element. Every failure is an Error that names the
/// file, the element and its index.
class BodyReader {
public:
    /// Checks the counts against the number of bytes, and the checksum of a binary body.
    BodyReader(const Header& header, std::string_view file, std::filesystem::path path);

    /// Reads the next element. Properties without a column are skipped; columns without a property
    /// are left as they are.
    ///
    /// @param in_front  How many rows of the element lie in front of these in the file: messages
    ///                  number rows as the file does.
    void read(const std::vector<Column>& columns, std::uint64_t in_front = 0);

    /// Skips the elements that are left and checks that nothing follows; the checksum of ascii.
    void finish();

private:
    [[noreturn]] void fail(const std::string& where, const std::string& what) const;
    void check_checksum() const;
    void read_binary(const PlyElement& element, const std::vector<Column>& columns);
    void read_ascii(const PlyElement& element,
                    const std::vector<Column>& columns,
                    std::uint64_t in_front);
    void skip_binary(const PlyElement& element);
    void skip_ascii(const PlyElement& element);

    const Header& header_;
    std::string_view body_;
    std::filesystem::path path_;
    std::size_t next_element_ = 0;
    std::size_t at_ = 0;
};

/// Whether an element of the file has this property; an Error if it has it with another type.
[[nodiscard]] bool has_property(const PlyElement& element,
                                std::string_view name,
                                PlyType type,
                                const std::filesystem::path& path);

/// The same of a vector: an Error if it has some of its components and not all.
///
/// @param prefix  What their names have in front of the axis.
/// @param what    What messages call it, as in "velocity".
[[nodiscard]] bool has_vector(const PlyElement& element,
                              int dimension,
                              std::string_view prefix,
                              std::string_view what,
                              const std::filesystem::path& path);

/// Puts header (with the body's checksum) and body into a file; returns the checksum. Throws an
/// Error for a created_by that a line has no room for.
///
/// @param body     Or a slab of it, of several writers.
/// @param writers  Null for one alone.
std::uint32_t write_file(const std::filesystem::path& path,
                         Header header,
                         const std::string& body,
                         const SlabWriters* writers = nullptr);

/// The columns of a field: its name alone, or with an axis behind it.
[[nodiscard]] std::vector<Column> field_columns(const VertexField& field);

/// Prefixes of the vectors of vertices that are no fields: positions, velocities, contact forces.
inline const std::vector<std::string_view> kVertexVectors = {"", "v", "f"};

/// A quantity, with room for its values, for every property of type double but those of known
/// vectors: a vector where the components of all axes follow one another, else a number.
///
/// @param prefixes  Of the known vectors: "" is for x, y and so on.
[[nodiscard]] std::vector<VertexField> fields_of(const PlyElement& element,
                                                 int dimension,
                                                 const std::vector<std::string_view>& prefixes);

/// Throws an Error unless fields have finite values, one or `dimension` for each of `count`.
///
/// @param of     What they are quantities of: "vertex".
/// @param first  The number of the first one, in messages.
void check_fields(const std::vector<VertexField>& fields,
                  int dimension,
                  Eigen::Index count,
                  std::string_view of,
                  const std::filesystem::path& path,
                  std::uint64_t first = 0);

/// Names of the components of vectors: each prefix with each axis behind it.
[[nodiscard]] std::set<std::string> axis_names(int dimension,
                                               const std::vector<std::string_view>& prefixes);

/// Throws an Error unless the names of fields are such that a file is read with the same fields.
///
/// @param reserved  Names of properties with another meaning.
/// @param of        What they are quantities of: "vertex".
void check_names(const std::vector<VertexField>& fields,
                 int dimension,
                 const std::set<std::string>& reserved,
                 std::string_view of,
                 const std::filesystem::path& path);

/// The element that these columns make.
[[nodiscard]] PlyElement make_element(std::string_view name,
                                      std::uint64_t count,
                                      const std::vector<Column>& columns);

/// One row of a matrix, which may be empty.
template <typename Value, int Rows>
[[nodiscard]] Column row_column(std::string name,
                                PlyType type,
                                const Eigen::Matrix<Value, Rows, Eigen::Dynamic>& values,
                                int row) {
    // Encoding only reads through the pointer; decoding is given arrays that are not const.
    auto* data = const_cast<Value*>(values.data());
    return {std::move(name), type, reinterpret_cast<char*>(data == nullptr ? data : data + row),
            Rows * sizeof(Value)};
}

/// Columns `names` of type double over the rows of a matrix of positions or velocities.
template <int Dim>
[[nodiscard]] std::vector<Column> vector_columns(const Positions<Dim>& values,
                                                 std::string_view prefix) {
    constexpr std::string_view kAxes = "xyzw";
    std::vector<Column> columns;
    for (int axis = 0; axis < Dim; ++axis) {
        columns.push_back(
            row_column(std::string(prefix) + kAxes[axis], PlyType::Double, values, axis));
    }
    return columns;
}

}  // namespace pent
