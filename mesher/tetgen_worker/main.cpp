// pent-tetgen: fills a closed surface with tetrahedra, in a process of its own.
//
// Copyright (C) the Pentimento authors
// SPDX-License-Identifier: AGPL-3.0-or-later
//
// TetGen 1.5.0 ends a run it cannot finish by throwing an int, and the destructors that would run
// on the way to a handler free memory twice; some input makes it run away in memory or time, or
// crash outright. Here all of that costs one worker process: the thrown int becomes an exit code
// before anything is unwound, and the process has limits on memory and time. It also keeps
// TetGen's license (AGPL-3.0) out of the programs that start it.

#define TETLIBRARY
#include "build_info.h"
#include "protocol.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <string_view>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <tetgen.h>
#include <unistd.h>
#include <vector>

namespace {

using pent::tetgen::Header;

// What else may be thrown ends the process by a signal.
[[noreturn]] void exit_on_throw() {
    try {
        throw;
    } catch (int code) {
        ::_exit(pent::tetgen::kTetgenThrew + code);
    } catch (const std::bad_alloc&) {
        ::_exit(pent::tetgen::kOutOfMemory);
    }
}

// The soft limit alone, so that its own signal tells what happened.
void lower_limit(int resource, rlim_t value) {
    rlimit limit{};
    ::getrlimit(resource, &limit);
    limit.rlim_cur = std::min(limit.rlim_cur, value);
    ::setrlimit(resource, &limit);
}

void set_limits(const char* memory_mib, const char* cpu_seconds) {
    lower_limit(RLIMIT_CORE, 0);
    lower_limit(RLIMIT_CPU, std::strtoull(cpu_seconds, nullptr, 10));
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they reserve terabytes
    lower_limit(RLIMIT_AS, std::strtoull(memory_mib, nullptr, 10) << 20U);
#else
    static_cast<void>(memory_mib);
#endif
}

bool read_all(void* data, std::size_t bytes) {
    return bytes == 0 || std::fread(data, bytes, 1, stdin) == 1;
}

bool write_all(std::FILE* file, const void* data, std::size_t bytes) {
    return bytes == 0 || std::fwrite(data, bytes, 1, file) == 1;
}

// TetGen owns and frees the arrays, so they come from new[]; it does not free facets it was given
// on the stack, which is why everything goes through its own types.
bool read_request(tetgenio& in) {
    Header header;
    if (!read_all(&header, sizeof header) || header.tag != pent::tetgen::kRequestTag) {
        return false;
    }
    in.firstnumber = 0;
    in.numberofpoints = static_cast<int>(header.points);
    in.pointlist = new REAL[3 * std::size_t{header.points}];
    if (!read_all(in.pointlist, 3 * sizeof(double) * header.points)) {
        return false;
    }
    std::vector<std::uint32_t> corners(3 * std::size_t{header.cells});
    if (!read_all(corners.data(), corners.size() * sizeof(std::uint32_t))) {
        return false;
    }
    in.numberoffacets = static_cast<int>(header.cells);
    in.facetlist = new tetgenio::facet[header.cells];
    for (std::size_t t = 0; t < header.cells; ++t) {
        tetgenio::facet& facet = in.facetlist[t];
        tetgenio::init(&facet);
        facet.numberofpolygons = 1;
        facet.polygonlist = new tetgenio::polygon[1];
        tetgenio::polygon& polygon = facet.polygonlist[0];
        tetgenio::init(&polygon);
        polygon.numberofvertices = 3;
        polygon.vertexlist = new int[3];
        for (std::size_t i = 0; i < 3; ++i) {
            polygon.vertexlist[i] = static_cast<int>(corners[3 * t + i]);
        }
    }
    return true;
}

bool write_answer(std::FILE* file, const tetgenio& out) {
    const Header header{pent::tetgen::kAnswerTag, static_cast<std::uint32_t>(out.numberofpoints),
                        static_cast<std::uint32_t>(out.numberoftetrahedra)};
    const std::size_t tets = header.cells;
    std::vector<double> regions(tets, 1.0);
    for (std::size_t t = 0; t < tets && out.numberoftetrahedronattributes > 0; ++t) {
        const auto stride = static_cast<std::size_t>(out.numberoftetrahedronattributes);
        regions[t] = out.tetrahedronattributelist[stride * (t + 1) - 1];
    }
    static_assert(sizeof(int) == sizeof(std::uint32_t));
    return write_all(file, &header, sizeof header)
           && write_all(file, out.pointlist, 3 * sizeof(double) * header.points)
           && write_all(file, out.tetrahedronlist, 4 * sizeof(int) * tets)
           && write_all(file, regions.data(), sizeof(double) * tets) && std::fflush(file) == 0;
}

// noexcept: an int thrown inside ends in exit_on_throw() with nothing unwound.
void fill(char* switches, tetgenio& in, tetgenio& out) noexcept {
    tetrahedralize(switches, &in, &out);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc == 2 && std::string_view(argv[1]) == "--version") {
        std::printf("pent-tetgen " PENT_VERSION "\n%s\n", pent::build_info());
        return pent::tetgen::kDone;
    }
    if (argc != 4) {
        std::fprintf(stderr,
                     "pent-tetgen is started by pent-mesh:\n"
                     "pent-tetgen SWITCHES MEMORY_MIB CPU_SECONDS < request > answer\n");
        return pent::tetgen::kBadArguments;
    }
    std::set_terminate(exit_on_throw);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // without pent-mesh there is nobody to answer
    set_limits(argv[2], argv[3]);
    // TetGen reports on stdout; the answer keeps the real one to itself.
    std::FILE* answer = ::fdopen(::dup(STDOUT_FILENO), "wb");
    if (answer == nullptr || ::dup2(STDERR_FILENO, STDOUT_FILENO) < 0) {
        return pent::tetgen::kCannotWrite;
    }
    tetgenio in;
    tetgenio out;
    if (!read_request(in)) {
        return pent::tetgen::kBadRequest;
    }
    fill(argv[1], in, out);
    const bool is_written = write_answer(answer, out);
    ::_exit(is_written ? pent::tetgen::kDone : pent::tetgen::kCannotWrite);
}
