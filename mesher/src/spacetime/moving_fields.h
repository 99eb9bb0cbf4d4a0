#pragma once

#include <pent/mesher/moving_mesh.h>

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pent::mesher {

/// Gives quantities names by which a .pent file of four dimensions tells them apart.
class FieldNames {
public:
    /// @param reserved  Names of properties with another meaning.
    /// @param others    Names of quantities of the vertices, where these are of the cells: what
    ///                  shows both at vertices could not tell them apart.
    explicit FieldNames(std::set<std::string> reserved, std::set<std::string> others = {})
        : taken_(std::move(reserved)), others_(std::move(others)) {}

    /// The name with '_' for all but letters, digits and '_', and with as many more behind it as it
    /// takes until no other quantity has it, nor a property of one, with an axis or without.
    [[nodiscard]] std::string take(std::string_view name, bool is_vector);

private:
    [[nodiscard]] bool is_free(const std::string& name, bool is_vector) const;

    std::set<std::string> taken_;
    std::set<std::string> others_;
};

/// Whether a vector of cells with this name is the direction of fibers.
[[nodiscard]] bool is_fiber_name(std::string_view name);

/// Adds the values of one frame to a field; not where the first ones have other components.
void add_values(Eigen::MatrixXd values, MovingField& field);

/// Removes fields that lack the values of a frame.
///
/// @param kind  What messages call them: "array".
/// @return      What the line "left out" says of each.
[[nodiscard]] std::vector<std::string> remove_unfinished(std::vector<MovingField>& fields,
                                                         std::size_t frames,
                                                         const std::string& kind);

}  // namespace pent::mesher
