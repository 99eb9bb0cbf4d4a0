#include "linear/preconditioner.h"

#include <Eigen/Cholesky>

#include <cmath>

namespace pent::simulator {

namespace {

// The modes of one vertex at arm x (from the middle of its aggregate, in units of its size): a
// column for each translation, then for each plane p < q the rotation e_q x_p - e_p x_q.
template <int Dim>
struct Modes {
    static constexpr int kCount = Dim * (Dim + 1) / 2;
    using Vector = Eigen::Matrix<double, Dim, 1>;
    using Coefficients = Eigen::Matrix<double, kCount, 1>;
    template <int Columns>
    using Rows = Eigen::Matrix<double, Dim, Columns>;

    // A P for a Dim x Dim block A.
    static Rows<kCount> times(const Rows<Dim>& A, const Vector& x) {
        Rows<kCount> product;
        product.template leftCols<Dim>() = A;
        int column = Dim;
        for (int p = 0; p < Dim; ++p) {
            for (int q = p + 1; q < Dim; ++q) {
                product.col(column++) = x[p] * A.col(q) - x[q] * A.col(p);
            }
        }
        return product;
    }

    // P^T T.
    template <int Columns>
    static Eigen::Matrix<double, kCount, Columns> transposed_times(const Rows<Columns>& T,
                                                                   const Vector& x) {
        Eigen::Matrix<double, kCount, Columns> product;
        product.template topRows<Dim>() = T;
        int row = Dim;
        for (int p = 0; p < Dim; ++p) {
            for (int q = p + 1; q < Dim; ++q) {
                product.row(row++) = x[p] * T.row(q) - x[q] * T.row(p);
            }
        }
        return product;
    }

    // P c.
    static Vector combined(const Coefficients& c, const Vector& x) {
        Vector sum = c.template head<Dim>();
        int k = Dim;
        for (int p = 0; p < Dim; ++p) {
            for (int q = p + 1; q < Dim; ++q, ++k) {
                sum[q] += c[k] * x[p];
                sum[p] -= c[k] * x[q];
            }
        }
        return sum;
    }
};

// Arms of all unknowns, Dim x unknowns.
template <int Dim>
BlockVector<Dim> make_arms(const Workers& workers,
                           const Aggregates& aggregates,
                           const BlockVector<Dim>& positions) {
    BlockVector<Dim> arms(Dim, positions.cols());
    workers.for_each(aggregates.count(), [&](int piece) {
        const auto& members = aggregates.members[static_cast<std::size_t>(piece)];
        Eigen::Matrix<double, Dim, 1> center = Eigen::Matrix<double, Dim, 1>::Zero();
        for (const std::uint32_t unknown : members) {
            center += positions.col(unknown);
        }
        center /= static_cast<double>(members.size());
        double spread = 0;
        for (const std::uint32_t unknown : members) {
            spread += (positions.col(unknown) - center).squaredNorm();
        }
        const double size = std::sqrt(spread / static_cast<double>(members.size()));
        for (const std::uint32_t unknown : members) {
            arms.col(unknown) = (positions.col(unknown) - center) / (size > 0 ? size : 1);
        }
    });
    return arms;
}

template <int Dim>
class RigidModes final : public Preconditioner<Dim> {
public:
    template <typename Scalar>
    RigidModes(const Workers& workers,
               const BlockMatrix<Dim, Scalar>& matrix,
               const Aggregates& aggregates,
               const BlockVector<Dim>& positions,
               std::unique_ptr<Preconditioner<Dim>> smoother)
        : aggregates_(&aggregates),
          arms_(make_arms(workers, aggregates, positions)),
          smoother_(std::move(smoother)) {
        const Eigen::Index size = kModes * aggregates.count();
        Eigen::MatrixXd half = Eigen::MatrixXd::Zero(size, size);
        workers.for_each(aggregates.count(), [&](int piece) {
            project(matrix, piece, half);
            if (matrix.coupling() != nullptr) {
                project(*matrix.coupling(), piece, half);
            }
        });
        Eigen::MatrixXd coarse = half + half.transpose();
        for (Eigen::Index k = 0; k < size; ++k) {
            // A mode that an aggregate does not have (rotations of a single vertex) is left out.
            coarse(k, k) = coarse(k, k) > 0 ? (1 + 1e-10) * coarse(k, k) : 1;
        }
        factors_.compute(coarse);
    }

    [[nodiscard]] bool is_usable() const { return factors_.info() == Eigen::Success; }

