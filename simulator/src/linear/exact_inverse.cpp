#include "linear/factorization.h"
#include "linear/preconditioner.h"

#include <pent/dimensions.h>

#include <optional>
#include <utility>

namespace pent::simulator {

namespace {

template <int Dim>
class ExactInverse final : public Preconditioner<Dim> {
public:
    explicit ExactInverse(Factorization<Dim> factors) : factors_(std::move(factors)) {}

    double apply(const Workers& /*workers*/,
                 const BlockVector<Dim>& r,
                 BlockVector<Dim>& z) const override {
        z = factors_.solve(r);
        return r.cwiseProduct(z).sum();
    }

private:
    Factorization<Dim> factors_;
};

}  // namespace

template <int Dim, typename Scalar>
std::unique_ptr<Preconditioner<Dim>> exact_inverse(const BlockKernels& kernels,
                                                   const BlockMatrix<Dim, Scalar>& A,
                                                   const Elimination& elimination) {
    auto factors = Factorization<Dim>::make(kernels, A, elimination);
    return factors ? std::make_unique<ExactInverse<Dim>>(std::move(*factors)) : nullptr;
}

#define PENT_INSTANTIATE(Dim, Scalar)                            \
    template std::unique_ptr<Preconditioner<Dim>> exact_inverse( \
        const BlockKernels&, const BlockMatrix<Dim, Scalar>&, const Elimination&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, float)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE, double)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
