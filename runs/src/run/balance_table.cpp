#include "run/balance_table.h"

#include <pent/real_text.h>
#include <pent/simulator/motion.h>

namespace pent::runs {

namespace {

using simulator::StepReport;
using simulator::TermEnergy;

void add(std::string& line, double value) {
    char digits[32];
    const auto [end, error] = real_to_chars(digits, digits + sizeof digits, value);
    line.append(1, ',').append(digits, end);
}

std::string header(const StepReport& step, int dimension) {
    std::string line = "step,time,kinetic";
    for (const TermEnergy& term : step.energies.terms) {
        line += term.is_stored ? "," + term.name : "";
    }
    line += ",energy";
    for (int axis = 0; axis < dimension; ++axis) {
        line += std::string(",p") + "xyzw"[axis];
    }
    for (int from = 0; from < dimension; ++from) {
        for (int to = from + 1; to < dimension; ++to) {
            line += ",L" + simulator::plane_name({from, to});
        }
    }
    return line + "\n";
}

}  // namespace

std::string balance_table(const std::vector<StepReport>& steps, int dimension) {
    std::string text = steps.empty() ? "" : header(steps.front(), dimension);
    for (const StepReport& step : steps) {
        text += std::to_string(step.step);
        add(text, step.time);
        add(text, step.energies.kinetic);
        for (const TermEnergy& term : step.energies.terms) {
            if (term.is_stored) {
                add(text, term.energy);
            }
        }
        add(text, step.energies.total());
        for (const auto* parts : {&step.momentum, &step.angular_momentum}) {
            for (const double part : *parts) {
                add(text, part);
            }
        }
        text += '\n';
    }
    return text;
}

}  // namespace pent::runs
