#pragma once

// What pent-mesh and pent-tetgen say to each other. Both are built from this file; MIT, so that
// it may stand on either side.
//
// pent-tetgen SWITCHES MEMORY_MIB CPU_SECONDS < request > answer
//
// request: Header {kRequestTag, points, triangles}, points x 3 doubles, triangles x 3 uint32
// answer:  Header {kAnswerTag, points, tets}, points x 3 doubles, tets x 4 uint32, tets x 1 double
//          (the number of the region, enclosed by facets, that the tet is in)

#include <cstdint>

namespace pent::tetgen {

constexpr std::uint64_t kRequestTag = 0x3151455254454754;  // "TGETREQ1"
constexpr std::uint64_t kAnswerTag = 0x31534e4154454754;   // "TGETANS1"

struct Header {
    std::uint64_t tag = 0;
    std::uint32_t points = 0;
    std::uint32_t cells = 0;
};

/// Exit codes. A code thrown by TetGen, 1 to 99, becomes kTetgenThrew plus that code.
enum Exit : int {
    kDone = 0,
    kBadRequest = 2,
    kBadArguments = 3,
    kOutOfMemory = 4,
    kCannotWrite = 5,
    kTetgenThrew = 100,
};

}  // namespace pent::tetgen