    [[nodiscard]] std::unique_ptr<Preconditioner<Dim>> take_smoother() {
        return std::move(smoother_);
    }

    void apply(const Workers& workers,
               const BlockVector<Dim>& r,
               BlockVector<Dim>& z) const override {
        smoother_->apply(workers, r, z);
        static_cast<void>(correct(workers, r, z));
    }

    bool correct(const Workers& workers,
                 const BlockVector<Dim>& r,
                 BlockVector<Dim>& x) const override {
        Eigen::VectorXd coarse(kModes * aggregates_->count());
        workers.for_each(aggregates_->count(), [&](int piece) {
            Coefficients sum = Coefficients::Zero();
            for (const std::uint32_t i : aggregates_->members[static_cast<std::size_t>(piece)]) {
                sum += Modes<Dim>::template transposed_times<1>(r.col(i), arms_.col(i));
            }
            coarse.template segment<kModes>(kModes * piece) = sum;
        });
        factors_.solveInPlace(coarse);
        workers.for_each(aggregates_->count(), [&](int piece) {
            const Coefficients part = coarse.template segment<kModes>(kModes * piece);
            for (const std::uint32_t i : aggregates_->members[static_cast<std::size_t>(piece)]) {
                x.col(i) += Modes<Dim>::combined(part, arms_.col(i));
            }
        });
        return true;
    }

private:
    static constexpr int kModes = Modes<Dim>::kCount;
    using Block = Eigen::Matrix<double, Dim, Dim>;
    using Coefficients = typename Modes<Dim>::Coefficients;
    using Product = typename Modes<Dim>::template Rows<kModes>;

    // The rows of one aggregate of P^T H P, where A = H + H^T: the stored triangle of A with its
    // diagonal halved. Products of a row with all vertices of an aggregate are added up first.
    template <typename Scalar>
    void project(const BlockMatrix<Dim, Scalar>& matrix, int piece, Eigen::MatrixXd& half) const {
        struct Part {
            std::uint32_t aggregate;
            Product product;
        };
        const BlockPattern& pattern = matrix.pattern();
        std::vector<Part> parts;
        for (const std::uint32_t row : aggregates_->members[static_cast<std::size_t>(piece)]) {
            parts.clear();
            for (std::int64_t k = pattern.row_start[row]; k < pattern.row_start[row + 1]; ++k) {
                const std::uint32_t column = pattern.columns[static_cast<std::size_t>(k)];
                const std::uint32_t aggregate = aggregates_->of_unknown[column];
                Block block = matrix.block(k).template cast<double>();
                if (column == row) {
                    block *= 0.5;
                }
                auto part = parts.begin();
                while (part != parts.end() && part->aggregate != aggregate) {
                    ++part;
                }
                if (part == parts.end()) {
                    part = parts.insert(part, {aggregate, Product::Zero()});
                }
                part->product += Modes<Dim>::times(block, arms_.col(column));
            }
            for (const Part& part : parts) {
                half.template block<kModes, kModes>(
                    kModes * piece, kModes * static_cast<Eigen::Index>(part.aggregate)) +=
                    Modes<Dim>::template transposed_times<kModes>(part.product, arms_.col(row));
            }
        }
    }

    const Aggregates* aggregates_;
    BlockVector<Dim> arms_;
    std::unique_ptr<Preconditioner<Dim>> smoother_;
    Eigen::LLT<Eigen::MatrixXd> factors_;
};

}  // namespace

template <int Dim, typename Scalar>
std::unique_ptr<Preconditioner<Dim>> with_rigid_modes(
    const Workers& workers,
    const BlockMatrix<Dim, Scalar>& matrix,
    const Aggregates& aggregates,
    const BlockVector<Dim>& positions,
    std::unique_ptr<Preconditioner<Dim>> smoother) {
    auto modes = std::make_unique<RigidModes<Dim>>(workers, matrix, aggregates, positions,
                                                   std::move(smoother));
    if (!modes->is_usable()) {
        return modes->take_smoother();
    }
    return modes;
}

#define PENT_INSTANTIATE(Dim, Scalar)                                       \
    template std::unique_ptr<Preconditioner<Dim>> with_rigid_modes(         \
        const Workers&, const BlockMatrix<Dim, Scalar>&, const Aggregates&, \
        const BlockVector<Dim>&, std::unique_ptr<Preconditioner<Dim>>);
PENT_INSTANTIATE(3, float)
PENT_INSTANTIATE(3, double)
PENT_INSTANTIATE(4, float)
PENT_INSTANTIATE(4, double)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
