#pragma once

#include <pent/simulator/step_report.h>

#include <string>
#include <vector>

namespace pent::runs {

/// Energies, momentum and angular momentum of steps as CSV: a header, and a line for each step. The
/// last of the energies is the sum of all that is kinetic or stored.
[[nodiscard]] std::string balance_table(const std::vector<simulator::StepReport>& steps,
                                        int dimension);

}  // namespace pent::runs
