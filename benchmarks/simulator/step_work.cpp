#include "step_work.h"

namespace pent::simulator::bench {

namespace {

constexpr double kVector = 4 * sizeof(double);  // of a vertex
constexpr double kBlock = 16 * sizeof(float);
constexpr double kColumn = sizeof(std::uint32_t);     // of a block
constexpr double kCoarseBlock = 100 * sizeof(float);  // 10 modes of one aggregate by another

}  // namespace

Work StepWork::forces() const {
    const auto elements = static_cast<double>(size.elements);
    constexpr double kElement = 17 * sizeof(double) + 5 * sizeof(std::uint32_t);
    return {.double_flops = elements * flops.forces,
            .bytes = elements * kElement + 3 * kVector * static_cast<double>(size.vertices)};
}

Work StepWork::hessian() const {
    // A block is set to zero, read and written.
    return {.float_flops = static_cast<double>(size.elements) * flops.hessian,
            .bytes = static_cast<double>(size.element_bytes)
                     + 3 * kBlock * static_cast<double>(size.matrix_blocks)};
}

Work StepWork::setup() const {
    const auto rows = static_cast<double>(size.free_vertices);
    const auto blocks = static_cast<double>(size.matrix_blocks);
    // A block times 10 modes: 4 columns as they are, 6 rotations of 3 operations an entry, and the
    // sum.
    constexpr double kProjection = 6 * 4 * 3 + 40;
    // A row: 10 modes times 4 x 10, and two factors of the column blocks.
    constexpr double kRow = 400 + 300;
    return {.double_flops = blocks * kProjection + rows * kRow,
            .bytes = blocks * (kBlock + kColumn) + rows * (2 * kBlock + 2 * kVector)
                     + aggregate_blocks * kCoarseBlock};
}

Work StepWork::product() const {
    const auto rows = static_cast<double>(size.free_vertices);
    const auto blocks = static_cast<double>(size.matrix_blocks);
    return {.double_flops = 64 * blocks,
            .bytes = blocks * (kBlock + kColumn) + rows * (2 * kVector + sizeof(std::int64_t))};
}

Work StepWork::precondition() const {
    const auto rows = static_cast<double>(size.free_vertices);
    // Three 4 x 4 blocks a row up and down the column, 10 modes twice; two products with the matrix
    // of the finest aggregates, of which one triangle is stored: a block counts in both.
    return {.double_flops = rows * (3 * 32 + 2 * 44) + 2 * 400 * aggregate_blocks,
            .bytes = rows * (2 * kBlock + 3 * kVector) + aggregate_blocks * kCoarseBlock};
}

Work StepWork::vectors() const {
    const auto rows = static_cast<double>(size.free_vertices);
    // r.z where z is found, x += a p with p = z + b p, p.q, r -= a q with r.r
    return {.double_flops = 4 * rows * (2 + 4 + 2 + 4), .bytes = rows * 10 * kVector};
}

double StepWork::least_step_seconds(const Ceilings& ceilings,
                                    int assemblies,
                                    int iterations) const {
    const auto seconds = [&](const Work& work) { return least_seconds(work, ceilings); };
    Work iteration = product();
    iteration += precondition();
    iteration += vectors();
    return (assemblies + 1) * seconds(forces())
           + assemblies * (seconds(hessian()) + seconds(setup())) + iterations * seconds(iteration);
}

}  // namespace pent::simulator::bench
