// SPDX-License-Identifier: GPL-3.0-or-later

#include "eigen_table.h"

#include "common/heartbeat.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/simulator/eigen_proof.h>

#include <array>

namespace {

using pent::formatted;
using pent::apps::Program;
using pent::simulator::EigenFunction;
using pent::simulator::EigenProof;
using pent::simulator::UndefinedModes;

constexpr std::array kSmall = {2, 3, 4, 5, 6, 7, 8};
constexpr std::array kLarge = {10, 30, 100};
constexpr int kDimensions = kSmall.size() + kLarge.size();

// GCOVR_EXCL_START: proofs up to dimension 100 take longer than a test may; their parts are tested
nlohmann::ordered_json to_json(const std::string& function, const EigenProof& proof) {
    nlohmann::ordered_json undefined = nlohmann::ordered_json::object();
    for (const UndefinedModes& entry : proof.undefined) {
        undefined[entry.state] = entry.modes;
    }
    return {{"function", function},
            {"dimension", proof.dim},
            {"states", proof.states},
            {"modes", proof.modes},
            {"values", proof.values},
            {"residual", proof.residual},
            {"orthogonality", proof.orthogonality},
            {"trace", proof.trace},
            {"undefined", undefined},
            {"holds", proof.holds()}};
}

// One line for a function in several dimensions.
template <typename Dimensions>
EigenProof prove(Program& program,
                 const EigenFunction& function,
                 const Dimensions& dimensions,
                 const char* range) {
    const std::string name = eigen_function_name(function);
    EigenProof all;
    pent::apps::Heartbeat heartbeat(program.common().quiet);
    for (const int dim : dimensions) {
        heartbeat.begin(formatted("%s in dimension %d", name.c_str(), dim));
        const EigenProof proof = prove_eigensystem(function, dim);
        program.report()["eigensystems"].push_back(to_json(name, proof));
        all.merge(proof);
    }
    const std::string values =
        all.dim <= kSmall.back() ? formatted("%9.0e", all.values) : "        -";
    program.say(formatted("  %-20s  %-11s  %6d  %6lld  %s  %9.0e  %9.0e  %9.0e", name.c_str(),
                          range, all.states,
                          static_cast<long long>(all.modes),  // NOLINT(google-runtime-int)
                          values.c_str(), all.residual, all.orthogonality, all.trace));
    if (!all.holds()) {
        throw pent::Error("the eigensystem of " + name + " does not hold; see the table");
    }
    return all;
}

}  // namespace

void prove_eigensystems(Program& program) {
    program.say(
        "The second derivative H of each function of the n x n matrix F has n^2 eigenvalues, known "
        "in\n"
        "formulas of the singular values sigma of F. Here they are held against numbers found "
        "without\n"
        "them; the largest error of all, relative:\n\n"
        "  values    eigenvalues against those a dense eigensolver finds in the n^2 x n^2 matrix\n"
        "  H q       eigenpairs: |H q - lambda q|, H q by minors of F, Cauchy's integral over "
        "complex\n"
        "            F, the Lyapunov equation of F = R S, and the product rule\n"
        "  q . q'    eigenmatrices: of norm 1 and orthogonal to one another\n"
        "  trace     the eigenvalues add up to the trace of H\n\n"
        "F is tried with distinct sigma, at rest, with repeated ones, one zero, two zeros, "
        "inverted,\n"
        "inverted with sigma_i + sigma_j = 0, and with a huge one. Above n = 8 modes are "
        "sampled.\n\n"
        "  function              n            states   modes     values        H q     q . q'      "
        "trace");
    std::string undefined;
    for (const EigenFunction& function : pent::simulator::eigen_functions()) {
        EigenProof all = prove(program, function, kSmall, "2 to 8");
        all.merge(prove(program, function, kLarge, "10, 30, 100"));
        for (const auto& [state, modes] : all.undefined) {
            undefined += formatted("\n  %-6s %-24s %3d modes in %d dimensions",
                                   eigen_function_name(function).c_str(), state.c_str(),
                                   static_cast<int>(modes), kDimensions);
        }
    }
    program.say(
        "\nUndefined, and left out above: the rotation R of F = R S is not unique where two "
        "singular\n"
        "values add up to zero; the twist of their plane then has no eigenvalue (taken as 0):"
        + undefined + "\n\nfinished: all hold to rounding");
}
// GCOVR_EXCL_STOP
