#pragma once

#include <pent/range.h>

#include <concepts>
#include <optional>
#include <string_view>
#include <type_traits>

namespace pent::simulator {

/// What is known of a key of a scene, beside the type and the default of its member: see
/// scene_schema.h.
struct Field {
    std::string_view key;
    std::string_view unit;
    std::string_view says;  ///< For people, as the docs have it.
    Range range;            ///< Of numbers, whole ones and entries of vectors.
    bool is_required = false;
    bool may_lack = false;      ///< Not written while it is empty, or infinite.
    bool is_direction = false;  ///< A vector of unit length; files may have it longer or shorter.
    std::optional<double> fallback = {};  ///< The default, where another value decides it.
    std::string_view default_says =
        {};                           ///< The default for people, where its value does not say it.
    bool does_apply = true;           ///< If not, it is neither read, checked nor written.
    std::string_view goes_with = {};  ///< What it takes to apply, as in `model = "arap"`.

    [[nodiscard]] constexpr Field required() const {
        Field field = *this;
        field.is_required = true;
        return field;
    }
    [[nodiscard]] constexpr Field may_be_missing() const {
        Field field = *this;
        field.may_lack = true;
        return field;
    }
    [[nodiscard]] constexpr Field direction() const {
        Field field = *this;
        field.is_direction = true;
        return field;
    }
    [[nodiscard]] constexpr Field otherwise(double value) const {
        Field field = *this;
        field.fallback = value;
        return field;
    }
    /// Of a key that other keys decide about, which stand before it.
    [[nodiscard]] constexpr Field only_with(bool does, std::string_view what) const {
        Field field = *this;
        field.does_apply = does;
        field.goes_with = what;
        return field;
    }
    [[nodiscard]] constexpr Field default_is(std::string_view text) const {
        Field field = *this;
        field.default_says = text;
        return field;
    }
};

[[nodiscard]] constexpr Field key(std::string_view name,
                                  std::string_view unit = "",
                                  std::string_view says = "",
                                  const Range& range = kAnyNumber) {
    return {.key = name, .unit = unit, .says = says, .range = range};
}

/// Whole numbers from one to another, both included.
[[nodiscard]] constexpr Range whole(double low, double high) {
    return {.low = low, .high = high};
}

template <typename Part, typename Of>
concept PartOf = std::same_as<std::remove_const_t<Part>, Of>;

}  // namespace pent::simulator
