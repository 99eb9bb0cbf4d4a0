#pragma once

#include <string>
#include <vector>

namespace pent::study {

/// Where a program was run.
struct Machine {
    std::string node = {};       ///< Name of the computer.
    std::string processor = {};  ///< Model, as the system calls it.

    bool operator==(const Machine&) const = default;
};

/// The one that this program runs on.
[[nodiscard]] Machine this_machine();

/// The first "model name" of a text like /proc/cpuinfo; empty if there is none.
[[nodiscard]] std::string model_name(const std::string& cpuinfo);

/// What to say where times of several models of processors stand side by side, with the number of
/// runs on each; empty for one model.
[[nodiscard]] std::string mixture_warning(const std::vector<Machine>& runs);

}  // namespace pent::study
