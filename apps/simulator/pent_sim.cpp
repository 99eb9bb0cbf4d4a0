#include "simulation_program.h"

int main(int argc, char** argv) {
    pent::apps::Program program(
        "pent-sim", "Simulates the deformable bodies of a scene, in four dimensions or three.",
        "pent-sim octopus.toml -o run/");
    return run_simulation_program(program, nullptr, argc, argv);
}
