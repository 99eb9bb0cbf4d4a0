#include "mpi_ranks.h"
#include "petsc_error.h"
#include "petsc_solver.h"

#include <pent/distributed/mpi_session.h>
#include <pent/error.h>
#include <pent/printable.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <malloc.h>
#include <petscsys.h>
#include <thread>

namespace pent::distributed {

namespace {

// Options of PETSc. Products that add up as messages come in would not give the same bits twice;
// the other two need fewer iterations where layers are thin.
std::string options_text(int ranks) {
    std::string text = ranks > 1 ? "-matptap_via allatonce" : "";
    for (const char* option : {"pc_gamg_aggressive_coarsening 0", "mg_levels_pc_type pbjacobi"}) {
        text += std::string(" -") + PetscSolver::kPrefix + option;
    }
    return text;
}

// SuperLU_DIST, which PETSc links, has freed memory kept for later from when it is loaded: arrays
// that grow would count two or three times. These are the C library's own settings.
void give_freed_memory_back() {
#ifdef __GLIBC__
    constexpr int kMappings = 65536;
    constexpr int kLarge = 128 * 1024;
    mallopt(M_MMAP_MAX, kMappings);
    mallopt(M_TRIM_THRESHOLD, kLarge);
    mallopt(M_MMAP_THRESHOLD, kLarge);
#endif
}

}  // namespace

MpiSession::MpiSession() {
    give_freed_memory_back();
    // Steps are taken by one thread at a time, which need not be this one.
    int provided = MPI_THREAD_SINGLE;
    if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided) != MPI_SUCCESS
        || provided < MPI_THREAD_SERIALIZED) {
        throw Error("MPI cannot be used by programs with threads: use another MPI library");
    }
    std::array<std::string, 3> words = {"pent-sim-mpi", "-skip_petscrc", "-no_signal_handler"};
    std::array<char*, 4> arguments = {words[0].data(), words[1].data(), words[2].data(), nullptr};
    int count = 3;
    char** list = arguments.data();
    check(PetscInitialize(&count, &list, nullptr, nullptr));
    check(PetscPushErrorHandler(PetscIgnoreErrorHandler, nullptr));
    auto ranks = std::make_shared<MpiRanks>(PETSC_COMM_WORLD);
    check(PetscOptionsInsertString(nullptr, options_text(ranks->count()).c_str()));
    ranks_ = std::move(ranks);
}

MpiSession::~MpiSession() {
    PetscFinalize();
    MPI_Finalize();
}

void MpiSession::finish(int code, const std::string& error) {
    using Clock = std::chrono::steady_clock;
    constexpr auto kPatience = std::chrono::seconds(5);
    const Clock::time_point start = Clock::now();
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibarrier(PETSC_COMM_WORLD, &request);
    for (int has_ended = 0; has_ended == 0;) {
        MPI_Test(&request, &has_ended, MPI_STATUS_IGNORE);
        if (has_ended == 0 && !error.empty() && Clock::now() - start > kPatience) {
            const std::string line = "rank " + std::to_string(ranks_->rank()) + ": " + error;
            std::fprintf(stderr, "pent-sim-mpi: %s\n", printable(line).c_str());
            MPI_Abort(PETSC_COMM_WORLD, code);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

}  // namespace pent::distributed
