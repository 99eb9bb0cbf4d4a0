#pragma once

#include "simulator_names.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <string_view>
#include <vector>

namespace pent::runs {

/// The words of scene files for the values of enumerations; the reader and the writer share them.
template <typename Value>
struct Name {
    Value value;
    std::string_view word;
};

inline constexpr std::array kModels = {
    Name<Model>{Model::StableNeoHookean, "stable-neo-hookean"},
    Name<Model>{Model::Arap, "arap"},
    Name<Model>{Model::StVenantKirchhoff, "st-venant-kirchhoff"},
    Name<Model>{Model::Linear, "linear"},
};
inline constexpr std::array kIntegrators = {
    Name<Integrator>{Integrator::LinearEuler, "linear_euler"},
    Name<Integrator>{Integrator::NewtonEuler, "newton_euler"},
    Name<Integrator>{Integrator::Bdf2, "bdf2"},
    Name<Integrator>{Integrator::Quasistatic, "quasistatic"},
};
inline constexpr std::array kElementKinds = {
    Name<ElementKind>{ElementKind::Linear, "linear"},
    Name<ElementKind>{ElementKind::Smoothed, "smoothed"},
};
inline constexpr std::array kFilters = {
    Name<Filter>{Filter::Clamp, "clamp"},
    Name<Filter>{Filter::Absolute, "absolute"},
    Name<Filter>{Filter::None, "none"},
};
inline constexpr std::array kContactModels = {
    Name<ContactModel>{ContactModel::Penalty, "penalty"},
    Name<ContactModel>{ContactModel::Barrier, "barrier"},
};
inline constexpr std::array kLinearSolvers = {
    Name<LinearSolverKind>{LinearSolverKind::Iterative, "cg"},
    Name<LinearSolverKind>{LinearSolverKind::Direct, "direct"},
};
inline constexpr std::array kPreconditioners = {
    Name<PreconditionerKind>{PreconditionerKind::BlockJacobi, "block-jacobi"},
    Name<PreconditionerKind>{PreconditionerKind::ColumnJacobi, "column-jacobi"},
    Name<PreconditionerKind>{PreconditionerKind::RigidModes, "rigid-modes"},
};
inline constexpr std::array kPrecisions = {
    Name<Precision>{Precision::Float, "float"},
    Name<Precision>{Precision::Double, "double"},
};

enum class Preset { Fast, Balanced, Accurate };

inline constexpr std::array kPresets = {
    Name<Preset>{Preset::Fast, "fast"},
    Name<Preset>{Preset::Balanced, "balanced"},
    Name<Preset>{Preset::Accurate, "accurate"},
};

/// The settings a preset stands for. docs/accuracy.md has the measurements behind them.
[[nodiscard]] inline SolverOptions preset(Preset choice) {
    SolverOptions solver;
    switch (choice) {
        case Preset::Fast:
            solver.tolerance = 1e-2;
            break;
        case Preset::Balanced:
            break;
        case Preset::Accurate:
            solver.integrator = Integrator::Bdf2;
            break;
    }
    return solver;
}

/// The place of a value in a table.
template <typename Table, typename Value>
[[nodiscard]] std::size_t place_of(const Table& table, Value value) {
    std::size_t place = 0;
    while (table[place].value != value) {
        ++place;
    }
    return place;
}

/// The words of a table, in its order.
template <typename Table>
[[nodiscard]] std::vector<std::string_view> names_of(const Table& table) {
    std::vector<std::string_view> words;
    words.reserve(table.size());
    for (const auto& name : table) {
        words.push_back(name.word);
    }
    return words;
}

/// The word for a value, which is in the table.
template <typename Table, typename Value>
[[nodiscard]] std::string_view word_of(const Table& table, Value value) {
    const auto found = std::find_if(table.begin(), table.end(),
                                    [&](const auto& name) { return name.value == value; });
    assert(found != table.end());
    return found->word;
}

}  // namespace pent::runs
