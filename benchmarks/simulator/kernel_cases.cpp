#include "beams.h"
#include "cases.h"
#include "dense_oracle.h"
#include "linear/preconditioner.h"
#include "shaken_beam.h"
#include "step_work.h"

#include <pent/stopwatch.h>

#include <Eigen/SparseCore>

namespace pent::simulator::bench {

namespace {

using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;

Sparse both_triangles(const BlockMatrix<4, float>& matrix) {
    const BlockPattern& pattern = matrix.pattern();
    std::vector<Eigen::Triplet<double>> entries;
    for (std::int64_t row = 0; row < matrix.rows(); ++row) {
        const auto r = static_cast<std::size_t>(row);
        for (std::int64_t k = pattern.row_start[r]; k < pattern.row_start[r + 1]; ++k) {
            const std::int64_t column = pattern.columns[static_cast<std::size_t>(k)];
            for (int i = 0; i < 16; ++i) {
                const auto from = static_cast<int>(4 * row + i % 4);
                const auto to = static_cast<int>(4 * column + i / 4);
                const auto value = static_cast<double>(matrix.block(k)(i % 4, i / 4));
                entries.emplace_back(from, to, value);
                if (column != row) {
                    entries.emplace_back(to, from, value);
                }
            }
        }
    }
    Sparse sparse(4 * matrix.rows(), 4 * matrix.rows());
    sparse.setFromTriplets(entries.begin(), entries.end());
    return sparse;
}

// What the kernels of a report work on.
struct Bench {
    ShakenBeam beam;
    StepWork work;
    BlockMatrix<4, float> scratch{beam.pattern};
    BlockMatrix<4, double> wide_scratch{beam.pattern};
    BlockMatrix<4, float> matrix{beam.pattern};  // of a step: stiffness and masses
    Sparse sparse;
    BlockVector<4> x = BlockVector<4>::Ones(4, beam.pattern.rows());
    BlockVector<4> y = BlockVector<4>::Zero(4, beam.pattern.rows());
    Positions<4> forces = Positions<4>::Zero(4, beam.mesh.vertex_count());
    BlockVector<4> dof_positions{4, beam.pattern.rows()};
    std::unique_ptr<Hierarchy> hierarchy;
    std::unique_ptr<Preconditioner<4>> preconditioner;

    explicit Bench(ElementKind kind) : beam(bench::beam(), kind) {
        constexpr float kMass = 0.1F;  // kg: 1000 kg/m^4 times 0.1^4 m^4
        const Workers workers(1);
        beam.assemble(workers, kernels<4>(best_isa()), matrix);
        for (std::int64_t row = 0; row < matrix.rows(); ++row) {
            matrix.add_to_diagonal(row, kMass);
            dof_positions.col(row) =
                beam.positions.col(beam.dofs.vertex_of(static_cast<std::uint32_t>(row)));
        }
        if (kind == ElementKind::Linear) {
            sparse = both_triangles(matrix);
        }
        hierarchy = std::make_unique<Hierarchy>(
            make_hierarchy<4>(beam.pattern, beam.dofs.column_start(), dof_positions), beam.pattern);
        preconditioner = make_preconditioner(workers);
        work.size.vertices = beam.mesh.vertex_count();
        work.size.free_vertices = matrix.rows();
        work.size.elements = beam.elements->count();
        work.size.element_bytes = beam.elements->bytes();
        work.size.matrix_blocks = beam.pattern.blocks();
        work.flops = count_flops(kind);
        work.aggregate_blocks = static_cast<double>(hierarchy->levels[0].pattern.columns.size());
    }

