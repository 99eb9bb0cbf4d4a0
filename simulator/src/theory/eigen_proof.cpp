#include "theory/eigen_oracle.h"

#include <pent/simulator/words.h>

#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>
#include <random>
#include <utility>

namespace pent::simulator {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Rotation drawn at random: the orthogonal factor of a matrix of normal deviates.
MatrixXd random_rotation(Index n, std::mt19937& random) {
    std::normal_distribution<double> normal;
    const MatrixXd any = MatrixXd::NullaryExpr(n, n, [&]() { return normal(random); });
    MatrixXd Q = Eigen::HouseholderQR<MatrixXd>(any).householderQ();
    if (Q.determinant() < 0) {
        Q.col(0) *= -1;
    }
    return Q;
}

struct State {
    std::string name;
    VectorXd sigma;
};

// Kinds of singular values at which formulas may fail. Those not named are near 1, so that products
// of a hundred of them neither vanish nor overflow.
std::vector<State> states(Index n) {
    const double spread = n <= 8 ? 0.6 : 0.05;
    const VectorXd distinct = VectorXd::LinSpaced(n, 1 + spread, 1 - spread);
    std::vector<State> list(8, {"", distinct});
    list[0].name = "distinct";
    list[1].name = "rest";
    list[1].sigma.setOnes();
    list[2].name = "repeated";
    list[2].sigma.head(2).setConstant(1.2);
    list[3].name = "one zero";
    list[3].sigma[n - 1] = 0;
    list[4].name = "two zeros";
    list[4].sigma.tail(2).setZero();
    list[5].name = "inverted";
    list[5].sigma[n - 1] = -0.3;
    list[6].name = "sigma_i + sigma_j = 0";
    list[6].sigma[n - 2] = 0.3;
    list[6].sigma[n - 1] = -0.3;
    list[7].name = "huge";
    list[7].sigma[0] = 1e4;
    return list;
}

HessianFrame claimed(const EigenFunction& function, const MatrixXd& F) {
    if (const auto* which = std::get_if<Invariant>(&function)) {
        return invariant_hessian(*which, F);
    }
    return hessian(proof_material(std::get<Model>(function)), F);
}

}  // namespace

std::string eigen_function_name(const EigenFunction& function) {
    if (const auto* which = std::get_if<Invariant>(&function)) {
        return *which == Invariant::I1 ? "I1" : *which == Invariant::I2 ? "I2" : "I3";
    }
    return std::string(word_of(std::get<Model>(function)));
}

std::vector<EigenFunction> eigen_functions() {
    std::vector<EigenFunction> all = {Invariant::I1, Invariant::I2, Invariant::I3};
    for (const Model model : values<Model>()) {
        all.emplace_back(model);
    }
    return all;
}

bool EigenProof::holds() const {
    constexpr double kRounding = 1e-10;
    return larger_error(larger_error(values, residual), larger_error(orthogonality, trace))
           < kRounding;
}

void EigenProof::merge(const EigenProof& other) {
    dim = std::max(dim, other.dim);
    states += other.states;
    modes += other.modes;
    values = larger_error(values, other.values);
    residual = larger_error(residual, other.residual);
    orthogonality = larger_error(orthogonality, other.orthogonality);
    trace = larger_error(trace, other.trace);
    for (const UndefinedModes& theirs : other.undefined) {
        const auto ours = std::find_if(undefined.begin(), undefined.end(), [&](const auto& entry) {
            return entry.state == theirs.state;
        });
        if (ours == undefined.end()) {
            undefined.push_back(theirs);
        } else {
            ours->modes += theirs.modes;
        }
    }
}

EigenProof prove_eigensystem(const EigenFunction& function, int dim) {
    std::mt19937 random(static_cast<unsigned>(dim));
    EigenProof proof;
    for (const State& state : states(dim)) {
        const MatrixXd F = random_rotation(dim, random) * state.sigma.asDiagonal()
                           * random_rotation(dim, random).transpose();
        compare(function, F, claimed(function, F), state.name, proof);
    }
    return proof;
}

}  // namespace pent::simulator
