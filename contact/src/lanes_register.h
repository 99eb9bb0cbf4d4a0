#pragma once

// Included once for each instruction set, by kernels.

namespace pent::contact {
namespace {

// Of a register of the instruction set that this file is compiled for.
#if defined(__AVX512F__)
constexpr int kRegisterBytes = 64;
#elif defined(__AVX__)
constexpr int kRegisterBytes = 32;
#else
constexpr int kRegisterBytes = 16;
#endif

}  // namespace
}  // namespace pent::contact
