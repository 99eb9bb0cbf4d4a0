#include "resume_table.h"

#include <pent/simulator/words.h>

#include <array>
#include <cstddef>
#include <set>
#include <tuple>

namespace pent::runs {

using namespace simulator;

namespace {

constexpr std::size_t kFactors = 8;

// A row as the place of each of its settings among those there are.
std::array<int, kFactors> levels(const ResumeRow& row) {
    return {static_cast<int>(row.integrator),
            row.contact ? 1 + static_cast<int>(*row.contact) : 0,
            row.friction > 0 ? 1 : 0,
            row.is_self ? 1 : 0,
            row.has_sleep ? 1 : 0,
            static_cast<int>(row.elements),
            static_cast<int>(row.model),
            row.dimension};
}

using Pair = std::tuple<std::size_t, int, std::size_t, int>;

std::set<Pair> pairs_of(const ResumeRow& row) {
    const auto at = levels(row);
    std::set<Pair> pairs;
    for (std::size_t a = 0; a < kFactors; ++a) {
        for (std::size_t b = a + 1; b < kFactors; ++b) {
            pairs.insert({a, at[a], b, at[b]});
        }
    }
    return pairs;
}

bool is_allowed(const ResumeRow& row) {
    if (row.elements == ElementKind::Quadratic && row.dimension == 4) {
        return false;  // sixteen times the cells: in 3D alone, for time
    }
    const bool has_barrier = row.contact == ContactModel::Barrier;
    return !(has_barrier && row.integrator == Integrator::LinearEuler)
           && !(row.has_sleep && row.integrator == Integrator::Quasistatic)
           && (row.contact || (row.friction == 0 && !row.is_self));
}

}  // namespace

std::string text_of(const ResumeRow& row) {
    return std::string(word_of(row.integrator)) + ", "
           + (row.contact ? std::string(word_of(*row.contact)) : "no contact")
           + (row.friction > 0 ? ", friction" : "") + (row.is_self ? ", self" : "")
           + (row.has_sleep ? ", sleep" : "") + ", " + std::string(word_of(row.elements)) + ", "
           + std::string(word_of(row.model)) + ", " + std::to_string(row.dimension) + "D";
}

std::vector<ResumeRow> every_row(int dimension) {
    std::vector<ResumeRow> rows;
    const std::array<std::optional<ContactModel>, 3> contacts = {
        std::nullopt, ContactModel::Penalty, ContactModel::Barrier};
    for (const auto& integrator : kWords<Integrator>) {
        for (const auto& contact : contacts) {
            for (const auto& elements : kWords<ElementKind>) {
                for (const auto& model : kWords<Model>) {
                    for (unsigned bits = 0; bits < 8; ++bits) {
                        const ResumeRow row{.integrator = integrator.value,
                                            .contact = contact,
                                            .friction = (bits & 1U) != 0 ? 0.4 : 0,
                                            .is_self = (bits & 2U) != 0,
                                            .has_sleep = (bits & 4U) != 0,
                                            .elements = elements.value,
                                            .model = model.value,
                                            .dimension = dimension};
                        if (is_allowed(row)) {
                            rows.push_back(row);
                        }
                    }
                }
            }
        }
    }
    return rows;
}

std::vector<ResumeRow> covering_rows(const std::vector<ResumeRow>& all) {
    std::set<Pair> missing;
    for (const ResumeRow& row : all) {
        missing.merge(pairs_of(row));
    }
    std::vector<ResumeRow> rows;
    while (!missing.empty()) {
        std::size_t most = 0;
        const ResumeRow* best = nullptr;
        for (const ResumeRow& row : all) {
            std::size_t count = 0;
            for (const Pair& pair : pairs_of(row)) {
                count += missing.count(pair);
            }
            if (count > most) {
                most = count;
                best = &row;
            }
        }
        for (const Pair& pair : pairs_of(*best)) {
            missing.erase(pair);
        }
        rows.push_back(*best);
    }
    return rows;
}

}  // namespace pent::runs
