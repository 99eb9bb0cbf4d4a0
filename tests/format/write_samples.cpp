// Writes a mesh in both encodings, a frame, and the mesh's numbers as plain text, for the test of
// the numpy reader in docs/.

#include "support/kuhn_box.h"

#include <pent/pent_file.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: write_samples FOLDER\n");
        return EXIT_FAILURE;
    }
    const std::filesystem::path folder = argv[1];
    pent::SimplexMesh<4> mesh = pent::test::kuhn_box<4>({2, 1, 1, 1}, {0.3, 0.1, 0.7, 1.1});
    mesh.columns.assign(mesh.vertex_count(), 5);
    mesh.layers.assign(mesh.vertex_count(), 6);
    mesh.regions.assign(mesh.cell_count(), 7);
    const std::uint32_t crc = pent::write_mesh(folder / "binary.pent", mesh);
    pent::write_mesh(folder / "ascii.pent", mesh, {.encoding = pent::Encoding::Ascii});
    pent::Frame<4> frame;
    frame.positions = mesh.positions;
    frame.velocities = -mesh.positions;
    frame.mesh_name = "binary.pent";
    frame.mesh_crc = crc;
    frame.time = 0.5;
    pent::write_frame(folder / "frame.pent", frame);
    std::ofstream(folder / "positions.txt") << std::setprecision(17) << mesh.positions.transpose();
    std::ofstream(folder / "cells.txt") << mesh.cells.transpose();
    return EXIT_SUCCESS;
}