    [[nodiscard]] std::unique_ptr<Preconditioner<4>> make_preconditioner(
        const Workers& workers) const {
        const BlockKernels& blocks = kernels<4>(best_isa()).blocks;
        return multilevel(workers, blocks, matrix, *hierarchy, dof_positions,
                          column_jacobi(workers, blocks, matrix, beam.dofs.column_start()));
    }
};

using SharedBench = std::shared_ptr<Bench>;

// Seconds of one call, from so many in a row.
template <typename Action>
double seconds_of(const Action& action, int calls = 1) {
    const Stopwatch watch;
    for (int i = 0; i < calls; ++i) {
        action();
    }
    return watch.seconds() / calls;
}

template <typename Scalar>
Case hessian_case(const SharedBench& bench, BlockMatrix<4, Scalar>& matrix, Isa isa, int threads) {
    constexpr bool kIsFloat = sizeof(Scalar) == sizeof(float);
    const auto elements = static_cast<double>(bench->beam.elements->count());
    const auto workers = std::make_shared<Workers>(threads);
    Case c{.name = std::string("projected Hessian and assembly, ")
                   + (kIsFloat ? "float, " : "double, ") + std::string(isa_name(isa)),
           .threads = threads,
           .unit = "element",
           .units = elements};
    c.run = [bench, isa, workers, &matrix] {
        return seconds_of([&] { bench->beam.assemble(*workers, kernels<4>(isa), matrix); });
    };
    if (kIsFloat && isa == best_isa()) {
        c.bound = [bench](const Ceilings& ceilings) {
            return least_seconds(bench->work.hessian(), ceilings);
        };
    }
    if (kIsFloat && isa == best_isa() && threads == 1) {
        constexpr Eigen::Index kSample = 1000;
        c.oracle = [bench] {
            return seconds_of([&] {
                static_cast<void>(oracle_hessians(bench->beam.mesh, bench->beam.material,
                                                  bench->beam.positions, kSample));
            });
        };
        c.oracle_factor = elements / kSample;
    }
    return c;
}

Case force_case(const SharedBench& bench, int threads) {
    const auto workers = std::make_shared<Workers>(threads);
    Case c{.name = "forces and energy, double",
           .threads = threads,
           .unit = "element",
           .units = static_cast<double>(bench->beam.elements->count())};
    c.run = [bench, workers] {
        return seconds_of([&] {
            static_cast<void>(bench->beam.elements->add_gradient(
                *workers, kernels<4>(best_isa()), bench->beam.positions, bench->forces));
        });
    };
    c.bound = [bench](const Ceilings& ceilings) {
        return least_seconds(bench->work.forces(), ceilings);
    };
    if (threads == 1) {
        c.oracle = [bench] {
            return seconds_of([&] {
                bench->forces =
                    oracle_forces(bench->beam.mesh, bench->beam.material, bench->beam.positions);
            });
        };
    }
    return c;
}

// Seconds of one of the calls in a row that an iterative solver makes. The first ones, which bring
// the matrix into the cache level by level, are left out, as they are of the ceilings.
template <typename Action>
double seconds_in_a_row(const Action& action) {
    constexpr int kCalls = 10;
    static_cast<void>(seconds_of(action, kCalls));
    return seconds_of(action, kCalls);
}

Case product_case(const SharedBench& bench, int threads) {
    const auto workers = std::make_shared<Workers>(threads);
    Case c{.name = "products in a row, float blocks",
           .threads = threads,
           .unit = "block",
           .units = static_cast<double>(bench->beam.pattern.blocks())};
    c.run = [bench, workers] {
        return seconds_in_a_row([&] {
            bench->matrix.multiply(*workers, kernels<4>(best_isa()).blocks, bench->x, bench->y);
        });
    };
    c.bound = [bench](const Ceilings& ceilings) {
        return least_seconds(bench->work.product(), ceilings);
    };
    if (threads == 1) {
        c.oracle = [bench] {
            return seconds_of([&] { bench->y.reshaped() = bench->sparse * bench->x.reshaped(); });
        };
    }
    return c;
}

Case apply_case(const SharedBench& bench, int threads) {
    const auto workers = std::make_shared<Workers>(threads);
    Case c{.name = "preconditioner, applied in a row", .threads = threads};
    c.run = [bench, workers] {
        return seconds_in_a_row(
            [&] { bench->preconditioner->apply(*workers, bench->x, bench->y); });
    };
    c.bound = [bench](const Ceilings& ceilings) {
        return least_seconds(bench->work.precondition(), ceilings);
    };
    return c;
}

Case setup_case(const SharedBench& bench, int threads) {
    const auto workers = std::make_shared<Workers>(threads);
    Case c{.name = "preconditioner, set up", .threads = threads};
    c.run = [bench, workers] {
        return seconds_of([&] { bench->preconditioner = bench->make_preconditioner(*workers); });
    };
    c.bound = [bench](const Ceilings& ceilings) {
        return least_seconds(bench->work.setup(), ceilings);
    };
    return c;
}

}  // namespace

std::vector<Case> kernel_cases(int threads) {
    const auto bench = std::make_shared<Bench>(ElementKind::Linear);
    std::vector<Case> cases;
    for (const Isa isa : {Isa::Scalar, Isa::Baseline, Isa::Avx2, Isa::Avx512}) {
        if (is_supported(isa)) {
            cases.push_back(hessian_case(bench, bench->scratch, isa, 1));
        }
    }
    cases.push_back(hessian_case(bench, bench->wide_scratch, best_isa(), 1));
    cases.push_back(hessian_case(bench, bench->scratch, best_isa(), threads));
    for (const int t : {1, threads}) {
        cases.push_back(force_case(bench, t));
        cases.push_back(product_case(bench, t));
        cases.push_back(setup_case(bench, t));
        cases.push_back(apply_case(bench, t));
    }
    // Per edge, of which a beam has fewer than cells, and with four times the blocks.
    const auto smoothed = std::make_shared<Bench>(ElementKind::Smoothed);
    for (const int t : {1, threads}) {
        cases.push_back(hessian_case(smoothed, smoothed->scratch, best_isa(), t));
        cases.back().name = "smoothed: " + cases.back().name;
        cases.back().oracle = nullptr;
        cases.push_back(product_case(smoothed, t));
        cases.back().name = "smoothed: " + cases.back().name;
        cases.back().oracle = nullptr;
    }
    return cases;
}

}  // namespace pent::simulator::bench
