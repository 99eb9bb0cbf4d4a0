#pragma once

#include <pent/simulator/scene.h>
#include <pent/simulator/words.h>

#include <algorithm>
#include <cassert>
#include <optional>
#include <string_view>
#include <vector>

namespace pent::simulator {

template <>
inline constexpr std::array kWords<Integrator> = {
    Word<Integrator>{Integrator::LinearEuler, "linear_euler"},
    Word<Integrator>{Integrator::NewtonEuler, "newton_euler"},
    Word<Integrator>{Integrator::Bdf2, "bdf2"},
    Word<Integrator>{Integrator::Quasistatic, "quasistatic"},
};
template <>
inline constexpr std::array kWords<ElementKind> = {
    Word<ElementKind>{ElementKind::Linear, "linear"},
    Word<ElementKind>{ElementKind::Smoothed, "smoothed"},
    Word<ElementKind>{ElementKind::Quadratic, "quadratic"},
};
template <>
inline constexpr std::array kWords<Filter> = {
    Word<Filter>{Filter::Clamp, "clamp"},
    Word<Filter>{Filter::Absolute, "absolute"},
    Word<Filter>{Filter::None, "none"},
};
template <>
inline constexpr std::array kWords<RestOffset> = {
    Word<RestOffset>{RestOffset::Keep, "keep"},
    Word<RestOffset>{RestOffset::Zero, "zero"},
};
template <>
inline constexpr std::array kWords<ContactModel> = {
    Word<ContactModel>{ContactModel::Penalty, "penalty"},
    Word<ContactModel>{ContactModel::Barrier, "barrier"},
};
template <>
inline constexpr std::array kWords<LinearSolverKind> = {
    Word<LinearSolverKind>{LinearSolverKind::Iterative, "cg"},
    Word<LinearSolverKind>{LinearSolverKind::Direct, "direct"},
};
template <>
inline constexpr std::array kWords<PreconditionerKind> = {
    Word<PreconditionerKind>{PreconditionerKind::BlockJacobi, "block-jacobi"},
    Word<PreconditionerKind>{PreconditionerKind::ColumnJacobi, "column-jacobi"},
    Word<PreconditionerKind>{PreconditionerKind::RigidModes, "rigid-modes"},
};
template <>
inline constexpr std::array kWords<Precision> = {
    Word<Precision>{Precision::Float, "float"},
    Word<Precision>{Precision::Double, "double"},
};

/// All values of an enumeration.
template <typename Value>
[[nodiscard]] std::vector<Value> values() {
    std::vector<Value> all;
    for (const Word<Value>& word : kWords<Value>) {
        all.push_back(word.value);
    }
    return all;
}

/// The words of an enumeration.
template <typename Value>
[[nodiscard]] std::vector<std::string_view> words() {
    std::vector<std::string_view> all;
    for (const Word<Value>& word : kWords<Value>) {
        all.push_back(word.word);
    }
    return all;
}

/// The place of a value among them.
template <typename Value>
[[nodiscard]] std::size_t place_of(Value value) {
    const auto found = std::find_if(kWords<Value>.begin(), kWords<Value>.end(),
                                    [&](const Word<Value>& word) { return word.value == value; });
    assert(found != kWords<Value>.end());
    return static_cast<std::size_t>(found - kWords<Value>.begin());
}

/// The word for a value.
template <typename Value>
[[nodiscard]] std::string_view word_of(Value value) {
    return kWords<Value>[place_of(value)].word;
}

/// The value that has a word; nothing if none has.
template <typename Value>
[[nodiscard]] std::optional<Value> value_of(std::string_view word) {
    const auto found = std::find_if(kWords<Value>.begin(), kWords<Value>.end(),
                                    [&](const Word<Value>& one) { return one.word == word; });
    return found == kWords<Value>.end() ? std::nullopt : std::optional(found->value);
}

}  // namespace pent::simulator
