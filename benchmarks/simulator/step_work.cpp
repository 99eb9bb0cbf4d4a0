#include "step_work.h"

namespace pent::simulator::bench {

namespace {

constexpr double kVector = 4 * sizeof(double);  // of a vertex
constexpr double kBlock = 16 * sizeof(float);
constexpr double kColumn = sizeof(std::uint32_t);  // of a block
constexpr int kModes = 10;                         // of an aggregate

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
    const double coarse = kModes * aggregates;
    // A block times 10 modes: 4 columns as they are, 6 rotations of 3 operations an entry, and the
    // sum.
    constexpr double kProjection = 6 * 4 * 3 + 40;
    // A row: 10 modes times 4 x 10, and two factors of the column blocks.
    constexpr double kRow = 400 + 300;
    return {.double_flops = blocks * kProjection + rows * kRow + coarse * coarse * coarse / 3,
            .bytes = blocks * (kBlock + kColumn) + rows * (2 * kBlock + 2 * kVector)
                     + coarse * coarse * sizeof(double)};
}

Work StepWork::product() const {
    const auto rows = static_cast<double>(size.free_vertices);
    const auto blocks = static_cast<double>(size.matrix_blocks);
    return {.double_flops = 64 * blocks,
            .bytes = blocks * (kBlock + kColumn) + rows * (2 * kVector + sizeof(std::int64_t))};
}

Work StepWork::precondition() const {
    const auto rows = static_cast<double>(size.free_vertices);
    const double coarse = kModes * aggregates;
    // Three 4 x 4 blocks a row up and down the column, 10 modes twice.
    return {.double_flops = rows * (3 * 32 + 2 * 44) + 2 * coarse * coarse,
            .bytes = rows * (2 * kBlock + 3 * kVector) + coarse * coarse / 2 * sizeof(double)};
}

Work StepWork::vectors() const {
    const auto rows = static_cast<double>(size.free_vertices);
    // r.z, p = z + b p, p.q, x += a p and r -= a q with r.r
    return {.double_flops = 4 * rows * (2 + 2 + 2 + 6), .bytes = rows * 13 * kVector};
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
