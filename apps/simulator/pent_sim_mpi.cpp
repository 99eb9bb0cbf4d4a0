#include "simulation_program.h"

#include <pent/distributed/mpi_session.h>

#include <exception>

int main(int argc, char** argv) {
    pent::apps::Program program(
        "pent-sim-mpi",
        "Simulates the deformable bodies of a scene by many processes, as pent-sim does by one.",
        "mpirun -n 4 pent-sim-mpi octopus.toml -o run/ --threads 8");
    try {
        pent::distributed::MpiSession session;
        if (session.ranks()->rank() != 0) {
            program.silence();
        }
        const int code = run_simulation_program(program, session.ranks(), argc, argv);
        session.finish(code, program.error());
        return code;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "pent-sim-mpi: %s\n", error.what());
        return 1;
    }
}
