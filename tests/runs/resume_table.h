#pragma once

#include <pent/simulator/scene.h>

#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace pent::runs {

/// What decides which state a run carries from step to step: one row of the table.
struct ResumeRow {
    simulator::Integrator integrator = simulator::Integrator::LinearEuler;
    std::optional<simulator::ContactModel> contact;
    double friction = 0;
    bool is_self = false;
    bool has_sleep = false;
    simulator::ElementKind elements = simulator::ElementKind::Linear;
    simulator::Model model = simulator::Model::StableNeoHookean;
    int dimension = 3;
};

/// For messages: "bdf2, barrier, friction, self, sleep, smoothed, arap, 3D".
[[nodiscard]] std::string text_of(const ResumeRow& row);

inline void PrintTo(const ResumeRow& row, std::ostream* out) {
    *out << text_of(row);
}

/// Every combination that check() allows; quadratic elements in 3D alone.
[[nodiscard]] std::vector<ResumeRow> every_row(int dimension);

/// Rows such that every two settings that occur together in some row of `all` occur together in one
/// of these: each row is the first of those that have most pairs not yet seen.
[[nodiscard]] std::vector<ResumeRow> covering_rows(const std::vector<ResumeRow>& all);

}  // namespace pent::runs
