#include "flop_count.h"

#include "beams.h"
#include "kernels/kernel_table.h"
#include "shaken_beam.h"

namespace pent::simulator {
namespace {

// A number that counts what is done with it.
template <typename Scalar>
struct Counted {
    Scalar value;

    static inline std::int64_t flops = 0;

    Counted() = default;
    template <typename Other>
    explicit Counted(Other other) : value(static_cast<Scalar>(other)) {}

    Counted operator-() const { return Counted(-value); }
    Counted& operator+=(Counted other) { return *this = *this + other; }
    Counted& operator-=(Counted other) { return *this = *this - other; }
    Counted& operator*=(Counted other) { return *this = *this * other; }
    friend Counted operator+(Counted a, Counted b) { return counted(a.value + b.value); }
    friend Counted operator-(Counted a, Counted b) { return counted(a.value - b.value); }
    friend Counted operator*(Counted a, Counted b) { return counted(a.value * b.value); }
    friend Counted operator/(Counted a, Counted b) { return counted(a.value / b.value); }
    friend bool operator<(Counted a, Counted b) { return a.value < b.value; }
    friend bool operator>(Counted a, Counted b) { return a.value > b.value; }
    friend bool operator>=(Counted a, Counted b) { return a.value >= b.value; }
    friend bool operator==(Counted a, Counted b) { return a.value == b.value; }

    static Counted counted(Scalar value) {
        ++flops;
        return Counted(value);
    }
};

template <typename Scalar>
struct Lanes<Counted<Scalar>> {
    using Real = Counted<Scalar>;
    using One = OneLane<Scalar>;
    static constexpr int kCount = 1;
    using Number = Scalar;
    using Mask = bool;

    static Real load(const double* from) { return Real(*from); }
    static void store(Real value, Scalar* to) { *to = value.value; }
    static Real load_stored(const Scalar* from) { return Real(*from); }
    static Real select(bool mask, Real yes, Real no) { return mask ? yes : no; }
    static bool any(bool mask) { return mask; }
    static Real root(Real value) { return Real::counted(One::root(value.value)); }
    static Real abs(Real value) { return Real(One::abs(value.value)); }
    static Real max(Real a, Real b) { return Real(One::max(a.value, b.value)); }
    static Real multiply_add(Real a, Real b, Real c) { return a * b + c; }
    static Scalar lane(Real value, int /*i*/) { return value.value; }
    static void set_lane(Real& value, int /*i*/, Scalar number) { value = Real(number); }
};

}  // namespace

namespace bench {

FlopCount count_flops(ElementKind kind) {
    const ShakenBeam sample(box({4, 4, 4, 4}), kind);
    const auto elements = static_cast<double>(sample.elements->count());
    Kernels<4> counting = kernels<4>(Isa::Scalar);
    counting.gradient = &add_gradient_of<4, Counted<double>>;
    counting.hessian_float = &add_hessian_of<4, Counted<float>, float>;
    Counted<double>::flops = Counted<float>::flops = 0;
    const Workers workers(1);
    Positions<4> gradient = Positions<4>::Zero(4, sample.mesh.vertex_count());
    static_cast<void>(sample.elements->add_gradient(workers, counting, sample.positions, gradient));
    BlockMatrix<4, float> matrix(sample.pattern);
    sample.assemble(workers, counting, matrix);
    return {.forces = static_cast<double>(Counted<double>::flops) / elements,
            .hessian = static_cast<double>(Counted<float>::flops) / elements};
}

}  // namespace bench
}  // namespace pent::simulator
